// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/multicast_only.hpp"
#include "common/bus/shell.hpp"
#include "common/seal/seal.hpp"
#include "tools/robot/link/link_rules.hpp"

namespace {

using namespace tread;
using namespace tread::link;

constexpr int kWaitMs = 5;

/// One direction: receives on one bus, sends on the other.
class Direction {
 public:
  Direction(lcm::LCM& from, lcm::LCM& to, const std::vector<LinkRule>& rules, double most)
      : to_(to), filter_(rules, most) {
    for (const LinkRule& rule : rules)
      from.subscribe(rule.channel, &Direction::hear, this)->setQueueCapacity(500);
  }
  const LinkFilter& filter() const { return filter_; }
  /// Messages that could not be sent because the link is down.
  int64_t unsent() const { return unsent_; }
  int64_t heard() const { return heard_; }

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    heard_ = hostNow();
    const auto* const bytes = static_cast<const uint8_t*>(buffer->data);
    const std::vector<uint8_t> message(bytes, bytes + sizeWithoutSeal(bytes, buffer->data_size));
    if (!filter_.passes(channel, message, buffer->data_size, hostNow())) return;
    if (to_.publish(channel, buffer->data, buffer->data_size) != 0) ++unsent_;
  }

  lcm::LCM& to_;
  LinkFilter filter_;
  int64_t unsent_ = 0;
  int64_t heard_ = 0;  ///< [us] of the host
};

void handleAll(lcm::LCM& bus, int milliseconds) {
  for (int wait = milliseconds, i = 0; i < 500 && bus.handleTimeout(wait) > 0; wait = 0, ++i) {
  }
}

/// Publishes the link's HEALTH.
class LinkNode : public Node {
 public:
  LinkNode(Bus& bus, const LinkConfig& config, const std::string& robot_url)
      : health_(bus, "link", config.effective),
        robot_(robot_url),
        station_(config.station_url),
        there_(open(robot_, robot_url), open(station_, config.station_url), config.to_station,
               config.most),
        back_(station_, robot_, config.to_robot, config.most) {}
  int64_t period() const override { return 1'000 * kWaitMs; }
  void step(int64_t utime) override {
    handleAll(robot_, 0);
    handleAll(station_, 0);
    const bool silent = hostNow() - back_.heard() > 2'000'000;
    health_.setState(health_t::HEALTH_OK, "");
    if (there_.unsent() > unsent_)
      health_.setState(health_t::HEALTH_DEGRADED,
                       "the link is down: nothing can be sent to the station");
    unsent_ = there_.unsent();
    health_.setCounter("to the station", there_.filter().passed());
    health_.setCounter("to the robot", back_.filter().passed());
    health_.setCounter("dropped for the rate", there_.filter().thinned());
    health_.setCounter("dropped for the budget", there_.filter().over_budget());
    health_.setCounter("the station is received", silent ? 0 : 1);
    health_.step(utime);
  }

 private:
  static lcm::LCM& open(lcm::LCM& bus, const std::string& url) {
    if (!bus.good() || !openForMulticastOnly(bus, url))
      throw std::runtime_error("LCM cannot be used at " + url);
    return bus;
  }

  HealthReporter health_;
  lcm::LCM robot_, station_;
  Direction there_, back_;
  int64_t unsent_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const LinkConfig config = readLinkConfig(reader);
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      const std::string url = access.url;
      LcmBus bus(std::move(access), TimeSource::kHost);
      LinkNode node(bus, config, url);
      bus.run(node, stop);
    };
  };
  return runShell(
      argc, argv, "tread-link",
      "Joins the robot's own bus and the operator station's. Only the channels that its "
      "configuration names cross, limited in rate.",
      prepare);
}

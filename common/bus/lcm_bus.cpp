// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_bus.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/multicast_only.hpp"

namespace tread {
namespace {

/// No clock runs that long (126 years), and sums of times cannot overflow.
constexpr int64_t kLargestUtime = 4'000'000'000'000'000;
constexpr int kEnoughAgreeing = 3;
constexpr int64_t kAgreementUs = 1'000'000;
constexpr int64_t kUnopposedUs = 200'000;

constexpr int kQueueCapacity = 1000;

/// For LCM, devices and files. With fewer, LCM may fail to start without an error.
constexpr size_t kDescriptors = 24;

const std::string& requireDescriptors(const std::string& url) {
  std::vector<int> held;
  for (int one = 0; one >= 0 && held.size() < kDescriptors;) {
    one = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (one >= 0) held.push_back(one);
  }
  for (const int one : held) ::close(one);
  if (held.size() == kDescriptors) return url;
  throw std::runtime_error("this process may open only " + std::to_string(held.size()) +
                           " more files, " + std::to_string(kDescriptors) +
                           " are needed: ulimit -n 1024, or LimitNOFILE=1024 in its unit");
}

}  // namespace

bool FollowedTime::observe(int64_t utime, int64_t host) {
  if (utime < 0 || utime > kLargestUtime) return false;
  const int64_t ahead = utime - now(host);
  if (!started_ || ahead > max_jump_us_) return observeCandidate(utime, host);
  // An old message neither confirms nor contradicts the present time.
  if (ahead >= -kAgreementUs) agreeing_ = 0;
  if (ahead > 0) set(utime, host);
  return true;
}

bool FollowedTime::observeCandidate(int64_t utime, int64_t host) {
  const int64_t expected = candidate_ + (host - candidate_host_);
  if (agreeing_ == 0 || std::abs(utime - expected) > kAgreementUs) {
    agreeing_ = 1;
    first_agreeing_ = host;
    candidate_ = utime;
    candidate_host_ = host;
  } else if (utime > candidate_) {
    // A duplicate, or a message with a longer delay, confirms nothing.
    ++agreeing_;
    candidate_ = utime;
    candidate_host_ = host;
  }
  const bool unopposed = !started_ || host - first_agreeing_ >= kUnopposedUs;
  if (agreeing_ < kEnoughAgreeing || !unopposed) return !started_;
  set(candidate_, candidate_host_);
  return true;
}

void FollowedTime::set(int64_t utime, int64_t host) {
  utime_ = utime;
  host_ = host;
  started_ = true;
  agreeing_ = 0;
}

struct LcmBus::Subscription {
  LcmBus* bus;
  std::string channel;

  static void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                      Subscription* self) {
    // LCM treats a channel name as a regular expression; ours have no special characters, others
    // may.
    if (channel != self->channel) return;
    self->bus->receive(channel, static_cast<const uint8_t*>(buffer->data), buffer->data_size);
  }
};

LcmBus::LcmBus(BusAccess access, TimeSource time_source, int64_t max_jump_us)
    : lcm_(std::make_unique<lcm::LCM>(requireDescriptors(access.url))),
      time_source_(time_source),
      boot_id_(hostNow()),
      followed_(boot_id_, max_jump_us) {
  if (!openForMulticastOnly(*lcm_, access.url))
    throw std::runtime_error(
        "LCM cannot use '" + (access.url.empty() ? std::string("the default URL") : access.url) +
        (access.url.rfind("tcpq:", 0) == 0
             ? "': no tread-launch with this --lcm-url runs"
             : "': is there a multicast route? type: sudo ip link set lo multicast on && "
               "sudo ip route add 224.0.0.0/4 dev lo"));
  setSealer(std::move(access.sealer));
}

LcmBus::~LcmBus() = default;

int64_t LcmBus::now() const {
  if (time_source_ == TimeSource::kHost) return hostNow();
  return followed_.now(hostNow());
}

int64_t LcmBus::sealClock() const {
  return hostNow();
}

int64_t LcmBus::utc() const {
  return hostUtc();
}

bool LcmBus::onReceipt(int64_t utime) {
  return time_source_ == TimeSource::kHost || followed_.observe(utime, hostNow());
}

bool LcmBus::send(const char* channel, const uint8_t* bytes, size_t size) {
  return lcm_->publish(channel, bytes, static_cast<unsigned int>(size)) == 0;
}

void LcmBus::listen(const char* channel) {
  subscriptions_.push_back(std::make_unique<Subscription>(Subscription{this, channel}));
  lcm::Subscription* subscription =
      lcm_->subscribeFunction(channel, &Subscription::receive, subscriptions_.back().get());
  if (subscription == nullptr)
    throw std::runtime_error(std::string("LCM does not let us subscribe to ") + channel);
  // LCM drops the newest when its queue is full: never let it get full.
  subscription->setQueueCapacity(kQueueCapacity);
}

void LcmBus::handle(int timeout_ms) {
  if (lcm_->handleTimeout(timeout_ms) <= 0) return;
  // At most one queue length per channel: messages that arrive faster than they are handled must
  // not delay the node's step.
  for (int i = 0; i < kQueueCapacity && lcm_->handleTimeout(0) > 0; ++i) {
  }
}

void LcmBus::run(Node& node, const std::atomic<bool>& stop) {
  try {
    runSteps(node, stop);
  } catch (...) {
    life_.stopping();
    node.shutdown(now());
    throw;
  }
  life_.stopping();
  node.shutdown(now());
}

void LcmBus::runSteps(Node& node, const std::atomic<bool>& stop) {
  const int64_t period = node.period();
  int64_t next_step = hostNow();
  while (!stop) {
    const int64_t wait = next_step - hostNow();
    // Rounded up: a remainder below a millisecond would be waited for without sleeping.
    handle(static_cast<int>(std::max<int64_t>(0, (wait + 999) / 1000)));
    const int64_t started = hostNow();
    if (started < next_step) continue;
    node.step(now());
    noteCycle(hostNow() - started);
    life_.beat(hostNow());
    // A late step is not made up for: stay on the grid.
    next_step += period * std::max<int64_t>(1, (hostNow() - next_step) / period + 1);
  }
}

void LcmBus::noteCycle(int64_t microseconds) {
  ++cycles_;
  cycle_sum_ += microseconds;
  cycle_max_ = std::max(cycle_max_, microseconds);
}

CycleTimes LcmBus::takeCycleTimes() {
  CycleTimes times;
  if (cycles_ > 0) times.mean_us = static_cast<int32_t>(cycle_sum_ / cycles_);
  times.max_us = static_cast<int32_t>(cycle_max_);
  cycles_ = cycle_sum_ = cycle_max_ = 0;
  return times;
}

}  // namespace tread

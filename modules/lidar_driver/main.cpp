// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "common/bus/shell.hpp"
#include "modules/lidar_driver/hokuyo/hokuyo_source.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"
#include "modules/lidar_driver/link_source.hpp"

namespace {

using namespace tread;
using namespace tread::lidar;

/// Ends the process when the library hangs for good: only a new process helps then. Tells `stuck`
/// whether it hangs at the end.
class GuardedSource : public ScanSource {
 public:
  GuardedSource(std::unique_ptr<ScanSource> source, bool& stuck)
      : source_(std::move(source)), stuck_(stuck) {}
  ~GuardedSource() override { stuck_ = !source_->end(); }
  std::vector<RangeScan> take(int64_t utime) override {
    if (source_->stuckFor() > 20.0) {
      std::cerr
          << "tread-lidar-driver: the range finder's library has not come back for 20 s; ending, "
             "so that the supervisor starts a new process"
          << std::endl;
      std::_Exit(1);
    }
    return source_->take(utime);
  }
  Reason reason(int64_t utime, bool ground) const override {
    return source_->reason(utime, ground);
  }
  std::string shortcomings() const override { return source_->shortcomings(); }
  std::map<std::string, int64_t> counters() const override { return source_->counters(); }

 private:
  std::unique_ptr<ScanSource> source_;
  bool& stuck_;
};

/// The range finder that looks around and the one that looks at the ground, as one source.
class TwoSources : public ScanSource {
 public:
  TwoSources(std::unique_ptr<ScanSource> around, std::unique_ptr<ScanSource> ground)
      : around_(std::move(around)), ground_(std::move(ground)) {}
  std::vector<RangeScan> take(int64_t utime) override {
    std::vector<RangeScan> scans = around_->take(utime);
    for (RangeScan& scan : ground_->take(utime)) {
      scan.ground = true;
      scans.push_back(std::move(scan));
    }
    return scans;
  }
  Reason reason(int64_t utime, bool ground) const override {
    return (ground ? ground_ : around_)->reason(utime, ground);
  }
  /// Both are of one kind.
  std::string shortcomings() const override { return around_->shortcomings(); }
  std::map<std::string, int64_t> counters() const override {
    std::map<std::string, int64_t> counters = around_->counters();
    for (const auto& [name, number] : ground_->counters()) counters["ground: " + name] = number;
    return counters;
  }
  double stuckFor() const override { return std::max(around_->stuckFor(), ground_->stuckFor()); }
  bool end() override {
    const bool ended = around_->end();
    return ground_->end() && ended;
  }

 private:
  std::unique_ptr<ScanSource> around_;
  std::unique_ptr<ScanSource> ground_;
};

/// One of the range finders; hokuyo is the one that is reached through a library.
std::unique_ptr<ScanSource> sourceAt(const std::string& address, const LidarDriverConfig& config) {
  if (!config.device.make) return std::make_unique<HokuyoSource>(address, config.latency);
  const auto open = [address] { return makeLink(address); };
  auto source = std::make_unique<LinkSource>(open, config.device.make());
  requireFree(source->link());
  return source;
}

std::unique_ptr<ScanSource> sourceOf(const LidarDriverConfig& config) {
  auto around = sourceAt(config.address, config);
  if (!config.ground_mounting) return around;
  return std::make_unique<TwoSources>(std::move(around), sourceAt(config.ground_address, config));
}

}  // namespace

int main(int argc, char** argv) {
  bool stuck = false;
  const auto prepare = [&stuck](ConfigReader& reader) -> ShellBody {
    const LidarDriverConfig config = readLidarDriverConfig(reader);
    checkDeviceAddress(config.device.name, config.address);
    if (config.ground_mounting) checkDeviceAddress(config.device.name, config.ground_address);
    const auto run = [config, &stuck](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kHost);
      GuardedSource source(sourceOf(config), stuck);
      LidarDriverNode node(config, bus, source, [](const std::string& line) {
        std::cerr << "tread-lidar-driver: " << line << std::endl;
      });
      bus.run(node, stop);
    };
    return {run, [config] {
              requireListening(config.address);
              if (config.ground_mounting) requireListening(config.ground_address);
            }};
  };
  const int code =
      runShell(argc, argv, "tread-lidar-driver", "Publishes SCAN from a range finder.", prepare);
  if (stuck) std::_Exit(code);
  return code;
}

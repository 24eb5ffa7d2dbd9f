// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>

#include "common/bus/shell.hpp"
#include "modules/lidar_driver/hokuyo/hokuyo_source.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"

namespace {

using namespace tread;
using namespace tread::lidar;

struct Device {
  std::function<void(const std::string&)> check_address;  ///< throws where it makes no sense
  std::function<std::unique_ptr<ScanSource>(const std::string& address, double latency)> make;
};

/// A new range finder is one line here, its name in kScanDevices, and a folder of its own.
Device deviceNamed(const std::string& name) {
  if (name == "hokuyo")
    return {[](const std::string& address) { rangeFinderAddress(address); },
            [](const std::string& address, double latency) {
              return std::make_unique<HokuyoSource>(address, latency);
            }};
  throw std::logic_error(name);
}

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
  std::string problem() const override { return source_->problem(); }

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
  std::string problem() const override {
    const std::string around = around_->problem();
    return around.empty() ? ground_->problem() : around;
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

std::unique_ptr<ScanSource> sourceOf(const LidarDriverConfig& config, const Device& device) {
  auto around = device.make(config.address, config.latency);
  if (!config.ground_mounting) return around;
  return std::make_unique<TwoSources>(std::move(around),
                                      device.make(config.ground_address, config.latency));
}

}  // namespace

int main(int argc, char** argv) {
  bool stuck = false;
  const auto prepare = [&stuck](ConfigReader& reader) -> ShellBody {
    const LidarDriverConfig config = readLidarDriverConfig(reader);
    const Device device = deviceNamed(config.device);
    device.check_address(config.address);
    if (config.ground_mounting) device.check_address(config.ground_address);
    return [config, device, &stuck](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kHost);
      GuardedSource source(sourceOf(config, device), stuck);
      LidarDriverNode node(config, bus, source);
      bus.run(node, stop);
    };
  };
  const int code =
      runShell(argc, argv, "tread-lidar-driver", "Publishes SCAN from a range finder.", prepare);
  if (stuck) std::_Exit(code);
  return code;
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdlib>
#include <iostream>

#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "modules/lidar_driver/hokuyo_source.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"

namespace {

using namespace tread;
using namespace tread::lidar;

/// Ends the process when the library hangs for good: only a new process helps then.
class GuardedSource : public ScanSource {
 public:
  explicit GuardedSource(HokuyoSource& source) : source_(source) {}
  std::vector<RangeScan> take(int64_t utime) override {
    if (source_.stuckFor() > 20.0) {
      std::cerr
          << "tread-lidar-driver: the range finder's library has not come back for 20 s; ending, "
             "so that the supervisor starts a new process"
          << std::endl;
      std::_Exit(1);
    }
    return source_.take(utime);
  }
  std::string problem() const override { return source_.problem(); }

 private:
  HokuyoSource& source_;
};

ShellBody prepare(ConfigReader& reader) {
  const LidarDriverConfig config = readLidarDriverConfig(reader);
  return [config](const std::string& lcm_url, const std::atomic<bool>& stop) {
    LcmBus bus(lcm_url, TimeSource::kHost);
    HokuyoSource device(config.address, config.latency);
    GuardedSource source(device);
    LidarDriverNode node(config, bus, source);
    bus.run(node, stop);
  };
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-lidar-driver",
                  "Publishes SCAN from a SCIP 2.0 range finder over TCP.", prepare);
}

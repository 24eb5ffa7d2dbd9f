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

/// Ends the process when the library hangs for good: only a new process helps then. Tells `stuck`
/// whether it hangs at the end.
class GuardedSource : public ScanSource {
 public:
  GuardedSource(const LidarDriverConfig& config, bool& stuck)
      : source_(config.address, config.latency), stuck_(stuck) {}
  ~GuardedSource() override { stuck_ = !source_.end(); }
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
  HokuyoSource source_;
  bool& stuck_;
};

ShellBody prepare(ConfigReader& reader, bool& stuck) {
  const LidarDriverConfig config = readLidarDriverConfig(reader);
  rangeFinderAddress(config.address);  // throws where it makes no sense
  return [config, &stuck](const std::string& lcm_url, const std::atomic<bool>& stop) {
    LcmBus bus(lcm_url, TimeSource::kHost);
    GuardedSource source(config, stuck);
    LidarDriverNode node(config, bus, source);
    bus.run(node, stop);
  };
}

}  // namespace

int main(int argc, char** argv) {
  bool stuck = false;
  const int code = runShell(argc, argv, "tread-lidar-driver",
                            "Publishes SCAN from a SCIP 2.0 range finder over TCP.",
                            [&stuck](ConfigReader& reader) { return prepare(reader, stuck); });
  if (stuck) std::_Exit(code);
  return code;
}

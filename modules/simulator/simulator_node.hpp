// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>

#include "common/bus/bus.hpp"
#include "common/bus/health.hpp"
#include "common/link/link.hpp"
#include "modules/simulator/emulators/simulated_devices.hpp"
#include "modules/simulator/truth_record.hpp"

namespace tread::sim {

/// The devices' ends of the lines to the drivers.
struct DeviceLines {
  Link& ins;
  Link& motor;
  Link* laser = nullptr;  ///< SCIP bytes; null where scans are taken with takeScans()
};

/// Steps the simulated robot and carries the devices' bytes over their lines.
/** Devices and lines are the owner's and outlive the node. Bytes that a line does not take are
   lost, as on a real one. Beside HEALTH and CONFIG nothing is published: the truth stays hidden,
   but for a record that whoever starts the simulator may want. Where the vehicle's motion is not to
   be relied on any more, HEALTH says why from then on, and `say` gets the line once. */
class SimulatorNode : public Node {
 public:
  using Say = std::function<void(const std::string& line)>;
  SimulatorNode(SimulatedDevices& devices, Bus& bus, const DeviceLines& lines,
                TruthRecord* record = nullptr, Say say = {});

  int64_t period() const override { return 2000; }
  void step(int64_t utime) override;

 private:
  void advanceTo(int64_t utime);
  void tellHealth(int64_t utime);
  std::string hear(Link& line, int64_t utime);
  void transmit(Link& line, const std::string& bytes);

  SimulatedDevices& devices_;
  DeviceLines lines_;
  TruthRecord* record_;
  Say say_;
  bool warned_ = false;
  int64_t next_health_ = 0;
  HealthReporter health_;
  bool laser_connected_ = false;
};

}  // namespace tread::sim

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

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
   but for a record that whoever starts the simulator may want. */
class SimulatorNode : public Node {
 public:
  SimulatorNode(SimulatedDevices& devices, Bus& bus, const DeviceLines& lines,
                TruthRecord* record = nullptr);

  int64_t period() const override { return 2000; }
  void step(int64_t utime) override;

 private:
  void advanceTo(int64_t utime);
  std::string hear(Link& line, int64_t utime);
  void say(Link& line, const std::string& bytes);

  SimulatedDevices& devices_;
  DeviceLines lines_;
  TruthRecord* record_;
  HealthReporter health_;
  bool laser_connected_ = false;
};

}  // namespace tread::sim

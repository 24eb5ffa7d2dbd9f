// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/link/link.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/simulator/emulators/simulated_devices.hpp"
#include "modules/simulator/simulator_files.hpp"

namespace tread::sim {

/// Configuration of the simulator process (config/simulators).
struct SimulatorConfig {
  std::string world;                   ///< path of a world file
  SimulatorSettings settings;          ///< the process sets start_utime and utc_at_zero
  std::optional<ModelDocument> model;  ///< replaces the dynamic vehicle
  std::string ins = "pty:devices/ins";
  std::string motor = "pty:devices/motor";
  std::string laser = "tcp-server:127.0.0.1:10940";
  std::string ground_laser = "tcp-server:127.0.0.1:10941";  ///< for robots that have one
  std::string record = "none";                              ///< path of the truth as CSV, or none
};

/// Reads it strictly, including the model file; throws ConfigError with file:line.
SimulatorConfig readSimulatorConfig(ConfigReader& reader);

/// The devices' ends of the lines to the drivers.
struct DeviceLines {
  Link& ins;
  Link& motor;
  Link* laser = nullptr;         ///< null if its scans are not read
  Link* ground_laser = nullptr;  ///< the same
};

/// Steps the simulated robot and transfers the devices' bytes over their lines.
/** Devices and lines belong to the caller and outlive the node. Bytes that a line does not take are
 * lost, as on a real one. Besides HEALTH and CONFIG nothing is published: the truth stays hidden,
 * except for an optional record. If the vehicle's motion becomes unreliable, HEALTH reports why
 * from then on, and `say` gets the line once. */
class SimulatorNode : public Node {
 public:
  using Say = std::function<void(const std::string& line)>;
  SimulatorNode(SimulatedDevices& devices, Bus& bus, const DeviceLines& lines,
                TruthRecord* record = nullptr, Say say = {});

  int64_t period() const override { return 2000; }
  void step(int64_t utime) override;

 private:
  void advanceTo(int64_t utime);
  void note(int64_t utime);
  void tellHealth(int64_t utime);
  void serve(LaserEmulator& laser, Link& line, bool& connected, int64_t utime);
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
  bool ground_laser_connected_ = false;
};

}  // namespace tread::sim

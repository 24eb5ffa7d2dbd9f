// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/virtual_bus.hpp"
#include "common/store/store.hpp"
#include "modules/simulator/simulator_node.hpp"
#include "tools/robot/setup/interview.hpp"
#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// A simulated machine and the devices at its ports. The setup sees only the ports.
struct HiddenMachine {
  sim::SimulatorSettings settings;
  sim::WorldDescription world;
  std::string ins_port, motor_port, laser_port;      ///< as in ports()
  int ins_baud = 0, motor_baud = 0, laser_baud = 0;  ///< 0 = not a serial line
  std::vector<std::string> empty_ports;              ///< without a device
};

/// The machine's host in virtual time: real device bytes over in-memory lines, real nodes. A serial
/// line opened at a wrong rate has garbage.
class VirtualSite : public Site {
 public:
  explicit VirtualSite(const HiddenMachine& machine);
  ~VirtualSite() override;

  std::vector<std::string> ports() override;
  std::unique_ptr<Link> open(const std::string& address) override;
  int64_t now() override { return bus_->now(); }
  void pass(int64_t duration) override { bus_->runUntil(now() + duration); }
  std::unique_ptr<RobotSession> start(const std::string& folder, Processes which) override;

  /// On its stand, or on the ground.
  void lift(bool lifted) { *lifted_ = lifted; }
  const sim::SimulatedRobot& robot() const { return devices_->robot(); }

 private:
  struct Port {
    std::string name;
    int baud = 0;
    std::unique_ptr<Link> host, device;
  };
  class PortLink;
  class Running;
  /// A bus with only the simulator: subscribers of the previous one may be gone.
  void beginBus(int64_t utime);

  std::shared_ptr<bool> lifted_;
  std::vector<Port> ports_;
  std::vector<std::string> empty_;
  std::unique_ptr<sim::SimulatedDevices> devices_;
  std::map<std::string, MemoryStore> stores_;
  uint64_t seed_;
  std::unique_ptr<VirtualBus> bus_;  ///< last: its nodes refer to the other members
};

/// A person who acts as asked before answering from a file.
class VirtualPerson : public AnswersFile {
 public:
  VirtualPerson(VirtualSite& site, const std::string& answers);
  std::string ask(const std::string& key) override;
  const std::string& heard() const { return *heard_; }

 private:
  VirtualPerson(VirtualSite& site, const std::string& answers, std::shared_ptr<std::string> heard);

  VirtualSite& site_;
  std::shared_ptr<std::string> heard_;
};

}  // namespace tread::setup

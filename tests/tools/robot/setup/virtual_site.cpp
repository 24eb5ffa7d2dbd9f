// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/tools/robot/setup/virtual_site.hpp"

#include <algorithm>

#include "common/config/config_reader.hpp"
#include "common/link/make_link.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"
#include "modules/mapping/mapping_node.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/planner/planner_node.hpp"
#include "modules/simulator/core/car.hpp"

namespace tread::setup {
namespace {

/// A vehicle that may be lifted: its tracks then run free, and it does not move.
class LiftableVehicle : public sim::Plant {
 public:
  LiftableVehicle(const sim::VehicleParameters& parameters, std::shared_ptr<bool> lifted)
      : parameters_(parameters), lifted_(std::move(lifted)) {
    if (parameters.wheelbase > 0.0) {
      vehicle_ = std::make_unique<sim::Car>(parameters);
    } else {
      vehicle_ = std::make_unique<sim::TrackedVehicle>(parameters);
    }
  }

  void step(const sim::MotorPower& power, const sim::Ground& ground, double dt) override {
    if (!*lifted_) return vehicle_->step(power, ground, dt);
    const double voltage = vehicle_->battery().voltage;
    const double left = std::clamp(power.left, -1.0, 1.0) * parameters_.left_power;
    const double right = std::clamp(power.right, -1.0, 1.0) * parameters_.right_power;
    sim::stepTrack(parameters_.drive, left, voltage, {}, dt, left_);
    if (parameters_.wheelbase > 0.0) return;  // the servo draws nothing from this supply
    sim::stepTrack(parameters_.drive, right, voltage, {}, dt, right_);
  }
  Twist2 velocity() const override { return *lifted_ ? Twist2{} : vehicle_->velocity(); }
  const sim::TrackDrive& left() const override { return *lifted_ ? left_ : vehicle_->left(); }
  const sim::TrackDrive& right() const override { return *lifted_ ? right_ : vehicle_->right(); }
  const sim::Battery& battery() const override { return vehicle_->battery(); }
  void stopBody() override { vehicle_->stopBody(); }

 private:
  sim::VehicleParameters parameters_;
  std::unique_ptr<sim::Plant> vehicle_;
  std::shared_ptr<bool> lifted_;
  sim::TrackDrive left_, right_;
};

constexpr int64_t kBegin = 1'000'000;  // [us]

template <class Read>
auto readProcess(const std::string& folder, const std::string& process, Read take) {
  ConfigReader reader = ConfigReader::fromFile(folder + "/" + process + ".yaml");
  return take(reader);
}

}  // namespace

/// The host's end of a port, opened at some rate.
class VirtualSite::PortLink : public Link {
 public:
  PortLink(Link* line, std::string address, bool right_rate)
      : line_(line), address_(std::move(address)), right_rate_(right_rate) {
    if (line_ == nullptr) return;
    setPipeConnected(*line_, false);  // discards earlier bytes
    setPipeConnected(*line_, true);
  }

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override {
    if (line_ == nullptr) return 0;
    const auto size = line_->read(buffer, capacity);
    if (!right_rate_ && size)
      for (size_t i = 0; i < *size; ++i) buffer[i] = garbled(buffer[i]);
    return size;
  }
  bool write(const uint8_t* bytes, size_t size) override {
    if (line_ == nullptr) return true;
    std::vector<uint8_t> sent(bytes, bytes + size);
    if (!right_rate_) std::transform(sent.begin(), sent.end(), sent.begin(), garbled);
    return line_->write(sent.data(), sent.size());
  }
  bool isOpen() const override { return line_ == nullptr || line_->isOpen(); }
  bool reopen(int64_t utime) override { return line_ == nullptr || line_->reopen(utime); }
  void close() override {
    if (line_ != nullptr) line_->close();
  }
  const std::string& address() const override { return address_; }
  std::string problem() const override { return line_ == nullptr ? "" : line_->problem(); }

 private:
  static uint8_t garbled(uint8_t byte) { return static_cast<uint8_t>(byte * 5 + 0x91); }

  Link* line_;
  std::string address_;
  bool right_rate_;
};

/// The nodes of a folder, on the bus for the lifetime of this object.
class VirtualSite::Running : public RobotSession {
 public:
  Running(VirtualSite& site, const std::string& folder, Processes which)
      : site_(site), folder_(folder) {
    const auto ins_config = readProcess(folder_, "ins_driver", ins::readInsDriverConfig);
    ins_ = site_.open(ins_config.address);
    add("ins_driver", {100, 0}, [this, ins_config](Bus& bus) {
      return std::make_unique<ins::InsDriverNode>(ins_config, bus, *ins_, site_.stores_["ins"]);
    });
    if (which == Processes::kAll) addAll();
    const auto motor_config = readProcess(folder_, "motor_bridge", motor::readMotorBridgeConfig);
    motor_ = site_.open(motor_config.address);
    add("motor_bridge", {100, 700}, [this, motor_config](Bus& bus) {
      return std::make_unique<motor::MotorBridgeNode>(motor_config, bus, *motor_);
    });
  }
  ~Running() override { site_.beginBus(site_.now()); }

  Bus& bus() override { return site_.bus_->outside(); }
  void pass(int64_t duration) override { site_.pass(duration); }

 private:
  void addAll() {
    const auto lidar = readProcess(folder_, "lidar_driver", lidar::readLidarDriverConfig);
    laser_ = site_.open(lidar.address);
    add("lidar_driver", {200, 300}, [this, lidar](Bus& bus) {
      return std::make_unique<lidar::LidarDriverNode>(lidar, bus, *laser_);
    });
    const auto mapping = readProcess(folder_, "mapping", mapping::readMappingConfig);
    add("mapping", {8'000, 1'700},
        [mapping](Bus& bus) { return std::make_unique<mapping::MappingNode>(mapping, bus); });
    const auto learner = readProcess(folder_, "learner", learner::readLearnerConfig);
    add("learner", {1'000, 5'300}, [this, learner](Bus& bus) {
      return std::make_unique<learner::LearnerNode>(learner, bus, site_.stores_["learner"]);
    });
    const auto planner = readProcess(folder_, "planner", planner::readPlannerConfig);
    add("planner", {15'000, 3'100},
        [planner](Bus& bus) { return std::make_unique<planner::PlannerNode>(planner, bus); });
  }

  void add(const std::string& name, NodeTiming timing, VirtualBus::Factory factory) {
    site_.bus_->addNode(name, std::move(factory), timing);
  }

  VirtualSite& site_;
  std::string folder_;
  std::unique_ptr<Link> ins_, motor_, laser_;
};

VirtualSite::VirtualSite(const HiddenMachine& machine)
    : lifted_(std::make_shared<bool>(false)),
      empty_(machine.empty_ports),
      seed_(machine.settings.robot.seed) {
  const auto port = [this](const std::string& name, int baud) {
    auto [host, device] = makePipe();
    ports_.push_back({name, baud, std::move(host), std::move(device)});
  };
  port(machine.ins_port, machine.ins_baud);
  port(machine.motor_port, machine.motor_baud);
  port(machine.laser_port, machine.laser_baud);
  sim::SimulatorSettings settings = machine.settings;
  settings.robot.start_utime = kBegin;
  sim::RobotParts parts;
  parts.vehicle = std::make_unique<LiftableVehicle>(settings.robot.vehicle, lifted_);
  devices_ = std::make_unique<sim::SimulatedDevices>(
      std::make_shared<const sim::World>(machine.world), settings, std::move(parts));
  beginBus(kBegin);
}

void VirtualSite::beginBus(int64_t utime) {
  bus_.reset();  // before another one gets the same lines
  bus_ = std::make_unique<VirtualBus>(seed_, FaultPlan{}, utime);
  bus_->addNode("simulator", [this](Bus& bus) {
    return std::make_unique<sim::SimulatorNode>(
        *devices_, bus,
        sim::DeviceLines{*ports_[0].device, *ports_[1].device, ports_[2].device.get()});
  });
}

VirtualSite::~VirtualSite() = default;

std::vector<std::string> VirtualSite::ports() {
  std::vector<std::string> names = empty_;
  for (const Port& port : ports_) names.push_back(port.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::unique_ptr<Link> VirtualSite::open(const std::string& address) {
  const LinkAddress parsed = parseLinkAddress(address);
  for (const Port& port : ports_) {
    const std::string name = address.substr(0, address.find('?'));
    if (port.name != name && port.name != address) continue;
    return std::make_unique<PortLink>(port.host.get(), address,
                                      port.baud == 0 || parsed.baud == port.baud);
  }
  return std::make_unique<PortLink>(nullptr, address, true);
}

std::unique_ptr<RobotSession> VirtualSite::start(const std::string& folder, Processes which) {
  return std::make_unique<Running>(*this, folder, which);
}

VirtualPerson::VirtualPerson(VirtualSite& site, const std::string& answers)
    : VirtualPerson(site, answers, std::make_shared<std::string>()) {}

VirtualPerson::VirtualPerson(VirtualSite& site, const std::string& answers,
                             std::shared_ptr<std::string> heard)
    : AnswersFile(ConfigReader::fromText(answers, "answers.yaml"),
                  [heard](const std::string& line) { *heard += line + "\n"; }),
      site_(site),
      heard_(heard) {}

std::string VirtualPerson::ask(const std::string& key) {
  if (key == "wheels_up" || key == "wheels_down") site_.lift(key == "wheels_up");
  return AnswersFile::ask(key);
}

}  // namespace tread::setup

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/fault_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <string_view>

#include "common/messages/blank.hpp"
#include "common/messages/fence_messages.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "tests/bench/faults/effect_watch.hpp"
#include "tests/bench/faults/forger.hpp"
#include "tests/bench/faults/invariants.hpp"
#include "tests/bench/faults/limit_rules.hpp"
#include "tests/bench/faults/lying_hand.hpp"
#include "tests/bench/faults/lying_parts.hpp"
#include "tests/bench/faults/person_at_stick.hpp"
#include "tests/bench/faults/scan_faults.hpp"
#include "tools/lab/missions/mission.hpp"

namespace tread::faults {
namespace {

constexpr int64_t kTick = 5'000;             // [us] between checks of the motors
constexpr int64_t kOperatorPeriod = 50'000;  // [us]
constexpr int64_t kHandPeriod = 20'000;      // [us]
constexpr int64_t kForgePeriod = 40'000;     // [us]
constexpr int64_t kFirstFault = 2'500'000;   // [us]
constexpr double kLine = 12.0;               // [m] shortest

SealKey someKey() {
  SealKey key;
  for (size_t i = 0; i < key.bytes.size(); ++i) key.bytes[i] = static_cast<uint8_t>(7 * i + 1);
  return key;
}

/// Errors of the INS beyond its noise.
class DisturbedIns : public sim::InsErrors {
 public:
  sim::InsInput sensed(int64_t utime, const sim::InsInput& truth) override {
    sim::InsInput input = truth;
    if (frozen && last_) input = *last_;
    if (!frozen) last_ = truth;
    if (drift_since > 0) drift_ = 0.4 * static_cast<double>(utime - drift_since) * 1e-6;
    if (!mirrored) mirror_ = truth;
    // Relative to the direction ahead when it began.
    const double left =
        2.0 * ((input.body.p_map - mirror_.body.p_map)
                   .head<2>()
                   .dot(Eigen::Vector2d(-std::sin(mirror_.yaw), std::cos(mirror_.yaw))));
    const double turned = 2.0 * (mirror_.yaw - input.yaw);
    if (mirrored) {
      input.body.p_map.head<2>() -=
          left * Eigen::Vector2d(-std::sin(mirror_.yaw), std::cos(mirror_.yaw));
      input.yaw += turned;
      input.body.R_map_body =
          Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
          input.body.R_map_body;
      input.rate_body.z() *= -1.0;
      input.v_body.y() *= -1.0;
    }
    input.body.p_map.x() += jump + drift_ * strength;
    input.yaw += turn;
    input.body.R_map_body = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                            input.body.R_map_body;
    input.body.roll += roll;
    input.body.R_map_body *= Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
    return input;
  }
  bool frozen = false, mirrored = false;
  double jump = 0.0, turn = 0.0, roll = 0.0, strength = 0.0;
  int64_t drift_since = 0;

 private:
  std::optional<sim::InsInput> last_;
  sim::InsInput mirror_;
  double drift_ = 0.0;
};

/// From the frame of the way to the map.
std::vector<Fence> fencesOf(const Scenario& scenario, const missions::MissionWorld& world) {
  const Eigen::Vector2d way = world.T_map_goal.position() - world.T_map_start.position();
  const Pose2 T_map_way{world.T_map_start.x, world.T_map_start.y, std::atan2(way.y(), way.x())};
  std::vector<Fence> fences = scenario.own_fences;
  for (Fence& fence : fences)
    for (Eigen::Vector2d& corner : fence.corners) corner = T_map_way * corner;
  return fences;
}

/// One mission with its faults and its rules.
class Run {
 public:
  Run(const missions::RobotConfig& robot, const FaultSchedule& schedule, const RunOptions& options)
      : schedule_(schedule),
        options_(options),
        world_(missions::makeMissionWorld(schedule.seed, robot.simulated.vehicle.outline, kLine)),
        own_fences_(fencesOf(schedule.scenario, world_)),
        system_(configured(robot), world_.description, world_.T_map_start, schedule.seed, "",
                planOf(schedule), {}, parts(robot.simulated.vehicle)),
        bus_(system_.bus()),
        start_(bus_.now()),
        active_(schedule.faults.size(), false),
        forger_(bus_, world_.T_map_goal, system_.patterns()),
        motors_(limitsOf()),
        fences_(own_fences_, robot.simulated.vehicle.outline),
        returns_(options.operator_lease_us),
        path_(robot.planner.map.footprint),
        counts_(schedule.keyed) {
    if (schedule.keyed) bus_.useKey(someKey());
    person_.emplace(bus_.outside(), world_.T_map_goal);
    if (schedule.scenario.hand) hand_.emplace(bus_.outside(), *schedule.scenario.hand);
    if (schedule.scenario.lie) liar_.emplace(bus_.outside(), *schedule.scenario.lie);
    watch();
  }

  FaultyRun run() {
    const int64_t end = start_ + std::llround(options_.duration * 1e6);
    try {
      while (bus_.now() < end && !result_.violation) tick();
    } catch (const std::exception& error) {
      breaks(std::string("a step threw: ") + error.what());
    }
    result_.collisions = static_cast<int>(system_.robot().truth().collisions.size());
    result_.paths_judged = path_.judged();
    result_.effect = effect_.effect();
    return result_;
  }

 private:
  missions::RobotConfig configured(missions::RobotConfig robot) const {
    robot.simulated.laser.beams = options_.beams;
    motor::BridgeConfig& bridge = robot.motor_bridge.bridge;
    bridge.fences.own.clear();
    if (options_.keeps_fences) bridge.fences.own = own_fences_;
    robot.planner.map.fences.clear();
    if (schedule_.scenario.planner_knows) robot.planner.map.fences = bridge.fences.own;
    if (schedule_.scenario.go_back)
      bridge.operators.lost = robot.planner.operators.lost = OperatorLost::kGoBack;
    return robot;
  }

  MotorLimits limitsOf() const {
    MotorLimits limits;
    limits.operator_lease_us = options_.operator_lease_us;
    limits.tilt = options_.tilt;
    limits.go_back = schedule_.scenario.go_back;
    return limits;
  }

  sim::RobotParts parts(const sim::VehicleParameters& vehicle) {
    auto errors = std::make_unique<DisturbedIns>();
    ins_ = errors.get();
    sim::RobotParts parts;
    parts.ins_errors = std::move(errors);
    auto drive = std::make_unique<LyingDrive>(sim::makeVehicle(vehicle));
    drive_ = drive.get();
    parts.vehicle = std::move(drive);
    return parts;
  }

  void watch() {
    bus_.setTap([this](int64_t now, const char* channel, const uint8_t* bytes, size_t size) {
      if (options_.log != nullptr) options_.log->write(now, channel, bytes, size);
      sent(now, channel, {bytes, bytes + size});
    });
    bus_.setArrivalTap([this](int64_t now, const std::string& node, const char* channel,
                              const uint8_t* bytes, size_t size) {
      handed(now, node, channel, {bytes, bytes + size});
    });
    system_.disturbScans([this](lidar::RangeScan& scan) { scans_.disturb(scan); });
  }

  void breaks(const std::string& what) {
    if (!what.empty() && !result_.violation) result_.violation = Violation{bus_.now(), what};
  }

  void sent(int64_t now, const std::string& channel, const std::vector<uint8_t>& bytes) {
    counts_.sent(channel, bytes);
    keep(channel, bytes);
    const auto size = static_cast<std::ptrdiff_t>(sizeWithoutSeal(bytes.data(), bytes.size()));
    const Received message{now, channel, {bytes.begin(), bytes.begin() + size}};
    const bool genuine = !schedule_.keyed || static_cast<size_t>(size) != bytes.size();
    if (!genuine) return;
    sent_.insert(hashOf(bytes));
    if (const auto motor = messageOf(kMotor, message)) {
      note(*motor);
      effect_.receive(*motor);
    }
    if (const auto health = messageOf(kHealth, message)) {
      breaks(counts_.check(*health));
      effect_.receive(*health);
    }
    if (const auto plan = messageOf(kPlan, message)) {
      if (plan->set_version < version_)
        breaks("the planner's PATTERN_SET went back from version " + std::to_string(version_) +
               " to " + std::to_string(plan->set_version));
      version_ = plan->set_version;
      result_.arrived = result_.arrived || plan->plan_status == plan_t::PLAN_ARRIVED;
      breaks(path_.check(now, *plan));
      effect_.receive(*plan);
      returns_.sent(*plan);
    }
    if (!schedule_.scenario.go_back) return;
    if (const auto program = messageOf(kProgram, message)) breaks(returns_.check(now, *program));
  }

  /// Notes which situations occurred: a rule that is never exercised proves nothing.
  void note(const motor_t& motor) {
    const bool moves = motor.command[0] != 0.0F || motor.command[1] != 0.0F;
    const auto says = [&](const char* words) {
      return motor.state_reason.find(words) != std::string::npos;
    };
    const bool by_hand = moves && motor.bridge_state == motor_t::STATE_MANUAL;
    result_.by_hand |= by_hand;
    result_.lied |= liar_ && liar_->holds() && mayDrive(motor.bridge_state);
    if (by_hand && schedule_.onlyLies()) breaks("moved by a stick that was not seen at rest");
    result_.returned |= moves && bus_.now() > operator_until_ + 3'000'000;
    const bool stopped = motor.bridge_state == motor_t::STATE_DISARMED;
    result_.tilt_stop |= stopped && (says("rolled") || says("pitched"));
    result_.fence_stop |= stopped && says("fence ");
  }

  void handed(int64_t now, const std::string& node, const std::string& channel,
              const std::vector<uint8_t>& bytes) {
    counts_.receive(node, channel, bytes);
    if (node != "motor_bridge" && node != "planner") return;
    const auto size = static_cast<std::ptrdiff_t>(sizeWithoutSeal(bytes.data(), bytes.size()));
    Received message{now, channel, {bytes.begin(), bytes.begin() + size}};
    message.changed = sent_.count(hashOf(bytes)) == 0;
    // With a key, unsealed, changed and repeated messages have no effect.
    const bool sealed = static_cast<size_t>(size) != bytes.size();
    const bool stop = (channel == "ESTOP" || channel == "ARM") && node == "motor_bridge";
    const bool counts = sealed && !message.changed;
    if (schedule_.keyed && !stop && (!counts || !handed_[node].insert(bytes).second)) return;
    if (schedule_.keyed && stop && !sealed && !isStopping(message)) return;
    if (node == "motor_bridge") {
      motors_.receive(message);
      fences_.receive(message);
    } else {
      path_.receive(message);
      returns_.receive(message);
    }
  }
  static size_t hashOf(const std::vector<uint8_t>& bytes) {
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  static bool isStopping(const Received& message) {
    const auto arm = messageOf(kArm, message);
    const auto estop = messageOf(kEstop, message);
    return (arm && stops(*arm)) || (estop && stops(*estop));
  }

  /// Stores the newest genuine messages of a channel for replays.
  void keep(const std::string& channel, const std::vector<uint8_t>& bytes) {
    for (const Fault& fault : schedule_.faults) {
      if (fault.kind != FaultKind::kReplay || fault.channel != channel || replaying_) continue;
      kept_[channel].push_back(bytes);
      if (kept_[channel].size() > 40) kept_[channel].pop_front();
      return;
    }
  }

  void tick() {
    bus_.runUntil(bus_.now() + kTick);
    const int64_t now = bus_.now();
    for (size_t i = 0; i < schedule_.faults.size(); ++i) apply(i, now - start_);
    if (!operator_lost_) operator_until_ = now;
    if ((now - start_) % kOperatorPeriod == 0 && !operator_lost_) person_->step(now);
    if ((now - start_) % kHandPeriod == 0 && !operator_lost_ && hand_)
      hand_->step(now, now - start_);
    if ((now - start_) % kHandPeriod == 0 && !operator_lost_ && liar_)
      liar_->step(now, now - start_);
    putFence(now - start_);
    judgeFences(now);
    const sim::MotorValues motors = system_.devices().power(now);
    const std::array<double, 2> power{motors[0], motors[1]};
    breaks(motors_.check(now, power));
    const bool turns = power[0] != 0.0 || power[1] != 0.0;
    if (!active_.empty()) effect_.step(now, turns, system_.robot().truth(), active_.front());
    result_.drove = result_.drove || turns;
    if (now - start_ > schedule_.end()) result_.drove_after = result_.drove_after || turns;
    if ((now - start_) % 1'000'000 == 0)
      for (const std::string& node : missions::robotNodes())
        if (bus_.statistics(node).failed > 0)
          breaks(node + ": a handler threw: " + bus_.statistics(node).last_refusal);
  }

  /// The operator's fence ahead of the driving robot, sent three times.
  void putFence(int64_t since) {
    const Scenario& scenario = schedule_.scenario;
    if (!scenario.fence_at || since < *scenario.fence_at || operator_lost_) return;
    const int64_t after = since - *scenario.fence_at;
    if (after > 1'000'000 || after % 500'000 >= kTick) return;
    if (!put_) {
      const Pose2& here = system_.robot().truth().T_map_body;
      const double near = scenario.fence_ahead, half = scenario.fence_width / 2.0;
      put_ = FenceRequest{"mission operator", false, {"across", true, {}}};
      for (const auto& [x, y] : {std::pair(near, -half), std::pair(near + 1.0, -half),
                                 std::pair(near + 1.0, half), std::pair(near, half)})
        put_->fence.corners.push_back(here * Eigen::Vector2d(x, y));
    }
    bus_.outside().publish(kFence, toMessage(*put_));
  }

  void judgeFences(int64_t now) {
    for (size_t i = 0; i < active_.size(); ++i)
      if (active_[i] && blinds(schedule_.faults[i])) fences_.blind(now);
    const sim::RobotTruth& truth = system_.robot().truth();
    breaks(fences_.check(now, truth.T_map_body, truth.v_body.v_x));
    result_.least_room = fences_.leastRoom();
  }
  /// Whether a fault disables the bridge or its commands to the motors.
  static bool blinds(const Fault& fault) {
    const bool ends = fault.kind == FaultKind::kKill || fault.kind == FaultKind::kHang;
    return fault.kind == FaultKind::kMotorLine || fault.kind == FaultKind::kBattery ||
           (ends && fault.node == "motor_bridge");
  }

  void apply(size_t i, int64_t since) {
    const Fault& fault = schedule_.faults[i];
    const bool active = since >= fault.from && since < fault.until;
    if (active &&
        (since - fault.from) / kForgePeriod != (since - kTick - fault.from) / kForgePeriod)
      repeat(fault);
    if (active == active_[i]) return;
    active_[i] = active;
    applyToNode(fault, active);
    applyToDevices(fault, active);
  }

  void repeat(const Fault& fault) {
    if (fault.kind == FaultKind::kForge) forger_.send(fault.channel, fault.strength);
    if (fault.kind != FaultKind::kReplay || kept_[fault.channel].empty()) return;
    const std::vector<uint8_t> bytes = kept_[fault.channel].front();
    kept_[fault.channel].pop_front();
    kept_[fault.channel].push_back(bytes);
    replaying_ = true;
    bus_.inject(fault.channel.c_str(), bytes.data(), bytes.size());
  }

  void applyToNode(const Fault& fault, bool active) {
    if (fault.kind == FaultKind::kHang && active) bus_.hang(fault.node, fault.until - fault.from);
    if (fault.kind == FaultKind::kOperatorLost) operator_lost_ = active;
    if (fault.kind == FaultKind::kEstop) sayEstop(active);
    if (fault.kind == FaultKind::kDisarm && active) sayDisarm();
    if (fault.kind == FaultKind::kWrongSet && active) publishWrongSet(fault.strength);
    if (fault.kind != FaultKind::kKill) return;
    active ? bus_.kill(fault.node) : bus_.restart(fault.node);
    counts_.start(fault.node);
    handed_[fault.node].clear();
    if (fault.node == "motor_bridge") {
      active ? motors_.end(bus_.now()) : motors_.start(bus_.now());
      fences_.start();
    }
    if (fault.node != "planner") return;
    path_.start();
    returns_.start();
    version_ = 0;
  }

  void sayEstop(bool engaged) {
    auto message = blank<estop_t>();
    message.utime = bus_.now();
    message.engaged = engaged;
    message.estop_by = "bystander";
    message.estop_reason = "a person in the way";
    bus_.outside().publish(kEstop, message);
  }
  void sayDisarm() {
    auto message = blank<arm_t>();
    message.utime = bus_.now();
    message.armed = false;
    message.armed_by = "mission operator";
    bus_.outside().publish(kArm, message);
  }

  void publishWrongSet(double strength) {
    const auto set = wrongSet(system_.patterns(), strength, version_ + 3);
    if (!set) return;
    for (const pattern_set_part_t& part : toMessages(*set))
      bus_.outside().publish(kPatternSet, part);
  }

  void applyToDevices(const Fault& fault, bool active) {
    auto& motor = dynamic_cast<sim::RoboteqEmulator&>(system_.devices().motor());
    auto& ins = dynamic_cast<sim::NmeaInsEmulator&>(system_.devices().ins());
    sim::NmeaInsFaults faults;
    switch (fault.kind) {
      case FaultKind::kInsOutage:
        (fault.strength < 0.5 ? faults.silent : faults.no_fix) = active;
        return ins.setFaults(faults);
      case FaultKind::kInsGarbage:
        faults.corrupt_share = active ? fault.strength : 0.0;
        faults.garbage_share = active ? 0.5 * fault.strength : 0.0;
        return ins.setFaults(faults);
      case FaultKind::kInsMirror:
        ins_->mirrored = active;
        return;
      case FaultKind::kDriveMirror:
        drive_->swapped = active;
        return;
      case FaultKind::kInsJump:
        ins_->jump = active ? 6.0 * fault.strength - 3.0 : 0.0;
        ins_->turn = active && fault.strength < 0.3 ? 1.0 - 2.0 * fault.strength : 0.0;
        return;
      case FaultKind::kInsFreeze:
        ins_->frozen = active;
        return;
      case FaultKind::kInsDrift:
        ins_->strength = active ? fault.strength : 0.0;
        ins_->drift_since = active ? bus_.now() : 0;
        return;
      case FaultKind::kTilt:
        ins_->roll = active ? 0.2 + 0.8 * fault.strength : 0.0;
        return;
      case FaultKind::kPhantom:
      case FaultKind::kVanish:
      case FaultKind::kScanFreeze:
      case FaultKind::kScanLag:
      case FaultKind::kScanMirror:
      case FaultKind::kScanTurn:
      case FaultKind::kScanFar:
      case FaultKind::kScanZero:
        return active ? scans_.begin(fault) : scans_.end();
      case FaultKind::kBattery:
        return motor.setBrownOut(active);
      case FaultKind::kMotorLine:
        if (fault.strength < 0.4) return system_.connect("motor", !active);
        if (fault.strength < 0.7) return motor.setSilent(active);
        if (active) motor.reboot(bus_.now());
        return;
      default:
        return;
    }
  }

  FaultSchedule schedule_;
  RunOptions options_;
  missions::MissionWorld world_;
  std::vector<Fence> own_fences_;
  DisturbedIns* ins_ = nullptr;
  LyingDrive* drive_ = nullptr;
  missions::RobotSystem system_;
  VirtualBus& bus_;
  int64_t start_;
  std::vector<bool> active_;
  Forger forger_;
  MotorRule motors_;
  FenceRule fences_;
  ReturnRule returns_;
  PathRule path_;
  CountRule counts_;
  std::optional<missions::Operator> person_;
  std::optional<PersonAtStick> hand_;
  std::optional<LyingHand> liar_;
  std::optional<FenceRequest> put_;
  bool operator_lost_ = false;
  int64_t operator_until_ = 0;  ///< [us]
  ScanFaults scans_;
  EffectWatch effect_;
  std::map<std::string, std::deque<std::vector<uint8_t>>> kept_;
  bool replaying_ = false;
  std::map<std::string, std::set<std::vector<uint8_t>>> handed_;  ///< by node
  std::set<size_t> sent_;                                         ///< hashes
  int64_t version_ = 0;
  FaultyRun result_;
};

}  // namespace

FaultSchedule scanScheduleOf(uint64_t seed, double duration) {
  return drawScanFault(seed, kFirstFault, std::llround(0.7 * duration * 1e6));
}

FaultSchedule bareScheduleOf(uint64_t seed, double duration) {
  return drawSchedule(seed, kFirstFault, std::llround(0.7 * duration * 1e6));
}

FaultSchedule scheduleOf(uint64_t seed, double duration) {
  FaultSchedule schedule = bareScheduleOf(seed, duration);
  addScenario(schedule, kFirstFault, std::llround(0.7 * duration * 1e6));
  return schedule;
}

FaultSchedule lyingScheduleOf(uint64_t seed, double duration) {
  FaultSchedule schedule = scheduleOf(seed, duration);
  addLie(schedule, kFirstFault, std::llround(0.7 * duration * 1e6));
  return schedule;
}

FaultyRun runFaulty(const missions::RobotConfig& robot, const FaultSchedule& schedule,
                    const RunOptions& options) {
  return Run(robot, schedule, options).run();
}

}  // namespace tread::faults

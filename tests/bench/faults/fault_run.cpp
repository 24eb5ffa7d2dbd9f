// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/fault_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "common/messages/blank.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "tests/bench/faults/invariants.hpp"
#include "tools/missions/mission.hpp"

namespace tread::faults {
namespace {

constexpr int64_t kTick = 5'000;             // [us] between looks at the motors
constexpr int64_t kOperatorPeriod = 50'000;  // [us]
constexpr int64_t kForgePeriod = 40'000;     // [us]
constexpr double kLine = 12.0;               // [m] shortest

SealKey someKey() {
  SealKey key;
  for (size_t i = 0; i < key.bytes.size(); ++i) key.bytes[i] = static_cast<uint8_t>(7 * i + 1);
  return key;
}

/// What is wrong with the INS beyond its noise.
class DisturbedIns : public sim::InsErrors {
 public:
  sim::InsInput sensed(int64_t utime, const sim::InsInput& truth) override {
    sim::InsInput input = truth;
    if (frozen && last_) input = *last_;
    if (!frozen) last_ = truth;
    if (drift_since > 0) drift_ = 0.4 * static_cast<double>(utime - drift_since) * 1e-6;
    input.body.p_map.x() += jump + drift_ * strength;
    input.yaw += turn;
    input.body.R_map_body = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                            input.body.R_map_body;
    return input;
  }
  bool frozen = false;
  double jump = 0.0, turn = 0.0, strength = 0.0;
  int64_t drift_since = 0;

 private:
  std::optional<sim::InsInput> last_;
  double drift_ = 0.0;
};

template <class Message>
std::vector<uint8_t> bytesOf(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// A set whose patterns turn and go otherwise than the vehicle does.
std::optional<PatternSet> wrongSet(const PatternSet& shipped, double strength, int64_t version) {
  PatternSetContent content = shipped.content();
  content.parent_version = content.version;
  content.version = version;
  const double turn = 0.4 + 1.2 * strength;
  for (MotionPattern& pattern : content.patterns)
    for (Pose2& pose : pattern.trajectory) pose = {pose.x, turn * pose.y, turn * pose.yaw};
  std::string why;
  return PatternSet::make(content, why);
}

/// Messages that a stranger may send.
class Forger {
 public:
  Forger(VirtualBus& bus, const Pose2& T_map_goal, const PatternSet& shipped)
      : bus_(bus), T_map_goal_(T_map_goal), shipped_(shipped) {}

  void send(const std::string& channel, double strength) {
    ++count_;
    if (channel == "ARM") return arm();
    if (channel == "GOAL") return goal(strength);
    if (channel == "PROGRAM") return program(strength);
    if (channel == "PATTERN_SET") return patternSet(strength);
    if (channel == "ESTOP") return clearing();
    if (channel == "MAP") return map(strength);
    if (channel == "INS") return ins(strength);
    notice();
  }

 private:
  template <class Message>
  void inject(const Channel<Message>& channel, Message& message, int64_t utime) {
    message.utime = utime;
    message.seq = 1'000'000 + count_;
    const std::vector<uint8_t> bytes = bytesOf(message);
    bus_.inject(channel.name, bytes.data(), bytes.size());
  }
  void arm() {
    auto message = blank<arm_t>();
    message.armed = true;
    message.armed_by = "mission operator";
    inject(kArm, message, bus_.now());
  }
  void goal(double strength) {
    auto message = blank<goal_t>();
    message.goal_id = 4711;
    message.goal_pose[0] = T_map_goal_.x + 10.0 * strength;
    message.goal_pose[1] = T_map_goal_.y - 10.0;
    message.goal_pose[2] = 0.0;
    message.position_tolerance = 0.5;
    message.yaw_tolerance = 4.0;
    inject(kGoal, message, bus_.now());
  }
  void program(double strength) {
    auto message = blank<program_t>();
    message.run_id = 99;
    message.lease = 200'000;
    message.running.execution_id = 1;
    message.running.slot_pattern_id = 1;
    message.running.slot_set_version = 1;
    message.running.command_kind = program_slot_t::KIND_POWER;
    message.running.period = 50'000;
    message.running.num_commands = 40;
    message.running.left.assign(40, strength < 0.1 ? 2.0F : 1.0F);
    message.running.right.assign(40, 1.0F);
    message.next = blank<program_slot_t>();
    inject(kProgram, message, bus_.now());
  }
  void patternSet(double strength) {
    const auto set = wrongSet(shipped_, strength, 1'000'000);
    if (!set) return;
    for (pattern_set_part_t part : toMessages(*set)) inject(kPatternSet, part, part.utime);
  }
  void clearing() {
    auto message = blank<estop_t>();
    message.engaged = false;
    message.estop_by = "stranger";
    inject(kEstop, message, bus_.now());
  }
  void map(double strength) {
    auto message = blank<map_tile_t>();
    message.tile_cells = 32;
    message.cell_size = strength < 0.2 ? 0.05 : 0.1;
    message.tile_x = static_cast<int32_t>(count_ % 7) - 3;
    message.tile_y = static_cast<int32_t>(count_ / 7 % 7) - 3;
    message.num_cells = message.tile_cells * message.tile_cells;
    message.cells.assign(static_cast<size_t>(message.num_cells), strength < 0.6 ? 0 : 254);
    inject(kMap, message, bus_.now() + 40'000);
  }
  void ins(double strength) {
    auto message = blank<ins_t>();
    message.position[0] = 5.0 * strength;
    message.position[1] = message.position[2] = 0.0;
    for (double& number : message.orientation) number = 0.0;
    message.orientation[0] = 1.0;
    message.ins_status = 0;
    inject(kIns, message, bus_.now());
  }
  void notice() {
    auto message = blank<operator_t>();
    message.station = 4712;
    message.operator_name = count_ % 2 == 0 ? "mission operator" : "stranger";
    message.allowed = operator_t::ALLOW_DRIVING;
    message.seen_utime = bus_.now();
    inject(kOperator, message, bus_.now());
  }

  VirtualBus& bus_;
  Pose2 T_map_goal_;
  const PatternSet& shipped_;
  int64_t count_ = 0;
};

/// One mission with its faults and its rules.
class Run {
 public:
  Run(const missions::RobotConfig& robot, const FaultSchedule& schedule, const RunOptions& options)
      : schedule_(schedule),
        options_(options),
        world_(missions::makeMissionWorld(schedule.seed, robot.simulated.vehicle.outline, kLine)),
        system_(robot, world_.description, world_.T_map_start, schedule.seed, "", planOf(schedule),
                nullptr, parts()),
        bus_(system_.bus()),
        start_(bus_.now()),
        active_(schedule.faults.size(), false),
        forger_(bus_, world_.T_map_goal, system_.patterns()),
        motors_(options.operator_lease_us),
        path_(robot.planner.map.footprint),
        counts_(schedule.keyed) {
    if (schedule.keyed) bus_.useKey(someKey());
    person_.emplace(bus_.outside(), world_.T_map_goal);
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
    return result_;
  }

 private:
  sim::RobotParts parts() {
    auto errors = std::make_unique<DisturbedIns>();
    ins_ = errors.get();
    sim::RobotParts parts;
    parts.ins_errors = std::move(errors);
    return parts;
  }

  void watch() {
    bus_.setTap([this](int64_t now, const char* channel, const uint8_t* bytes, size_t size) {
      sent(now, channel, {bytes, bytes + size});
    });
    bus_.setArrivalTap([this](int64_t now, const std::string& node, const char* channel,
                              const uint8_t* bytes, size_t size) {
      handed(now, node, channel, {bytes, bytes + size});
    });
    system_.disturbScans([this](lidar::RangeScan& scan) { disturb(scan); });
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
    if (const auto health = messageOf(kHealth, message)) breaks(counts_.check(*health));
    if (const auto plan = messageOf(kPlan, message)) {
      if (plan->set_version < version_)
        breaks("the planner's PATTERN_SET went back from version " + std::to_string(version_) +
               " to " + std::to_string(plan->set_version));
      version_ = plan->set_version;
      result_.arrived = result_.arrived || plan->plan_status == plan_t::PLAN_ARRIVED;
      breaks(path_.check(now, *plan));
    }
  }

  void handed(int64_t now, const std::string& node, const std::string& channel,
              const std::vector<uint8_t>& bytes) {
    counts_.receive(node, channel, bytes);
    if (node != "motor_bridge" && node != "planner") return;
    const auto size = static_cast<std::ptrdiff_t>(sizeWithoutSeal(bytes.data(), bytes.size()));
    const Received message{now, channel, {bytes.begin(), bytes.begin() + size}};
    // With a key what nobody sealed counts for nothing, nor does what comes a second time.
    const bool sealed = static_cast<size_t>(size) != bytes.size();
    const bool stop = (channel == "ESTOP" || channel == "ARM") && node == "motor_bridge";
    if (schedule_.keyed && !stop && (!sealed || !handed_[node].insert(bytes).second)) return;
    if (schedule_.keyed && stop && !sealed && !isStopping(message)) return;
    if (node == "motor_bridge") motors_.receive(message);
    if (node == "planner") path_.receive(message);
  }
  static bool isStopping(const Received& message) {
    const auto arm = messageOf(kArm, message);
    const auto estop = messageOf(kEstop, message);
    return (arm && stops(*arm)) || (estop && stops(*estop));
  }

  /// For replays: the newest genuine messages of a channel.
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
    if ((now - start_) % kOperatorPeriod == 0 && !operator_lost_) person_->step(now);
    const std::array<double, 2> power = system_.devices().power(now);
    breaks(motors_.check(now, power));
    const bool turns = power[0] != 0.0 || power[1] != 0.0;
    result_.drove = result_.drove || turns;
    if (now - start_ > schedule_.end()) result_.drove_after = result_.drove_after || turns;
    if ((now - start_) % 1'000'000 == 0)
      for (const std::string& node : missions::robotNodes())
        if (bus_.statistics(node).failed > 0)
          breaks(node + ": a handler threw: " + bus_.statistics(node).last_refusal);
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
    if (fault.node == "motor_bridge") active ? motors_.end(bus_.now()) : motors_.start(bus_.now());
    if (fault.node != "planner") return;
    path_.start();
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
      case FaultKind::kPhantom:
      case FaultKind::kVanish:
        scan_fault_ = active ? &fault : nullptr;
        return;
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

  void disturb(lidar::RangeScan& scan) const {
    if (scan_fault_ == nullptr) return;
    const bool phantom = scan_fault_->kind == FaultKind::kPhantom;
    const double centre = 1.6 * (scan_fault_->strength - 0.5);
    const double half = phantom ? 0.2 : 0.9;
    for (size_t i = 0; i < scan.ranges.size(); ++i) {
      const double angle = scan.angle_first + static_cast<double>(i) * scan.angle_step;
      if (std::abs(angle - centre) > half) continue;
      scan.ranges[i] = phantom ? static_cast<float>(1.0 + 3.0 * scan_fault_->strength)
                               : std::numeric_limits<float>::infinity();
    }
  }

  FaultSchedule schedule_;
  RunOptions options_;
  missions::MissionWorld world_;
  DisturbedIns* ins_ = nullptr;
  missions::RobotSystem system_;
  VirtualBus& bus_;
  int64_t start_;
  std::vector<bool> active_;
  Forger forger_;
  MotorRule motors_;
  PathRule path_;
  CountRule counts_;
  std::optional<missions::Operator> person_;
  bool operator_lost_ = false;
  const Fault* scan_fault_ = nullptr;
  std::map<std::string, std::deque<std::vector<uint8_t>>> kept_;
  bool replaying_ = false;
  std::map<std::string, std::set<std::vector<uint8_t>>> handed_;  ///< by node
  int64_t version_ = 0;
  FaultyRun result_;
};

}  // namespace

FaultSchedule scheduleOf(uint64_t seed, double duration) {
  return drawSchedule(seed, 2'500'000, std::llround(0.7 * duration * 1e6));
}

FaultyRun runFaulty(const missions::RobotConfig& robot, const FaultSchedule& schedule,
                    const RunOptions& options) {
  return Run(robot, schedule, options).run();
}

}  // namespace tread::faults

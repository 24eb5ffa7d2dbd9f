// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/pattern_recorder/recorder_node.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/vehicle/robot_description.hpp"

namespace tread::pattern_recorder {
namespace {

constexpr int64_t kTrackSpan = 30'000'000;  // [us] of INS data that are kept
constexpr int64_t kSettle = 200'000;        // [us] after which messages have arrived
constexpr int64_t kGiveUpAfter =
    2'000'000;  // [us] after its end when an execution is evaluated in any case
constexpr double kDegrees = 180.0 / kPi;

constexpr int64_t kTwistWindow = 300'000;  // [us] over which standstill is detected
constexpr double kStandingSpeed = 0.15;    // [m/s] and
constexpr double kStandingRate = 0.10;     // [rad/s]: noise of an INS at rest stays below

}  // namespace

ExecutionCollector::ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted,
                                       int give_up_after, const MeasurementLimits& limits, Say say)
    : set_(set),
      run_id_(run_id),
      wanted_(wanted),
      give_up_after_(give_up_after),
      limits_(limits),
      say_(std::move(say)),
      ins_(kTrackSpan),
      recorded_(set.patterns().size()),
      refused_in_a_row_(set.patterns().size(), 0) {
  if (limits_.max_speed <= 0.0) limits_.max_speed = largestSpeed(set_);
}

std::vector<int64_t> ExecutionCollector::judge(int64_t utime) {
  std::vector<int64_t> judged;
  const int64_t horizon = utime - kSettle;
  ins_.settle(horizon);
  for (auto end = executions_.nextEnd(); end; end = executions_.nextEnd()) {
    const bool passed = ins_.history().newest() >= *end;
    if (!passed && horizon < *end + kGiveUpAfter) break;
    const execution_record_t record = *executions_.takeEndedBy(*end);
    if (record.record_run_id != run_id_) continue;
    judged.push_back(record.record_execution_id);
    judge(record);
  }
  return judged;
}

void ExecutionCollector::judge(const execution_record_t& record) {
  for (size_t p = 0; p < set_.patterns().size(); ++p) {
    const MotionPattern& pattern = set_.patterns()[p];
    if (pattern.id != record.record_pattern_id) continue;
    Measurement measured = measure(record, pattern);
    if (!measured.fair())
      refuse(p, measured.gate, measured.reason);
    else if (!measured.complete())
      refuse(p, Gate::kCoveredTime, "the INS does not cover its end");
    else
      keep(p, std::move(measured.trajectory));
  }
}

Measurement ExecutionCollector::measure(const execution_record_t& record,
                                        const MotionPattern& pattern) const {
  ExecutionCut cut{recordFrom(record)};
  cut.unexpected_command = commands_.unexpectedCommand(
      {record.record_run_id, record.record_execution_id}, pattern, set_.content().channels);
  return tread::measure(ins_.history(), cut, pattern, set_.classNamed(pattern.entry_class),
                        set_.content().period_us, limits_);
}

void ExecutionCollector::keep(size_t pattern, std::vector<Pose2> measured) {
  refused_in_a_row_[pattern] = 0;
  // Patterns used only to reach a class or to return may be driven more often than required.
  if (missing(pattern) <= 0) return;
  const Pose2 end = measured.back();
  recorded_[pattern].push_back(std::move(measured));
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%s %zu of %d: ends %.3f m ahead, %.3f m to the left, turned %.1f deg",
                set_.patterns()[pattern].name.c_str(), recorded_[pattern].size(), wanted_, end.x,
                end.y, end.yaw * kDegrees);
  say_(text.data());
}

void ExecutionCollector::refuse(size_t pattern, Gate gate, const std::string& reason) {
  if (missing(pattern) <= 0) return;
  ++refused_;
  const std::string& name = set_.patterns()[pattern].name;
  say_(name + " refused, it will be repeated: " + reason);
  // A stop by the operator or a failsafe is no evidence against the pattern.
  if (gate == Gate::kAborted || ++refused_in_a_row_[pattern] < give_up_after_) return;
  hopeless_ = name + " was refused " + std::to_string(give_up_after_) +
              " times in a row, the last time: " + reason;
}

std::vector<int> ExecutionCollector::missing() const {
  std::vector<int> missing;
  for (size_t p = 0; p < recorded_.size(); ++p) missing.push_back(this->missing(p));
  return missing;
}

RecorderNode::RecorderNode(const PatternSet& set, const RecordingConfig& config, Bus& bus, Say say)
    : config_(config),
      bus_(bus),
      health_(bus, "recorder", "pattern set: " + set.content().name + "\n"),
      robot_(bus, health_, OperatorRules{}.lease_us),
      beacon_(bus, config.operator_name),
      drive_(set, config.room, bus.bootId(), say),
      collector_(set, bus.bootId(), config.executions, config.give_up_after, config.limits,
                 std::move(say)) {
  robot_.on_ins = [this](const ins_t& message) { collector_.take(message, bus_.now()); };
  robot_.on_motor = [this](const motor_t& message) { collector_.take(message); };
  robot_.on_execution = [this](const execution_t& message) {
    collector_.take(message, bus_.now());
  };
  bus_.subscribe<program_t>(kProgram, [this](const program_t& message) { take(message); });
}

void RecorderNode::take(const program_t& message) {
  if (message.run_id == drive_.program().runId() || robot_.invalidTime(message.utime, "PROGRAM"))
    return;
  silent_ = true;
  drive_.fail("another planner publishes PROGRAM (its run is " + std::to_string(message.run_id) +
              "); end it first; config/launch/recording.yaml starts the robot without one");
}

void RecorderNode::step(int64_t utime) {
  if (robot_.timeJumped(utime) || !stepped_) begun_ = utime;
  beacon_.step(utime);
  stepped_ = true;
  const RobotReadings readings = robot_.readings(utime);
  RecordingProgress progress;
  progress.judged = collector_.judge(utime);
  progress.missing = collector_.missing();
  progress.hopeless = collector_.hopeless();
  progress.standing = stands();
  drive_.step(readings, progress, !listens(utime));
  // The person who brings it back decides again whether it may continue.
  if (drive_.leftRoom()) robot_.permission().restart(utime);
  publishProgram(utime, readings);
  publishHealth(utime);
}

void RecorderNode::shutdown(int64_t utime) {
  drive_.stop();
  publishProgram(utime, robot_.readings(utime));
  beacon_.letGo(utime);
}

bool RecorderNode::stands() const {
  const int64_t newest = collector_.track().newest();
  const PoseTrack* track = collector_.track().covering(newest);
  if (track == nullptr) return false;
  const auto twist = track->twistBefore(newest, kTwistWindow, kTwistWindow);
  return twist && std::hypot(twist->v_x, twist->v_y) < kStandingSpeed &&
         std::abs(twist->omega) < kStandingRate;
}

void RecorderNode::publishProgram(int64_t utime, const RobotReadings& readings) {
  if (silent_ || listens(utime)) return;
  // Before the robot's first message its time is unknown, and others would follow ours.
  if (!readings.pose && !readings.bridge) return;
  bus_.publish(kProgram,
               programOf(drive_.program(), bus_, utime, seq_program_++, config_.lease_us));
}

void RecorderNode::publishHealth(int64_t utime) {
  health_.setState(reason().empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, reason());
  int64_t fair = 0;
  for (const auto& executions : recorded()) fair += static_cast<int64_t>(executions.size());
  health_.setCounter("recorded", fair);
  health_.setCounter("refused", collector_.refused());
  health_.step(utime);
}

}  // namespace tread::pattern_recorder

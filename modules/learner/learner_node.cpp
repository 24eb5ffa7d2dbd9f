// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/learner_node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/config/scalars.hpp"
#include "common/messages/blank.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "modules/learner/core/state_text.hpp"

namespace tread::learner {
namespace {

void readGates(ConfigReader& reader, MeasurementLimits& limits) {
  ConfigReader gates = reader.section("gates");
  gates.seconds("max_gap", limits.max_gap_us, {0.01, 5.0});
  gates.number("min_covered", limits.min_covered, {0.1, 1.0}, "1");
  gates.number("max_speed", limits.max_speed, {0.0, 20.0}, "m/s");
  gates.number("speed_margin", limits.speed_margin, {1.0, 10.0}, "1");
  gates.number("min_motion", limits.min_motion, {0.0, 1.0}, "m");
  gates.number("min_turn", limits.min_turn, {0.0, 1.0}, "rad");
  gates.seconds("entry_window", limits.entry_window_us, {0.01, 2.0});
  gates.number("entry_speed", limits.entry_speed, {0.01, 40.0}, "m/s");
  gates.number("entry_yaw_rate", limits.entry_yaw_rate, {0.01, 40.0}, "rad/s");
  // A file cannot contain "infinite".
  bool any_entry = std::isinf(limits.entry_speed) && std::isinf(limits.entry_yaw_rate);
  gates.flag("any_entry", any_entry);
  if (any_entry)
    limits.entry_speed = limits.entry_yaw_rate = std::numeric_limits<double>::infinity();
  gates.number("max_slope", limits.max_slope, {0.0, 1.6}, "rad");
}

/// Messages that must name a higher version than ours before it is accepted: a single one may be
/// broken.
constexpr int kBelievedAfter = 3;
/// Distance kept above a higher version of an earlier life.
constexpr int64_t kAboveUnknown = 100;

constexpr int64_t kGripPeriod = 500'000;  // [us]

void fill(double (&target)[3], const Pose2& pose) {
  target[0] = pose.x;
  target[1] = pose.y;
  target[2] = pose.yaw;
}

ExecutionKey keyOf(const execution_record_t& record) {
  return {record.record_run_id, record.record_execution_id};
}

learning_t reportOf(const execution_record_t& record, Rule rule) {
  auto message = blank<learning_t>();
  message.utime = record.ended;
  message.learned_run_id = record.record_run_id;
  message.learned_execution_id = record.record_execution_id;
  message.learned_pattern_id = record.record_pattern_id;
  message.learning_rule = rule;
  message.scored_version = record.record_set_version;
  return message;
}

/// One line for each key of a section that was given and is obsolete. It counts as read.
template <size_t kCount>
void addRetired(ConfigReader& reader, const char* section_name, const char* const (&keys)[kCount],
                std::vector<std::string>& lines) {
  ConfigReader section = reader.section(section_name);
  for (const char* key : keys)
    if (section.retired(key))
      lines.emplace_back(section.error(key, "has no effect any more; take it out").what());
}

/// One line for each key that was given and that the rule does not use.
std::vector<std::string> unreadKeys(ConfigReader& reader, const Rule& rule) {
  const auto reads = [](const Rule& one, const char* key) {
    const std::vector<std::string> keys = keysReadBy(one);
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::vector<std::string> lines;
  for (const char* key : {"memory", "scaling", "ground"}) {
    if (!reader.has(key) || reads(rule, key)) continue;
    std::vector<std::string> readers;
    for (const Rule& other : ruleNames())
      if (reads(other, key)) readers.push_back(other);
    const std::string problem =
        "rule " + rule + " does not read it, " + joinWords(readers) + " would; take it out";
    lines.emplace_back(reader.error(key, problem).what());
  }
  addRetired(reader, "scaling", kRetiredScalingKeys, lines);
  addRetired(reader, "ground", kRetiredGroundKeys, lines);
  return lines;
}

/// The default of a vehicle's largest speed is the largest of its patterns.
LearnerNodeConfig withSpeed(LearnerNodeConfig config) {
  if (config.limits.max_speed <= 0.0) config.limits.max_speed = largestSpeed(config.shipped);
  return config;
}

}  // namespace

std::vector<std::string> keysReadBy(const Rule& rule) {
  if (rule == "off") return {};
  if (rule == "single") return {"memory"};
  if (rule == "collective" || rule == "telescoping") return {"memory", "scaling"};
  return {"ground"};
}

LearnerNodeConfig readLearnerConfig(ConfigReader& reader) {
  std::string patterns;
  reader.path("patterns", patterns, true);
  LearnerNodeConfig config(readPatternFile(patterns));
  if (reader.has("robot")) {
    const RobotDescription robot = readRobot(reader);
    const CommandChannels given = config.shipped.content().channels, taken = robot.drive.channels();
    if (kindsOf(given) != kindsOf(taken))
      throw reader.error("patterns", patterns + " commands " + describe(given) +
                                         ", the robot takes " + describe(taken) +
                                         "; give a set of the same vehicle");
    config.limits.max_slope = robot.max_tilt.value_or(config.limits.max_slope);
    config.front = robot.outline.front;
  }
  readLearnerSettings(reader, config);
  reader.finish();
  return config;
}

void readLearnerSettings(ConfigReader& reader, LearnerNodeConfig& config) {
  reader.text("store", config.store);
  std::string rule = config.rule.rule;
  reader.choice("rule", rule, ruleNames());
  config.rule.rule = rule;
  // w = 1 would never learn without giving a reason: `off` is for that.
  reader.number("memory", config.rule.memory, {0.0, 0.999}, "1");
  readRules(reader, config.rule);
  config.warnings = unreadKeys(reader, config.rule.rule);
  readGates(reader, config.limits);
  // No shorter: the publisher sends a portion per step, and LCM loses more than 100 kB in 20 ms.
  reader.seconds("period", config.period_us, {0.02, 0.1});
  reader.seconds("settle", config.settle_us, {0.0, 2.0});
  reader.seconds("give_up", config.give_up_us, {0.1, 30.0});
  reader.seconds("follow", config.follow_us, {0.0, 60.0});
  reader.seconds("repeat", config.repeat_us, {0.2, 5.0});
  reader.seconds("track_span", config.track_span_us, {5.0, 600.0});
  reader.flag("shock", config.shock);
  if (config.shock && !(config.front > 0.0))
    throw reader.error("shock", "needs the robot's outline; name its file: robot: robot.yaml");
  reader.integer("remembered_versions", config.remembered_versions, {2, 1000}, "1");
}

std::string LearnerNodeConfig::effective() const {
  // Reading an empty text over these values prints them.
  ConfigReader reader = ConfigReader::fromText("{}", "learner");
  LearnerNodeConfig copy = *this;
  readLearnerSettings(reader, copy);
  return "shipped_set: " + shipped.content().name +
         "\nshipped_checksum: " + std::to_string(shipped.checksum()) + "\n" + reader.effective();
}

LearnerNode::LearnerNode(LearnerNodeConfig config, Bus& bus, Store& store)
    : config_(withSpeed(std::move(config))),
      bus_(bus),
      learner_(config_.rule, config_.shipped),
      memory_(store),
      ins_(config_.track_span_us),
      publisher_(bus),
      health_(bus, "learner", config_.effective()) {
  bus.subscribe<ins_t>(kIns, [this](const ins_t& ins) {
    ins_.add(ins, bus_.now());
    if (shock_) shock_->take(ins);
  });
  bus.subscribe<execution_t>(kExecution, [this](const execution_t& message) { hear(message); });
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& motor) { hear(motor); });
  if (config_.shock) shock_.emplace(config_.front, bus, store, health_);
  bus.overhear<pattern_set_part_t>(
      kPatternSet, [this](const pattern_set_part_t& part) { noteVersion(part.set_version); });
  health_.watchNamesakes();
  // Not now(), which is unknown before the first message.
  start(bus.bootId());
}

void LearnerNode::start(int64_t boot_time) {
  StoredLearning found = memory_.recall(config_.shipped, boot_time);
  start_problem_ = found.problem;
  versions_.emplace(config_.shipped.version(), config_.shipped);
  if (found.state) {
    executions_.remember(found.state->handled);
    if (!learner_.restore(std::move(found.state->set), std::move(found.state->residuals),
                          found.state->memory))
      health_.addToCounter("state of another rule: learning restarts");
    keepVersion();
  }
  if (found.first_version > learner_.set().version())
    learner_.renumber(found.first_version, learner_.set().version());
  adoptVersion();
}

void LearnerNode::resume(LearnerState state, const std::vector<PatternSet>& earlier) {
  versions_.clear();
  versions_.emplace(config_.shipped.version(), config_.shipped);
  for (const PatternSet& set : earlier) versions_.insert_or_assign(set.version(), set);
  executions_.remember(state.handled);
  learner_.restore(std::move(state.set), std::move(state.residuals), state.memory);
  adoptVersion();
}

void LearnerNode::step(int64_t utime) {
  const int64_t horizon = utime - config_.settle_us;
  ins_.settle(horizon);
  const bool passive = mustBePassive(utime);
  if (passive_ && !passive) becomeActive();
  passive_ = passive;
  if (passive_) {
    // The other learner learns from them.
    while (executions_.takeEndedBy(horizon)) health_.addToCounter("executions left to the other");
  } else if (!listensOnly()) {
    handleEnded(utime);
    if (!executions_.nextEnd()) followRunning(ins_.history().newest());
    if (utime >= next_repeat_ && publisher_.setsSent()) {
      publisher_.putSet(learner_.set());
      next_repeat_ = utime + config_.repeat_us;
    }
    publisher_.step(utime);
  } else {
    publisher_.step(utime, false);  // a log is replayed from the first state on
  }
  if (shock_ && !passive_) shock_->step(utime);
  if (!passive_) publishGrip(utime);
  ++steps_;
  reportHealth(utime);
}

void LearnerNode::handleEnded(int64_t utime) {
  const int64_t horizon = utime - config_.settle_us;
  for (auto end = executions_.nextEnd(); end; end = executions_.nextEnd()) {
    const bool passed = ins_.history().newest() >= *end;
    const bool hopeless = horizon >= *end + config_.give_up_us;
    if (!passed && !hopeless) break;
    const execution_record_t record = *executions_.takeEndedBy(*end);
    // An earlier life of this process has reported executions that ended before, or nobody can
    // measure them.
    if (record.ended < ins_.begin()) {
      health_.addToCounter("executions before the start");
    } else {
      if (running_ && keyOf(*running_) == keyOf(record)) followRunning(record.ended);
      handle(record);
    }
  }
}

void LearnerNode::noteRunning(const execution_t& message) {
  for (const execution_record_t& record : message.records) {
    if (record.outcome != execution_record_t::OUTCOME_RUNNING || record.started <= followed_until_)
      continue;
    if (running_ && keyOf(*running_) == keyOf(record)) continue;
    running_ = record;
    followed_until_ = record.started;
  }
}

/// The measured part of a running execution is learned at once, because the next one is being
/// chosen. All parts up to `until`, so that messages that name a set later find it whichever part
/// came in time.
void LearnerNode::followRunning(int64_t until) {
  if (!running_ || config_.follow_us <= 0) return;
  const MotionPattern* pattern = learner_.set().find(running_->record_pattern_id);
  if (pattern == nullptr || running_->started < ins_.begin()) return;
  const int64_t end = running_->started + learner_.set().content().period_us *
                                              static_cast<int64_t>(pattern->commands.size());
  // A part that would be known no sooner than the end is left to the record.
  for (int64_t part = 1 + (followed_until_ - running_->started) / config_.follow_us;; ++part) {
    const int64_t ended = running_->started + part * config_.follow_us;
    if (ended > until || ended + config_.settle_us >= end) return;
    followed_until_ = ended;
    ExecutionCut cut = cutOf(*running_, *pattern);
    cut.ended = ended;
    cut.beginning = true;
    const Measurement measurement = measureCut(cut, *pattern);
    feelGrip(cut, measurement, pattern->id);
    if (!learner_.learnsParts()) continue;
    if (measurement.fair() && learner_.follow(pattern->id, measurement, part, ended))
      publishVersion();
    pattern = learner_.set().find(running_->record_pattern_id);
  }
}

/// The shipped pattern defines the request: a learned one already includes the ground.
void LearnerNode::feelGrip(const ExecutionCut& cut, const Measurement& measurement,
                           int pattern_id) {
  const MotionPattern* pattern = learner_.shipped().find(pattern_id);
  if (pattern == nullptr || !cut.unexpected_command.empty()) return;
  const auto sign =
      gripSign(measurement, *pattern, learner_.shipped().classNamed(pattern->entry_class),
               learner_.shipped().periodSeconds());
  if (!sign) return;
  grip_.take(*sign, cut.started);
  grip_felt_ = cut.ended;
  next_grip_ = 0;
}

void LearnerNode::publishGrip(int64_t utime) {
  // A clock that jumped back must not silence it.
  if (utime < next_grip_ && next_grip_ - utime <= kGripPeriod) return;
  next_grip_ = utime + kGripPeriod;
  auto message = blank<grip_t>();
  message.utime = grip_felt_;
  message.seq = seq_grip_++;
  const Grip grip = grip_.grip();
  message.deceleration = grip.deceleration;
  message.gave_way = static_cast<int8_t>(grip.gave_way);
  message.grip_signs = static_cast<int32_t>(grip_.signs());
  bus_.publish(kGrip, message);
}

/// By steps, not by time, which jumps at the first message.
bool LearnerNode::listensOnly() const {
  return steps_ * config_.period_us < config_.listen_us;
}

/// Whether a learner is running that was started before this one.
bool LearnerNode::mustBePassive(int64_t utime) const {
  // At the start a mistake costs three seconds; later a single broken message must not cause it.
  const bool soon = listensOnly() || passive_;
  const auto other = health_.namesake(utime, soon ? 1 : HealthReporter::kSureAfter);
  return other && other->boot_id < health_.bootId();
}

void LearnerNode::becomeActive() {
  if (highest_heard_ > learner_.set().version()) goAbove(highest_heard_);
  next_repeat_ = 0;
}

void LearnerNode::hear(const execution_t& message) {
  executions_.add(message, bus_.now());
  noteRunning(message);
  int64_t highest = 0;
  for (const execution_record_t& record : message.records)
    highest = std::max(highest, record.record_set_version);
  noteVersion(highest);
}

/// A version was named by others: ours goes above it, unless the message is broken.
void LearnerNode::noteVersion(int64_t version) {
  if (version <= learner_.set().version() || version > PatternSet::kHighestVersion) return;
  const bool believed = ++unknown_versions_[version] >= kBelievedAfter;
  // Broken messages may name any number; old ones no longer matter.
  if (unknown_versions_.size() > 16) unknown_versions_.clear();
  if (!believed) return;
  highest_heard_ = std::max(highest_heard_, version);
  // Only one of two learners, otherwise both would climb endlessly.
  if (!passive_ && !mustBePassive(bus_.now())) goAbove(version);
}

void LearnerNode::hear(const motor_t& motor) {
  commands_.add(motor);
  const bool by_hand = motor.bridge_state == motor_t::STATE_MANUAL;
  const bool lost = motor.seq != seq_motor_ + 1;
  seq_motor_ = motor.seq;
  hand_.add({motor.utime, commandFrom(motor),
             by_hand && kindsFrom(motor) == kindsOf(learner_.set().content().channels)},
            lost);
  auto message = blank<execution_t>();
  for (const HandDrivenPattern& driven : hand_.take(learner_.set(), learner_.learnsParts())) {
    auto record = blank<execution_record_t>();
    record.record_execution_id = driven.started;
    record.record_pattern_id = driven.pattern_id;
    record.record_set_version = learner_.set().version();
    record.started = driven.started;
    record.ended = driven.ended;
    record.outcome = driven.completed ? execution_record_t::OUTCOME_COMPLETED
                                      : execution_record_t::OUTCOME_ABORTED;
    if (!driven.completed) {
      record.outcome_code = static_cast<int16_t>(StopReason::kLeftByHand);
      record.outcome_reason = sentenceOf(StopReason::kLeftByHand);
    }
    message.records.push_back(record);
    health_.addToCounter("executions under manual control");
  }
  executions_.add(message, bus_.now());
}

void LearnerNode::goAbove(int64_t version) {
  unknown_versions_.clear();
  health_.addToCounter("versions lost and gone above");
  learner_.renumber(version + kAboveUnknown, learner_.set().version());
  adoptVersion();
}

void LearnerNode::handle(const execution_record_t& record) {
  learning_t message = reportOf(record, config_.rule.rule);
  message.seq = seq_learning_++;
  message.result_version = learner_.set().version();
  health_.addToCounter("executions");
  const MotionPattern* pattern = learner_.set().find(record.record_pattern_id);
  Measurement measurement;
  if (pattern == nullptr) {
    measurement.gate = Gate::kUnknownPattern;
    measurement.reason =
        "pattern " + std::to_string(record.record_pattern_id) + " is not in the set";
  } else {
    message.learned_pattern_name = pattern->name;
    const ExecutionCut cut = cutOf(record, *pattern);
    measurement = measureCut(cut, *pattern);
    score(record, measurement, message);
    feelGrip(cut, measurement, pattern->id);
    const bool known = measurement.gate == Gate::kNone || measurement.gate == Gate::kEntryTwist;
    if (known && std::isfinite(measurement.path_length)) grip_.drive(measurement.path_length);
  }
  message.accepted = measurement.fair();
  message.gate_code = static_cast<int16_t>(measurement.gate);
  message.gate_reason = measurement.reason;
  health_.addToCounter(measurement.fair() ? "learnable"
                                          : std::string("refused: ") + gateName(measurement.gate));
  if (measurement.fair()) {
    const Correction correction = learner_.learn(record.record_pattern_id, measurement,
                                                 scoredError(record, measurement), record.ended);
    message.changed = correction.changed;
    message.gate_reason = correction.guards;
    message.change_reason = correction.reason;
    message.ground_changed = correction.note.change_probability;
    message.surface = correction.note.surface;
    message.surface_probability = correction.note.surface_probability;
    const Axes& V = correction.note.scaling;
    fill(message.scaling, {V[0], V[1], V[2]});
    if (correction.changed_after) health_.addToCounter("changes noticed while a pattern ran");
    if (correction.note.no_change)
      health_.addToCounter("changes after which the ground was the one before");
    if (correction.changed) {
      start_problem_.clear();
      adoptVersion();
    }
    message.result_version = learner_.set().version();
    scoreAfter(measurement, record.record_pattern_id, message);
  }
  if (running_ && keyOf(*running_) == keyOf(record)) running_.reset();
  if (!message.changed && learner_.unfollow(record.ended)) publishVersion();
  bus_.publish(kLearning, message);
}

ExecutionCut LearnerNode::cutOf(const execution_record_t& record,
                                const MotionPattern& pattern) const {
  ExecutionCut cut{recordFrom(record)};
  const PatternSet& set = learner_.set();
  cut.unexpected_command =
      commands_.unexpectedCommand(keyOf(record), pattern, set.content().channels);
  // When a failsafe stops the robot it may have been held: that is not the ground's influence.
  cut.beginning = learner_.learnsParts() && !cut.completed() &&
                  (cut.reason.code == StopReason::kStoppedByPlanner ||
                   cut.reason.code == StopReason::kLeftByHand);
  cut.steady_before = hand_.steadyBefore(set.classNamed(pattern.entry_class).steady, record.started,
                                         set.content().period_us);
  return cut;
}

Measurement LearnerNode::measureCut(const ExecutionCut& cut, const MotionPattern& pattern) const {
  const PatternSet& set = learner_.set();
  Measurement measurement =
      measure(ins_.history(), cut, pattern, set.classNamed(pattern.entry_class),
              set.content().period_us, config_.limits);
  measurement.context.voltage = commands_.meanVoltage(cut.started, cut.ended);
  return measurement;
}

const MotionPattern* LearnerNode::patternOf(int64_t version, int pattern_id) const {
  const auto found = versions_.find(version);
  return found == versions_.end() ? nullptr : found->second.find(pattern_id);
}

std::optional<Pose2> LearnerNode::scoredError(const execution_record_t& record,
                                              const Measurement& measurement) const {
  const MotionPattern* named = patternOf(record.record_set_version, record.record_pattern_id);
  if (named == nullptr || !measurement.complete()) return std::nullopt;
  return endError(measurement, *named);
}

void LearnerNode::score(const execution_record_t& record, const Measurement& measurement,
                        learning_t& message) const {
  fill(message.measured_entry, {measurement.context.entry.v_x, measurement.context.entry.v_y,
                                measurement.context.entry.omega});
  message.slope = measurement.context.tilt.inclination;
  message.path_length = measurement.path_length;
  if (measurement.complete()) fill(message.measured_end, measurement.trajectory.back());
  const MotionPattern* named = patternOf(record.record_set_version, record.record_pattern_id);
  if (named != nullptr) fill(message.predicted_end, named->end());
  const auto error = scoredError(record, measurement);
  if (!error || !measurement.fair()) return;
  message.error_position = std::hypot(error->x, error->y);
  message.error_yaw = error->yaw;
}

void LearnerNode::scoreAfter(const Measurement& measurement, int pattern_id,
                             learning_t& message) const {
  const MotionPattern* now = learner_.set().find(pattern_id);
  if (now == nullptr || !measurement.complete()) return;
  const Pose2 error = endError(measurement, *now);
  message.error_position_after = std::hypot(error.x, error.y);
  message.error_yaw_after = error.yaw;
}

void LearnerNode::keepVersion() {
  versions_.insert_or_assign(learner_.set().version(), learner_.set());
  while (versions_.size() > static_cast<size_t>(config_.remembered_versions))
    versions_.erase(versions_.begin());
}

std::string LearnerNode::stateText() const {
  const LearnerState state{learner_.set(), learner_.residuals(), learner_.memory(),
                           config_.rule.rule, executions_.handled()};
  return formatState(state, learner_.shipped(), config_.rule);
}

/// A version that is valid until the running execution ends: it is not stored.
void LearnerNode::publishVersion() {
  keepVersion();
  if (const auto problem = memory_.reserve(learner_.set().version())) noteWrite(problem);
  publisher_.putSet(learner_.set());
}

/// Makes the newest version official: on disk first, then on the bus.
void LearnerNode::adoptVersion() {
  keepVersion();
  const std::string text = stateText();
  auto problem = memory_.reserve(learner_.set().version());
  auto unsaved = memory_.save(text);
  if (!problem) problem = unsaved;
  noteWrite(problem);
  publisher_.putSet(learner_.set());
  publisher_.putState(learner_.set(), config_.rule.rule, text);
}

void LearnerNode::noteWrite(const std::optional<std::string>& problem) {
  write_problem_ = problem ? "learning in memory only: " + *problem : "";
  if (problem) health_.addToCounter("states not written");
}

void LearnerNode::reportHealth(int64_t utime) {
  std::string problem = write_problem_.empty() ? start_problem_ : write_problem_;
  if (passive_) problem = "passive, publishes and learns nothing while an earlier learner lives";
  health_.setState(problem.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, problem);
  health_.setCounter("set version", learner_.set().version());
  if (learner_.rule().remembered() >= 0)
    health_.setCounter("surfaces remembered", learner_.rule().remembered());
  health_.setCounter("INS too late", ins_.tooLate());
  health_.setCounter("INS with invalid time", ins_.invalid());
  health_.setCounter("INS without pose", ins_.withoutPose());
  health_.setCounter("invalid execution records", executions_.invalid());
  health_.step(utime);
}

}  // namespace tread::learner

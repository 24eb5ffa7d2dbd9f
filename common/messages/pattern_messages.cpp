// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/pattern_messages.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/messages/blank.hpp"
#include "common/report/text.hpp"

namespace tread {
namespace {

pattern_set_part_t partOf(const PatternSet& set, size_t index) {
  const PatternSetContent& content = set.content();
  const MotionPattern& pattern = content.patterns[index];
  auto part = blank<pattern_set_part_t>();
  part.utime = content.utime;
  part.set_version = content.version;
  part.parent_version = content.parent_version;
  part.set_checksum = set.checksum();
  part.set_name = content.name;
  part.part = static_cast<int32_t>(index);
  part.part_count = static_cast<int32_t>(content.patterns.size());
  part.set_pattern_id = pattern.id;
  part.pattern_name = pattern.name;
  part.num_channels = static_cast<int32_t>(content.channels.size());
  for (const CommandChannel& channel : content.channels) {
    part.channel_name.push_back(channel.name);
    part.channel_kind.push_back(static_cast<int16_t>(channel.kind));
    part.channel_lowest.push_back(channel.lowest);
    part.channel_highest.push_back(channel.highest);
  }
  part.set_period = static_cast<int32_t>(content.period_us);
  part.entry_class = pattern.entry_class;
  part.exit_class = pattern.exit_class;
  part.times_learned = pattern.times_learned;
  std::copy(pattern.end_covariance.begin(), pattern.end_covariance.end(), part.end_covariance);
  return part;
}

/// An empty text, or what is wrong: "what; what is allowed".
using Problem = std::string;

template <class Numbers>
bool allFinite(const Numbers& numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [](double number) { return std::isfinite(number); });
}

Problem headProblem(const pattern_set_part_t& part) {
  if (part.set_version < 1) return "version is not 1 or more";
  if (part.parent_version < 0 || part.parent_version >= part.set_version)
    return "parent version is not 0 or one before";
  if (part.part_count < 1 || part.part_count > static_cast<int32_t>(PatternLimits::kMaxPatterns))
    return "part count is not 1.." + std::to_string(PatternLimits::kMaxPatterns);
  if (part.part < 0 || part.part >= part.part_count) return "part number is not below the count";
  if (part.set_period < PatternLimits::kMinPeriodUs ||
      part.set_period > PatternLimits::kMaxPeriodUs)
    return "period is not 5 ms..1 s";
  return {};
}

/// PatternSet::make checks their meaning.
Problem channelProblem(const pattern_set_part_t& part) {
  if (part.num_channels < 1 || part.num_channels > static_cast<int32_t>(Command::kMaxChannels))
    return "number of channels is not 1.." + std::to_string(Command::kMaxChannels);
  const auto channels = static_cast<size_t>(part.num_channels);
  for (const size_t size :
       {part.channel_name.size(), part.channel_kind.size(), part.channel_lowest.size(),
        part.channel_highest.size(), part.entry_steady.size(), part.exit_steady.size()})
    if (size != channels) return "lengths are not the number of channels";
  for (const int16_t kind : part.channel_kind)
    if (!knownCommandKind(kind)) return "command kind is unknown";
  return {};
}

Problem seriesProblem(const pattern_set_part_t& part) {
  const auto samples = static_cast<size_t>(std::max(part.num_samples, 0));
  if (samples < 1 || samples > PatternLimits::kMaxSamples)
    return "number of samples is not 1.." + std::to_string(PatternLimits::kMaxSamples);
  if (part.command.size() != samples || part.trajectory.size() != samples)
    return "lengths of commands and trajectory are not the number of samples";
  for (size_t i = 0; i < samples; ++i) {
    if (part.command[i].size() != part.channel_kind.size() || !allFinite(part.command[i]))
      return "command " + std::to_string(i) + " is not a finite number for each channel";
    if (part.trajectory[i].size() != 3 || !allFinite(part.trajectory[i]))
      return "pose " + std::to_string(i) + " is not three finite numbers";
  }
  return {};
}

Problem partProblem(const pattern_set_part_t& part) {
  if (Problem problem = headProblem(part); !problem.empty()) return problem;
  if (Problem problem = channelProblem(part); !problem.empty()) return problem;
  for (const std::string* name :
       {&part.set_name, &part.pattern_name, &part.entry_class, &part.exit_class})
    if (name->empty() || name->size() > PatternLimits::kMaxNameLength)
      return "a name has not 1.." + std::to_string(PatternLimits::kMaxNameLength) + " characters";
  if (!allFinite(part.entry_twist) || !allFinite(part.exit_twist) ||
      !allFinite(part.entry_steady) || !allFinite(part.exit_steady))
    return "a motion class is not finite";
  for (const double variance : part.end_covariance)
    if (std::isinf(variance)) return "end covariance is infinite";
  if (part.set_pattern_id < 0 || part.times_learned < 0) return "pattern id or count is negative";
  return seriesProblem(part);
}

/// Whether two parts agree about their set.
bool sameSet(const pattern_set_part_t& a, const pattern_set_part_t& b) {
  return a.utime == b.utime && a.parent_version == b.parent_version &&
         a.set_checksum == b.set_checksum && a.set_name == b.set_name &&
         a.part_count == b.part_count && a.channel_name == b.channel_name &&
         a.channel_kind == b.channel_kind && a.channel_lowest == b.channel_lowest &&
         a.channel_highest == b.channel_highest && a.set_period == b.set_period;
}

Command commandFrom(const std::vector<double>& values) {
  Command command;
  for (size_t i = 0; i < values.size(); ++i) command[i] = values[i];
  return command;
}

std::vector<double> valuesOf(const Command& command, size_t channels) {
  std::vector<double> values(channels);
  for (size_t i = 0; i < channels; ++i) values[i] = command[i];
  return values;
}

MotionPattern patternOf(const pattern_set_part_t& part) {
  MotionPattern pattern;
  pattern.id = part.set_pattern_id;
  pattern.name = part.pattern_name;
  pattern.entry_class = part.entry_class;
  pattern.exit_class = part.exit_class;
  pattern.times_learned = part.times_learned;
  std::copy(std::begin(part.end_covariance), std::end(part.end_covariance),
            pattern.end_covariance.begin());
  for (const auto& command : part.command) pattern.commands.push_back(commandFrom(command));
  for (const auto& pose : part.trajectory)
    pattern.trajectory.push_back({pose[0], pose[1], pose[2]});
  return pattern;
}

/// Adds a class, or compares it with the present one of that name; false if they differ.
bool addClass(std::vector<MotionClass>& classes, const std::string& name, const double (&twist)[3],
              const std::vector<double>& steady) {
  const auto known = std::find_if(classes.begin(), classes.end(),
                                  [&](const MotionClass& motion) { return motion.name == name; });
  if (known == classes.end()) {
    classes.push_back({name, {twist[0], twist[1], twist[2]}, commandFrom(steady)});
    return true;
  }
  return known->twist.v_x == twist[0] && known->twist.v_y == twist[1] &&
         known->twist.omega == twist[2] && known->steady == commandFrom(steady);
}

std::string about(const pattern_set_part_t& part) {
  return "PATTERN_SET version " + std::to_string(part.set_version) + ", part " +
         std::to_string(part.part) + ": ";
}

/// Far more than the eight that are repeated.
constexpr size_t kRememberedKeys = 64;
/// The queue of waiting executions is only longer if somebody sends invalid ones.
constexpr size_t kMaxWaiting = 64;
/// An execution that is over does not end later than this after now [us].
constexpr int64_t kMaxAheadUs = 1'000'000;

}  // namespace

std::vector<pattern_set_part_t> toMessages(const PatternSet& set) {
  std::vector<pattern_set_part_t> parts;
  for (size_t i = 0; i < set.patterns().size(); ++i) {
    const MotionPattern& pattern = set.patterns()[i];
    pattern_set_part_t part = partOf(set, i);
    const auto fillClass = [&](const std::string& name, double(&twist)[3],
                               std::vector<double>& steady) {
      const MotionClass& motion = set.classNamed(name);
      twist[0] = motion.twist.v_x;
      twist[1] = motion.twist.v_y;
      twist[2] = motion.twist.omega;
      steady = valuesOf(motion.steady, set.content().channels.size());
    };
    fillClass(pattern.entry_class, part.entry_twist, part.entry_steady);
    fillClass(pattern.exit_class, part.exit_twist, part.exit_steady);
    part.num_samples = static_cast<int32_t>(pattern.commands.size());
    for (const Command& command : pattern.commands)
      part.command.push_back(valuesOf(command, set.content().channels.size()));
    for (const Pose2& pose : pattern.trajectory)
      part.trajectory.push_back({pose.x, pose.y, pose.yaw});
    parts.push_back(std::move(part));
  }
  return parts;
}

std::optional<PatternSet> PatternSetAssembler::add(const pattern_set_part_t& part) {
  refusal_.clear();
  const Problem problem = partProblem(part);
  if (!problem.empty()) return refuse(about(part) + problem);
  if (part.set_version < last_version_) ++older_;
  if (part.set_version <= last_version_) return std::nullopt;
  Pending& pending = pendingOf(part.set_version);
  const bool fits = pending.parts.empty() || sameSet(pending.parts.begin()->second, part);
  // It is unknown which of the two is broken: start again with this one, the rest is repeated.
  if (!fits) pending.parts.clear();
  pending.parts.insert_or_assign(part.part, part);
  if (pending.parts.size() == static_cast<size_t>(part.part_count)) return complete(pending);
  if (!fits) return refuse(about(part) + "contradicts the other parts of its version");
  return std::nullopt;
}

PatternSetAssembler::Pending& PatternSetAssembler::pendingOf(int64_t version) {
  constexpr size_t kMostPending = 3;
  const auto known = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& pending) {
    return pending.version == version;
  });
  if (known != pending_.end()) {
    pending_.splice(pending_.end(), pending_, known);
  } else {
    if (pending_.size() == kMostPending) pending_.pop_front();
    pending_.push_back({version, {}});
  }
  return pending_.back();
}

std::optional<PatternSet> PatternSetAssembler::complete(Pending& pending) {
  const pattern_set_part_t first = pending.parts.begin()->second;
  PatternSetContent content;
  content.name = first.set_name;
  content.version = first.set_version;
  content.parent_version = first.parent_version;
  content.utime = first.utime;
  content.channels.clear();
  for (size_t i = 0; i < first.channel_name.size(); ++i)
    content.channels.push_back({first.channel_name[i],
                                static_cast<CommandKind>(first.channel_kind[i]),
                                first.channel_lowest[i], first.channel_highest[i]});
  content.period_us = first.set_period;
  bool same_classes = true;
  for (const auto& [index, part] : pending.parts) {
    same_classes &=
        addClass(content.classes, part.entry_class, part.entry_twist, part.entry_steady);
    same_classes &= addClass(content.classes, part.exit_class, part.exit_twist, part.exit_steady);
    content.patterns.push_back(patternOf(part));
  }
  pending.parts.clear();
  const std::string version = "PATTERN_SET version " + std::to_string(first.set_version) + ": ";
  if (!same_classes) return refuse(version + "two parts have different twists of one motion class");
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  if (!set) return refuse(version + why);
  if (set->checksum() != first.set_checksum) return refuse(version + "checksum differs");
  last_version_ = set->version();
  pending_.remove_if([&](const Pending& older) { return older.version <= last_version_; });
  return set;
}

std::optional<PatternSet> PatternSetAssembler::refuse(const std::string& why) {
  ++refused_;
  refusal_ = why;
  return std::nullopt;
}

BridgeReading readingFrom(const motor_t& message) {
  BridgeReading reading;
  reading.utime = message.utime;
  reading.state = knownBridgeState(message.bridge_state).value_or(BridgeState::kDisarmed);
  reading.reason = {stopReasonFrom(message.state_code), message.state_reason};
  reading.run_id = message.motor_run_id;
  reading.execution_id = message.execution_id;
  reading.command_index = message.command_index;
  return reading;
}

bool mayDrive(int16_t bridge_state) {
  return isArmed(knownBridgeState(bridge_state).value_or(BridgeState::kDisarmed));
}

ExecutionRecord recordFrom(const execution_record_t& message) {
  ExecutionRecord record{message.record_run_id,
                         message.record_execution_id,
                         message.record_pattern_id,
                         message.record_set_version,
                         message.started,
                         message.ended,
                         message.commands_played,
                         message.commands_total,
                         ExecutionOutcome::kRunning,
                         {}};
  if (message.outcome == execution_record_t::OUTCOME_COMPLETED)
    record.outcome = ExecutionOutcome::kCompleted;
  if (message.outcome == execution_record_t::OUTCOME_ABORTED)
    record.outcome = ExecutionOutcome::kAborted;
  record.reason = {stopReasonFrom(message.outcome_code), message.outcome_reason};
  return record;
}

std::vector<ExecutionRecord> recordsFrom(const execution_t& message) {
  std::vector<ExecutionRecord> records;
  for (const execution_record_t& record : message.records) records.push_back(recordFrom(record));
  return records;
}

program_slot_t toMessage(const PlannedExecution& slot) {
  auto message = blank<program_slot_t>();
  if (slot.empty()) return message;
  const PatternSetContent& content = slot.set->content();
  message.execution_id = slot.execution_id;
  message.slot_pattern_id = slot.pattern_id;
  message.slot_set_version = slot.set->version();
  message.period = static_cast<int32_t>(content.period_us);
  message.num_channels = static_cast<int32_t>(content.channels.size());
  for (const CommandChannel& channel : content.channels)
    message.channel_kind.push_back(static_cast<int16_t>(channel.kind));
  for (const Command& command : slot.pattern().commands) {
    std::vector<float>& values = message.command.emplace_back();
    for (size_t i = 0; i < content.channels.size(); ++i)
      values.push_back(static_cast<float>(command[i]));
  }
  message.num_commands = static_cast<int32_t>(message.command.size());
  return message;
}

void ExecutionQueue::add(const execution_t& message, int64_t now) {
  for (const execution_record_t& record : message.records) {
    if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
    const ExecutionKey key{record.record_run_id, record.record_execution_id};
    if (known_.count(key) > 0) continue;
    const bool sense =
        record.started > 0 && record.ended >= record.started && record.ended <= now + kMaxAheadUs;
    if (!sense || waiting_.size() >= kMaxWaiting) {
      ++invalid_;
      continue;
    }
    known_.insert(key);
    waiting_[{record.ended, key.first, key.second}] = record;
  }
}

std::optional<int64_t> ExecutionQueue::nextEnd() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->second.ended;
}

std::optional<execution_record_t> ExecutionQueue::takeEndedBy(int64_t horizon) {
  if (waiting_.empty() || waiting_.begin()->second.ended > horizon) return std::nullopt;
  execution_record_t record = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
  noteHandled({record.record_run_id, record.record_execution_id});
  return record;
}

void ExecutionQueue::remember(const std::vector<ExecutionKey>& handled) {
  for (const ExecutionKey& key : handled) {
    known_.insert(key);
    noteHandled(key);
  }
}

void ExecutionQueue::noteHandled(const ExecutionKey& key) {
  order_.push_back(key);
  while (order_.size() > kRememberedKeys) {
    known_.erase(order_.front());
    order_.pop_front();
  }
}

Command commandFrom(const motor_t& message) {
  Command command;
  // An absent or unknown channel is NaN in the message.
  for (size_t i = 0; i < Command::kMaxChannels; ++i)
    if (message.channel_kind[i] != 0 || !std::isnan(message.command[i]))
      command[i] = static_cast<double>(message.command[i]);
  return command;
}

std::vector<CommandKind> kindsFrom(const motor_t& message) {
  std::vector<CommandKind> kinds;
  for (const int16_t kind : message.channel_kind)
    if (kind != 0) kinds.push_back(static_cast<CommandKind>(kind));
  return kinds;
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/robot_log.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace tread::replay {
namespace {

constexpr int64_t kTransportUs = 20;  ///< of a message on the virtual bus
/// A broken message may hold any time: a stamp this far [us] ahead of the log's clock is believed
/// only after so many in a row.
constexpr int64_t kLargestLead = 5'000'000;
constexpr int kBelievedAfter = 5;
/// A running robot publishes at least this often [us]: a longer silence means that the recorder's
/// clock was set.
constexpr int64_t kLongestSilence = 1'000'000;

/// Time and number of an event on a channel that one process publishes with the time of sending or
/// of a measurement just made. Not PROGRAM: a planner that has just started does not know the time.
std::optional<Stamp> stampOf(const LogEvent& event) {
  std::optional<Stamp> stamp;
  dispatch(
      event,
      [&](const auto& message) {
        stamp = Stamp{event.utime, message.utime, message.seq};
      },
      kIns, kMotor, kExecution);
  return stamp;
}

/// Number of an event on a channel of one publisher.
std::optional<int64_t> numberOf(const LogEvent& event) {
  std::optional<int64_t> seq;
  dispatch(
      event, [&](const auto& message) { seq = message.seq; }, kPatternSet, kLearning, kMap, kPlan,
      kProgram, kIns, kMotor, kExecution);
  return seq;
}

/// Follows the robot's clock through a log.
class Clock {
 public:
  int64_t heard(const LogEvent& event, const std::optional<Stamp>& stamp) {
    const int64_t passed = event.utime - last_recorded_;
    if (now_ != 0 && passed > 0 && passed < kLongestSilence) now_ += passed;
    last_recorded_ = event.utime;
    if (stamp) follow(stamp->utime);
    heard_ = std::max(heard_, now_);
    return heard_;
  }

 private:
  void follow(int64_t utime) {
    const int64_t lead = utime - now_;
    const bool sane = lead > -kLongestSilence && lead < kLargestLead;
    doubted_ = sane ? 0 : doubted_ + 1;
    if (now_ == 0 || doubted_ >= kBelievedAfter || (sane && lead > 0)) now_ = utime;
  }

  int64_t now_ = 0;
  int64_t heard_ = 0;
  int64_t last_recorded_ = 0;
  int doubted_ = 0;  ///< stamps in a row that are far from now_
};

void noteSeq(const LogEvent& event, int64_t seq, std::map<std::string, int64_t>& last,
             std::map<std::string, int64_t>& missing) {
  const auto [known, first] = last.try_emplace(event.channel, seq);
  const int64_t gap = seq - known->second - 1;
  // Who starts again counts from the beginning; a gap of thousands is a broken number.
  if (!first && gap > 0 && gap < 100'000) missing[event.channel] += gap;
  known->second = seq;
}

bool inVirtualTime(const std::vector<LogEvent>& events) {
  for (const LogEvent& event : events) {
    health_t health;
    if (decode(event, kHealth, health)) return health.utc < 0;
  }
  return false;
}

}  // namespace

RobotLog toRobotLog(const std::string& name, std::vector<LogEvent> events) {
  RobotLog log;
  log.name = name;
  log.virtual_time = inVirtualTime(events);
  Clock clock;
  std::map<std::string, int64_t> last;
  for (LogEvent& event : events) {
    config_t config;
    if (decode(event, kConfig, config))
      log.configs.emplace(config.config_process, config.config_text);
    const std::optional<Stamp> stamp = stampOf(event);
    if (const auto number = numberOf(event)) noteSeq(event, *number, last, log.missing);
    const int64_t heard = log.virtual_time ? event.utime + kTransportUs : clock.heard(event, stamp);
    log.events.push_back({std::move(event), heard});
  }
  // Events before the first stamp get the time of the first stamp.
  const auto first = std::find_if(log.events.begin(), log.events.end(),
                                  [](const TimedEvent& event) { return event.heard != 0; });
  for (auto early = log.events.begin(); first != log.events.end() && early != first; ++early)
    early->heard = first->heard;
  return log;
}

Intake intakeOf(const RobotLog& log, const std::string& process,
                const std::vector<std::string>& channels) {
  Intake intake;
  std::map<int64_t, std::pair<health_t, int64_t>> first;  // by boot id, with the count until then
  std::map<int64_t, std::pair<health_t, int64_t>> last;
  int64_t count = 0;
  for (const TimedEvent& timed : log.events) {
    health_t health;
    if (decode(timed.event, kHealth, health) && health.process == process) {
      first.emplace(health.boot_id, std::make_pair(health, count));
      last.insert_or_assign(health.boot_id, std::make_pair(health, count));
    }
    if (std::find(channels.begin(), channels.end(), timed.event.channel) != channels.end()) ++count;
  }
  for (const auto& [boot_id, end] : last) {
    const auto& [health, count_then] = first.at(boot_id);
    intake.heard += end.first.received - health.received;
    intake.lost += end.first.lost - health.lost;
    intake.in_log += end.second - count_then;
  }
  return intake;
}

std::string intakeLine(const RobotLog& log, const std::string& process,
                       const std::vector<std::string>& channels) {
  const Intake intake = intakeOf(log, process, channels);
  return "by its HEALTH the " + process + " heard " + std::to_string(intake.heard) +
         " messages and knows of " + std::to_string(intake.lost) + " lost; the log holds " +
         std::to_string(intake.in_log) + " of the same time";
}

RobotLog readRobotLog(const std::string& path) {
  const auto isOurs = [](const LogEvent& event) {
    return event.channel != kScan.name && event.channel != kPlanTree.name &&
           std::any_of(kChannels.begin(), kChannels.end(),
                       [&](const ChannelSpec& spec) { return event.channel == spec.name; });
  };
  std::string problem;
  std::vector<LogEvent> events = readEvents({path}, problem, isOurs);
  RobotLog log = toRobotLog(std::filesystem::path(path).filename().string(), std::move(events));
  log.problem = problem;
  if (log.events.empty())
    throw std::runtime_error(path + ": no event on any of our channels" +
                             (log.problem.empty() ? "" : "; " + log.problem));
  return log;
}

}  // namespace tread::replay

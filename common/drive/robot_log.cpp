// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/robot_log.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace tread {
namespace {

constexpr int64_t kTransportUs = 20;  ///< of a message on the virtual bus

/// Sequence number of an event on a channel with one publisher.
std::optional<int64_t> numberOf(const LogEvent& event) {
  std::optional<int64_t> seq;
  dispatch(
      event, [&](const auto& message) { seq = message.seq; }, kPatternSet, kLearning, kMap, kPlan,
      kProgram, kIns, kMotor, kExecution);
  return seq;
}

void noteSeq(const LogEvent& event, int64_t seq, std::map<std::string, int64_t>& last,
             std::map<std::string, int64_t>& missing) {
  if (seq < 0) return;  // a broken number
  const auto [known, first] = last.try_emplace(event.channel, seq);
  const int64_t gap = seq - known->second - 1;
  // A restarted publisher counts from the beginning; a gap of thousands is a broken number.
  if (!first && gap > 0 && gap < 100'000) missing[event.channel] += gap;
  known->second = seq;
}

/// Removes what a robot with a key has refused: unsealed messages that do not stop it.
void removeUnsealed(std::vector<LogEvent>& events) {
  bool robot_has_key = false;
  const auto refused = [&](const LogEvent& event) {
    if (event.channel == kMotor.name) robot_has_key = event.sealed;
    bool is_stop = false;
    dispatch(
        event, [&](const auto& message) { is_stop = stops(message); }, kEstop, kArm, kGoal, kFence);
    return robot_has_key && !event.sealed && !is_stop;
  };
  events.erase(std::remove_if(events.begin(), events.end(), refused), events.end());
}

/// Fills in what follows from all events together.
void describe(RobotLog& log) {
  removeUnsealed(log.events);
  std::map<std::string, int64_t> last;
  for (size_t i = 0; i < log.events.size(); ++i) {
    const LogEvent& event = log.events[i];
    const double time = 1e-6 * static_cast<double>(event.utime - log.events.front().utime);
    config_t config;
    health_t health;
    if (decode(event, kConfig, config))
      log.configs.emplace(config.config_process, config.config_text);
    if (const auto number = numberOf(event)) noteSeq(event, *number, last, log.missing);
    if (!decode(event, kHealth, health)) continue;
    if (log.health.empty()) log.virtual_time = health.utc < 0;
    log.health[health.process].push_back({{time, i}, health});
  }
  if (!log.virtual_time) return;
  for (LogEvent& event : log.events) event.utime += kTransportUs;
}

template <class Keep>
RobotLog robotLogOf(const std::string& name, DriveReader events, const Keep& keep) {
  RobotLog log;
  log.name = name;
  for (DriveEvent event; events.next(event);)
    if (keep(event)) log.events.push_back(std::move(event));
  log.problem = events.problem();
  describe(log);
  return log;
}

}  // namespace

RobotLog toRobotLog(const std::string& name, std::vector<LogEvent> events) {
  return robotLogOf(name, DriveReader(std::move(events)), [](const LogEvent&) { return true; });
}

const std::vector<Said<health_t>>& RobotLog::healthOf(const std::string& process) const {
  static const std::vector<Said<health_t>> kNone;
  const auto found = health.find(process);
  return found == health.end() ? kNone : found->second;
}

Intake intakeOf(const RobotLog& log, const std::string& process,
                const std::vector<std::string>& channels) {
  using Health = const Said<health_t>*;
  std::map<int64_t, std::pair<Health, Health>> lives;  // by boot id: first and last
  for (const Said<health_t>& health : log.healthOf(process))
    lives.try_emplace(health.message.boot_id, &health, &health).first->second.second = &health;
  const auto at = [&](Health health) {
    return log.events.begin() + static_cast<std::ptrdiff_t>(health->event);
  };
  Intake intake;
  for (const auto& [boot_id, life] : lives) {
    const auto [first, last] = life;
    intake.heard += last->message.received - first->message.received;
    intake.lost += last->message.lost - first->message.lost;
    intake.in_log += std::count_if(at(first), at(last), [&](const LogEvent& event) {
      return std::find(channels.begin(), channels.end(), event.channel) != channels.end();
    });
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

RobotLog readRobotLog(const std::vector<std::string>& paths,
                      const std::vector<const char*>& without) {
  const auto isOurs = [&](const LogEvent& event) {
    const auto named = [&](const char* name) { return event.channel == name; };
    return std::none_of(without.begin(), without.end(), named) &&
           std::any_of(kChannels.begin(), kChannels.end(),
                       [&](const ChannelSpec& spec) { return named(spec.name); });
  };
  if (paths.empty()) throw std::runtime_error("no log is named");
  RobotLog log = robotLogOf(std::filesystem::path(paths.front()).filename().string(),
                            DriveReader(paths), isOurs);
  if (log.events.empty())
    throw std::runtime_error(paths.front() + ": no event on any of our channels" +
                             (log.problem.empty() ? "" : "; " + log.problem));
  return log;
}

ConfigReader loggedConfig(const RobotLog& log, const std::string& process,
                          const std::vector<std::string>& overrides) {
  const std::string& text = log.configs.at(process);
  const std::string name = log.name + ", CONFIG of the " + process;
  for (const std::string& override : overrides) {
    ConfigReader known = ConfigReader::fromText(text, name);
    const std::string key = override.substr(0, override.find('='));
    std::optional<ConfigReader> section;
    size_t from = 0;
    for (size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', from)) {
      ConfigReader& at = section ? *section : known;
      const std::string part = key.substr(from, dot - from);
      if (!at.has(part)) break;
      ConfigReader inner = at.section(part);
      section.emplace(std::move(inner));
      from = dot + 1;
    }
    if (!(section ? *section : known).has(key.substr(from)))
      throw std::runtime_error(name + ": has no key " + key);
  }
  return ConfigReader::fromText(text, name, overrides);
}

}  // namespace tread

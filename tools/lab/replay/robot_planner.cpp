// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/robot_planner.hpp"

#include "tools/lab/replay/robot_replay.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "common/drive/log_bus.hpp"
#include "common/drive/robot_log.hpp"
#include "modules/planner/planner_node.hpp"
#include "tools/lab/replay/planner_inputs.hpp"
#include "tools/lab/replay/robot_learner.hpp"

namespace tread::replay {
namespace {

/// More consecutive lost steps [1] mean a corrupted number, not a loss.
constexpr int64_t kMostLost = 100;

/// One step of a planner with its messages.
struct Step : LoggedStep {
  std::optional<plan_t> plan;
};

/// One run of a planner process.
struct Life {
  int64_t run_id = 0;
  bool from_start = false;
  std::vector<Step> steps;
  Hearing hearing;
};

/// Adds steps whose PROGRAM the recorder has lost.
void addLost(std::vector<Step>& steps, const program_t& next) {
  if (steps.empty()) return;
  const program_t last = steps.back().program;
  const int64_t lost = next.seq - last.seq - 1;
  if (lost < 1 || lost > kMostLost) return;
  for (int64_t i = 1; i <= lost; ++i) {
    Step step{};
    step.program.utime = last.utime + (next.utime - last.utime) * i / (lost + 1);
    step.lost = true;
    steps.push_back(std::move(step));
  }
}

/// A planner that shuts down publishes an empty PROGRAM, which is no step. A last step that looks
/// like one is not compared.
void dropFarewell(std::vector<Step>& steps) {
  const Step& last = steps.back();
  if (steps.size() > 1 && last.program.running.num_commands == 0 && !last.plan) steps.pop_back();
}

/// Why the planner of a log cannot be replayed.
std::string noPlanner(const RobotLog& log) {
  for (const LogEvent& event : log.events)
    if (event.channel == kProgram.name)
      return ": its PROGRAM is not this version's program_t (the log is older or newer); replay it "
             "with the version of Tread that recorded it";
  return ": no PROGRAM, so no planner was running";
}

std::vector<Life> livesIn(const RobotLog& log) {
  std::vector<Life> lives;
  for (const LogEvent& event : log.events) {
    program_t program;
    plan_t plan;
    if (decode(event, kProgram, program)) {
      if (lives.empty() || lives.back().run_id != program.run_id)
        lives.push_back({program.run_id, program.seq == 0, {}, {}});
      addLost(lives.back().steps, program);
      lives.back().steps.push_back({{program, false}, std::nullopt});
    } else if (!lives.empty() && decode(event, kPlan, plan)) {
      lives.back().steps.back().plan = plan;
    }
  }
  for (Life& life : lives) dropFarewell(life.steps);
  return lives;
}

/// The planner's lives in the log, with the messages received before each step.
std::vector<Life> heardLives(const RobotLog& log, const planner::PlannerConfig& config) {
  std::vector<Life> lives = livesIn(log);
  if (lives.empty()) throw std::runtime_error(log.name + noPlanner(log));
  const std::vector<PlannerInput> inputs = plannerInputs(log, config);
  for (Life& life : lives)
    life.hearing = hearingOf(log, inputs, {life.steps.begin(), life.steps.end()});
  return lives;
}

/// Number of expansions at which the robot's deadline ended a step's search; 0 = it did not.
int32_t cutOf(const Step& step, int64_t deadline) {
  return step.plan && step.plan->search_time > deadline ? step.plan->expansions : 0;
}

/// The node's messages of a step; they are appended to `all`.
Step messagesOf(LogBus& bus, std::vector<LogEvent>& all) {
  Step step{};
  for (LogEvent& event : bus.takePublished()) {
    plan_t plan;
    if (event.channel == kProgram.name) decode(event, kProgram, step.program);
    if (decode(event, kPlan, plan)) step.plan = plan;
    all.push_back(std::move(event));
  }
  return step;
}

/// Feeds HEALTH and FENCES to a planner, between its inputs in the order of the log.
/** PROGRAM does not name or count these messages. */
class Overhearing {
 public:
  Overhearing(const RobotLog& log, const Hearing& hearing, LogBus& bus)
      : log_(log), hearing_(hearing), bus_(bus) {
    if (hearing.from > 0) next_ = hearing.inputs[hearing.from - 1].event + 1;
  }

  /// Feeds the messages before an input that were received before a time.
  void until(size_t input, int64_t utime) {
    const bool at_end = input >= hearing_.inputs.size();
    const size_t end = at_end ? log_.events.size() : hearing_.inputs[input].event;
    for (; next_ < end && log_.events[next_].utime < utime; ++next_) {
      const LogEvent& event = log_.events[next_];
      if (bus_.overhears(event.channel) && !bus_.hears(event.channel)) bus_.overhear(event);
    }
  }

 private:
  const RobotLog& log_;
  const Hearing& hearing_;
  LogBus& bus_;
  size_t next_ = 0;  ///< next event
};

/// Replays a life with the real planner.
std::vector<Step> replayed(const RobotLog& log, const Life& life,
                           const planner::PlannerConfig& config, std::vector<LogEvent>& all) {
  const Hearing& hearing = life.hearing;
  LogBus bus(life.run_id);
  if (!log.virtual_time && life.from_start) bus.forgetTime();
  planner::PlannerNode node(config, bus);
  int32_t cut = 0;
  node.setStop([&cut](int expansions) { return cut > 0 && expansions >= cut; });
  Overhearing beside(log, hearing, bus);
  std::vector<Step> steps;
  size_t input = hearing.from;
  int64_t last = 0;
  for (size_t i = 0; i < life.steps.size(); ++i) {
    const int64_t utime = life.steps[i].program.utime;
    for (; input < hearing.until[i]; ++input) {
      beside.until(input, INT64_MAX);
      const LogEvent& event = log.events[hearing.inputs[input].event];
      const bool knows = bus.knowsTime();
      bus.setNow(knows ? std::min(std::max(event.utime, last), utime) : event.utime);
      bus.hear(event);
    }
    beside.until(input, utime);
    cut = cutOf(life.steps[i], config.deadline);
    if (bus.knowsTime()) bus.setNow(utime);
    node.step(utime);
    last = utime;
    steps.push_back(messagesOf(bus, all));
  }
  return steps;
}

void compare(const Step& log, const Step& replay, PlannerCheck& check) {
  const std::string program = differenceOf(log.program, replay.program);
  ++(program.empty() ? check.programs.equal : check.programs.different);
  if (log.plan && replay.plan) {
    const std::string plan = differenceOf(*log.plan, *replay.plan);
    ++(plan.empty() ? check.plans.equal : check.plans.different);
    if (!plan.empty()) check.noteDifference(plan);
  } else if (log.plan) {
    ++check.plans.only_in_log;
    check.noteDifference("PLAN on INS of " + std::to_string(log.plan->utime) +
                         " us: only in the log");
  } else if (replay.plan) {
    ++check.plans.only_in_replay;
  }
  if (!program.empty()) check.noteDifference(program);
}

std::vector<LogEvent> replayAll(const RobotLog& log, const std::vector<Life>& lives,
                                const planner::PlannerConfig& config, PlannerCheck* check) {
  std::vector<LogEvent> all;
  for (const Life& life : lives) {
    std::vector<Step> steps = replayed(log, life, config, all);
    if (check == nullptr) continue;
    check->steps += static_cast<int64_t>(steps.size());
    if (!life.from_start) continue;
    ++check->compared;
    // A life, or its recording, may end between PROGRAM and PLAN.
    if (!life.steps.back().plan) steps.back().plan.reset();
    for (size_t i = 0; i < steps.size(); ++i) {
      if (life.steps[i].lost) continue;
      if (cutOf(life.steps[i], config.deadline) > 0) ++check->searches_cut;
      compare(life.steps[i], steps[i], *check);
    }
  }
  return all;
}

std::string verdictOf(const PlannerCheck& check) {
  if (check.compared == 0) return "not compared";
  if (check.equal()) return "EQUAL";
  return check.lacking > 0 ? "DIFFERENT, but it had received messages that the log lacks"
                           : "DIFFERENT";
}

}  // namespace

planner::PlannerConfig plannerConfigOf(const RobotLog& log,
                                       const std::vector<std::string>& overrides) {
  const auto text = log.configs.find("planner");
  if (text == log.configs.end())
    throw std::runtime_error(log.name +
                             ": no CONFIG of the planner; give its configuration with --config");
  ConfigReader reader = loggedConfig(log, "planner", overrides);
  return planner::readLoggedPlannerConfig(reader);
}

PlannerCheck checkPlanner(const RobotLog& log, const planner::PlannerConfig& config) {
  const std::vector<Life> lives = heardLives(log, config);
  PlannerCheck check;
  check.name = log.name;
  check.lives = static_cast<int>(lives.size());
  if (const auto lost = log.missing.find(kPlan.name); lost != log.missing.end())
    check.plans_lost = lost->second;
  const std::vector<LogEvent> first = replayAll(log, lives, config, &check);
  check.same_twice = sameBytes(first, replayAll(log, lives, config, nullptr));
  if (check.compared < check.lives)
    check.notes.push_back(
        "the log begins in the middle of a planner's life, which cannot be compared: its "
        "permission "
        "and its numbers are not known");
  for (const Life& life : lives) {
    check.lacking += life.hearing.lacking;
    check.notes.push_back(hearingLine(life.hearing));
  }
  check.noteLog(log, "planner");
  return check;
}

std::string reportOf(const PlannerCheck& check) {
  std::ostringstream out;
  out << check.name << ": " << check.lives << (check.lives == 1 ? " planner, " : " planners, ")
      << check.steps << " steps, " << check.searches_cut
      << " searches cut by the deadline on the robot (replayed with the same count)\n";
  out << notesText(check) << "  PROGRAM: " << check.programs.equal << " equal, "
      << check.programs.different << " different\n  PLAN: " << countsText(check.plans, "") << "\n"
      << differenceText(check);
  out << check.name << ": planner " << verdictOf(check) << "\n";
  return out.str();
}

}  // namespace tread::replay

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/drive/log_bus.hpp"
#include "common/drive/robot_log.hpp"
#include "common/store/store.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/mapping/mapping_node.hpp"
#include "modules/planner/planner_node.hpp"
#include "tests/tools/lab/replay/driven_log.hpp"
#include "tools/lab/replay/robot_learner.hpp"
#include "tools/lab/replay/robot_planner.hpp"
#include "tools/lab/replay/robot_replay.hpp"
#include "tools/robot/report/logged_learner.hpp"

using namespace tread;
using namespace tread::replay;
using namespace tread::samples;

namespace {

const std::string kPatterns = TREAD_SOURCE_DIR "/config/patterns";

const std::vector<LogEvent>& plainDrive() {
  static const std::vector<LogEvent> kEvents = keptDrivenLog(30.0);
  return kEvents;
}

LearnerCheck learnerCheck(std::vector<LogEvent> events) {
  const RobotLog log = toRobotLog("drive", std::move(events));
  const LearnerCheck check = checkLearner(log, report::learnerConfigOf(log, kPatterns));
  UNSCOPED_INFO(reportOf(check));
  return check;
}

PlannerCheck plannerCheck(std::vector<LogEvent> events) {
  const RobotLog log = toRobotLog("drive", std::move(events));
  const PlannerCheck check = checkPlanner(log, plannerConfigOf(log));
  UNSCOPED_INFO(reportOf(check));
  return check;
}

FaultPlan killed(const std::string& node) {
  FaultPlan faults;
  faults.nodes.push_back({node, 17'000'000, 1'000'000});
  return faults;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The number at an offset of an encoded message; each type begins with fingerprint, utime and seq.
int64_t numberAt(const LogEvent& event, size_t place) {
  uint64_t number = 0;
  for (size_t i = place; i < place + 8; ++i) number = number << 8 | event.bytes.at(i);
  return static_cast<int64_t>(number);
}

/// The newest message that a planner had received before a step; events.end() if none.
std::vector<LogEvent>::iterator newestOf(std::vector<LogEvent>& events, const program_t& program) {
  return std::find_if(events.begin(), events.end(), [&program](const LogEvent& event) {
    return event.channel == program.newest_input &&
           numberAt(event, 8) == program.newest_input_utime &&
           numberAt(event, 16) == program.newest_input_seq;
  });
}

std::vector<program_t> programsOf(const std::vector<LogEvent>& events) {
  std::vector<program_t> programs;
  program_t program;
  for (const LogEvent& event : events)
    if (decode(event, kProgram, program)) programs.push_back(program);
  return programs;
}

/// Removes messages of a channel from the middle of the log; their seq may or may not show it.
template <class Message>
void lose(std::vector<LogEvent>& events, const Channel<Message>& channel, int count, bool shown) {
  const std::string name = channel.name;
  auto lost =
      std::find_if(events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2), events.end(),
                   [&name](const LogEvent& event) { return event.channel == name; });
  for (int left = count; left > 0; --left) {
    REQUIRE(lost != events.end());
    lost = std::find_if(events.erase(lost), events.end(),
                        [&name](const LogEvent& event) { return event.channel == name; });
  }
  int64_t seq = 0;
  if (!shown)
    rewrite<Message>(events, channel, [&seq](Message& message) {
      message.seq = seq++;
      return true;
    });
}

/// As written by lcm-logger on a host whose UTC is set forward during the drive.
std::vector<LogEvent> recordedInUtc(std::vector<LogEvent> events) {
  rewrite<health_t>(events, kHealth, [](health_t& health) {
    health.utc = 1'700'000'000'000'000;
    return true;
  });
  for (size_t i = 0; i < events.size(); ++i)
    events[i].utime += 1'700'000'000'000'000 + (i > events.size() / 2 ? 3'600'000'000 : 0);
  return events;
}

/// As written by a recorder that was delayed during these seconds of the drive.
std::vector<LogEvent> recordedAtOnce(std::vector<LogEvent> events, double from, double to) {
  const int64_t begin = events.front().utime + std::llround(from * 1e6);
  const int64_t end = events.front().utime + std::llround(to * 1e6);
  for (LogEvent& event : events)
    if (event.utime > begin && event.utime < end) event.utime = end;
  return events;
}

}  // namespace

TEST_CASE("a robot's log through the learner gives the sets of the log, twice") {
  const LearnerCheck check = learnerCheck(plainDrive());
  REQUIRE(check.from_start);
  REQUIRE(check.versions.equal >= 10);
  REQUIRE(check.learning.equal >= 10);
  REQUIRE(check.same_twice);
  REQUIRE(check.equal());
}

TEST_CASE("a set that a newer one of the same execution overtook is no difference, the newest is") {
  const std::vector<LogEvent> drive = drivenLog(15.0, {}, "multi_model");
  const LearnerCheck whole = learnerCheck(drive);
  REQUIRE(whole.equal());
  // The replay may publish one more at the end, which the log no longer holds.
  REQUIRE(whole.versions.only_in_replay <= 1);
  const int64_t beyond = whole.versions.only_in_replay;
  std::map<int64_t, std::vector<int64_t>> versions;  // by parent
  for (const LogEvent& event : drive) {
    pattern_set_part_t part;
    if (!decode(event, kPatternSet, part)) continue;
    std::vector<int64_t>& siblings = versions[part.parent_version];
    if (siblings.empty() || siblings.back() < part.set_version)
      siblings.push_back(part.set_version);
  }
  const auto followed =
      std::find_if(std::next(versions.begin(), static_cast<std::ptrdiff_t>(versions.size() / 2)),
                   versions.end(), [](const auto& each) { return each.second.size() > 2; });
  REQUIRE(followed != versions.end());
  const std::vector<int64_t> siblings = followed->second;
  const auto without = [&drive](int64_t lost) {
    std::vector<LogEvent> events = drive;
    events.erase(std::remove_if(events.begin(), events.end(),
                                [lost](const LogEvent& event) {
                                  pattern_set_part_t part;
                                  return decode(event, kPatternSet, part) &&
                                         part.set_version == lost;
                                }),
                 events.end());
    int64_t seq = 0;
    rewrite<pattern_set_part_t>(events, kPatternSet, [&seq](pattern_set_part_t& part) {
      part.seq = seq++;
      return true;
    });
    return learnerCheck(std::move(events));
  };
  const LearnerCheck overtaken = without(siblings.front());
  REQUIRE(overtaken.versions.only_in_replay == beyond + 1);
  REQUIRE(overtaken.equal());
  const LearnerCheck lost = without(siblings.back());
  REQUIRE(lost.versions.only_in_replay == beyond + 1);
  REQUIRE_FALSE(lost.equal());
}

TEST_CASE("a recorder whose clock is UTC, and is set forward by an hour, changes nothing") {
  REQUIRE(learnerCheck(recordedInUtc(plainDrive())).equal());
}

TEST_CASE("a recorder that was not listened to for a while changes nothing") {
  for (const auto& [from, to] :
       {std::pair(8.0, 28.0), std::pair(0.3, 25.0), std::pair(5.0, 31.0)}) {
    CAPTURE(from, to);
    const std::vector<LogEvent> events = recordedAtOnce(plainDrive(), from, to);
    CHECK(learnerCheck(events).equal());
    CHECK(plannerCheck(events).equal());
  }
}

TEST_CASE("a log that begins in the middle is replayed from the first state that can be replayed") {
  // Executions may name a set from before the cut: states that need it are skipped.
  for (const size_t share : {2, 3, 4}) {
    std::vector<LogEvent> events = plainDrive();
    events.erase(events.begin(),
                 events.begin() + static_cast<std::ptrdiff_t>(events.size() / share));
    const LearnerCheck check = learnerCheck(std::move(events));
    REQUIRE_FALSE(check.from_start);
    REQUIRE(check.versions.equal >= 4);
    REQUIRE(check.equal());
  }
}

TEST_CASE("a learner that was killed and started again is replayed in both lives") {
  const LearnerCheck check = learnerCheck(drivenLog(30.0, killed("learner")));
  REQUIRE(check.lives == 2);
  REQUIRE(check.versions.equal >= 10);
  REQUIRE(check.equal());
}

TEST_CASE("a changed sample of a set is named with version, pattern, sample and both values") {
  std::vector<LogEvent> events = plainDrive();
  int64_t version = 0;
  rewrite<pattern_set_part_t>(events, kPatternSet, [&version](pattern_set_part_t& part) {
    if (version == 0) version = part.set_version + 5;
    if (part.set_version != version || part.part != 3) return false;
    part.trajectory[2][1] = 0.125;
    return true;
  });
  const LearnerCheck check = learnerCheck(std::move(events));
  REQUIRE(check.versions.different == 1);
  REQUIRE(contains(check.first_difference, "version " + std::to_string(version) + ", pattern "));
  REQUIRE(contains(check.first_difference, "trajectory[2][1]: log 0.125, replay "));
  REQUIRE_FALSE(check.equal());
}

TEST_CASE("a part of a set that the replay lacks is a difference") {
  std::vector<LogEvent> events = plainDrive();
  int64_t version = 0;
  rewrite<pattern_set_part_t>(events, kPatternSet, [&version](pattern_set_part_t& part) {
    if (version == 0) version = part.set_version + 5;
    if (part.set_version != version || part.part != 3) return false;
    part.part = 1000;
    return true;
  });
  const LearnerCheck check = learnerCheck(std::move(events));
  REQUIRE(contains(check.first_difference, ", part 1000: in the log, not in the replay"));
  REQUIRE_FALSE(check.equal());
}

TEST_CASE("a LEARNING that only the replay has is a difference unless seq shows that it was lost") {
  std::vector<LogEvent> events = plainDrive();
  const bool shown = GENERATE(true, false);
  lose(events, kLearning, 1, shown);
  const LearnerCheck check = learnerCheck(std::move(events));
  REQUIRE(check.learning.only_in_replay == 1);
  REQUIRE(check.equal() == shown);
}

TEST_CASE("a PLAN that only the replay has is a difference unless seq shows that it was lost") {
  std::vector<LogEvent> events = plainDrive();
  const bool shown = GENERATE(true, false);
  lose(events, kPlan, 2, shown);
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(check.plans.only_in_replay == 2);
  REQUIRE(check.equal() == shown);
}

TEST_CASE("a recording that ends between PROGRAM and PLAN is compared up to there") {
  std::vector<LogEvent> events = plainDrive();
  while (events.back().channel != kPlan.name) events.pop_back();
  while (events.back().channel != kProgram.name) events.pop_back();
  REQUIRE(plannerCheck(std::move(events)).equal());
}

TEST_CASE("an INS message that the robot had heard otherwise makes other sets") {
  std::vector<LogEvent> events = plainDrive();
  const int64_t from = events[events.size() / 2].utime;
  rewrite<ins_t>(events, kIns, [from](ins_t& ins) {
    if (ins.utime < from) return false;
    ins.position[0] += 1e-9 * static_cast<double>(ins.utime - from);
    return true;
  });
  const LearnerCheck check = learnerCheck(std::move(events));
  REQUIRE(check.versions.equal >= 3);
  REQUIRE(check.versions.different >= 1);
  REQUIRE(check.same_twice);
  REQUIRE_FALSE(check.equal());
}

TEST_CASE("messages that the recorder lost are counted, and what the learner counted is beside") {
  std::vector<LogEvent> events = plainDrive();
  int count = 0;
  events.erase(std::remove_if(events.begin(), events.end(),
                              [&count](const LogEvent& event) {
                                return event.channel == kMotor.name && ++count % 100 == 50;
                              }),
               events.end());
  const RobotLog log = toRobotLog("drive", std::move(events));
  REQUIRE(log.missing.at("MOTOR") == count / 100 + (count % 100 >= 50 ? 1 : 0));
  const Intake intake = intakeOf(log, "learner", playedChannels("learner"));
  REQUIRE(intake.lost == 0);
  REQUIRE(intake.heard > intake.in_log);
}

TEST_CASE("a log without the learner's state or configuration is refused with one line") {
  std::vector<LogEvent> events = plainDrive();
  const auto without = [&events](const char* channel) {
    events.erase(
        std::remove_if(events.begin(), events.end(),
                       [channel](const LogEvent& event) { return event.channel == channel; }),
        events.end());
  };
  without(kLearnerState.name);
  REQUIRE_THROWS_WITH(learnerCheck(events), Catch::Contains("no complete LEARNER_STATE"));
  without(kConfig.name);
  REQUIRE_THROWS_WITH(learnerCheck(events), Catch::Contains("no CONFIG of the learner"));
  REQUIRE_THROWS_WITH(plannerCheck(events), Catch::Contains("no CONFIG of the planner"));
}

TEST_CASE("a robot's log through the planner gives the programs and plans of the log, twice") {
  const PlannerCheck check = plannerCheck(plainDrive());
  REQUIRE(check.programs.equal >= 590);
  REQUIRE(check.plans.equal >= 100);
  REQUIRE(check.same_twice);
  REQUIRE(check.equal());
}

TEST_CASE("a planner that mapping's HEALTH stopped is stopped in the replay, too") {
  // The range finder lies for six seconds: mapping reports it in HEALTH, which the planner
  // receives.
  const auto lies = [](missions::RobotSystem& system) {
    const int64_t start = system.bus().now();
    system.disturbScans([&system, start](lidar::RangeScan& scan) {
      const int64_t driven = system.bus().now() - start;
      if (driven > 12'000'000 && driven < 18'000'000)
        std::fill(scan.ranges.begin(), scan.ranges.end(), 0.0F);
    });
  };
  std::vector<LogEvent> events = drivenLog(25.0, {}, "collective", lies);
  const auto stopped = std::count_if(events.begin(), events.end(), [](const LogEvent& event) {
    plan_t plan;
    return decode(event, kPlan, plan) && contains(plan.reason, "mapping: ");
  });
  REQUIRE(stopped >= 20);
  const PlannerCheck check = plannerCheck(events);
  REQUIRE(check.programs.equal == check.steps);
  REQUIRE(check.plans.equal >= 100);
  REQUIRE(check.equal());
  // Without HEALTH the replay cannot know why the robot stopped.
  events.erase(std::remove_if(events.begin(), events.end(),
                              [](const LogEvent& event) {
                                health_t health;
                                return decode(event, kHealth, health) &&
                                       health.process == "mapping";
                              }),
               events.end());
  REQUIRE_FALSE(plannerCheck(events).equal());
}

TEST_CASE("what a robot with a key did not take is not replayed, a stop is") {
  std::vector<LogEvent> events = plainDrive();
  for (LogEvent& event : events) event.sealed = true;
  goal_t forged{};
  forged.goal_id = 4711;
  forged.goal_pose[0] = -5.0;
  forged.utime = events[events.size() / 2].utime;
  events.insert(events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2),
                eventOf(kGoal, forged));
  estop_t stop{};
  stop.engaged = true;
  stop.utime = events.back().utime;
  events.push_back(eventOf(kEstop, stop));
  const size_t all = events.size();
  CHECK(toRobotLog("drive", events).events.size() == all - 1);
  CHECK(plannerCheck(std::move(events)).equal());
}

TEST_CASE(
    "a message that was recorded on the other side of a step counts where the planner heard it") {
  std::vector<LogEvent> events = plainDrive();
  int later = 0;
  int earlier = 0;
  for (const program_t& program : programsOf(events)) {
    const auto newest = newestOf(events, program);
    if (newest == events.end()) continue;
    // As if the recorder had received it just after the step began; or the next one just before.
    if (later <= earlier) {
      newest->utime = program.utime + 100;
      ++later;
    } else {
      const std::vector<std::string> heard = playedChannels("planner");
      const auto next = std::find_if(newest + 1, events.end(), [&heard](const LogEvent& event) {
        return std::count(heard.begin(), heard.end(), event.channel) > 0;
      });
      if (next == events.end()) continue;
      next->utime = program.utime - 100;
      ++earlier;
    }
  }
  REQUIRE(later > 200);
  REQUIRE(earlier > 200);
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(check.programs.equal >= 590);
  REQUIRE(check.equal());
}

TEST_CASE("two messages that recorder and planner heard in different orders are put right") {
  std::vector<LogEvent> events = plainDrive();
  int swapped = 0;
  for (const program_t& program : programsOf(events)) {
    const auto newest = newestOf(events, program);
    if (newest == events.end() || newest->channel != kMotor.name) continue;
    const auto other = newest + (program.seq % 2 == 0 ? 1 : -1);
    if (other->channel != kIns.name && other->channel != kExecution.name) continue;
    std::iter_swap(newest, other);
    std::swap(newest->utime, other->utime);
    ++swapped;
  }
  REQUIRE(swapped > 20);
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(contains(reportOf(check), std::to_string(swapped) + " pairs in the other order"));
  REQUIRE(check.equal());
}

TEST_CASE("what the recorder lost, and what the planner did not hear, is told beside the verdict") {
  std::vector<LogEvent> events = plainDrive();
  int motors = 0;
  events.erase(std::remove_if(events.begin(), events.end(),
                              [&motors](const LogEvent& event) {
                                return event.channel == kMotor.name && ++motors % 200 == 100;
                              }),
               events.end());
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(contains(reportOf(check), "; " + std::to_string((motors + 100) / 200) +
                                        " that it received are not in the log"));
  REQUIRE(check.programs.equal >= 580);

  FaultPlan faults;
  MessageFault fault;
  fault.channel = kMotor.name;
  fault.receiver = "planner";
  fault.drop = 0.02;
  faults.messages.push_back(fault);
  const PlannerCheck deaf = plannerCheck(drivenLog(20.0, faults));
  REQUIRE(contains(reportOf(deaf), " of the log it did not receive"));
  REQUIRE(deaf.programs.equal >= 350);
}

TEST_CASE("a log that begins in the middle of a planner's life is stepped, not compared") {
  std::vector<LogEvent> events = plainDrive();
  events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(events.size() / 3));
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(check.compared == 0);
  REQUIRE(check.steps > 300);
  REQUIRE(check.same_twice);
  REQUIRE(contains(reportOf(check), "planner not compared"));
  REQUIRE_FALSE(check.equal());
  REQUIRE_FALSE(contains(reportOf(check), "that it received are not in the log"));
}

TEST_CASE("a log whose PROGRAM is of another version is refused with one line") {
  std::vector<LogEvent> events = plainDrive();
  for (LogEvent& event : events)
    if (event.channel == kProgram.name) event.bytes[0] ^= 1;
  REQUIRE_THROWS_WITH(plannerCheck(std::move(events)),
                      Catch::Contains("is not this version's program_t") && !Catch::Contains("\n"));
}

TEST_CASE("a planner that was killed and started again is replayed in both lives") {
  const PlannerCheck check = plannerCheck(drivenLog(24.0, killed("planner")));
  REQUIRE(check.lives == 2);
  REQUIRE(check.compared == 2);
  REQUIRE(check.equal());
}

TEST_CASE("another goal than the planner had heard makes other plans, and the first is named") {
  std::vector<LogEvent> events = plainDrive();
  rewrite<goal_t>(events, kGoal, [](goal_t& goal) {
    goal.goal_pose[1] += 3.0;
    return true;
  });
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(check.plans.different > 0);
  REQUIRE(check.same_twice);
  REQUIRE(contains(check.first_difference, ": log "));
}

TEST_CASE("a search that the deadline cut on the robot is cut at the same count") {
  std::vector<LogEvent> events = plainDrive();
  rewrite<plan_t>(events, kPlan, [](plan_t& plan) {
    plan.search_time = 60'000;  // as if each had been cut where it ended
    return true;
  });
  const PlannerCheck check = plannerCheck(std::move(events));
  REQUIRE(check.searches_cut > 10);
  REQUIRE(check.equal());
}

TEST_CASE("the channels of a recipe are those that the node hears, and none of its own") {
  const missions::RobotConfig robot = missions::readRobot(TREAD_SOURCE_DIR "/config/robots/teodor");
  const auto check = [](const std::string& process, const LogBus& bus) {
    std::vector<std::string> played = playedChannels(process);
    std::sort(played.begin(), played.end());
    REQUIRE(played == bus.heard());
    for (const ChannelSpec& channel : kChannels)
      if (channel.publisher == process)
        REQUIRE(std::count(played.begin(), played.end(), channel.name) == 0);
  };
  MemoryStore store;
  LogBus bus(1);
  const learner::LearnerNode learner(robot.learner, bus, store);
  check("learner", bus);
  LogBus planner_bus(1);
  const planner::PlannerNode planner(robot.planner, planner_bus);
  check("planner", planner_bus);
  LogBus mapping_bus(1);
  const mapping::MappingNode mapping(robot.mapping, mapping_bus);
  check("mapping", mapping_bus);
  REQUIRE(channelFilter("learner") == "^(INS|MOTOR|EXECUTION)$");
}

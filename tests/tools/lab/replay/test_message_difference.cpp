// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The report of differences between messages, and how time and gaps of a log are found.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "common/messages/blank.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/lab/replay/robot_replay.hpp"

using namespace tread;
using namespace tread::replay;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

pattern_set_part_t part() {
  auto message = blank<pattern_set_part_t>();
  message.set_version = 9;
  message.set_pattern_id = 3;
  message.pattern_name = "left";
  message.part_count = 2;
  message.set_checksum = 1234;
  message.num_samples = 2;
  message.command = {{0.5, 0.5}, {0.5, 0.6}};
  message.trajectory = {{0.1, 0.0, 0.0}, {0.2, 0.0, 0.1}};
  return message;
}

plan_t plan() {
  auto message = blank<plan_t>();
  message.utime = 2'000'000;
  message.goal_id = 1;
  message.num_patterns = 2;
  message.execution_id = {4, 0};
  message.pattern_id = {1, 2};
  message.pose = {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.5}};
  message.covariance = {std::vector<double>(6, 0.01), std::vector<double>(6, 0.02)};
  return message;
}

program_t program() {
  auto message = blank<program_t>();
  message.utime = 3'000'000;
  message.running.execution_id = 4;
  message.running.num_commands = 2;
  message.running.num_channels = 2;
  message.running.channel_kind.assign(2, program_slot_t::KIND_POWER);
  message.running.command = {{0.5F, 0.5F}, {0.5F, 0.25F}};
  return message;
}

ins_t insAt(int64_t utime, int64_t seq) {
  auto ins = blank<ins_t>();
  ins.utime = utime;
  ins.seq = seq;
  return ins;
}

}  // namespace

TEST_CASE("equal messages have no difference, and an unknown number equals itself") {
  CHECK(differenceOf(part(), part(), 0.0).empty());
  CHECK(differenceOf(blank<learning_t>(), blank<learning_t>(), 0.0).empty());
  CHECK(differenceOf(plan(), plan()).empty());
  CHECK(differenceOf(program(), program()).empty());
}

TEST_CASE("of several differences the first is named with both values") {
  pattern_set_part_t replay = part();
  replay.trajectory[1][2] = 0.2;
  replay.times_learned = 5;
  replay.set_checksum = 1;
  CHECK(differenceOf(part(), replay, 0.0) ==
        "version 9, pattern 3 'left', trajectory[1][2]: log 0.1, replay 0.2");
  replay.pattern_name = "right";
  CHECK(differenceOf(part(), replay, 0.0) ==
        "version 9, pattern 3 'left', pattern_name: log 'left', replay 'right'");
}

TEST_CASE("samples of another number are not compared one by one") {
  pattern_set_part_t replay = part();
  replay.num_samples = 1;
  replay.command.resize(1);
  replay.trajectory.resize(1);
  CHECK(differenceOf(part(), replay, 0.0) ==
        "version 9, pattern 3 'left', num_samples: log 2, replay 1");
}

TEST_CASE("numbers within the tolerance are equal, and checksums count to the bit only") {
  pattern_set_part_t replay = part();
  replay.trajectory[0][0] += 1e-9;
  replay.set_checksum = 77;
  CHECK(differenceOf(part(), replay, 1e-6).empty());
  CHECK_FALSE(differenceOf(part(), replay, 1e-12).empty());
  replay.trajectory = part().trajectory;
  CHECK(differenceOf(part(), replay, 0.0).find("set_checksum: log 1234, replay 77") !=
        std::string::npos);
  // A number differs from an unknown one at any tolerance.
  replay.trajectory[0][0] = kNone;
  CHECK_FALSE(differenceOf(part(), replay, 1e6).empty());
}

TEST_CASE("the number of a message and how long a search took are never compared") {
  plan_t replay = plan();
  replay.seq = 99;
  replay.search_time = 50'000;
  CHECK(differenceOf(plan(), replay).empty());
  program_t other = program();
  other.seq = 99;
  other.inputs_heard = 5;
  other.newest_input = "INS";
  CHECK(differenceOf(program(), other).empty());
}

TEST_CASE("what messages of an older version lack is not compared") {
  plan_t old_plan = plan();
  old_plan.reason_code = -1;
  plan_t new_plan = old_plan;
  new_plan.reason_code = 7;
  new_plan.risk = 0.01;
  new_plan.risk_per_metre = 0.01;
  CHECK(differenceOf(old_plan, new_plan).empty());
  CHECK_FALSE(differenceOf(new_plan, old_plan).empty());
  auto old_note = blank<learning_t>();
  old_note.gate_code = -1;
  learning_t new_note = old_note;
  new_note.gate_code = 0;
  CHECK(differenceOf(old_note, new_note, 0.0).empty());
  CHECK_FALSE(differenceOf(new_note, old_note, 0.0).empty());
}

TEST_CASE("a plan's first different pattern, pose or covariance is named") {
  plan_t replay = plan();
  replay.covariance[1][3] = 0.5;
  CHECK(differenceOf(plan(), replay) ==
        "PLAN on INS of 2000000 us, covariance[1][3]: log 0.02, replay 0.5");
  replay.pose[1][1] = -1.5;
  CHECK(differenceOf(plan(), replay) ==
        "PLAN on INS of 2000000 us, pose[1][1]: log 0, replay -1.5");
  replay.pattern_id[0] = 7;
  CHECK(differenceOf(plan(), replay) ==
        "PLAN on INS of 2000000 us, pattern_id[0]: log 1, replay 7");
  replay.reason = "blocked";
  CHECK(differenceOf(plan(), replay) ==
        "PLAN on INS of 2000000 us, reason: log '', replay 'blocked'");
}

TEST_CASE("a plan of fewer patterns differs in their number, and none is looked for behind it") {
  plan_t replay = plan();
  replay.num_patterns = 1;
  replay.execution_id.resize(1);
  replay.pattern_id.resize(1);
  replay.pose.resize(1);
  replay.covariance.resize(1);
  CHECK(differenceOf(plan(), replay) == "PLAN on INS of 2000000 us, num_patterns: log 2, replay 1");
}

TEST_CASE("a program's first different command is named by slot and channel") {
  program_t replay = program();
  replay.next.execution_id = 6;
  CHECK(differenceOf(program(), replay) ==
        "PROGRAM at 3000000 us, next.execution_id: log 0, replay 6");
  replay.running.command[1][1] = 0.75F;
  CHECK(differenceOf(program(), replay) ==
        "PROGRAM at 3000000 us, running.command[1][1]: log 0.25, replay 0.75");
}

TEST_CASE("an execution that the log accepted and the replay did not differs in that first") {
  auto log = blank<learning_t>();
  log.learned_execution_id = 12;
  log.accepted = 1;
  auto replay = log;
  replay.accepted = 0;
  CHECK(differenceOf(log, replay, 0.0) == "LEARNING of execution 12, accepted: log 1, replay 0");
  log.accepted = replay.accepted = 1;
  log.measured_end[1] = 0.5;
  replay.measured_end[1] = kNone;
  CHECK(differenceOf(log, replay, 1e-3) ==
        "LEARNING of execution 12, measured_end[1]: log 0.5, replay nan");
}

TEST_CASE("messages that only one side has are counted, and the first difference stays the first") {
  ReplayCheck check;
  const std::map<int, int> log{{1, 10}, {2, 20}, {3, 30}};
  const std::map<int, int> replay{{2, 20}, {3, 31}, {4, 40}};
  const auto difference = [](int a, int b) { return a == b ? "" : std::to_string(b) + " differs"; };
  const auto name = [](int key) { return "message " + std::to_string(key); };
  const MessageCounts counts = compareByKey(log, replay, {}, 0, difference, name, check);
  CHECK(countsText(counts, " plans") ==
        "1 plans equal, 1 different, 1 only in the log, 1 only in the replay");
  CHECK(check.first_difference == "message 1: in the log, not in the replay");
  CHECK(differenceText(check) == "  first difference: message 1: in the log, not in the replay\n");
  CHECK(differenceText({}).empty());
}

TEST_CASE("what the log is known to lack, or came too late for it, is no difference") {
  const std::map<int, int> log{{1, 10}};
  const std::map<int, int> replay{{1, 10}, {2, 20}, {3, 30}};
  const auto difference = [](int, int) { return std::string(); };
  const auto name = [](int key) { return "message " + std::to_string(key); };
  const auto firstWith = [&](const std::set<int>& late, int64_t lost) {
    ReplayCheck check;
    CHECK(compareByKey(log, replay, late, lost, difference, name, check).only_in_replay == 2);
    return check.first_difference;
  };
  CHECK(firstWith({}, 2).empty());
  CHECK(firstWith({3}, 1).empty());
  CHECK(firstWith({2, 3}, 0).empty());
  CHECK(firstWith({}, 1) == "message 2: in the replay, not in the log");
  CHECK(firstWith({2}, 0) == "message 3: in the replay, not in the log");
}

TEST_CASE("gaps in seq are what the log lacks, a restart and a broken number are none") {
  std::vector<LogEvent> events;
  int64_t utime = 1'000'000;
  for (const int64_t seq : {0, 1, 2, 5, 6, 0, 1, 900'000'000, 2, 3})
    events.push_back(eventOf(kIns, insAt(utime += 20'000, seq)));
  const RobotLog log = toRobotLog("gaps", events);
  CHECK(log.missing.at("INS") == 2);
  CHECK(log.missing.count("MOTOR") == 0);
  CHECK(log.events.size() == events.size());
}

TEST_CASE("the robot's time follows its messages, goes on between them and never goes back") {
  std::vector<LogEvent> events;
  const int64_t utc = 1'700'000'000'000'000;
  const auto record = [&](int64_t recorded, LogEvent event) {
    event.utime = utc + recorded;
    events.push_back(std::move(event));
  };
  record(0, {0, "NOISE", {}});
  record(10'000, eventOf(kIns, insAt(5'000'000, 0)));
  record(15'000, {0, "NOISE", {}});
  record(30'000, eventOf(kIns, insAt(5'019'000, 1)));
  record(50'000, eventOf(kIns, insAt(999'000'000, 2)));  // corrupted: far ahead
  record(70'000, eventOf(kIns, insAt(5'060'000, 3)));
  const RobotLog log = toRobotLog("clock", events);
  CHECK_FALSE(log.virtual_time);
  CHECK(log.events[0].utime == 4'990'000);  // before the first stamp
  CHECK(log.events[1].utime == 5'000'000);
  CHECK(log.events[2].utime == 5'005'000);
  CHECK(log.events[3].utime == 5'020'000);
  for (size_t i = 1; i < log.events.size(); ++i)
    CHECK(log.events[i].utime >= log.events[i - 1].utime);
  CHECK(log.events.back().utime == 5'060'000);
}

TEST_CASE("a recipe plays to a bus of its own what the process hears, for each process") {
  CHECK(playableProcesses() == std::vector<std::string>{"learner", "mapping", "planner"});
  for (const std::string& process : playableProcesses()) {
    const std::string recipe = recipeFor(process, "run.lcmlog");
    INFO(recipe);
    CHECK(recipe.find("tread-" + process + " --config FILE --lcm-url ") != std::string::npos);
    CHECK(recipe.find("-e '" + channelFilter(process) + "' run.lcmlog\n") != std::string::npos);
    CHECK(recipe.find("ttl=0") != std::string::npos);
  }
}

TEST_CASE("tread-replay says of a log that it cannot use what is missing, in one line") {
  const samples::OwnFolder folder;
  const std::string noise = folder.path("noise.lcmlog");
  const std::string bare = folder.path("bare.lcmlog");
  {
    LogWriter(noise).write(1, "NOISE", nullptr, 0);
    LogWriter(bare).write(kIns, insAt(1'000'000, 0));
  }
  const std::string text = folder.write("text.lcmlog", "this is no log\n");
  for (const std::string command : {"planner", "learner"}) {
    const std::vector<std::pair<std::string, std::string>> refused{
        {bare, "no CONFIG of the " + command},
        {noise, "no event on any of our channels"},
        {text, text},
        {folder.path("none.lcmlog"), "none.lcmlog"},
        {bare + " --config /no/such.yaml", "/no/such.yaml"}};
    for (const auto& [arguments, words] : refused) {
      const samples::CalledProgram run =
          samples::called("tread-replay " + command + " " + arguments);
      INFO(command << " " << arguments << ": " << run.printed);
      CHECK(run.status != 0);
      CHECK(run.isOneLine());
      CHECK(run.printed.find("tread-replay: ") == 0);
      CHECK(run.says(words));
    }
  }
}

TEST_CASE("tread-replay refuses options that exclude each other, and prints a recipe") {
  for (const std::string arguments :
       {"learner x --model a --patterns b", "--recipe simulator x", "--recipe planner", "planner",
        "learner x --rule magic", "mapping", "ins"}) {
    const samples::CalledProgram run = samples::called("tread-replay " + arguments);
    INFO(arguments << ": " << run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
  }
  const samples::CalledProgram recipe = samples::called("tread-replay --recipe planner a.lcmlog");
  CHECK(recipe.status == 0);
  CHECK(recipe.printed == recipeFor("planner", "a.lcmlog"));
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The report of a drive, from logs with known contents.
#include <catch2/catch.hpp>

#include <limits>

#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/report/invented_drive.hpp"
#include "tools/robot/report/drive_report.hpp"

using namespace tread;
using namespace tread::report;
using namespace tread::samples;

namespace {

DriveRecord driveOf(const std::vector<LogEvent>& events) {
  const OwnFolder folder;
  return readDrive({writeLog(folder.path("drive.lcmlog"), events)});
}

std::string resultOf(const std::vector<LogEvent>& events) {
  return resultLine(driveOf(events), {});
}

std::vector<LogEvent> arrivingDrive() {
  std::vector<LogEvent> events = tenMetres();
  events.push_back(eventOf(kPlan, planAt(15.2, plan_t::PLAN_ARRIVED, "at the goal")));
  return events;
}

sim::TruthRow truthAt(double seconds, const std::string& surface, int contacts = 0) {
  sim::TruthRow row;
  row.utime = std::llround(seconds * 1e6);
  row.T_map_body = {seconds - 5.0, 0.0, 0.0};
  row.surface = surface;
  row.contacts = contacts;
  return row;
}

/// Rows at 50 Hz over the drive of tenMetres(), on the surface that `surface` returns for a time.
template <class SurfaceAt>
std::vector<sim::TruthRow> truthOn(const SurfaceAt& surface) {
  std::vector<sim::TruthRow> rows;
  for (int i = 0; i <= 600; ++i) rows.push_back(truthAt(4.0 + 0.02 * i, surface(4.0 + 0.02 * i)));
  return rows;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a drive that arrives is told with its time, its way and the straight line") {
  const DriveRecord drive = driveOf(arrivingDrive());
  CHECK(drive.arrived);
  CHECK(drive.log.problem.empty());
  CHECK(drive.seconds() == Approx(10.2));
  CHECK(drive.distance() == Approx(10.0).margin(0.11));
  CHECK(drive.straightLine() == Approx(10.0));
  CHECK(resultLine(drive, {}) ==
        "arrived after 10.2 s and 10.0 m (straight line 10.0 m); 0 patterns driven, 0 aborted, "
        "disarmed 0 times");
}

TEST_CASE("a drive that does not arrive is told with the planner's last reason") {
  std::vector<LogEvent> events = tenMetres();
  CHECK(contains(resultOf(events), "NOT ARRIVED after 10.0 s and 10.0 m; 0 patterns"));
  events.push_back(eventOf(kPlan, planAt(15.1, plan_t::PLAN_BLOCKED, "no way through")));
  CHECK(contains(resultOf(events), "NOT ARRIVED after 10.0 s and 10.0 m: no way through; "));
}

TEST_CASE("a log without a goal is told so, whatever else it holds") {
  CHECK(resultOf({}) == "no goal in this log");
  CHECK(resultOf({eventOf(kIns, insAt(1.0, 0.0)),
                  eventOf(kPlan, planAt(2.0, plan_t::PLAN_ARRIVED))}) == "no goal in this log");
  // An operator who cancels the goal sends goal 0.
  CHECK(resultOf({eventOf(kGoal, goalAt(1.0, 5.0, 0))}) == "no goal in this log");
}

TEST_CASE("of two arrivals in one log the first ends the drive") {
  std::vector<LogEvent> events = arrivingDrive();
  events.push_back(eventOf(kGoal, goalAt(16.0, 30.0, 2)));
  for (int i = 0; i < 100; ++i)
    events.push_back(eventOf(kIns, insAt(16.0 + 0.1 * i, 10.0 + 0.2 * i)));
  events.push_back(eventOf(kMotor, motorAt(25.0, motor_t::STATE_DISARMED)));
  events.push_back(eventOf(kPlan, planAt(26.0, plan_t::PLAN_ARRIVED)));
  const DriveRecord drive = driveOf(events);
  CHECK(drive.seconds() == Approx(10.2));
  CHECK(drive.distance() == Approx(10.0).margin(0.11));
  CHECK(drive.T_map_goal.x == 10.0);
  CHECK(drive.disarmed == 0);
}

TEST_CASE("beyond the first arrival: goals, stops, faults and E-stops of the whole log are told") {
  std::vector<LogEvent> events = arrivingDrive();
  const auto plan = [&](double seconds, int64_t goal, int16_t status, const std::string& reason) {
    plan_t message = planAt(seconds, status, reason);
    message.goal_id = goal;
    events.push_back(eventOf(kPlan, message));
  };
  const auto motor = [&](double seconds, int16_t state, const std::string& reason) {
    motor_t message = motorAt(seconds, state);
    message.state_reason = reason;
    events.push_back(eventOf(kMotor, message));
  };
  motor(15.3, motor_t::STATE_DRIVING, "playing");
  plan(16.0, 2, plan_t::PLAN_DRIVING, "");
  motor(16.5, motor_t::STATE_ESTOP, "E-stop: dog (ada)");
  plan(16.6, 2, plan_t::PLAN_STOPPED, "E-stop is engaged");
  motor(17.0, motor_t::STATE_DRIVING, "playing");
  plan(17.0, 3, plan_t::PLAN_DRIVING, "");
  plan(18.0, 3, plan_t::PLAN_ARRIVED, "");
  plan(19.0, 4, plan_t::PLAN_DRIVING, "");
  motor(19.5, motor_t::STATE_DISARMED, "INS is stale");
  plan(19.6, 4, plan_t::PLAN_STOPPED, "motor_bridge: INS is stale");
  const DriveRecord drive = driveOf(events);
  CHECK(Chronicle(drive.log).goals.size() == 4);
  CHECK(Chronicle(drive.log).incidents.size() == 2);
  const std::string report = reportOf(drive, {}, {});
  INFO(report);
  CHECK(contains(resultLine(drive, {}),
                 "disarmed 0 times; in the whole log 2 of 4 goals reached; 2 stops that needed "
                 "arming (0 faults, 1 E-stops), THE LAST GOAL NOT REACHED"));
  CHECK_FALSE(endedWell(drive, {}));
  CHECK(contains(
      report,
      "\nthe whole log: 2 of 4 goals reached; 2 stops that needed arming (0 faults, 1 E-stops)"));
  CHECK(contains(report, "goal 2: NOT reached in 0.6 s: E-stop is engaged"));
  CHECK(contains(report, "goal 3: arrived after 1.0 s"));
  CHECK(contains(report, "E-stop: E-stop: dog (ada)"));
  CHECK(contains(report, "disarmed: INS is stale"));
}

TEST_CASE("an E-stop or fault that lasts to the log's end is no good end, one that is cleared is") {
  for (const int16_t state : {motor_t::STATE_ESTOP, motor_t::STATE_FAULT}) {
    std::vector<LogEvent> events = arrivingDrive();
    CHECK(endedWell(driveOf(events), {}));
    events.push_back(eventOf(kMotor, motorAt(16.0, state)));
    const DriveRecord drive = driveOf(events);
    CHECK_FALSE(endedWell(drive, {}));
    CHECK(contains(resultLine(drive, {}), state == motor_t::STATE_ESTOP
                                              ? "1 E-stops), IT ENDS WITH AN E-STOP"
                                              : "(1 faults, 0 E-stops), IT ENDS WITH A FAULT"));
    events.push_back(eventOf(kMotor, motorAt(17.0, motor_t::STATE_DISARMED)));
    CHECK(endedWell(driveOf(events), {}));
  }
}

TEST_CASE("who disarms after the arrival ends the drive well") {
  std::vector<LogEvent> events = arrivingDrive();
  events.push_back(eventOf(kMotor, motorAt(16.0, motor_t::STATE_DISARMED)));
  CHECK(endedWell(driveOf(events), {}));
}

TEST_CASE("holes in a log are told with their channels, one line where all fell silent together") {
  std::vector<LogEvent> events;
  for (int i = 0; i <= 200; ++i) {
    const double time = 5.0 + 0.05 * i;
    const bool hole = time > 8.0 && time < 10.0;
    if (!hole) events.push_back(eventOf(kMotor, motorAt(time, motor_t::STATE_ARMED)));
    if (!hole && (time < 12.0 || time > 12.9)) events.push_back(eventOf(kIns, insAt(time, 0.0)));
  }
  const std::vector<Hole> holes = Chronicle(driveOf(events).log).holes;
  REQUIRE(holes.size() == 2);
  CHECK(holes[0].begin == Approx(3.0));
  CHECK(holes[0].length == Approx(2.0));
  CHECK(holes[0].channels.size() == 2);
  CHECK(holes[1].channels == std::vector<std::string>{"INS"});
}

TEST_CASE("a goal that is moved on the way does not begin the drive anew") {
  std::vector<LogEvent> events = tenMetres();
  events.push_back(eventOf(kGoal, goalAt(15.0, 12.0, 2)));
  events.push_back(eventOf(kPlan, planAt(17.0, plan_t::PLAN_ARRIVED)));
  const DriveRecord drive = driveOf(events);
  CHECK(drive.seconds() == Approx(12.0));
  CHECK(drive.straightLine() == Approx(12.0));
}

TEST_CASE("an execution is counted once, by how it ended, however often it is repeated") {
  std::vector<LogEvent> events = tenMetres();
  for (int repeat = 0; repeat < 3; ++repeat) {
    const double later = 0.1 * repeat;
    events.push_back(
        eventOf(kExecution, executionAt(15.0 + later, 1, execution_record_t::OUTCOME_COMPLETED)));
    events.push_back(
        eventOf(kExecution, executionAt(15.0 + later, 2, execution_record_t::OUTCOME_ABORTED)));
    events.push_back(
        eventOf(kExecution, executionAt(15.0 + later, 3, execution_record_t::OUTCOME_RUNNING)));
  }
  CHECK(contains(resultOf(events), "; 1 patterns driven, 1 aborted, "));
}

TEST_CASE("a permission that is lost and given again is counted each time it is lost") {
  std::vector<LogEvent> events = tenMetres();
  for (const int16_t state :
       {motor_t::STATE_DRIVING, motor_t::STATE_STOPPING, motor_t::STATE_DISARMED,
        motor_t::STATE_FAULT, motor_t::STATE_ARMED, motor_t::STATE_ESTOP})
    events.push_back(eventOf(kMotor, motorAt(15.0, state)));
  CHECK(contains(resultOf(events), "disarmed 2 times"));
}

TEST_CASE("errors are means of what was measured, refused and unknown ones are left out") {
  std::vector<LogEvent> events = tenMetres();
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  events.push_back(eventOf(kLearning, learningAt(7.0, true, 0.1, -0.1)));
  events.push_back(eventOf(kLearning, learningAt(8.0, true, 0.3, 0.1)));
  events.push_back(eventOf(kLearning, learningAt(9.0, false, 5.0, 5.0)));
  events.push_back(eventOf(kLearning, learningAt(10.0, true, kUnknown, kUnknown)));
  const DriveRecord drive = driveOf(events);
  REQUIRE(drive.errors.size() == 2);
  CHECK(drive.errors[0].time == Approx(2.0));
  const std::string report = reportOf(drive, {}, {});
  INFO(report);
  CHECK(contains(report, "mean 0.200 m, 5.73 deg over 2 measured (1 refused)\n"));
  CHECK_FALSE(contains(report, "nan"));
}

TEST_CASE("a report without one message of a kind says none, and no number") {
  const std::string report = reportOf(driveOf(tenMetres()), {}, {});
  INFO(report);
  CHECK(contains(report, "INS to learner's set   none\n"));
  CHECK(contains(report, "scan to tile           none\n"));
  CHECK(contains(report, "mean 0.000 m, 0.00 deg over 0 measured"));
}

TEST_CASE("a log that breaks off is read as far as it goes, and the report says so") {
  const OwnFolder folder;
  const std::string path = writeLog(folder.path("drive.lcmlog"), arrivingDrive());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 20);
  const DriveRecord drive = readDrive({path});
  CHECK_FALSE(drive.arrived);
  CHECK_FALSE(drive.log.problem.empty());
  CHECK(drive.distance() == Approx(10.0).margin(0.11));
  CHECK(contains(reportOf(drive, {}, {}), "the log: " + drive.log.problem + "\n"));
}

TEST_CASE("parts of one recording are one drive") {
  const OwnFolder folder;
  const std::vector<LogEvent> all = arrivingDrive();
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  const DriveRecord drive = readDrive({writeLog(folder.path("a.lcmlog"), {all.begin(), middle}),
                                       writeLog(folder.path("b.lcmlog"), {middle, all.end()})});
  CHECK(resultLine(drive, {}) == resultOf(all));
  CHECK(drive.log.messages == all.size());
}

TEST_CASE("INS measurements that are not finite or have no fix are no part of the track") {
  std::vector<LogEvent> events = tenMetres();
  ins_t jump = insAt(15.1, 500.0);
  jump.ins_status = ins_t::STATUS_NO_POSITION;
  events.push_back(eventOf(kIns, jump));
  events.push_back(eventOf(kIns, insAt(15.2, std::numeric_limits<double>::quiet_NaN())));
  events.push_back({15'300'000, kIns.name, {0, 1, 2, 3}});
  const DriveRecord drive = driveOf(events);
  CHECK(drive.distance() == Approx(10.0).margin(0.11));
  CHECK(drive.seconds() == Approx(10.0));
}

TEST_CASE("a border is crossed when the robot stays behind it, and only within the drive") {
  const DriveRecord drive = driveOf(arrivingDrive());
  SimulationTruth truth;
  truth.rows = truthOn([](double time) {
    if (time < 5.0) return "yard";                  // before the goal
    if (time > 7.0 && time < 7.3) return "tarmac";  // a short visit
    return time < 10.0 ? "grass" : "cinder";
  });
  const DriveScene scene = sceneOf(drive, truth, {});
  REQUIRE(scene.crossings.size() == 1);
  CHECK(scene.crossings[0].to == "cinder");
  CHECK(scene.crossings[0].time == Approx(5.0).margin(0.03));
  CHECK(scene.contacts.empty());
  CHECK(scene.T_map_goal.x == 10.0);
  CHECK(scene.duration == Approx(10.2));
}

TEST_CASE("contacts of the truth stand in the result and in the picture, one place each") {
  const DriveRecord drive = driveOf(arrivingDrive());
  SimulationTruth truth;
  truth.rows = {truthAt(6.0, "grass", 0), truthAt(7.0, "grass", 1), truthAt(8.0, "grass", 1),
                truthAt(9.0, "grass", 2)};
  CHECK(contains(resultLine(drive, truth), "; contacts 2"));
  const DriveScene scene = sceneOf(drive, truth, {});
  REQUIRE(scene.contacts.size() == 2);
  CHECK(scene.contacts[0].x() == Approx(2.0));
  CHECK(scene.contacts[1].x() == Approx(4.0));
  CHECK_FALSE(contains(resultLine(drive, {}), "contacts"));
}

TEST_CASE("errors by rule are told before, just after and long after a change of ground") {
  RuleErrors errors;
  errors.driven = "off";
  errors.rules = {"off", "multi_model"};
  for (int i = 0; i < 30; ++i) {
    report::ShadowedExecution execution;
    execution.began = i * kSecond;
    execution.ended = execution.began + 900'000;
    execution.measured = true;
    // Both know the old ground; off never learns the new one, multi_model does after three
    // executions.
    const bool old = i < 15;
    execution.by_rule = {{old ? 0.1 : 0.5, 0.0}, {old || i >= 18 ? 0.1 : 0.5, 0.0}};
    errors.executions.push_back(execution);
  }
  const std::string words = reportOf(errors, {15 * kSecond - 50'000});
  INFO(words);
  CHECK(contains(words,
                 "  off             0.300 m  0.00 deg    0.100 m  0.00 deg    "
                 "0.500 m  0.00 deg    0.500 m  0.00 deg\n"));
  CHECK(contains(words,
                 "  multi_model     0.140 m  0.00 deg    0.100 m  0.00 deg    "
                 "0.500 m  0.00 deg    0.100 m  0.00 deg\n"));
}

TEST_CASE("executions across a change of ground, and unfair ones, count for no rule") {
  RuleErrors errors;
  errors.rules = {"off"};
  report::ShadowedExecution across, unfair, whole;
  across.began = 1 * kSecond;
  across.ended = 3 * kSecond;
  across.measured = whole.measured = true;
  across.by_rule = {{9.0, 0.0}};
  unfair.began = whole.began = 4 * kSecond;
  unfair.ended = whole.ended = 5 * kSecond;
  whole.by_rule = {{0.25, 0.0}};
  errors.executions = {across, unfair, whole};
  const std::string words = reportOf(errors, {2 * kSecond});
  INFO(words);
  CHECK(contains(words,
                 "  off             0.250 m  0.00 deg                    -    "
                 "0.250 m  0.00 deg                    -\n"));
}

TEST_CASE("tread-report tells and draws a drive, and ends with 0 only if it arrived untouched") {
  const OwnFolder folder;
  const std::string good = writeLog(folder.path("good.lcmlog"), arrivingDrive());
  const std::string bad = writeLog(folder.path("bad.lcmlog"), tenMetres());
  const CalledProgram arrived =
      called("tread-report " + good + " --rules none --picture " + folder.path("drive.png"));
  INFO(arrived.printed);
  CHECK(arrived.status == 0);
  CHECK(arrived.printed.find("arrived after 10.2 s") == 0);
  CHECK(arrived.says("picture: " + folder.path("drive.png")));
  CHECK(isPng(folder.text("drive.png")));
  CHECK(called("tread-report " + bad + " --rules none").status == 1);
  std::vector<LogEvent> stopped = arrivingDrive();
  stopped.push_back(eventOf(kMotor, motorAt(16.0, motor_t::STATE_ESTOP)));
  const std::string estop = writeLog(folder.path("estop.lcmlog"), stopped);
  CHECK(called("tread-report " + estop + " --rules none").status == 1);
  CHECK(called("tread-report " + good).says("prediction error by rule: none, "));
  const std::string header =
      "utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m\n";
  const std::string touched =
      folder.write("truth.csv", header + "7000000,2,0,0,1,0.5,0.5,grass,1,2\n");
  const CalledProgram contact = called("tread-report " + good + " --rules none --truth " + touched);
  CHECK(contact.status == 1);
  CHECK(contact.says("contacts 1"));
}

TEST_CASE("tread-report says in one line what it cannot read or does not know") {
  const OwnFolder folder;
  const std::string log = writeLog(folder.path("good.lcmlog"), arrivingDrive());
  const std::string csv = folder.write("truth.csv", "a,b\n1,2\n");
  const std::vector<std::pair<std::string, std::string>> refused{
      {csv, "is this an LCM log?"},
      {"/no/such.lcmlog", "/no/such.lcmlog"},
      {log + " --rules none --world /no/world.yaml", "/no/world.yaml"},
      {log + " --rules none --truth " + csv, "is no record of a simulation's truth"}};
  for (const auto& [arguments, words] : refused) {
    const CalledProgram run = called("tread-report " + arguments);
    INFO(run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
    CHECK(run.printed.find("tread-report: ") == 0);
    CHECK(run.says(words));
  }
  for (const char* arguments : {"", "x.lcmlog --rules magic", "x.lcmlog --pictures a.png"}) {
    const CalledProgram run = called(std::string("tread-report ") + arguments);
    INFO(run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
  }
}

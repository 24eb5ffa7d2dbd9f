// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>

#include "tests/helpers.hpp"
#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

using tread::testing::kSecond;

}  // namespace

TEST_CASE(
    "From rest the chain begins with a pattern that begins at rest, and the next is there at "
    "once") {
  Rig rig;
  const Decision decision = rig.run(0.4);
  CHECK(decision.report.status == PlanStatus::kDriving);
  REQUIRE(!rig.supervisor().program().running().empty());
  CHECK(rig.running().entry_class == "rest");
  REQUIRE(!rig.supervisor().program().next().empty());
  CHECK(rig.next().entry_class == rig.running().exit_class);
}

TEST_CASE(
    "Whatever runs, something that stops is next or follows: the series never ends at speed") {
  Rig rig;
  bool always = true;
  for (int i = 0; i < 400; ++i) {
    rig.run(0.05);
    const ExecutionTracker& program = rig.supervisor().program();
    if (program.running().empty() || rig.running().exit_class == "rest") continue;
    const bool soon_over = program.confirmed() && program.ends() - rig.now() < 130'000;
    always = always && (!program.next().empty() || !soon_over);
  }
  CHECK(always);
  CHECK(rig.run(0.05).report.status == PlanStatus::kArrived);
}

TEST_CASE("Arrived, it stands and says so until there is another goal") {
  Rig rig;
  CHECK(rig.run(18.0).report.status == PlanStatus::kArrived);
  CHECK(rig.run(2.0).report.status == PlanStatus::kArrived);
  CHECK(std::abs(rig.speed()) < 1e-3);
  rig.inputs().goal = Goal{2, {6.0, 4.0, 0.0}, 0.5, 4.0};
  CHECK(rig.run(1.0).report.status == PlanStatus::kDriving);
}

TEST_CASE("Without a goal it is idle, a goal taken back lets it finish and stop") {
  Rig rig;
  rig.run(3.0);
  CHECK(rig.speed() > 0.9);
  rig.inputs().goal.reset();
  const Decision decision = rig.run(4.0);
  CHECK(decision.report.status == PlanStatus::kIdle);
  CHECK(std::abs(rig.speed()) < 1e-3);
  CHECK(rig.supervisor().counters().count("stopped at once") == 0);
}

TEST_CASE("It does not drive unless the bridge is armed and the operator's permission was seen") {
  Rig rig;
  rig.inputs().armed_by_operator = false;
  Decision decision = rig.run(1.0);
  CHECK(decision.report.status == PlanStatus::kWaiting);
  CHECK(decision.report.reason.words == "not armed since the planner's start");
  CHECK(rig.supervisor().program().running().empty());
  rig.inputs().armed_by_operator = true;
  rig.bridge().setArmed(false);
  decision = rig.run(1.0);
  CHECK(decision.report.status == PlanStatus::kStopped);
  CHECK(rig.supervisor().program().running().empty());
}

TEST_CASE("An INS that falls silent empties the program within 150 ms and a step") {
  Rig rig;
  rig.run(3.0);
  const int64_t last = rig.now();
  const auto silent = [&](PlannerInputs& s) { s.pose->utime = std::min(s.pose->utime, last); };
  rig.run(0.15, silent);
  CHECK(!rig.supervisor().program().running().empty());
  const Decision decision = rig.run(0.1, silent);
  CHECK(rig.supervisor().program().running().empty());
  CHECK(decision.report.status == PlanStatus::kWaiting);
  CHECK(decision.report.reason.words.find("INS is") == 0);
}

TEST_CASE("A map without new scans: the program is emptied within half a second, and says why") {
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 40.0;
  rig.run(3.0);
  rig.stopMapping();
  CHECK(rig.run(0.3).report.status == PlanStatus::kDriving);
  rig.run(0.25);
  CHECK(rig.supervisor().program().running().empty());
  const Decision decision = rig.run(3.0);
  CHECK(std::abs(rig.speed()) < 0.01);
  CHECK(decision.report.status == PlanStatus::kWaiting);
  CHECK(decision.report.reason.words.find("MAP is") == 0);
}

TEST_CASE("Without the learner it drives on for 5 s and then stops with that reason") {
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 40.0;
  const int64_t lost = rig.now() + 2 * kSecond;
  const auto tamper = [&](PlannerInputs& s) { s.set_received = std::min(s.set_received, lost); };
  CHECK(rig.run(6.5, tamper).report.status == PlanStatus::kDriving);
  CHECK(rig.speed() > 0.9);
  const Decision decision = rig.run(3.5, tamper);
  CHECK(std::abs(rig.speed()) < 0.01);
  CHECK(decision.report.reason.words.find("the learner is lost") == 0);
}

TEST_CASE("A wall that appears close ahead while driving: the running pattern is stopped in time") {
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 14.0;
  rig.run(3.5);
  REQUIRE(rig.speed() > 0.9);
  Playground ground;
  const double x = rig.pose().x + 0.65 + 0.75;
  ground.addWall({x + 0.1, -9.0}, {x + 0.1, 9.0});
  rig.paint(ground);
  const Decision decision = rig.run(0.1);
  CHECK(decision.report.status == PlanStatus::kBlocked);
  CHECK(decision.report.reason.words.find("stopped at once: something is in the way") == 0);
  CHECK(rig.supervisor().program().running().empty());
  rig.run(1.0);
  CHECK(rig.pose().x + 0.65 < x);
}

TEST_CASE("On ground on which it takes longer to stop, a wall ahead stops it earlier") {
  // Largest distance of an appearing wall at which the running plan is dropped [m].
  const auto farthest = [](double seconds) {
    double reach = 0.0;
    for (double distance = 0.5; distance < 1.5; distance += 0.1) {
      Rig rig;
      rig.inputs().goal->T_map_goal.x = 14.0;
      rig.run(3.2);
      REQUIRE(rig.speed() > 0.9);
      rig.supervisor().setStoppingTime(seconds);
      Playground ground;
      const double x = rig.pose().x + 0.65 + distance;
      ground.addWall({x + 0.1, -9.0}, {x + 0.1, 9.0});
      rig.paint(ground);
      rig.run(0.1);
      if (rig.supervisor().program().running().empty()) reach = distance;
    }
    return reach;
  };
  const double usual = farthest(0.3);
  CHECK(usual > 0.5);
  CHECK(farthest(1.2) > usual + 0.15);
}

TEST_CASE("A wall that only the next pattern would hit replaces the next, the running goes on") {
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 14.0;
  rig.run(3.5);
  const int64_t before = rig.supervisor().program().running().execution_id;
  Playground ground;
  const double x = rig.pose().x + 0.65 + 1.9;
  ground.addWall({x + 0.1, -9.0}, {x + 0.1, 9.0});
  rig.paint(ground);
  rig.run(0.1);
  CHECK(rig.supervisor().program().running().execution_id >= before);
  CHECK(!rig.supervisor().program().running().empty());
  rig.run(2.0);
  CHECK(rig.pose().x + 0.65 < x);
}

TEST_CASE("After an abort it waits until the vehicle stands, then begins again from rest") {
  Rig rig;
  rig.run(3.0);
  rig.bridge().setArmed(false);
  rig.run(0.1);
  rig.bridge().setArmed(true);
  rig.run(0.1);
  CHECK(rig.speed() > 0.1);
  CHECK(rig.supervisor().program().running().empty());
  rig.run(1.5);
  REQUIRE(!rig.supervisor().program().running().empty());
  const ExecutionTracker& program = rig.supervisor().program();
  CHECK((rig.running().entry_class == "rest" || program.running().execution_id > 5));
}

TEST_CASE("Before it comes to rest it has said why: at the goal, or what it does from there") {
  Rig rig;
  std::set<std::string> reasons;
  const auto listen = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 0.05) {
      const Decision decision = rig.run(0.05);
      const ExecutionTracker& program = rig.supervisor().program();
      if (program.running().empty() || decision.report.status != PlanStatus::kDriving) continue;
      if (rig.running().exit_class == "rest") CHECK_FALSE(decision.report.reason.empty());
      reasons.insert(decision.report.reason.words);
    }
  };
  listen(18.0);
  CHECK(reasons == std::set<std::string>{"", "stopping at the goal"});
  rig.inputs().goal = Goal{2, {-6.0, 0.0, 0.0}, 0.5, 4.0};
  listen(1.0);
  CHECK(reasons.count("stopping to turn on the spot") == 1);
}

TEST_CASE("A pattern that the bridge ends early is told with the bridge's reason") {
  Rig rig;
  rig.run(3.0);
  rig.bridge().setArmed(false);
  // Without the message of disarming only the aborted execution shows it.
  const Decision decision =
      rig.run(0.1, [](PlannerInputs& s) { s.bridge->state = BridgeState::kArmed; });
  CHECK(decision.report.status == PlanStatus::kWaiting);
  CHECK(decision.report.reason.words.find("stopped by motor_bridge: ") == 0);
}

TEST_CASE("Boxed in it says that it is blocked, and drives when it is let out") {
  Playground ground;
  ground.addWall({-1.0, -0.7}, {1.0, -0.7}, 0.1);
  ground.addWall({-1.0, 0.7}, {1.0, 0.7}, 0.1);
  ground.addWall({-1.0, -0.7}, {-1.0, 0.7}, 0.1);
  Playground closed = ground;
  closed.addWall({1.0, -0.7}, {1.0, 0.7}, 0.1);
  Rig rig(closed);
  Decision decision = rig.run(3.0);
  CHECK((decision.report.status == PlanStatus::kUnreachable ||
         decision.report.status == PlanStatus::kBlocked));
  CHECK(!decision.report.reason.empty());
  CHECK(std::abs(rig.pose().x) < 0.01);
  rig.paint(ground);
  decision = rig.run(3.0);
  CHECK(decision.report.status == PlanStatus::kDriving);
}

TEST_CASE("Where no plan is found the vehicle tries to get out before it calls itself blocked") {
  // In front of it a passage that half the vehicle's width fits through, but not the vehicle.
  Playground ground;
  ground.addWall({1.6, -9.0}, {1.6, -0.40}, 0.2);
  ground.addWall({1.6, 0.40}, {1.6, 9.0}, 0.2);
  ground.addWall({-1.5, -9.0}, {-1.5, 9.0});
  for (double x = 2.0; x < 4.0; x += 0.1) ground.addWall({x, 0.36}, {x, 9.0}, 0.1);
  Rig rig(ground);
  rig.run(30.0);
  CHECK(rig.supervisor().counters().count("recovery moves") == 1);
}

TEST_CASE("Plans are reported with the ids under which they were handed over") {
  Rig rig;
  rig.run(2.0);
  Decision decision;
  while (!decision.planned) decision = rig.run(0.05);
  const ExecutionTracker& program = rig.supervisor().program();
  REQUIRE(decision.report.steps.size() >= 3);
  REQUIRE(decision.report.execution_ids.size() == decision.report.steps.size());
  CHECK(decision.report.execution_ids[0] == program.running().execution_id);
  CHECK(decision.report.execution_ids[1] == program.next().execution_id);
  CHECK(decision.report.execution_ids[2] == 0);
  CHECK(decision.report.set_version == 1);
  CHECK(decision.report.time_to_go > 5.0);
  CHECK(decision.report.time_to_go < 20.0);
}

TEST_CASE("A vehicle that is pushed off its way is planned for anew at once, from where it is") {
  const double push = GENERATE(0.0, 0.02, 0.4);
  Rig rig;
  rig.run(4.0);
  // To the middle of a pattern, just after a plan.
  const ExecutionTracker& program = rig.supervisor().program();
  const auto due = [&] { return program.ends() - rig.now(); };
  while (due() < 300'000 || due() > 700'000) rig.run(0.05);
  while (!rig.run(0.05).planned) continue;
  const auto pushed = [&](PlannerInputs& seen) { seen.pose->T_map_body.y += push; };
  const double before = rig.run(0.05).report.steps.front().T_map_end.y;
  const Decision decision = rig.run(0.05, pushed);
  CAPTURE(push);
  CHECK(rig.supervisor().counters().count("left the predicted corridor") == (push > 0.1 ? 1 : 0));
  if (push < 0.1) return;
  CHECK(decision.planned);
  CHECK(decision.report.steps.front().T_map_end.y == Approx(before + push).margin(0.1));
}

TEST_CASE(
    "While a person drives it hands over nothing, and shows what it would do from where the "
    "robot is") {
  Rig rig;
  const auto by_hand = [](PlannerInputs& s) {
    s.bridge->state = BridgeState::kManual;
    s.bridge->reason = {StopReason::kByHand, "driven by hand by ada"};
    s.bridge->execution_id = 0;
  };
  rig.run(2.0);
  REQUIRE(rig.speed() > 0.5);
  const int64_t before = rig.supervisor().program().running().execution_id;
  for (int i = 0; i < 60; ++i) {
    const Decision decision = rig.run(0.05, by_hand);
    REQUIRE(rig.supervisor().program().running().empty());
    REQUIRE(rig.supervisor().program().next().empty());
    REQUIRE(decision.halted.empty());
    if (i == 0) continue;
    REQUIRE(decision.report.status == PlanStatus::kWaiting);
    REQUIRE(decision.report.reason.words == "driven by hand by ada");
    REQUIRE(decision.report.goal_id == 1);
    REQUIRE(!decision.report.steps.empty());
    REQUIRE(std::isfinite(decision.report.time_to_go));
    for (const int64_t id : decision.report.execution_ids) REQUIRE(id == 0);
  }
  // While moving, the next pattern continues instead of beginning at rest.
  const Decision shown = rig.run(0.3, [&](PlannerInputs& seen) {
    by_hand(seen);
    seen.pose->twist = Twist2{1.0, 0.0, 0.0};
  });
  REQUIRE(!shown.report.steps.empty());
  const PatternSet set = samplePatterns();
  const MotionPattern* first = set.find(shown.report.steps.front().pattern_id);
  REQUIRE(first != nullptr);
  CHECK(first->entry_class != "rest");
  // After giving back it drives on to the goal by itself.
  rig.run(2.0);
  CHECK(rig.speed() > 0.5);
  CHECK(rig.supervisor().program().running().execution_id > before);
  CHECK(rig.run(20.0).report.status == PlanStatus::kArrived);
}

TEST_CASE("What a person drives over without INS or map does not end the goal") {
  Rig rig;
  rig.run(2.0);
  const auto blind = [](PlannerInputs& s) {
    s.bridge->state = BridgeState::kManual;
    s.bridge->reason = {StopReason::kByHand, "driven by hand by ada"};
    s.pose->utime -= 2'000'000;
  };
  for (int i = 0; i < 20; ++i) {
    const Decision decision = rig.run(0.05, blind);
    REQUIRE(decision.halted.empty());
    REQUIRE(decision.report.steps.empty());
  }
  CHECK(rig.run(20.0).report.status == PlanStatus::kArrived);
}

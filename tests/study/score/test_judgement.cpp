// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/study/score/sample_records.hpp"

using namespace tread::blindtest;
using namespace tread::blindtest::samples;

TEST_CASE("the truth alone is exactly right, with another name it is found but not exact") {
  const Judgement right = judge(answered(hidden({"slip_ratio"}, "single"), {"slip_ratio"}));
  CHECK(right.exact);
  CHECK(right.first_right);
  const Judgement more =
      judge(answered(hidden({"slip_ratio"}, "single"), {"gyro_bias", "slip_ratio"}));
  CHECK(more.found == 1);
  CHECK_FALSE(more.exact);
  CHECK_FALSE(more.first_right);
  CHECK_FALSE(more.only_wrong);
}

TEST_CASE("naming one that no drive can tell from the truth counts as naming the truth") {
  CaseRecord record = answered(hidden({"icr_offset"}, "single"), {"lever_arm_x"});
  CHECK(judge(record).only_wrong);
  record.truth.effects.front().group = {"lever_arm_x"};
  CHECK(judge(record).exact);
  CHECK(judge(record).first_right);
}

TEST_CASE("saying that a wrong name may be the truth lists the truth and does not name it") {
  CaseRecord record = answered(hidden({"body_inertia"}, "single"), {"actuator_lag"});
  record.answer.effects.front().group = {"body_inertia"};
  CHECK(judge(record).listed);
  CHECK(judge(record).found == 0);
}

TEST_CASE("effects that are the truth together count where all of them are named") {
  CaseRecord record = answered(hidden({"position_scale"}, "single"), {"slip_ratio"});
  record.truth.effects.front().together = {{"slip_ratio", "track_width"}};
  CHECK(judge(record).only_wrong);
  record.answer.effects.push_back({"track_width", {}, {}, {}});
  CHECK(judge(record).exact);
  record.answer.effects.push_back({"gyro_bias", {}, {}, {}});
  CHECK(judge(record).found == 1);
  CHECK_FALSE(judge(record).exact);
}

TEST_CASE("an effect that only the gyro sees is excited") {
  CaseRecord record = hidden({"gyro_bias"}, "single");
  record.truth.gap = {{0.0, 0.0}, {}, 0.02};
  CHECK(judge(record).excited);
  record.truth.gap.yaw_rate = 0.0001;
  CHECK_FALSE(judge(record).excited);
}

TEST_CASE("a wrong name is only wrong, a runner-up is listed, silence names nothing") {
  CaseRecord record = answered(hidden({"battery_sag"}, "single"), {"thermal_derating"});
  CHECK(judge(record).only_wrong);
  CHECK_FALSE(judge(record).listed);
  record.answer.effects.front().runner_ups = {"battery_sag"};
  CHECK(judge(record).listed);
  CHECK(judge(hidden({"battery_sag"}, "single")).nothing);
}

TEST_CASE("a term of the nominal model that moves beyond three sigma counts, apart") {
  CaseRecord record = hidden({"yaw_inertia"}, "single");
  record.answer.calibrated = {{"yaw_inertia.lag", 0.30, 0.26, 0.34, 0.10, 0.01}};
  CHECK(judge(record).found == 1);
  CHECK(judge(record).moved == 1);
  record.answer.calibrated.front().value = 0.13;
  CHECK(judge(record).found == 0);
}

TEST_CASE("whether a term has moved is what the workflow says of it, where it says so") {
  CaseRecord record = hidden({"heading_latency"}, "semi");
  record.truth.effects.front().group = {"centrifugal_drift"};
  record.answer.calibrated = {{"centrifugal_drift.time", 0.30, 0.26, 0.34, 0.10, 0.01, false}};
  CHECK(judge(record).found == 0);
  record.answer.calibrated.front().moved = true;
  CHECK(judge(record).moved == 1);
  CHECK(judge(record).first_right);
}

TEST_CASE("a model's own term that is wrongly called another one is a wrong name") {
  CaseRecord record = hidden({}, "null");
  CHECK_FALSE(judge(record).alarm);
  record.answer.verdict = "NOT_IN_CATALOGUE";
  CHECK_FALSE(judge(record).alarm);
  record.answer.verdict = "FOUND";
  CHECK(judge(record).alarm);
  CaseRecord single = hidden({"gyro_bias"}, "single");
  single.answer.verdict = "FOUND";
  CHECK(judge(single).only_wrong);
}

TEST_CASE("the closed share of the gap is measured from the nominal model down to the truth") {
  CaseRecord record = answered(hidden({"slip_ratio"}, "single"), {"slip_ratio"});
  record.answer.after = {{0.1, 0.1}, {}};
  CHECK(judge(record).closed == Approx(1.0));
  record.answer.after = record.answer.before;
  CHECK(judge(record).closed == Approx(0.0));
  record.answer.before = {{0.1, 0.1}, {}};
  CHECK_FALSE(judge(record).closed == Approx(0.0));  // no gap, no share
}

TEST_CASE("parameters are compared with what the truth changes of the nominal model") {
  CaseRecord record = answered(hidden({"command_delay"}, "single"), {"command_delay"});
  record.truth.effects.front().numbers = {{"T_d", 0.15}};
  record.answer.effects.front().parameters = {{"command_delay.delay", 0.18, 0.15, 0.21, 0.0}};
  const Judgement judgement = judge(record);
  REQUIRE(judgement.parameters.size() == 1);
  CHECK(judgement.parameters.front().relative == Approx(0.2));
  CHECK(judgement.parameters.front().inside);
}

TEST_CASE("a limit is compared under the name that people give it") {
  CaseRecord record = answered(hidden({"grip_limit"}, "single"), {"grip_limit"});
  record.truth.effects.front().numbers = {{"a_lat", 1.961}};
  record.answer.effects.front().parameters = {{"grip_limit.inverse_limit", 5.0, 4.0, 6.0, 0.0},
                                              {"grip_limit.friction", 0.22, 0.21, 0.23}};
  const Judgement judgement = judge(record);
  REQUIRE(judgement.parameters.size() == 1);
  CHECK(judgement.parameters.front().relative == Approx(0.1).margin(0.002));
  CHECK_FALSE(judgement.parameters.front().inside);
}

TEST_CASE(
    "out of the catalogue, the right variable must be said with PARTIAL or NOT_IN_CATALOGUE") {
  CaseRecord record = hidden({"stribeck_friction"}, "out_of_catalogue");
  record.truth.effects.front().depends_on = {"speed"};
  record.answer.unexplained = {{"along", "v |v|"}};
  CHECK_FALSE(judge(record).right_variable);
  record.answer.verdict = "NOT_IN_CATALOGUE";
  CHECK(judge(record).right_variable);
  record.answer.unexplained = {{"yaw rate", "pitch"}};
  CHECK_FALSE(judge(record).right_variable);
}

TEST_CASE("a command of now and one of before are told apart as variables") {
  CaseRecord record = hidden({"inner_track_stall"}, "out_of_catalogue");
  record.answer.verdict = "NOT_IN_CATALOGUE";
  const auto isRight = [&record](const char* truth, const char* said) {
    record.truth.effects.front().depends_on = {truth};
    record.answer.unexplained = {{"yaw rate", said}};
    return judge(record).right_variable;
  };
  CHECK(isRight("command", "command of the inner track"));
  CHECK(isRight("previous_command", "forward command before"));
  CHECK(isRight("time_since_command", "time since the command"));
  CHECK_FALSE(isRight("command", "forward command before"));
  CHECK_FALSE(isRight("command", "time since the command"));
  CHECK_FALSE(isRight("voltage", "turning command"));
}

TEST_CASE("a degenerate case is right where its alternatives are named together") {
  CaseRecord record = answered(hidden({"lever_arm_x"}, "degenerate"), {"icr_offset"});
  record.truth.right_names = {"icr_offset", "lever_arm_x"};
  CHECK_FALSE(judge(record).grouped);
  record.answer.effects.front().group = {"lever_arm_x"};
  CHECK(judge(record).grouped);
  record.answer.effects.front().group.clear();
  record.answer.verdict = "AMBIGUOUS";
  CHECK(judge(record).grouped);
}

TEST_CASE("a bad log is refused by CANNOT_TELL or an error, with a reason") {
  CaseRecord record = hidden({}, "bad");
  record.answer.verdict = "error";
  CHECK_FALSE(judge(record).refused);
  record.answer.reason = "0001.lcm: no message on MOTOR";
  CHECK(judge(record).refused);
  record.answer.verdict = "FOUND";
  CHECK_FALSE(judge(record).refused);
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

ModelDocument tracked() {
  ModelDocument model;
  model.vehicle.name = "tracked";
  model.vehicle.full_speed = 1.0;
  model.vehicle.gauge = 0.8;
  return model;
}

UnnamedTerm yawTerm(const std::string& condition, const std::string& times = "") {
  UnnamedTerm term;
  term.name = "unnamed_1";
  term.condition = findTermCondition(condition);
  term.times = findTermCondition(times);
  term.times_low = -1.0;
  term.times_high = 1.0;
  term.at = {-0.4, 0.0, 0.4};
  term.values = {-0.1, 0.0, 0.2};
  return term;
}

/// Steady yaw rate for a command.
double yawRate(const ModelDocument& model, const TrackCommand& command) {
  return steadyTwist(model.vehicle, command).omega;
}

}  // namespace

TEST_CASE("the kernel adds an unnamed term to its channel, by its condition") {
  ModelDocument with = tracked();
  with.vehicle.unnamed = {yawTerm("v")};
  CHECK(yawRate(with, {0.2, 0.2}) == Approx(0.1));
  CHECK(yawRate(with, {-0.2, -0.2}) == Approx(-0.05));
  with.vehicle.unnamed[0].channel = TermChannel::kSpeed;
  CHECK(steadyTwist(with.vehicle, {0.2, 0.2}).v_x == Approx(0.3));
  with.vehicle.unnamed[0].channel = TermChannel::kSideways;
  CHECK(steadyTwist(with.vehicle, {0.2, 0.2}).v_y == Approx(0.1));
}

TEST_CASE("a simulated motion has the term in it, as the twist says") {
  ModelDocument with = tracked();
  with.vehicle.unnamed = {yawTerm("v")};
  VehicleKernel kernel(with.vehicle, steadyEntry(with.vehicle, {0.2, 0.2}));
  kernel.step({0.2, 0.2}, 2.0);
  CHECK(kernel.pose().yaw == Approx(0.2));
  CHECK(kernel.twist().omega == Approx(0.1));
}

TEST_CASE("beyond what was driven a term stays as it is at the end, the factor too") {
  ModelDocument with = tracked();
  with.vehicle.unnamed = {yawTerm("v")};
  CHECK(yawRate(with, {0.4, 0.4}) == Approx(0.2));
  CHECK(yawRate(with, {1.0, 1.0}) == Approx(0.2));
  with.vehicle.unnamed = {yawTerm("v", "forward command")};
  with.vehicle.unnamed[0].times_high = 0.5;
  CHECK(yawRate(with, {0.4, 0.4}) == Approx(0.4 * 0.2));
  CHECK(yawRate(with, {1.0, 1.0}) == Approx(0.5 * 0.2));
}

TEST_CASE("what stands stays where it is, whatever its terms say") {
  ModelDocument with = tracked();
  with.vehicle.unnamed = {yawTerm("v")};
  with.vehicle.unnamed[0].values = {0.3, 0.3, 0.3};
  VehicleKernel kernel(with.vehicle, EntryState{});
  kernel.step({0.0, 0.0}, 5.0);
  CHECK(kernel.pose().yaw == 0.0);
}

TEST_CASE("a term of a change acts while the motion changes, and not in steady motion") {
  ModelDocument with = tracked();
  with.vehicle.lag = 0.2;
  with.vehicle.unnamed = {yawTerm("change of |yaw rate|", "sign of yaw rate")};
  const TrackCommand spin{-0.4, 0.4};
  CHECK(yawRate(with, spin) == Approx(1.0));
  const auto turned = [&](const ModelDocument& model, const TrackCommand& from,
                          const TrackCommand& to) {
    VehicleKernel kernel(model.vehicle, steadyEntry(model.vehicle, from));
    kernel.step(to, 3.0);
    return kernel.pose().yaw;
  };
  ModelDocument plain = tracked();
  plain.vehicle.lag = 0.2;
  // It speeds up winding, and brakes a spin.
  CHECK(turned(with, {}, spin) > turned(plain, {}, spin) + 0.02);
  CHECK(turned(with, spin, {}) < turned(plain, spin, {}) - 0.01);
}

TEST_CASE("another kernel goes on from a state with what the terms remember") {
  ModelDocument with = tracked();
  with.vehicle.lag = 0.2;
  with.vehicle.unnamed = {yawTerm("turns before"), yawTerm("change of yaw rate")};
  VehicleKernel whole(with.vehicle, EntryState{});
  whole.step({-0.3, 0.4}, 0.5);
  VehicleKernel later(with.vehicle, whole.state());
  CHECK(later.twist().omega == whole.twist().omega);
  const Pose2 before = whole.pose();
  whole.step({0.3, 0.1}, 0.5);
  later.step({0.3, 0.1}, 0.5);
  CHECK(later.pose().yaw == Approx(whole.pose().yaw - before.yaw).margin(1e-12));
}

TEST_CASE("a term of values 0 changes nothing, and a model without terms not a bit") {
  ModelDocument with = tracked();
  with.vehicle.effects.yaw_inertia = 0.1;
  const ModelDocument without = with;
  with.vehicle.unnamed = {yawTerm("v")};
  with.vehicle.unnamed[0].values = {0.0, 0.0, 0.0};
  VehicleKernel one(with.vehicle, EntryState{});
  VehicleKernel other(without.vehicle, EntryState{});
  one.step({0.1, 0.4}, 1.0);
  other.step({0.1, 0.4}, 1.0);
  CHECK(one.pose().x == other.pose().x);
  CHECK(one.pose().yaw == other.pose().yaw);
  CHECK(formatModelDocument(without).find("unnamed") == std::string::npos);
}

namespace {

ModelDocument withTwoTerms() {
  ModelDocument model = tracked();
  model.vehicle.unnamed = {yawTerm("change of |yaw rate|", "sign of yaw rate"), yawTerm("v")};
  model.vehicle.unnamed[1].name = "unnamed_2";
  model.vehicle.unnamed[1].channel = TermChannel::kSideways;
  model.covariance = {{"unnamed_1.0", "unnamed_1.2"}, {{0.01, 0.001}, {0.001, 0.02}}};
  return model;
}

std::string termRefusal(const std::string& from, const std::string& to) {
  std::string text = formatModelDocument(withTwoTerms());
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  try {
    parseModelDocument(text, "model.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("unnamed terms are in the model file and come back bit for bit") {
  const ModelDocument model = withTwoTerms();
  const ModelDocument read = parseModelDocument(formatModelDocument(model), "model.yaml");
  REQUIRE(read.vehicle.unnamed.size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    const UnnamedTerm& a = model.vehicle.unnamed[i];
    const UnnamedTerm& b = read.vehicle.unnamed[i];
    CHECK(a.name == b.name);
    CHECK(a.channel == b.channel);
    CHECK(a.condition == b.condition);
    CHECK(a.times == b.times);
    CHECK(a.at == b.at);
    CHECK(a.values == b.values);
  }
  CHECK(read.vehicle.unnamed[0].times_low == -1.0);
  CHECK(read.covariance.parameters == model.covariance.parameters);
  CHECK(formatModelDocument(read) == formatModelDocument(model));
}

TEST_CASE("a bad unnamed term is refused in one line that says what is allowed") {
  using Catch::Contains;
  CHECK_THAT(termRefusal("condition: v", "condition: moon phase"), Contains("model.yaml:"));
  CHECK_THAT(termRefusal("condition: v", "condition: pitch"), Contains("turns before"));
  CHECK_THAT(termRefusal("channel: v_y", "channel: v_z"), Contains("v_y"));
  CHECK_THAT(termRefusal("[-0.4, 0, 0.4]", "[-0.4, 0.4, 0]"), Contains("ascending"));
  CHECK_THAT(termRefusal("[-0.4, 0, 0.4]", "[0.4]"), Contains("2 to 6"));
  CHECK_THAT(termRefusal("[-0.1, 0, 0.2]", "[-0.1, 0]"), Contains("one for each"));
  CHECK_THAT(termRefusal("[-0.1, 0, 0.2]", "[-0.1, 0, .nan]"), Contains("values"));
  CHECK_THAT(termRefusal("[-1, 1]", "[1, -1]"), Contains("times_range"));
  CHECK_THAT(termRefusal("name: unnamed_1", "name: yaw_pull"), Contains("something else"));
  CHECK_THAT(termRefusal("name: unnamed_2", "name: unnamed_1"), Contains("already"));
  CHECK_THAT(termRefusal("name: unnamed_2", "name: Hysteresis!"), Contains("a letter first"));
  CHECK_THAT(termRefusal("unnamed_1.2]", "unnamed_1.3]"), Contains("no parameter"));
}

TEST_CASE("a term that a person names keeps its covariance, and no name is given twice") {
  ModelDocument model = withTwoTerms();
  renameTerm(model, "unnamed_1", "steering_hysteresis");
  CHECK(model.vehicle.unnamed[0].name == "steering_hysteresis");
  CHECK(model.covariance.parameters ==
        std::vector<std::string>{"steering_hysteresis.0", "steering_hysteresis.2"});
  CHECK(*findParameter(model, "steering_hysteresis.2") == 0.2);
  CHECK(parseModelDocument(formatModelDocument(model), "m").vehicle.unnamed[0].name ==
        "steering_hysteresis");
  using Catch::Contains;
  CHECK_THROWS_WITH(renameTerm(model, "unnamed_1", "other"),
                    Contains("it has steering_hysteresis"));
  CHECK_THROWS_WITH(renameTerm(model, "unnamed_2", "steering_hysteresis"), Contains("already"));
  CHECK_THROWS_WITH(renameTerm(model, "unnamed_2", "yaw_pull"), Contains("something else"));
}

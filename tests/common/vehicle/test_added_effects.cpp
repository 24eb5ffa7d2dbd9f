// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects from files. A separate program, as they are added to the global catalogue.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/added_effects.hpp"
#include "common/vehicle/kept_term.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

/// The file of an effect with one parameter.
std::string fileOf(const std::string& name, const std::string& changes, const std::string& to,
                   const std::string& parameter) {
  return "name: " + name + "\ntitle: T\nsentence: S\nchannels: xw\nchanges: " + changes +
         "\nto: '" + to + "'\nparameters:\n  - " + parameter +
         "\nlooks_like: L\nseparates: S\ncheck: C\n";
}

std::string gain(const std::string& name, const std::string& more = "") {
  return "{name: " + name + ", unit: '1', min: -0.5, max: 0.5, typical: 0.1" + more + "}";
}

void add(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "effect.yaml");
  EffectEntry entry = readEffectEntry(reader);
  reader.finish();
  addEntry(std::move(entry), reader);
}

std::string problemWith(const std::string& text) {
  try {
    add(text);
  } catch (const ConfigError& problem) {
    return problem.what();
  }
  return "";
}

ModelDocument tracked() {
  ModelDocument model;
  model.vehicle.name = "tracked";
  model.vehicle.full_speed = 1.2;
  model.vehicle.gauge = 0.8;
  model.vehicle.lag = 0.2;
  model.vehicle.delay = 0.07;
  model.vehicle.yaw_gain = 0.7;
  return model;
}

/// A drive with turns in both directions, forwards, backwards and on the spot.
std::vector<TrackCommand> drive() {
  std::vector<TrackCommand> commands;
  for (const TrackCommand& command :
       {TrackCommand{0.9, 0.5}, {0.2, 0.8}, {-0.7, 0.7}, {0.0, 0.0}, {-0.9, -0.4}, {1.0, 1.0}})
    commands.insert(commands.end(), 20, command);
  return commands;
}

/// Largest difference between two models in that drive [m and rad].
double apart(const ModelDocument& one, const ModelDocument& other) {
  const auto a = simulate(one.vehicle, drive(), 0.05, steadyEntry(one.vehicle, {0.3, 0.6}));
  const auto b = simulate(other.vehicle, drive(), 0.05, steadyEntry(other.vehicle, {0.3, 0.6}));
  double most = 0.0;
  for (size_t i = 0; i < a.size(); ++i)
    most = std::max({most, std::abs(a[i].x - b[i].x), std::abs(a[i].y - b[i].y),
                     std::abs(a[i].yaw - b[i].yaw)});
  return most;
}

ModelDocument with(const std::string& path, double value) {
  ModelDocument model = tracked();
  *findParameter(model, path) = value;
  return model;
}

}  // namespace

TEST_CASE("an effect of a file does what the same one of the catalogue does") {
  struct Twin {
    const char* builtin;
    const char* changes;
    const char* to;
    const char* parameter;
    double value;
  };
  for (const Twin& twin :
       {Twin{"quadratic_drag.drag", "v", "v - p * v * abs(v)", "", 0.2},
        {"reverse_speed_gain.gain", "v", "v + p * abs(v)", "", 0.1},
        {"speed_understeer.gain", "yaw_rate", "lessened(yaw_rate, p * v * v)", "", 0.3},
        {"yaw_pull.pull", "yaw_rate", "yaw_rate + p * v", "", 0.1},
        {"icr_offset.offset", "v_y", "v_y - p * yaw_rate", "", 0.2},
        {"centrifugal_drift.time", "v_y", "v_y - p * v * yaw_rate", "", 0.2},
        {"track_asymmetry.asymmetry", "track", "speed * (1 + side * p)", "", 0.1},
        {"speed_saturation.inverse_limit", "track", "limited(speed, abs(p), 0)", "", 1.5},
        {"motor_deadband.width", "track", "dead_zone(speed, abs(p))", "", 0.15}}) {
    const std::string path = twin.builtin;
    INFO(path);
    const std::string name = "twin_of_" + path.substr(0, path.find('.'));
    add(fileOf(name, twin.changes, twin.to, "{name: p, unit: '1', min: -2, max: 2, typical: 1.9}"));
    const std::string parameter = effectNamed(effectOfPath(path)).parameters.front().name;
    const ModelDocument builtin = with(effectOfPath(path) + "." + parameter, twin.value);
    const ModelDocument added = with(name + ".p", twin.value);
    CHECK(apart(builtin, added) < 1e-12);
    CHECK(apart(tracked(), added) > 0.01);
    CHECK(apart(tracked(), with(name + ".p", 0.0)) == 0.0);
  }
}

TEST_CASE("a model with an effect of a file is read where that file is not") {
  add(fileOf("of_a_file", "v", "v + p * abs(yaw_rate)", gain("p", ", positive: more")));
  const ModelDocument model = with("of_a_file.p", 0.25);
  const std::string text = formatModelDocument(model);
  CHECK(text.find("catalogue:") != std::string::npos);
  CHECK(formatModelDocument(parseModelDocument(text, "model.yaml")) == text);
  CHECK(formatModelDocument(tracked()).find("catalogue:") == std::string::npos);
  // The same model for a vehicle with an effect unknown to this program.
  std::string elsewhere = text;
  for (size_t at = 0; (at = elsewhere.find("of_a_file", at)) != std::string::npos;)
    elsewhere.replace(at, 9, "unheard_of");
  CHECK(findEffect("unheard_of") == nullptr);
  const ModelDocument read = parseModelDocument(elsewhere, "model.yaml");
  CHECK(*findParameter(read, "unheard_of.p") == 0.25);
  CHECK(apart(read, model) < 1e-12);
  // Another law under a known name would change the model's motion.
  std::string other = text;
  other.replace(other.find("p * abs(yaw_rate)"), 17, "p * abs(v)");
  CHECK_THROWS_WITH(parseModelDocument(other, "model.yaml"),
                    Catch::Contains("'of_a_file' is in the catalogue already"));
}

TEST_CASE("the text of an effect reads back as the same effect") {
  const std::filesystem::path folder = std::filesystem::path(TREAD_SOURCE_DIR) / "config/effects";
  size_t read = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    INFO(file.path());
    const EffectEntry entry = readEffectFile(file.path().string());
    const std::string text = formatEffect(entry);
    ConfigReader reader = ConfigReader::fromText(text, "again.yaml");
    CHECK(formatEffect(readEffectEntry(reader)) == text);
    ++read;
  }
  CHECK(read == 3);
  addEffectsOf(folder.string());
  const size_t all = effectCatalogue().size();
  addEffectsOf(folder.string());  // adding it twice has no further effect
  CHECK(effectCatalogue().size() == all);
  CHECK(confoundedEffects("centre_to_side", {}) == std::vector<std::string>{"lever_arm_y"});
  CHECK(confoundedEffects("lever_arm_y", {}) == std::vector<std::string>{"centre_to_side"});
}

TEST_CASE("what is no effect is refused in one line that says what to do") {
  const std::string p = gain("p");
  const auto refused = [](const std::string& text, const std::string& why) {
    const std::string problem = problemWith(text);
    INFO(text << problem);
    CHECK(problem.find(why) != std::string::npos);
    CHECK(problem.find("effect.yaml:") == 0);
    CHECK(problem.find('\n') == std::string::npos);
  };
  refused(fileOf("e", "v", "v + p * (yaw_rate", p), "is no formula");
  refused(fileOf("e", "v", "v + p * yawrate", p), "'yawrate' is unknown; it may name v, yaw_rate");
  refused(fileOf("e", "track", "speed + p * v", p), "'v' is unknown; it may name speed, other");
  refused(fileOf("e", "v", "v = p", p), "it assigns");
  refused(fileOf("e", "v", "v, p", p), "has several values");
  refused(fileOf("e", "v", "v + p / yaw_rate", p), "has no finite value where v 0, yaw_rate 0");
  refused(fileOf("e", "v", "v + p * log(v)", p), "has no finite value");
  refused(fileOf("e", "v", "v + 0.1 + p", p), "changes v while all strengths are 0");
  refused(fileOf("e", "v", "v + 0 * p", p), "does nothing with p 0.1");
  refused(fileOf("e", "v", std::string(1200, '1'), p), "longer than");
  refused(fileOf("e", "heading", "v + p", p), "changes");
  refused(fileOf("e", "v", "v + p", "{name: p, unit: m, max: 1, typical: 0.1}"), "min");
  refused(fileOf("e", "v", "v + p", "{name: p, unit: m, min: 2, max: 1, typical: 0.1}"), "max");
  refused(fileOf("e", "v", "v + p", "{name: p, unit: m, min: 1, max: 2, typical: 1}"), "off at 0");
  refused(fileOf("e", "v", "v + p", "{name: p, unit: m, min: -.inf, max: 2, typical: 1}"), "min");
  refused(fileOf("e", "v", "v + p", "{name: p, unit: m, min: 0, max: 2, typical: .nan}"),
          "typical");
  refused(fileOf("e", "v", "v + v", gain("v")), "'v' names something else already");
  refused(fileOf("e", "v", "v + p", p + "\nmore: 1"), "more");
  refused(fileOf("E", "v", "v + p", p), "is no name");
  refused(fileOf("crab", "v", "v + p", p), "'crab' is in the catalogue already");
  refused(fileOf("lag", "v", "v + p", p), "names something else already");
  refused(fileOf("e", "v", "v + p", p) +
              "confused_with:\n  - {effects: [crap], because: B, "
              "separates: S}\n",
          "'crap' is no effect");
  CHECK(findEffect("e") == nullptr);
  CHECK_THROWS_WITH(addEffectsOf("/nowhere"), Catch::Contains("/nowhere: is no folder"));
}

TEST_CASE("what is no number in a drive changes nothing, and nothing changes without bound") {
  add(fileOf("odd", "v", "v + p * (v > 3 ? sqrt(-v) : 1e9 * max(0, v - 1.9))", gain("p")));
  ModelDocument fast = with("odd.p", 0.5);
  fast.vehicle.full_speed = 4.0;
  CHECK(steadyTwist(fast.vehicle, {1.0, 1.0}).v_x == 4.0);
  CHECK(steadyTwist(fast.vehicle, {0.7, 0.7}).v_x == Approx(2.8 + kLargestTermValue));
}

TEST_CASE("simulations have formulas of their own: copies and threads do not disturb each other") {
  add(fileOf("threaded", "yaw_rate", "yaw_rate + p * v * turns_before", gain("p")));
  const ModelDocument model = with("threaded.p", 0.4);
  const auto run = [&model] {
    return simulate(model.vehicle, drive(), 0.05, steadyEntry(model.vehicle, {0.3, 0.6})).back();
  };
  const Pose2 alone = run();
  std::vector<Pose2> ends(8);
  std::vector<std::thread> threads;
  for (Pose2& end : ends)
    threads.emplace_back([&end, &run] {
      for (int i = 0; i < 20; ++i) end = run();
    });
  for (std::thread& thread : threads) thread.join();
  for (const Pose2& end : ends) CHECK(end.yaw == alone.yaw);
  VehicleKernel kernel(model.vehicle, steadyEntry(model.vehicle, {0.3, 0.6}));
  VehicleKernel copy = kernel;
  copy.step({0.9, -0.9}, 1.0);
  VehicleKernel fresh(model.vehicle, steadyEntry(model.vehicle, {0.3, 0.6}));
  kernel.step({0.2, 0.8}, 1.0);
  fresh.step({0.2, 0.8}, 1.0);
  CHECK(kernel.pose().yaw == fresh.pose().yaw);
}

TEST_CASE("ranges of distances are of the robot's size") {
  addEffectsOf(std::string(TREAD_SOURCE_DIR) + "/config/effects");
  ModelDocument model = tracked();
  CHECK(plausibleBounds(model, "centre_to_side.offset")->max == Approx(0.4));
  model.vehicle.gauge = 0.42;
  CHECK(plausibleBounds(model, "centre_to_side.offset")->min == Approx(-0.21));
}

TEST_CASE("conditions of unnamed terms are the same in formulas") {
  TermInputs inputs;
  double value = -0.9;
  for (const TermInput& input : kTermInputs) inputs.*input.value = (value += 0.21);
  for (const TermCondition& condition : termConditions()) {
    INFO(condition.name);
    std::vector<std::string> names;
    for (const TermInput& input : kTermInputs) names.emplace_back(input.name);
    const FormulaUse formula(std::make_shared<const Formula>(condition.formula, names));
    for (size_t i = 0; i < names.size(); ++i) formula.input(i) = inputs.*kTermInputs[i].value;
    CHECK(formula.value() == Approx(condition.value(inputs)));
  }
}

TEST_CASE("an unnamed term is kept as an effect that does the same") {
  UnnamedTerm term;
  term.name = "unnamed_1";
  term.condition = findTermCondition("turns before");
  term.times = findTermCondition("|v|");
  term.times_low = 0.1;
  term.times_high = 0.6;
  term.at = {-0.5, 0.0, 0.3, 0.9};
  term.values = {-0.3, 0.0, 0.1, 0.4};
  ModelDocument model = tracked();
  model.vehicle.unnamed = {term};
  model.covariance = {{"lag", "unnamed_1.0", "unnamed_1.3"},
                      {{0.01, 0.0, 0.0}, {0.0, 0.0009, 0.0}, {0.0, 0.0, 0.0016}}};
  add(formatEffect(effectOf(term, "steering_hysteresis")));
  ModelDocument kept = model;
  replaceTerm(kept, "unnamed_1", effectNamed("steering_hysteresis"));
  CHECK(kept.vehicle.unnamed.empty());
  CHECK(apart(model, kept) < 1e-12);
  CHECK(apart(tracked(), kept) > 0.02);
  CHECK(kept.covariance.parameters == std::vector<std::string>{"lag", "steering_hysteresis.share"});
  // Both values ten standard deviations from 0: the error of their common part is one over the root
  // of 200.
  CHECK(kept.covariance.matrix[1][1] == Approx(1.0 / 200.0));
  CHECK(formatModelDocument(parseModelDocument(formatModelDocument(kept), "m")) ==
        formatModelDocument(kept));
}

TEST_CASE("more parameters than there is room for are refused") {
  std::string problem;
  for (int i = 0; i < 40 && problem.empty(); ++i)
    problem = problemWith(fileOf("many_" + std::to_string(i), "v", "v + p * v", gain("p")));
  CHECK(problem.find("have at most 32 parameters together") != std::string::npos);
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/suite.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "modules/simulator/core/noise.hpp"
#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/rng.hpp"

namespace tread::blind {
namespace {

const char* const kNoises[] = {"low", "mid", "high"};
/// Share of a suite's minutes.
constexpr double kLong = 1.0;
constexpr double kShort = 1.0 / 3.0;

std::vector<std::string> catalogueNames() {
  std::vector<std::string> names;
  for (const EffectSpec& effect : effectList())
    if (effect.kind == EffectKind::kVehicle || effect.kind == EffectKind::kMeasurement)
      names.push_back(effect.name);
  return names;
}

std::vector<std::string> unknownNames() {
  std::vector<std::string> names;
  for (const EffectSpec& effect : effectList())
    if (effect.kind == EffectKind::kOutOfCatalogue) names.push_back(effect.name);
  return names;
}

/// Two that can be distinguished (not of one exact group, not two changes at an unknown time) and
/// combined (not two that both rebuild the motor).
bool fitTogether(const std::string& a, const std::string& b) {
  if (a == b) return false;
  const auto has = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), b) != names.end();
  };
  if (has(effectNamed(a).group)) return false;
  for (const auto& all : effectNamed(a).together)
    if (has(all)) return false;
  const auto changes = [](const std::string& name) {
    return name == "payload_change" || name == "terrain_change";
  };
  const auto motors = [](const std::string& name) {
    return name == "lag_asymmetry" || name == "track_backlash";
  };
  return !(changes(a) && changes(b)) && !(motors(a) && motors(b));
}

class SuiteMaker {
 public:
  SuiteMaker(double minutes, uint64_t seed)
      : minutes_(minutes), seed_(seed), dice_(sim::streamSeed(seed, kSuiteStream)) {}

  CasePlan& add(CaseKind kind, const std::vector<std::string>& effects, double size,
                const std::string& noise) {
    CasePlan plan;
    plan.kind = kind;
    plan.effects = effects;
    plan.size = size;
    plan.noise = noise;
    plan.minutes = minutes_;
    plan.seed = sim::streamSeed(seed_, 1000 + plans_.size());
    plans_.push_back(plan);
    return plans_.back();
  }

  void addSingle(const std::string& effect, double size, const std::string& noise,
                 double share = kLong) {
    add(CaseKind::kSingle, {effect}, size, noise).minutes *= share;
  }

  void addNulls(int count, const std::string& noise, double share) {
    for (int i = 0; i < count; ++i) add(CaseKind::kNull, {}, 0.0, noise).minutes *= share;
  }

  void addPairs(int count) {
    const std::vector<std::string> names = catalogueNames();
    while (count > 0) {
      const std::string& a =
          names[static_cast<size_t>(dice_.below(static_cast<int>(names.size())))];
      const std::string& b =
          names[static_cast<size_t>(dice_.below(static_cast<int>(names.size())))];
      if (!fitTogether(a, b)) continue;
      add(CaseKind::kPair, {a, b}, count % 2 == 0 ? 2.0 : 4.0, "mid");
      --count;
    }
  }

  void addUnknown(int rounds) {
    for (int i = 0; i < rounds; ++i)
      for (const std::string& name : unknownNames())
        add(CaseKind::kUnknown, {name}, i % 2 == 0 ? 2.0 : 4.0, kNoises[(1 + i / 2) % 3]);
  }

  void addDegenerate(int rounds) {
    for (int i = 0; i < rounds; ++i)
      for (const DegenerateGroup& group : degenerateGroups()) {
        const auto pick = static_cast<size_t>(i) % group.hidden.size();
        CasePlan& plan = add(CaseKind::kDegenerate, {group.hidden[pick]}, 4.0, kNoises[1 - i % 2]);
        plan.group = group.right;
        plan.choice = group.choice;
      }
  }

  void addBad(int rounds) {
    for (int i = 0; i < rounds; ++i)
      for (const std::string& defect : defectNames())
        add(CaseKind::kBad, {}, 0.0, "mid").defect = defect;
  }

  /// Shuffled, so that the order reveals nothing.
  std::vector<CasePlan> shuffled() {
    std::vector<size_t> numbers;
    for (size_t i = 0; i < plans_.size(); ++i) numbers.push_back(i + 1);
    for (size_t i = numbers.size(); i > 1; --i)
      std::swap(numbers[i - 1], numbers[static_cast<size_t>(dice_.below(static_cast<int>(i)))]);
    for (size_t i = 0; i < plans_.size(); ++i) {
      char name[16];
      std::snprintf(name, sizeof name, "%04zu", numbers[i]);
      plans_[i].name = name;
    }
    std::sort(plans_.begin(), plans_.end(),
              [](const CasePlan& a, const CasePlan& b) { return a.name < b.name; });
    return std::move(plans_);
  }

 private:
  double minutes_;
  uint64_t seed_;
  Rng dice_;
  std::vector<CasePlan> plans_;
};

}  // namespace

const std::vector<DegenerateGroup>& degenerateGroups() {
  static const std::vector<std::string> lines{"icr_offset", "lever_arm_x"};
  static const std::vector<std::string> drift{"centrifugal_drift", "heading_latency"};
  static const std::vector<std::string> late{"command_delay", "ins_latency"};
  static const std::vector<std::string> scale{"position_scale", "slip_ratio", "track_width"};
  static const std::vector<std::string> askew{"heading_misalignment", "crab"};
  static const std::vector<std::string> loss{
      "slip_ratio",     "motor_deadband",     "position_scale",  "rolling_resistance",
      "quadratic_drag", "reverse_speed_gain", "speed_saturation"};
  static const std::vector<std::string> turn{
      "track_width",      "yaw_rate_skid",    "yaw_breakaway", "speed_understeer",
      "reverse_yaw_gain", "turn_power_limit", "grip_limit"};
  static const std::vector<std::string> pull{"track_asymmetry", "yaw_pull"};
  static const std::vector<DegenerateGroup> groups{
      {lines, lines, Choice::kFull},
      {drift, drift, Choice::kFull},
      {{"command_delay", "ins_latency_all"}, late, Choice::kFull},
      {{"position_scale", "slip_ratio"}, scale, Choice::kFull},
      {askew, askew, Choice::kFull},
      {{"slip_ratio", "motor_deadband", "rolling_resistance", "quadratic_drag"},
       loss,
       Choice::kStraight},
      {{"track_width", "yaw_rate_skid", "yaw_breakaway", "speed_understeer"},
       turn,
       Choice::kOneSpeed},
      {pull, pull, Choice::kForward},
  };
  return groups;
}

namespace {

void addSmall(SuiteMaker& maker) {
  for (const char* effect :
       {"track_asymmetry", "motor_deadband", "yaw_breakaway", "command_delay", "battery_sag",
        "slope_pitch", "turn_power_limit", "icr_offset", "ins_latency", "gyro_bias"})
    maker.addSingle(effect, 2.0, "mid");
  for (const char* noise : {"mid", "high"}) maker.addNulls(2, noise, kLong);
  maker.addPairs(2);
  maker.addUnknown(1);
  maker.addBad(1);
}

/// The mix of the full suite with a fifth of the cases.
void addMedium(SuiteMaker& maker) {
  const std::vector<std::string> names = catalogueNames();
  for (size_t i = 0; i < names.size(); ++i) {
    maker.addSingle(names[i], 2.0, "mid");
    maker.addSingle(names[i], 2.0, "high");
    // Half of them at mid noise, the other half at high noise.
    maker.addSingle(names[i], 2.0, i % 2 == 0 ? "mid" : "high", kShort);
    if (i % 3 == 0) maker.addSingle(names[i], i % 2 == 0 ? 4.0 : 1.0, "mid");
  }
  maker.addNulls(20, "mid", kLong);
  maker.addNulls(20, "high", kLong);
  maker.addNulls(10, "mid", kShort);
  maker.addNulls(10, "high", kShort);
  maker.addPairs(20);
  maker.addUnknown(2);
  maker.addDegenerate(1);
  maker.addBad(2);
}

void addFull(SuiteMaker& maker) {
  for (const std::string& effect : catalogueNames()) {
    for (const double size : {1.0, 2.0, 4.0})
      for (const char* noise : kNoises) maker.addSingle(effect, size, noise);
    for (const char* noise : {"mid", "high"}) maker.addSingle(effect, 2.0, noise, kShort);
  }
  for (const char* noise : {"mid", "high"})
    for (const double share : {kLong, kShort}) maker.addNulls(100, noise, share);
  maker.addPairs(200);
  maker.addUnknown(10);
  maker.addDegenerate(12);
  maker.addBad(8);
}

}  // namespace

const std::vector<std::string>& suiteNames() {
  static const std::vector<std::string> names{"small", "medium", "full"};
  return names;
}

std::vector<CasePlan> suiteOf(const std::string& name, double minutes, uint64_t seed) {
  SuiteMaker maker(minutes, seed);
  if (name == "full") {
    addFull(maker);
  } else if (name == "medium") {
    addMedium(maker);
  } else if (name == "small") {
    addSmall(maker);
  } else {
    throw std::invalid_argument("suite '" + name + "' is not small, medium or full");
  }
  return maker.shuffled();
}

}  // namespace tread::blind

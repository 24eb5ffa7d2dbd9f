// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/truth_text.hpp"

#include <nlohmann/json.hpp>

namespace tread::blind {
namespace {

using Json = nlohmann::ordered_json;

const char* nameOf(EffectKind kind) {
  if (kind == EffectKind::kVehicle || kind == EffectKind::kVehicleVariant ||
      kind == EffectKind::kAdded)
    return "vehicle";
  return kind == EffectKind::kOutOfCatalogue ? "out_of_catalogue" : "measurement";
}

Json listOf(const std::vector<Quantity>& quantities) {
  Json list = Json::array();
  for (const Quantity& one : quantities)
    list.push_back(
        {{"name", one.name}, {"value", one.value}, {"unit", one.unit}, {"measured", one.measured}});
  return list;
}

Json effectOf(const HiddenTruth& hidden, double size) {
  const EffectSpec& spec = *hidden.spec;
  Json effect;
  effect["name"] = spec.name;
  effect["kind"] = nameOf(spec.kind);
  effect["form"] = spec.form == EffectForm::kPhysical ? "physical" : "kinematic";
  effect["shape"] = spec.shape == EffectShape::kSame ? "same" : "other";
  effect["place"] = placeOf(spec);
  effect["how"] = spec.how;
  effect["size"] = size;
  effect["levers"] = listOf(hidden.levers);
  effect["equivalent"] = listOf(hidden.equivalent);
  effect["group"] = hidden.group;
  effect["together"] = spec.together;
  effect["depends_on"] = spec.depends_on;
  return effect;
}

Json errorOf(const EndPoseError& error) {
  Json json;
  json["position_m"] = {{"median", error.position.median}, {"rms", error.position.rms}};
  json["yaw_rad"] = {{"median", error.yaw.median}, {"rms", error.yaw.rms}};
  json["yaw_rate_rad_s"] = {{"rms", error.yaw_rate}};
  json["executions"] = error.executions;
  return json;
}

/// Verdicts that are correct answers.
std::vector<std::string> rightVerdicts(const CasePlan& plan, const CaseTruth& truth) {
  switch (plan.kind) {
    case CaseKind::kNull:
      return {"NO_DISCREPANCY"};
    case CaseKind::kUnknown:
      return {"PARTIAL", "NOT_IN_CATALOGUE"};
    case CaseKind::kDegenerate:
      return {"AMBIGUOUS", "FOUND", "MEASUREMENT"};
    case CaseKind::kBad:
      return {"CANNOT_TELL", "error"};
    default:
      break;
  }
  bool measurement_only = true;
  for (const HiddenTruth& effect : truth.effects)
    measurement_only = measurement_only && nameOf(effect.spec->kind) == std::string("measurement");
  std::vector<std::string> verdicts{measurement_only ? "MEASUREMENT" : "FOUND"};
  // An exact group may be named as such.
  for (const HiddenTruth& effect : truth.effects)
    if (!effect.group.empty() || !effect.spec->together.empty())
      return {verdicts.front(), "AMBIGUOUS"};
  return verdicts;
}

}  // namespace

std::string truthText(const CasePlan& plan, const CaseTruth& truth) {
  Json json;
  json["format"] = "tread-hide truth 1";
  json["case"] = plan.name;
  json["log"] = "blind/" + plan.name + ".lcm";
  json["kind"] = kindName(plan.kind);
  json["seed"] = plan.seed;
  json["minutes"] = plan.minutes;
  json["duration_s"] = truth.duration;
  json["programme"] = choiceName(plan.choice);
  const NoiseLevel noise = noiseLevel(plan.noise).value_or(NoiseLevel{});
  json["noise"] = {{"name", noise.name},
                   {"gyro_bin_rad_s", noise.gyro_bin},
                   {"fix_m", noise.fix},
                   {"heading_rad", noise.heading},
                   {"terrain", noise.terrain}};
  json["size"] = plan.size;
  json["effects"] = Json::array();
  for (const HiddenTruth& effect : truth.effects)
    json["effects"].push_back(effectOf(effect, plan.size));
  json["right_verdicts"] = rightVerdicts(plan, truth);
  json["right_names"] = plan.group.empty() ? plan.effects : plan.group;
  json["defect"] = plan.defect;
  json["defect_at"] = truth.defect_at;
  json["floor"] = errorOf(truth.floor);
  json["gap"] = errorOf(truth.gap);
  json["excitation"] = {{"speed_m_s", truth.excitation.speed},
                        {"yaw_rate_rad_s", truth.excitation.yaw_rate},
                        {"side_acceleration_m_s2", truth.excitation.side_acceleration},
                        {"reversals", truth.excitation.reversals}};
  return json.dump(2) + "\n";
}

}  // namespace tread::blind

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/verdict_json.hpp"

#include <cmath>

#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json estimateJson(const Estimate& estimate) {
  return {{"value", number(estimate.value)},
          {"unit", estimate.unit},
          {"low", number(estimate.low)},
          {"high", number(estimate.high)}};
}

/// Adds an estimate under its name and, where people say its reciprocal, under that name, too.
void add(Json& parameters, const std::string& before_name, const Estimate& estimate) {
  parameters[before_name + lastPart(estimate.parameter)] = estimateJson(estimate);
  const Estimate natural = naturalEstimate(estimate);
  if (natural.parameter != estimate.parameter)
    parameters[before_name + natural.parameter] = estimateJson(natural);
}

Json effectJson(const FoundEffect& effect) {
  Json parameters = Json::object();
  for (const Estimate& estimate : effect.parameters) add(parameters, "", estimate);
  Json runner_ups = Json::array();
  for (const RunnerUp& runner_up : effect.runner_ups) runner_ups.push_back(runner_up.effect);
  return {{"name", effect.name},
          {"kind", effect.kind == EffectKind::kVehicle ? "vehicle" : "measurement"},
          {"parameters", parameters},
          {"group", effect.group},
          {"runner_up", runner_ups},
          {"accepted", effect.accepted}};
}

Json calibratedJson(const std::vector<Estimate>& calibrated) {
  Json all = Json::object();
  for (const Estimate& estimate : calibrated) {
    const size_t point = estimate.parameter.find('.');
    add(all, point == std::string::npos ? "" : estimate.parameter.substr(0, point + 1), estimate);
    all[estimate.parameter]["before"] = number(estimate.before);
    all[estimate.parameter]["moved"] = estimate.moved;
  }
  return all;
}

Json figureJson(const ErrorFigure& figure) {
  return {{"median", number(figure.median)}, {"rms", number(figure.rms)}};
}

Json errorsJson(const EndErrors& errors) {
  return {{"position_m", figureJson(errors.position)}, {"yaw_rad", figureJson(errors.yaw)}};
}

Json gapJson(const std::optional<Gap>& gap) {
  if (!gap)
    return {{"horizon_s", 2.0}, {"before", nullptr}, {"after", nullptr}, {"floor", nullptr}};
  return {{"horizon_s", number(gap->horizon)},
          {"before", errorsJson(gap->before)},
          {"after", errorsJson(gap->after)},
          {"floor", gap->floor ? errorsJson(*gap->floor) : Json(nullptr)}};
}

Json decisionsJson(const std::vector<Decision>& decisions) {
  Json all = Json::array();
  for (const Decision& decision : decisions)
    all.push_back({{"effect", decision.effect},
                   {"decision", decision.accepted ? "accepted" : "rejected"},
                   {"by", decision.by}});
  return all;
}

Json inputsJson(const std::vector<InputFile>& inputs) {
  Json all = {{"model", nullptr}, {"train", Json::array()}, {"test", Json::array()}};
  for (const InputFile& input : inputs) {
    const Json file = {{"name", input.name}, {"sha256", input.sha256}};
    if (input.role == InputFile::Role::kModel)
      all["model"] = file;
    else
      all[input.role == InputFile::Role::kTrain ? "train" : "test"].push_back(file);
  }
  return all;
}

}  // namespace

nlohmann::ordered_json verdictJson(const Finding& finding, const std::vector<InputFile>& inputs) {
  Json effects = Json::array();
  for (const FoundEffect& effect : finding.effects) effects.push_back(effectJson(effect));
  Json unexplained = Json::array();
  for (const Unexplained& rest : finding.unexplained)
    unexplained.push_back(Json{{"channel", rest.channel}, {"variable", rest.variable}});
  return {{"verdict", verdictName(finding.verdict)},
          {"reason", finding.reason},
          {"effects", effects},
          {"calibrated", calibratedJson(finding.calibrated)},
          {"gap", gapJson(finding.gap)},
          {"unexplained", unexplained},
          {"not_excited", finding.not_excited},
          {"decisions", decisionsJson(finding.decisions)},
          {"seed", finding.seed},
          {"inputs", inputsJson(inputs)}};
}

}  // namespace tread::gap

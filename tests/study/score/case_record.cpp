// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/case_record.hpp"

#include <cmath>
#include <stdexcept>

#include "common/config/problem_words.hpp"

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

double numberAt(const Json& json, const char* key) {
  return json.contains(key) && json.at(key).is_number() ? json.at(key).get<double>() : kUnknown;
}

std::vector<std::string> wordsAt(const Json& json, const char* key) {
  return json.contains(key) ? json.at(key).get<std::vector<std::string>>()
                            : std::vector<std::string>{};
}

EndErrors errorOf(const Json& json) {
  if (!json.is_object()) return {};
  const auto of = [&](const char* size) {
    return EndError{numberAt(json.at("position_m"), size), numberAt(json.at("yaw_rad"), size)};
  };
  EndErrors errors{of("rms"), of("median")};
  if (json.contains("yaw_rate_rad_s")) errors.yaw_rate = numberAt(json.at("yaw_rate_rad_s"), "rms");
  return errors;
}

HiddenEffect hiddenOf(const Json& json) {
  HiddenEffect effect;
  effect.name = json.at("name");
  effect.kind = json.value("kind", "");
  effect.form = json.value("form", "");
  effect.shape = json.value("shape", "");
  effect.place = json.value("place", "");
  effect.group = wordsAt(json, "group");
  if (json.contains("together"))
    effect.together = json.at("together").get<std::vector<std::vector<std::string>>>();
  effect.depends_on = wordsAt(json, "depends_on");
  for (const Json& number : json.at("equivalent"))
    effect.numbers.push_back({number.at("name"), numberAt(number, "value")});
  return effect;
}

Truth truthOf(const Json& json) {
  Truth truth;
  truth.name = json.at("case");
  truth.kind = json.at("kind");
  truth.noise = json.at("noise").at("name");
  truth.programme = json.at("programme");
  truth.defect = json.at("defect");
  truth.size = json.at("size");
  truth.minutes = json.at("minutes");
  truth.duration = json.at("duration_s");
  for (const Json& effect : json.at("effects")) truth.effects.push_back(hiddenOf(effect));
  truth.right_verdicts = wordsAt(json, "right_verdicts");
  truth.right_names = wordsAt(json, "right_names");
  truth.floor = errorOf(json.at("floor"));
  truth.gap = errorOf(json.at("gap"));
  return truth;
}

Estimated estimatedOf(const std::string& path, const Json& json, const Json& nominal) {
  Estimated one{path, numberAt(json, "value"), numberAt(json, "low"), numberAt(json, "high")};
  if (nominal.contains(path)) {
    one.before = numberAt(nominal.at(path), "value");
    one.before_sigma = numberAt(nominal.at(path), "sigma");
  }
  if (json.contains("moved")) one.moved = json.at("moved").get<bool>();
  return one;
}

NamedEffect namedOf(const Json& json, const Json& nominal) {
  NamedEffect effect;
  effect.name = json.at("name");
  effect.group = wordsAt(json, "group");
  effect.runner_ups = wordsAt(json, "runner_up");
  for (const auto& [name, value] : json.at("parameters").items())
    effect.parameters.push_back(estimatedOf(effect.name + "." + name, value, nominal));
  if (json.contains("motor_currents_rise")) {
    const Json& load = json.at("motor_currents_rise").at("load");
    if (load.is_boolean()) effect.load = load.get<bool>();
  }
  return effect;
}

Answer answerOf(const Json& json, const Json& nominal) {
  Answer answer;
  const Json& verdict = json.at("verdict");
  if (verdict.is_null()) {
    answer.verdict = "error";
    answer.reason = json.at("message");
    return answer;
  }
  answer.verdict = verdict.at("verdict");
  answer.reason = verdict.value("reason", "");
  for (const Json& effect : verdict.at("effects"))
    answer.effects.push_back(namedOf(effect, nominal));
  for (const auto& [path, value] : verdict.at("calibrated").items())
    answer.calibrated.push_back(estimatedOf(path, value, nominal));
  answer.before = errorOf(verdict.at("gap").at("before"));
  answer.after = errorOf(verdict.at("gap").at("after"));
  for (const Json& rest : verdict.at("unexplained"))
    answer.unexplained.emplace_back(rest.at("channel"), rest.at("variable"));
  return answer;
}

}  // namespace

CaseRecord recordOf(const Json& line) {
  try {
    return {truthOf(line.at("truth")), answerOf(line.at("answer"), line.at("nominal"))};
  } catch (const nlohmann::json::exception& problem) {
    throw std::runtime_error("case " + line.value("case", "?") + ": " + wordsOf(problem));
  }
}

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/report/find_output.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/lab/gap/report/sections.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

void add(std::vector<EffectDecision>& decisions, const std::string& name, bool accepted,
         const std::string& by) {
  const Effect& effect = effectOrGuess(name);
  for (const EffectDecision& other : decisions)
    if (other.effect == effect.name)
      throw std::runtime_error(effect.name + (other.accepted == accepted
                                                  ? " is named twice; once is enough"
                                                  : " is both accepted and rejected; choose one"));
  decisions.push_back({effect.name, accepted, by});
}

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json estimateJson(const ParameterEstimate& estimate) {
  return {{"value", number(estimate.value)},
          {"unit", estimate.unit},
          {"low", number(estimate.low)},
          {"high", number(estimate.high)}};
}

/// Adds an estimate under its name and, for a reciprocal, also under its natural name.
void add(Json& parameters, const std::string& before_name, const ParameterEstimate& estimate) {
  parameters[before_name + lastPart(estimate.parameter)] = estimateJson(estimate);
  const ParameterEstimate natural = naturalEstimate(estimate);
  if (natural.parameter != estimate.parameter)
    parameters[before_name + natural.parameter] = estimateJson(natural);
}

/// Answer of an additional measurement; null if it does not decide.
Json answerJson(bool yes, bool no) {
  return yes == no ? Json(nullptr) : Json(yes);
}

constexpr const char* kEvidenceNames[] = {"wheel_speeds_show", "motor_currents_rise",
                                          "battery_voltage_falls"};

Json evidenceJson(const MeasuredEvidence& evidence) {
  const bool currents = evidence.source == EvidenceSource::kCurrents;
  Json json = {{currents ? "rise" : "share", number(evidence.value)},
               {"low", number(evidence.low)},
               {"high", number(evidence.high)}};
  if (evidence.source != EvidenceSource::kWheels)
    json[currents ? "load" : "battery"] = answerJson(evidence.confirms(), evidence.refutes());
  return json;
}

Json effectJson(const FoundEffect& effect) {
  Json parameters = Json::object();
  for (const ParameterEstimate& estimate : effect.parameters) add(parameters, "", estimate);
  Json runner_ups = Json::array();
  for (const RunnerUp& runner_up : effect.runner_ups) runner_ups.push_back(runner_up.effect);
  Json json = {
      {"name", effect.name},
      {"kind", effectNamed(effect.name).kind() == EffectKind::kVehicle ? "vehicle" : "measurement"},
      {"parameters", parameters},
      {"group", effect.group},
      {"runner_up", runner_ups},
      {"accepted", effect.accepted}};
  for (const MeasuredEvidence& evidence : effect.evidence)
    json[kEvidenceNames[static_cast<size_t>(evidence.source)]] = evidenceJson(evidence);
  return json;
}

Json calibratedJson(const std::vector<ParameterEstimate>& calibrated) {
  Json all = Json::object();
  for (const ParameterEstimate& estimate : calibrated) {
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

Json unnamedJson(const IdentifiedModel& identified) {
  Json all = Json::array();
  for (const UnnamedFinding& found : identified.unnamed) {
    const UnnamedTerm& term = *termOfPath(identified.model, found.name + ".0");
    Json deviations = Json::array();
    for (const double deviation : found.deviations) deviations.push_back(number(deviation));
    all.push_back({{"name", found.name},
                   {"channel", termChannelName(term.channel)},
                   {"condition", term.condition->name},
                   {"times", term.times == nullptr ? Json(nullptr) : Json(term.times->name)},
                   {"at", term.at},
                   {"values", term.values},
                   {"deviations", deviations},
                   {"gain", number(found.gain)},
                   {"gain_error", number(found.gain_error)}});
  }
  return all;
}

Json gapJson(const std::optional<Gap>& gap) {
  if (!gap)
    return {{"horizon_s", 2.0}, {"before", nullptr}, {"after", nullptr}, {"floor", nullptr}};
  return {{"horizon_s", number(gap->horizon)},
          {"before", errorsJson(gap->before)},
          {"after", errorsJson(gap->after)},
          {"floor", gap->floor ? errorsJson(*gap->floor) : Json(nullptr)}};
}

Json decisionsJson(const std::vector<EffectDecision>& decisions) {
  Json all = Json::array();
  for (const EffectDecision& decision : decisions)
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

/// Makes both halves equal to the bit: rounding made them differ.
void makeSymmetric(std::vector<std::vector<double>>& matrix) {
  for (size_t i = 0; i < matrix.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      matrix[i][j] = matrix[j][i] = 0.5 * (matrix[i][j] + matrix[j][i]);
}

}  // namespace

void requireOf(const std::string& request, const std::string& effect, VehicleLayout layout) {
  if (effectNamed(effect).isOf(layout)) return;
  throw std::runtime_error(request + " " + effect + ": no effect of " + nameOf(layout) +
                           ", which the model is of");
}

std::vector<EffectDecision> decisionsOf(const DecisionWords& words, const ModelDocument& model) {
  std::vector<EffectDecision> decisions;
  for (const std::string& name : words.accepted) add(decisions, name, true, words.by);
  for (const std::string& name : words.accepted)
    requireOf("--accept", name, model.vehicle.layout());
  for (const std::string& name : words.rejected) {
    add(decisions, name, false, words.by);
    if (isOn(effectNamed(name), model))
      throw std::runtime_error("--reject " + name +
                               ": the model has this effect; take it out of the model file first");
  }
  if (decisions.empty() && !words.by.empty())
    throw std::runtime_error("--by " + words.by +
                             ": no decision is given; add --accept or --reject");
  return decisions;
}

nlohmann::ordered_json verdictJson(const GapFinding& finding,
                                   const std::vector<InputFile>& inputs) {
  Json effects = Json::array();
  for (const FoundEffect& effect : finding.identified.effects)
    effects.push_back(effectJson(effect));
  Json unexplained = Json::array();
  for (const Unexplained& rest : finding.adequacy.unexplained)
    unexplained.push_back(Json{{"channel", rest.channel},
                               {"variable", rest.variable},
                               {"like", rest.like.empty() ? Json(nullptr) : Json(rest.like)}});
  return {{"verdict", verdictName(finding.verdict)},
          {"reason", finding.reason},
          {"cut_short", finding.search.cut_short},
          {"brief", finding.source.brief},
          {"effects", effects},
          {"calibrated", calibratedJson(finding.identified.calibrated)},
          {"gap", gapJson(finding.gap)},
          {"unnamed", unnamedJson(finding.identified)},
          {"moved_terms", finding.identified.moved_terms},
          {"unexplained", unexplained},
          {"not_excited", finding.identified.not_excited},
          {"decisions", decisionsJson(finding.source.decisions)},
          {"seed", finding.source.seed},
          {"inputs", inputsJson(inputs)}};
}

ModelDocument newModel(const GapFinding& finding, const std::vector<InputFile>& inputs) {
  ModelDocument model = finding.identified.model;
  makeSymmetric(model.covariance.matrix);
  const Provenance& old = finding.before.provenance;
  Provenance provenance;
  provenance.tool = toolVersion();
  provenance.seed = static_cast<int64_t>(finding.source.seed);
  provenance.runs = 1;
  for (const InputFile& input : inputs) {
    if (input.role != InputFile::Role::kTrain) continue;
    provenance.logs.push_back({input.name, input.sha256});
    if (std::any_of(old.logs.begin(), old.logs.end(),
                    [&](const SourceLog& log) { return log.sha256 == input.sha256; }))
      provenance.runs = old.runs + 1;
  }
  provenance.decisions = finding.source.decisions;
  for (const EffectDecision& earlier : old.decisions)
    if (std::none_of(finding.source.decisions.begin(), finding.source.decisions.end(),
                     [&](const EffectDecision& now) { return now.effect == earlier.effect; }))
      provenance.decisions.push_back(earlier);
  model.provenance = provenance;
  return model;
}

bool hasNewModel(const GapFinding& finding) {
  return finding.verdict != GapVerdict::kCannotTell;
}

void writeFinding(const std::string& folder, const GapFinding& finding,
                  const std::vector<InputFile>& inputs) {
  const Page page = reportPage(finding, inputs);
  if (hasNewModel(finding)) {
    const std::string model = formatModelDocument(newModel(finding, inputs));
    parseModelDocument(model, folder + "/model.yaml");  // refuse to write an unreadable file
    writeText(folder + "/model.yaml", model);
  }
  writeText(folder + "/report.md", markdownOf(page));
  writeText(folder + "/report.html", htmlOf(page));
  // Last: when the verdict exists, the other files do, too.
  writeText(folder + "/verdict.json", verdictJson(finding, inputs).dump(2) + "\n");
}

}  // namespace tread::gap

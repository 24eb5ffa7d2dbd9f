// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/gap/report/effect_words.hpp"
#include "tools/gap/report/sections.hpp"

namespace tread::gap {
namespace {

std::string saidRange(const PlausibleRange& range, const Estimate& estimate) {
  if (range.min == range.max) return "";
  const EffectParameter* parameter = findEffectParameter(estimate.parameter);
  if (parameter != nullptr && parameter->reciprocal())
    return "above " + said(1.0 / range.max, naturalUnit(*parameter));
  return saidInterval(range.min, range.max, estimate.unit);
}

/// Before its effect was added a parameter was off.
std::string saidBefore(const Estimate& estimate, const Estimate& natural) {
  if (findEffectParameter(estimate.parameter) != nullptr && estimate.before == 0.0) return "off";
  return said(natural.before, saidUnit(natural));
}

/// What a parameter makes together with what it acts on top of.
std::string saidTotal(const Finding& finding, const Estimate& estimate) {
  const auto total = totalOf(estimate.parameter, finding.identified.model);
  return total ? total->name + " " + said(total->value, total->unit) : "";
}

void addRow(const Finding& finding, const Estimate& estimate, const std::string& effect,
            Table& table) {
  const Estimate natural = naturalEstimate(estimate);
  table.rows.push_back({effect, lastPart(natural.parameter), saidBefore(estimate, natural),
                        said(natural.value, saidUnit(natural)) +
                            (isAtLimit(finding, estimate) ? " (at its limit)" : ""),
                        saidInterval(natural.low, natural.high, saidUnit(natural)),
                        saidRange(plausibleRange(finding, estimate.parameter), estimate),
                        saidTotal(finding, estimate)});
}

/// Takes away a last column that says nothing.
void forgetEmptyTotals(Table& table) {
  for (const std::vector<std::string>& row : table.rows)
    if (!row.back().empty()) return;
  table.header.pop_back();
  for (std::vector<std::string>& row : table.rows) row.pop_back();
}

/// Pairs whose estimates move together.
Points highCorrelations(const ParameterCovariance& covariance) {
  Points points;
  const size_t size = std::min(covariance.parameters.size(), covariance.matrix.size());
  for (size_t i = 0; i < size; ++i)
    for (size_t j = i + 1; j < size; ++j) {
      const double scale = std::sqrt(covariance.matrix[i][i] * covariance.matrix[j][j]);
      const double correlation = scale > 0.0 ? covariance.matrix[i][j] / scale : 0.0;
      if (std::abs(correlation) > 0.9)
        points.items.push_back(covariance.parameters[i] + " and " + covariance.parameters[j] +
                               ": correlation " + threeDigits(correlation) +
                               "; only their combination is well known");
    }
  return points;
}

}  // namespace

Section effectsSection(const Finding& finding) {
  Section section{
      finding.verdict == GapVerdict::kCannotTell ? "Effects where the fit ended" : "What was found",
      {}};
  for (const FoundEffect& found : finding.identified.effects) {
    const Effect& effect = effectNamed(found.name);
    section.blocks.push_back(Paragraph{
        effect.title + " (" + effect.name + ", " +
        (effect.kind() == EffectKind::kVehicle ? "of the vehicle" : "of the measurement") + ")"});
    section.blocks.push_back(
        Points{{"Equation: " + effect.equation, "In the residuals: " + effect.looks_like,
                "In two minutes: " + checkOf(found),
                "Evidence: score " + threeDigits(found.score) + ", p " + saidChance(found.p_value) +
                    ", gain " + threeDigits(found.gain) + " \u00b1 " +
                    threeDigits(found.gain_error) + " nats on blocks that were not fitted"}});
  }
  return section;
}

Section parametersSection(const Finding& finding) {
  Section section{finding.verdict == GapVerdict::kCannotTell ? "Parameters where the fit ended"
                                                             : "Parameters of the new model",
                  {}};
  Table table{
      {"term", "parameter", "before", "now", "95 % interval", "plausible", "in all"}, {}, 2};
  for (const FoundEffect& effect : finding.identified.effects)
    for (const Estimate& estimate : effect.parameters)
      addRow(finding, estimate, titleOf(effect.name), table);
  for (const Estimate& estimate : finding.identified.calibrated) {
    const bool term = findEffectParameter(estimate.parameter) != nullptr;
    addRow(finding, estimate,
           term ? titleOf(effectOfPath(estimate.parameter)) : std::string("nominal model"), table);
  }
  if (table.rows.empty()) return section;
  forgetEmptyTotals(table);
  section.blocks.push_back(table);
  const Points pairs = highCorrelations(finding.identified.model.covariance);
  if (!pairs.items.empty()) section.blocks.push_back(pairs);
  return section;
}

Section envelopeSection(const Finding& finding) {
  Section section{"Where the new model holds", {}};
  if (!finding.identified.model.envelope || finding.verdict == GapVerdict::kCannotTell)
    return section;
  const Envelope& envelope = *finding.identified.model.envelope;
  section.blocks.push_back(Paragraph{
      "It was made from motions up to " + said(envelope.v, "m/s") + ", " +
      said(envelope.omega, "rad/s") + " and " + said(envelope.v_omega, "m/s2") +
      " sideways (speed times yaw rate). The model file carries these numbers, and the simulator "
      "warns beyond them: there it extrapolates."});
  return section;
}

Section filesSection(const Finding& finding, const std::vector<InputFile>& inputs) {
  Section section{"Versions and files", {}};
  Table table{{"file", "as", "SHA-256"}, {}, 3};
  for (const InputFile& input : inputs) {
    const char* role = input.role == InputFile::Role::kModel   ? "model"
                       : input.role == InputFile::Role::kTrain ? "training"
                                                               : "test";
    table.rows.push_back({input.name, role, input.sha256});
  }
  section.blocks.push_back(table);
  section.blocks.push_back(Paragraph{std::string(toolVersion()) + ", seed " +
                                     std::to_string(finding.source.seed) +
                                     ". The same files and the same seed give the same report."});
  return section;
}

const char* toolVersion() {
  return "tread-gap " TREAD_GAP_VERSION;
}

}  // namespace tread::gap

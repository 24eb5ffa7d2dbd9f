// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <sstream>

#include "common/config/scalars.hpp"
#include "common/vehicle/model_file.hpp"

namespace tread {
namespace {

void line(std::ostringstream& out, const std::string& key, double value,
          const std::string& comment) {
  out << key << ": " << formatNumber(value);
  if (!comment.empty()) out << "  # " << comment;
  out << '\n';
}

double valueOf(const ModelDocument& document, const EffectParameter& parameter) {
  return parameter.vehicle != nullptr ? document.vehicle.effects.*parameter.vehicle
                                      : document.measurement.*parameter.measured;
}

/// Unit of a parameter and, for a limit, the limit itself.
std::string unitOf(const EffectParameter& parameter, double value) {
  if (!parameter.reciprocal() || value == 0.0) return parameter.unit;
  char limit[40];
  std::snprintf(limit, sizeof limit, "%.4g", naturalValue(parameter, value));
  return parameter.unit + ": " + parameter.natural_name + " " + limit + " " +
         parameter.natural_unit;
}

bool isDefault(const ModelDocument& document, const Effect& effect) {
  static const ModelDocument nominal{};
  for (const EffectParameter& parameter : effect.parameters)
    if (valueOf(document, parameter) != valueOf(nominal, parameter)) return false;
  return true;
}

void writeEffects(std::ostringstream& out, const ModelDocument& document, EffectKind kind,
                  const std::string& key) {
  bool any = false;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind != kind || isDefault(document, effect)) continue;
    if (!any) out << key << ":\n";
    any = true;
    out << "  " << effect.name << ":  # " << effect.sentence << '\n';
    for (const EffectParameter& parameter : effect.parameters) {
      const double value = valueOf(document, parameter);
      line(out, "    " + parameter.name, value, unitOf(parameter, value));
    }
  }
}

void writeNominal(std::ostringstream& out, const VehicleModel& model) {
  const bool power = model.kind == CommandKind::kPower;
  out << "name: " << formatText(model.name) << '\n';
  out << "kind: " << (power ? "power" : "track_speed") << '\n';
  if (power) line(out, "full_speed", model.full_speed, "m/s, track speed at power 1");
  line(out, "gauge", model.gauge, "m, between the middles of the tracks");
  line(out, "lag", model.lag, "s, time constant of the track speeds");
  line(out, "delay", model.delay, "s, before a command begins to act");
  line(out, "forward_gain", model.forward_gain, "ground speed over mean track speed");
  line(out, "yaw_gain", model.yaw_gain, "yaw rate over that of the track speeds");
  if (model.step != VehicleModel().step)
    line(out, "step", model.step, "s, longest step of integration");
}

void writeSpread(std::ostringstream& out, const ExecutionSpread& spread) {
  out << "spread:  # standard deviations from one execution to the next\n";
  line(out, "  forward", spread.forward, "of the factor on the forward speed");
  line(out, "  yaw", spread.yaw, "of the factor on the yaw rate");
  line(out, "  crab", spread.crab, "rad, of the direction of travel");
}

std::string list(const std::vector<double>& values) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(formatNumber(value));
  return "[" + joinWords(words) + "]";
}

void writeEstimate(std::ostringstream& out, const ModelDocument& document) {
  if (!document.bounds.empty()) out << "bounds:  # narrower than what is plausible\n";
  for (const ParameterBounds& bounds : document.bounds)
    out << "  " << bounds.parameter << ": " << list({bounds.min, bounds.max}) << '\n';
  if (document.covariance.parameters.empty()) return;
  out << "covariance:  # of the estimate, in the parameters' units\n";
  out << "  parameters: [" << joinWords(document.covariance.parameters) << "]\n  matrix:\n";
  for (const std::vector<double>& row : document.covariance.matrix)
    out << "    - " << list(row) << '\n';
}

void writeProvenance(std::ostringstream& out, const Provenance& provenance) {
  if (provenance.tool.empty() && !provenance.seed && provenance.runs == 0 &&
      provenance.logs.empty() && provenance.decisions.empty())
    return;
  out << "provenance:\n";
  if (!provenance.tool.empty()) out << "  tool: " << formatText(provenance.tool) << '\n';
  if (provenance.seed) out << "  seed: " << *provenance.seed << '\n';
  out << "  runs: " << provenance.runs << "  # of the tool on these logs\n";
  if (!provenance.logs.empty()) out << "  logs:\n";
  for (const SourceLog& log : provenance.logs)
    out << "    - name: " << formatText(log.name) << "\n      sha256: " << formatText(log.sha256)
        << '\n';
  if (!provenance.decisions.empty()) out << "  decisions:  # of people\n";
  for (const Decision& decision : provenance.decisions) {
    out << "    - effect: " << decision.effect
        << "\n      decision: " << (decision.accepted ? "accepted" : "rejected") << '\n';
    if (!decision.by.empty()) out << "      by: " << formatText(decision.by) << '\n';
  }
}

void writeEnvelope(std::ostringstream& out, const Envelope& envelope) {
  out << "envelope:  # largest motions that the model was made from\n";
  line(out, "  v", envelope.v, "m/s");
  line(out, "  omega", envelope.omega, "rad/s");
  line(out, "  v_omega", envelope.v_omega, "m/s2");
}

}  // namespace

std::string formatModelDocument(const ModelDocument& document) {
  std::ostringstream out;
  writeNominal(out, document.vehicle);
  writeEffects(out, document, EffectKind::kVehicle, "effects");
  writeEffects(out, document, EffectKind::kMeasurement, "measurement");
  writeSpread(out, document.vehicle.spread);
  writeEstimate(out, document);
  writeProvenance(out, document.provenance);
  if (document.envelope) writeEnvelope(out, *document.envelope);
  return out.str();
}

std::string formatModel(const VehicleModel& model) {
  ModelDocument document;
  document.vehicle = model;
  return formatModelDocument(document);
}

}  // namespace tread

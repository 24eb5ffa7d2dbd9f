// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model_file.hpp"

#include "common/config/config_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "common/config/scalars.hpp"
#include "common/geometry/degrees.hpp"
#include "common/vehicle/effect_file.hpp"
#include "common/vehicle/omni_wheels_file.hpp"

namespace tread {
namespace {

constexpr Range kGain{0.05, 5.0};
constexpr Range kSpread{0.0, 1.0};
constexpr Range kAnything{-1e300, 1e300};
constexpr double kNoLimit = 1e9;
constexpr Range kCurve{-1000.0, 1000.0};  // where an unnamed term has values, in any unit
constexpr Range kCurveValue{-kLargestTermValue, kLargestTermValue};
constexpr size_t kMostUnnamedTerms = 16;

/// For a holonomic base, whose wheel positions are in robot.yaml.
void readOmni(ConfigReader& reader, VehicleModel& model) {
  for (const char* key : {"gauge", "wheelbase"})
    if (reader.has(key))
      throw reader.error(key, "is of a vehicle with two tracks; a model with wheels has none");
  model.wheels = readOmniWheels(reader);
  model.gauge = 2.0 * model.wheels.radius();
  reader.number("sideways_gain", model.sideways_gain, kGain, "");
}

void readTracks(ConfigReader& reader, VehicleModel& model) {
  std::string kind;
  reader.choice("kind", kind, {"power", "track_speed"}, true);
  model.kind = kind == "power" ? CommandKind::kPower : CommandKind::kTrackSpeed;
  if (model.kind == CommandKind::kPower)
    reader.number("full_speed", model.full_speed, {0.01, 100.0}, "m/s", true);
  else if (reader.has("full_speed"))
    throw reader.error("full_speed", "is for power commands; track_speed commands are in m/s");
  if (reader.has("wheels")) {
    readOmni(reader, model);
  } else {
    reader.number("gauge", model.gauge, {0.05, 10.0}, "m", true);
    reader.number("wheelbase", model.wheelbase, {0.2, 10.0}, "m");
  }
  if (reader.has("steering_lag") && !model.isCar())
    throw reader.error("steering_lag", "is for a car; give its wheelbase, too");
  reader.number("steering_lag", model.steering_lag, {0.0, 3.0}, "s");
  if (reader.has("steering_gain") && !model.isCar())
    throw reader.error("steering_gain", "is for a car; give its wheelbase, too");
  reader.number("steering_gain", model.steering_gain, kGain, "");
  reader.number("lag", model.lag, {0.0, 5.0}, "s");
  reader.number("delay", model.delay, {0.0, 2.0}, "s");
  reader.number("forward_gain", model.forward_gain, kGain, "");
  reader.number("yaw_gain", model.yaw_gain, kGain, "");
  reader.number("step", model.step, {0.0005, 0.1}, "s");
}

void readParameter(ConfigReader& effect, const EffectParameter& parameter, double& value) {
  const bool natural = parameter.reciprocal() && effect.has(parameter.natural_name);
  if (natural && effect.has(parameter.name))
    throw effect.error(parameter.natural_name,
                       "stands beside " + parameter.name + ", its reciprocal; give one of them");
  if (natural) {
    double limit = kNoLimit;
    effect.number(parameter.natural_name, limit, {1.0 / parameter.max, kNoLimit},
                  parameter.natural_unit);
    value = 1.0 / limit;
  }
  effect.number(parameter.name, value, {parameter.min, parameter.max}, parameter.unit);
}

void readMeasurement(ConfigReader reader, MeasurementModel& measurement) {
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != EffectKind::kMeasurement) continue;
    ConfigReader section = reader.section(effect.name);
    for (const EffectParameter& parameter : effect.parameters)
      readParameter(section, parameter, measurement.*parameter.measured);
  }
}

void readBounds(ConfigReader reader, ModelDocument& document) {
  for (const std::string& parameter : reader.keys()) {
    const double* value = findParameter(document, parameter);
    if (value == nullptr)
      throw reader.error(parameter,
                         "is no parameter; write lag, forward_gain or effect.parameter "
                         "(icr_offset.offset)");
    std::vector<double> ends;
    reader.numbers(parameter, ends, 2, kAnything, "", true);
    if (ends[0] >= ends[1] || *value < ends[0] || *value > ends[1])
      throw reader.error(parameter, "the model's value must lie between the two bounds");
    document.bounds.push_back({parameter, ends[0], ends[1]});
  }
}

bool isSymmetric(const std::vector<std::vector<double>>& matrix) {
  for (size_t i = 0; i < matrix.size(); ++i) {
    if (matrix[i][i] < 0.0) return false;
    for (size_t j = 0; j < i; ++j)
      if (matrix[i][j] != matrix[j][i]) return false;
  }
  return true;
}

void readCovariance(ConfigReader reader, const ModelDocument& document,
                    ParameterCovariance& covariance) {
  reader.texts("parameters", covariance.parameters);
  std::set<std::string> known;
  for (const std::string& parameter : covariance.parameters)
    if (findParameter(document, parameter) == nullptr || !known.insert(parameter).second)
      throw reader.error("parameters", "'" + parameter +
                                           "' is no parameter or there twice; write lag, "
                                           "forward_gain or effect.parameter");
  const size_t size = covariance.parameters.size();
  reader.table("matrix", covariance.matrix, std::max<size_t>(size, 1), kAnything, "");
  if (covariance.matrix.size() != size || !isSymmetric(covariance.matrix))
    throw reader.error("matrix",
                       "one row per parameter, symmetric, nothing negative on the "
                       "diagonal");
}

void readRest(ConfigReader& reader, std::optional<std::vector<RestTerm>>& rest) {
  if (!reader.has("rest")) return;
  rest.emplace();
  for (ConfigReader& entry : reader.sections("rest")) {
    RestTerm term;
    entry.text("channel", term.channel, true);
    entry.text("condition", term.condition, true);
    entry.number("size", term.size, kAnything, "", true);
    entry.number("deviation", term.deviation, {0.0, kAnything.max}, "", true);
    rest->push_back(term);
  }
}

/// A condition of an unnamed term; refused if the kernel has none of that name.
const TermCondition* readCondition(ConfigReader& entry, const std::string& key, bool required) {
  std::string name;
  std::vector<std::string> known;
  for (const TermCondition& condition : termConditions()) known.emplace_back(condition.name);
  if (!required && !entry.has(key)) return nullptr;
  entry.choice(key, name, known, required);
  return findTermCondition(name);
}

void readCurve(ConfigReader& entry, UnnamedTerm& term) {
  entry.numbers("at", term.at, 0, kCurve, "", true);
  entry.numbers("values", term.values, 0, kCurveValue, "", true);
  if (term.at.size() < kLeastTermValues || term.at.size() > kMostTermValues)
    throw entry.error("at", "2 to 6 values of the condition, ascending");
  for (size_t i = 0; i + 1 < term.at.size(); ++i)
    if (!(term.at[i] < term.at[i + 1])) throw entry.error("at", "must be ascending");
  if (term.values.size() != term.at.size()) throw entry.error("values", "one for each value of at");
}

void readUnnamed(ConfigReader& reader, ModelDocument& document) {
  if (reader.has("unnamed") && document.vehicle.isOmni())
    throw reader.error("unnamed", "is of a vehicle with two tracks; a model with wheels has none");
  for (ConfigReader& entry : reader.sections("unnamed")) {
    if (document.vehicle.unnamed.size() >= kMostUnnamedTerms)
      throw entry.error("name", "is the " + std::to_string(kMostUnnamedTerms + 1) +
                                    "th unnamed term; a model has at most " +
                                    std::to_string(kMostUnnamedTerms));
    UnnamedTerm term;
    entry.text("name", term.name, true);
    const std::string problem = problemWithTermName(document, term.name);
    if (!problem.empty()) throw entry.error("name", problem);
    std::string channel;
    entry.choice("channel", channel, {"yaw rate", "v", "v_y"}, true);
    for (const TermChannel one :
         {TermChannel::kYawRate, TermChannel::kSpeed, TermChannel::kSideways})
      if (channel == termChannelName(one)) term.channel = one;
    term.condition = readCondition(entry, "condition", true);
    term.times = readCondition(entry, "times", false);
    if (term.times != nullptr) {
      std::vector<double> range;
      entry.numbers("times_range", range, 2, kCurve, "", true);
      if (!(range[0] < range[1])) throw entry.error("times_range", "must be ascending");
      term.times_low = range[0];
      term.times_high = range[1];
    }
    readCurve(entry, term);
    document.vehicle.unnamed.push_back(term);
  }
}

/// A mistyped name in a manual decision would be kept forever without effect.
void requireEffect(const ConfigReader& reader, const std::string& name) {
  try {
    effectOrGuess(name);
  } catch (const std::runtime_error& problem) {
    throw reader.error("effect", problem.what());
  }
}

void readProvenance(ConfigReader reader, Provenance& provenance) {
  reader.text("tool", provenance.tool);
  if (reader.has("seed")) {
    int64_t seed = 0;
    reader.integer("seed", seed, {0.0, 9.2e18}, "");
    provenance.seed = seed;
  }
  reader.integer("runs", provenance.runs, {0.0, 1e9}, "");
  for (ConfigReader& entry : reader.sections("logs")) {
    SourceLog log;
    entry.text("name", log.name, true);
    entry.text("sha256", log.sha256, true);
    if (log.sha256.size() != 64 ||
        log.sha256.find_first_not_of("0123456789abcdef") != std::string::npos)
      throw entry.error("sha256", "is no SHA-256; 64 digits 0-9 a-f");
    provenance.logs.push_back(log);
  }
  for (ConfigReader& entry : reader.sections("decisions")) {
    EffectDecision decision;
    entry.text("effect", decision.effect, true);
    requireEffect(entry, decision.effect);
    std::string decided = "accepted";
    entry.choice("decision", decided, {"accepted", "rejected"}, true);
    decision.accepted = decided == "accepted";
    entry.text("by", decision.by);
    provenance.decisions.push_back(decision);
  }
}

std::optional<Envelope> readEnvelope(ConfigReader& reader) {
  if (!reader.has("envelope")) return std::nullopt;
  ConfigReader section = reader.section("envelope");
  Envelope envelope;
  section.number("v", envelope.v, {0.0, 100.0}, "m/s", true);
  section.number("omega", envelope.omega, {0.0, 100.0}, "rad/s", true);
  section.number("v_omega", envelope.v_omega, {0.0, 10000.0}, "m/s2", true);
  return envelope;
}

/// Refuses effects that such a vehicle cannot have: they would act wrongly or not at all.
void refuseOthers(ConfigReader& effects, const VehicleModel& model) {
  for (const Effect& effect : effectCatalogue())
    if (effect.kind() == EffectKind::kVehicle && isOn(effect, model.effects, {}) &&
        !effect.isOf(model.layout()))
      throw effects.error(effect.name, std::string("is no effect of ") + nameOf(model.layout()) +
                                           ", which this model is of; leave it out");
}

ModelDocument readDocument(ConfigReader reader) {
  ModelDocument document;
  VehicleModel& model = document.vehicle;
  reader.text("name", model.name, true);
  readTracks(reader, model);
  for (ConfigReader& entry : reader.sections("catalogue")) addEntry(readEffectEntry(entry), entry);
  ConfigReader effects = reader.section("effects");
  readEffects(effects, model.effects);
  refuseOthers(effects, model);
  readMeasurement(reader.section("measurement"), document.measurement);
  ConfigReader spread = reader.section("spread");
  spread.number("forward", model.spread.forward, kSpread, "");
  spread.number("yaw", model.spread.yaw, kSpread, "");
  spread.number("crab", model.spread.crab, kSpread, "rad");
  readUnnamed(reader, document);
  readRest(reader, document.rest);
  readBounds(reader.section("bounds"), document);
  readCovariance(reader.section("covariance"), document, document.covariance);
  readProvenance(reader.section("provenance"), document.provenance);
  document.envelope = readEnvelope(reader);
  reader.finish();
  return document;
}

// The text of a model file.

void line(std::ostringstream& out, const std::string& key, double value,
          const std::string& comment) {
  out << key << ": " << formatNumber(value);
  if (!comment.empty()) out << "  # " << comment;
  out << '\n';
}

/// Unit of a parameter and, for a limit, its natural value.
std::string unitOf(const EffectParameter& parameter, double value) {
  if (!parameter.reciprocal() || value == 0.0) return parameter.unit;
  char limit[40];
  std::snprintf(limit, sizeof limit, "%.4g", naturalValue(parameter, value));
  return parameter.unit + ": " + parameter.natural_name + " " + limit + " " +
         parameter.natural_unit;
}

/// Whether an effect does nothing: shapes, such as the time of a change, have no effect alone.
bool isOff(const ModelDocument& document, const Effect& effect) {
  return !isOn(effect, document.vehicle.effects, document.measurement);
}

void writeEffects(std::ostringstream& out, const ModelDocument& document, EffectKind kind,
                  const std::string& key) {
  bool any = false;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != kind || isOff(document, effect)) continue;
    if (!any) out << key << ":\n";
    any = true;
    out << "  " << effect.name << ":  # " << effect.sentence << '\n';
    for (const EffectParameter& parameter : effect.parameters) {
      const double value = valueOf(document, parameter);
      line(out, "    " + parameter.name, value, unitOf(parameter, value));
    }
  }
}

/// The model's effects that files describe, so that it can be read without those files.
void writeCatalogue(std::ostringstream& out, const ModelDocument& document) {
  bool any = false;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.law == nullptr || isOff(document, effect)) continue;
    if (!any) out << "catalogue:  # effects below that the catalogue had from files\n";
    any = true;
    std::istringstream lines(formatEffect(entryOf(effect)));
    std::string text;
    for (const char* indent = "  - "; std::getline(lines, text); indent = "    ")
      out << indent << text << '\n';
  }
}

/// An angle [rad] in degrees that reads back as the same one.
std::string degrees(double angle) {
  const double nearest = toDegrees(angle);
  for (double up = nearest, down = nearest; up - down < 1e-9;
       up = std::nextafter(up, 1e3), down = std::nextafter(down, -1e3))
    for (const double value : {up, down})
      if (toRadians(value) == angle) return formatNumber(value);
  return formatNumber(nearest);
}

void writeWheels(std::ostringstream& out, const OmniWheels& wheels) {
  out << "wheels:  # m, deg\n";
  for (const OmniWheel& wheel : wheels.wheels())
    out << "  - {position: [" << formatNumber(wheel.x) << ", " << formatNumber(wheel.y)
        << "], heading: " << degrees(wheel.heading) << ", rollers: " << degrees(wheel.rollers)
        << "}\n";
}

void writeNominal(std::ostringstream& out, const VehicleModel& model) {
  const bool power = model.kind == CommandKind::kPower;
  out << "name: " << formatText(model.name) << '\n';
  out << "kind: " << (power ? "power" : "track_speed") << '\n';
  if (power) line(out, "full_speed", model.full_speed, "m/s, track speed at power 1");
  if (model.isOmni()) {
    writeWheels(out, model.wheels);
    line(out, "sideways_gain", model.sideways_gain, "ground speed over that of the rims");
  } else {
    line(out, "gauge", model.gauge,
         model.isCar() ? "m, between the rear wheels" : "m, between the middles of the tracks");
  }
  if (model.isCar()) {
    line(out, "wheelbase", model.wheelbase,
         "m, of a car; the second command is its steering angle");
    line(out, "steering_lag", model.steering_lag, "s, time constant of the steering");
    line(out, "steering_gain", model.steering_gain, "angle of the wheels over the commanded one");
  }
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

void writeUnnamed(std::ostringstream& out, const std::vector<UnnamedTerm>& terms) {
  if (!terms.empty()) out << "unnamed:  # what drives show and no effect of the catalogue names\n";
  for (const UnnamedTerm& term : terms) {
    out << "  - name: " << term.name << "\n    channel: " << termChannelName(term.channel)
        << "\n    condition: " << formatText(term.condition->name) << "  # " << term.condition->unit
        << '\n';
    if (term.times != nullptr)
      out << "    times: " << formatText(term.times->name) << "  # " << term.times->unit
          << "\n    times_range: " << list({term.times_low, term.times_high})
          << "  # as driven, constant beyond\n";
    out << "    at: " << list(term.at) << "  # of the condition, as driven, constant beyond\n"
        << "    values: " << list(term.values) << "  # " << termChannelUnit(term.channel)
        << (term.times != nullptr ? std::string(" per ") + term.times->unit : "")
        << ", straight between\n";
  }
}

void writeEstimate(std::ostringstream& out, const ModelDocument& document) {
  if (!document.bounds.empty()) out << "bounds:  # narrower than what is plausible\n";
  for (const ParameterBounds& bounds : document.bounds)
    out << "  " << bounds.parameter << ": " << list({bounds.min, bounds.max}) << '\n';
  if (document.rest)
    out << "rest:" << (document.rest->empty() ? " []" : "")
        << "  # what it did not explain, in m/s or rad/s per unit of the condition\n";
  for (const RestTerm& term : document.rest.value_or(std::vector<RestTerm>{}))
    out << "  - {channel: " << formatText(term.channel)
        << ", condition: " << formatText(term.condition) << ", size: " << formatNumber(term.size)
        << ", deviation: " << formatNumber(term.deviation) << "}\n";
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
  for (const EffectDecision& decision : provenance.decisions) {
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

void readEffects(ConfigReader& effects, EffectValues& values) {
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != EffectKind::kVehicle) continue;
    const bool added = effect.law != nullptr && effects.has(effect.name);
    ConfigReader section = effects.section(effect.name);
    for (const EffectParameter& parameter : effect.parameters) {
      double& value = valueIn(values, parameter);
      if (added && parameter.role == ParameterRole::kShape) value = parameter.typical;
      readParameter(section, parameter, value);
    }
  }
}

const Effect& effectOrGuess(const std::string& name) {
  if (const Effect* effect = findEffect(name)) return *effect;
  std::vector<std::string> names;
  for (const Effect& effect : effectCatalogue()) names.push_back(effect.name);
  const auto meant = nearestSpelling(name, names);
  throw std::runtime_error(
      "'" + name + "' is no effect of the catalogue; " +
      (meant ? "did you mean " + *meant + "?" : "tread-gap explain lists them"));
}

ModelDocument readModelDocument(const std::string& path) {
  return readDocument(ConfigReader::fromFile(path));
}

ModelDocument parseModelDocument(const std::string& text, const std::string& name) {
  return readDocument(ConfigReader::fromText(text, name));
}

ModelDocument readTrackModelDocument(const std::string& path) {
  ModelDocument document = readModelDocument(path);
  if (document.vehicle.isOmni())
    throw ConfigError(path +
                      ": is a model of a holonomic base (wheels); give one of two tracks or a car");
  return document;
}

VehicleModel readModelFile(const std::string& path) {
  return readModelDocument(path).vehicle;
}

std::string formatModelDocument(const ModelDocument& document) {
  std::ostringstream out;
  writeNominal(out, document.vehicle);
  writeCatalogue(out, document);
  writeEffects(out, document, EffectKind::kVehicle, "effects");
  writeEffects(out, document, EffectKind::kMeasurement, "measurement");
  writeUnnamed(out, document.vehicle.unnamed);
  writeSpread(out, document.vehicle.spread);
  writeEstimate(out, document);
  writeProvenance(out, document.provenance);
  if (document.envelope) writeEnvelope(out, *document.envelope);
  return out.str();
}

}  // namespace tread

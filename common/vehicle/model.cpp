// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model_document.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace tread {
namespace {

void warn(const char* what, const char* unit, double known, double asked,
          std::vector<std::string>& warnings) {
  if (asked <= known) return;
  char line[160];
  std::snprintf(line, sizeof line,
                "%s up to %.3g %s is asked for, the model was made from up to %.3g %s: beyond it "
                "is guesswork",
                what, asked, unit, known, unit);
  warnings.push_back(line);
}

}  // namespace

Followed follow(double value, double target, double lag, double dt) {
  if (lag <= 0.0) return {target, target};
  const double decay = std::exp(-dt / lag);
  const double distance = value - target;
  return {target + distance * (1.0 - decay) * lag / dt, target + distance * decay};
}

Followed follow(double value, const MovingTarget& target, double lag, double dt) {
  if (lag <= 0.0) return {target.mean, target.to};
  // With s = t / dt the target is from + slope s + bend s^2; the steady response is target - lag
  // target' + lag^2 target''.
  const double bend = 3.0 * (target.from + target.to) - 6.0 * target.mean;
  const double slope = target.to - target.from - bend;
  const double share = lag / dt;
  if (share > 1e4) return follow(value, target.mean, lag, dt);  // rounding
  const double bent = 2.0 * share * share * bend;
  const double behind_from = target.from - share * slope + bent;
  const double behind_to = target.to - share * (slope + 2.0 * bend) + bent;
  const double end = behind_to + (value - behind_from) * std::exp(-dt / lag);
  return {target.mean - share * (end - value), end};
}

Followed followRamp(double value, double& ramp, double target, double inverse_limit, double lag,
                    double dt) {
  const double way = target - ramp;
  const double rising = std::min(dt, std::abs(way) * inverse_limit);
  const double from = ramp;
  ramp = rising < dt ? target : from + std::copysign(dt / inverse_limit, way);
  if (rising <= 0.0) return follow(value, target, lag, dt);
  const Followed first = follow(value, {from, 0.5 * (from + ramp), ramp}, lag, rising);
  if (rising >= dt) return first;
  const Followed rest = follow(first.end, target, lag, dt - rising);
  return {(first.mean * rising + rest.mean * (dt - rising)) / dt, rest.end};
}

ExecutionNoise drawNoise(const ExecutionSpread& spread, std::mt19937_64& random) {
  std::normal_distribution<double> standard;
  ExecutionNoise noise;
  noise.forward = 1.0 + spread.forward * standard(random);
  noise.yaw = 1.0 + spread.yaw * standard(random);
  noise.crab = spread.crab * standard(random);
  return noise;
}

void Envelope::include(const Twist2& v_body) {
  v = std::max(v, std::abs(v_body.v_x));
  omega = std::max(omega, std::abs(v_body.omega));
  v_omega = std::max(v_omega, std::abs(v_body.v_x * v_body.omega));
}

std::vector<std::string> warningsOutside(const Envelope& known, const Envelope& asked) {
  std::vector<std::string> warnings;
  warn("speed", "m/s", known.v, asked.v, warnings);
  warn("yaw rate", "rad/s", known.omega, asked.omega, warnings);
  warn("speed times yaw rate", "m/s2", known.v_omega, asked.v_omega, warnings);
  return warnings;
}

Envelope envelopeOf(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                    double period, const EntryState& entry) {
  VehicleKernel kernel(model, entry);
  Envelope envelope;
  envelope.include(kernel.twist());
  for (const TrackCommand& command : commands) {
    kernel.step(command, period);
    envelope.include(kernel.twist());
  }
  return envelope;
}

double& valueOf(ModelDocument& document, const EffectParameter& parameter) {
  return parameter.measured != nullptr ? document.measurement.*parameter.measured
                                       : valueIn(document.vehicle.effects, parameter);
}

double valueOf(const ModelDocument& document, const EffectParameter& parameter) {
  return valueOf(const_cast<ModelDocument&>(document), parameter);
}

namespace {

const std::string kRest = "rest.";

/// The number that is the whole rest of a path after its beginning.
std::optional<size_t> numberAfter(const std::string& beginning, const std::string& path) {
  size_t number = 0;
  const char* const end = path.data() + path.size();
  if (path.compare(0, beginning.size(), beginning) != 0) return std::nullopt;
  const auto [last, error] = std::from_chars(path.data() + beginning.size(), end, number);
  return error == std::errc{} && last == end ? std::optional(number) : std::nullopt;
}

}  // namespace

std::string restPath(size_t term) {
  return kRest + std::to_string(term);
}

std::optional<size_t> restTermOf(const std::string& path) {
  return numberAfter(kRest, path);
}

namespace {

UnnamedTerm* termOf(ModelDocument& document, const std::string& name) {
  for (UnnamedTerm& term : document.vehicle.unnamed)
    if (term.name == name) return &term;
  return nullptr;
}

/// The value of an unnamed term at a path.
double* termValue(ModelDocument& document, const std::string& path) {
  UnnamedTerm* term = termOf(document, path.substr(0, path.find('.')));
  if (term == nullptr) return nullptr;
  const auto value = numberAfter(term->name + ".", path);
  return value && *value < term->values.size() ? &term->values[*value] : nullptr;
}

}  // namespace

const UnnamedTerm* termOfPath(const ModelDocument& document, const std::string& path) {
  ModelDocument& changeable = const_cast<ModelDocument&>(document);
  return termValue(changeable, path) == nullptr
             ? nullptr
             : termOf(changeable, path.substr(0, path.find('.')));
}

std::string termPath(const UnnamedTerm& term, size_t value) {
  return term.name + "." + std::to_string(value);
}

std::string problemWithTermName(const ModelDocument& document, const std::string& name) {
  const bool plain =
      !name.empty() && name.size() <= 40 && name[0] >= 'a' && name[0] <= 'z' &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!plain)
    return "'" + name + "' is no name of a term; write a-z, 0-9 and _, a letter first, at most 40";
  if (findEffect(name) != nullptr || name == "rest" || findParameter(document, name) != nullptr)
    return "'" + name + "' names something else already; choose another name";
  if (termOf(const_cast<ModelDocument&>(document), name) != nullptr)
    return "the model has a term '" + name + "' already; choose another name";
  return "";
}

void renameTerm(ModelDocument& document, const std::string& from, const std::string& to) {
  UnnamedTerm* term = termOf(document, from);
  if (term == nullptr) {
    std::string known;
    for (const UnnamedTerm& other : document.vehicle.unnamed)
      known += (known.empty() ? "" : ", ") + other.name;
    throw std::runtime_error("the model has no term '" + from + "'; " +
                             (known.empty() ? "it has none" : "it has " + known));
  }
  const std::string problem = problemWithTermName(document, to);
  if (!problem.empty()) throw std::runtime_error(problem);
  const auto rename = [&](std::string& path) {
    if (path.compare(0, from.size() + 1, from + ".") == 0) path = to + path.substr(from.size());
  };
  for (std::string& path : document.covariance.parameters) rename(path);
  for (ParameterBounds& bounds : document.bounds) rename(bounds.parameter);
  term->name = to;
}

std::vector<std::string> calibratedNumbers(VehicleLayout layout) {
  std::vector<std::string> numbers{"lag", "delay", "forward_gain"};
  if (layout == VehicleLayout::kCar) {
    numbers.insert(numbers.end(), {"steering_gain", "steering_lag"});
    return numbers;
  }
  numbers.push_back("yaw_gain");
  if (layout == VehicleLayout::kOmni) numbers.push_back("sideways_gain");
  return numbers;
}

double* findParameter(ModelDocument& document, const std::string& path) {
  static const std::map<std::string, double VehicleModel::*> nominal{
      {"lag", &VehicleModel::lag},
      {"delay", &VehicleModel::delay},
      {"gauge", &VehicleModel::gauge},
      {"full_speed", &VehicleModel::full_speed},
      {"forward_gain", &VehicleModel::forward_gain},
      {"yaw_gain", &VehicleModel::yaw_gain},
      {"sideways_gain", &VehicleModel::sideways_gain},
      {"steering_gain", &VehicleModel::steering_gain},
      {"steering_lag", &VehicleModel::steering_lag}};
  const auto number = nominal.find(path);
  if (number != nominal.end()) return &(document.vehicle.*number->second);
  if (const auto term = restTermOf(path))
    return document.rest && *term < document.rest->size() ? &(*document.rest)[*term].size : nullptr;
  if (const EffectParameter* parameter = findEffectParameter(path))
    return &valueOf(document, *parameter);
  return termValue(document, path);
}

const double* findParameter(const ModelDocument& document, const std::string& path) {
  return findParameter(const_cast<ModelDocument&>(document), path);
}

std::string unitOf(const std::string& path) {
  if (const EffectParameter* parameter = findEffectParameter(path)) return parameter->unit;
  if (path == "lag" || path == "delay" || path == "steering_lag") return "s";
  if (path == "full_speed") return "m/s";
  return path == "gauge" ? "m" : "1";
}

std::optional<ParameterBounds> plausibleBounds(const ModelDocument& document,
                                               const std::string& path) {
  for (const ParameterBounds& bounds : document.bounds)
    if (bounds.parameter == path) return bounds;
  const EffectParameter* parameter = findEffectParameter(path);
  if (parameter == nullptr) return std::nullopt;
  const double min =
      parameter->adds_to != nullptr ? -(document.vehicle.*parameter->adds_to) : parameter->min;
  if (parameter->gauges <= 0.0) return ParameterBounds{path, min, parameter->max};
  const double far = parameter->gauges * document.vehicle.gauge;
  return ParameterBounds{path, std::max(min, -far), std::min(parameter->max, far)};
}

}  // namespace tread

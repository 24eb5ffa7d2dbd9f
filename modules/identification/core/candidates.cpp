// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tread::gap {
namespace {

constexpr double kGravity = 9.81;     // [m/s2]
constexpr double kSmallProbe = 0.25;  // of the typical value: smooth effects are straight there
constexpr double kVanished = 2e-3;    // of an effect's typical size
constexpr int kMoments = 15;          // at which a change is looked for
constexpr double kEdge = 0.06;        // share of the drive without moments at either end

double& numberIn(ModelDocument& model, const std::string& path) {
  return *findParameter(model, path);
}

/// Reciprocals of limits that bite: just, and more and more.
std::vector<double> limitsBelow(double most) {
  std::vector<double> probes;
  if (most <= 0.0) return probes;
  for (double share : {0.92, 0.8, 0.65, 0.45}) probes.push_back(1.0 / (share * most));
  return probes;
}

std::vector<double> probesOf(const Effect& effect, const EffectParameter& parameter,
                             const Excitation& most) {
  if (effect.name == "speed_saturation") return limitsBelow(most.track_speed);
  if (effect.name == "turn_power_limit") return limitsBelow(most.omega);
  if (effect.name == "grip_limit") {
    std::vector<double> probes = limitsBelow(most.v_omega);
    for (double& probe : probes) probe *= kGravity;
    return probes;
  }
  if (effect.name != "command_delay" && !parameter.probes.empty()) return parameter.probes;
  return {kSmallProbe * parameter.typical};
}

/// With what values of other parameters a strength is tried.
struct Setting {
  std::vector<std::pair<std::string, double>> shapes;
  double since = kNotMeasured;
};

/// Changes at moments all over the drive, later than `after`.
std::vector<Setting> momentsFor(const std::string& path, const Excitation& most, double after) {
  std::vector<Setting> moments;
  const double length = most.end - most.begin;
  for (int i = 0; i < kMoments; ++i) {
    const double share = kEdge + (1.0 - 2.0 * kEdge) * i / (kMoments - 1.0);
    const double moment = most.begin + share * length;
    if (moment > after) moments.push_back({{{path, moment}}, moment});
  }
  return moments;
}

/// A second change of ground begins as a repetition of the first.
std::vector<Setting> secondChanges(const EffectValues& effects, const Excitation& most) {
  auto moments = momentsFor("terrain_change.time_2", most, effects.terrain_time_1 + 1.0);
  for (Setting& moment : moments) {
    moment.shapes.emplace_back("terrain_change.width_2", effects.terrain_width_1);
    moment.shapes.emplace_back("terrain_change.slip_2", effects.terrain_slip_1);
    moment.shapes.emplace_back("terrain_change.breakaway_2", effects.terrain_breakaway_1);
  }
  return moments;
}

std::vector<Setting> settingsFor(const std::string& effect, const std::string& parameter,
                                 const ModelDocument& model, const Excitation& most) {
  if (effect == "payload_change") return momentsFor("payload_change.time", most, -1.0);
  if (effect == "terrain_change")
    return parameter.back() == '2' ? secondChanges(model.vehicle.effects, most)
                                   : momentsFor("terrain_change.time_1", most, -1.0);
  if (effect == "thermal_derating") {
    std::vector<Setting> times;
    for (double time : {60.0, 240.0, 900.0})
      times.push_back({{{"thermal_derating.time_constant", time}}});
    return times;
  }
  if (effect == "ins_latency")
    return {{{{"ins_latency.gyro_share", 0.0}}}, {{{"ins_latency.gyro_share", 1.0}}}};
  if (effect == "gyro_bias")
    return {{{{"gyro_bias.heading_share", 0.0}}}, {{{"gyro_bias.heading_share", 1.0}}}};
  return {{}};
}

/// What is fitted together with a strength.
std::vector<std::string> freedWith(const std::string& effect, const std::string& parameter) {
  if (effect == "payload_change") return {"payload_change.yaw", "payload_change.speed"};
  if (effect == "thermal_derating")
    return {"thermal_derating.loss", "thermal_derating.time_constant"};
  if (effect == "terrain_change") {
    const std::string number = parameter.substr(parameter.size() - 1);
    return {"terrain_change.width_" + number, "terrain_change.slip_" + number};
  }
  return {effect + "." + parameter};
}

bool firstChangeOn(const EffectValues& effects) {
  return effects.terrain_width_1 != 0.0 || effects.terrain_slip_1 != 0.0 ||
         effects.terrain_breakaway_1 != 0.0;
}

bool secondChangeOn(const EffectValues& effects) {
  return effects.terrain_width_2 != 0.0 || effects.terrain_slip_2 != 0.0 ||
         effects.terrain_breakaway_2 != 0.0;
}

/// Whether a strength of an effect can be switched on in this model.
bool isOpen(const Effect& effect, const EffectParameter& parameter, const ModelDocument& model,
            const Excitation& most) {
  if (parameter.role == ParameterRole::kShape) return false;
  const EffectValues& effects = model.vehicle.effects;
  // A load that only moves its centre looks like the centre itself from early on.
  if (effect.name == "payload_change" && parameter.name == "icr") return false;
  if (effect.name == "terrain_change") {
    if (parameter.name.find("breakaway") == 0) return false;
    const bool second = parameter.name.back() == '2';
    return second ? firstChangeOn(effects) && !secondChangeOn(effects) : !firstChangeOn(effects);
  }
  if (parameter.name == "per_drop" && !most.voltage) return false;
  return !isOn(effect, effects, model.measurement);
}

/// All directions of an effect that can be switched on.
void addCandidates(const Effect& effect, const ModelDocument& model, const Excitation& most,
                   std::vector<Candidate>& all) {
  for (const EffectParameter& parameter : effect.parameters) {
    if (!isOpen(effect, parameter, model, most)) continue;
    for (double change : probesOf(effect, parameter, most))
      for (const Setting& setting : settingsFor(effect.name, parameter.name, model, most)) {
        double begin = 0.0;
        for (const auto& [path, value] : setting.shapes)
          if (path == effect.name + "." + parameter.name) begin = value;
        all.push_back({effect.name, parameter.name, begin + change, change, setting.since,
                       setting.shapes, freedWith(effect.name, parameter.name),
                       std::isfinite(setting.since) ? setting.shapes.front().first : ""});
      }
  }
}

bool isNominalFree(const FitState& state) {
  return std::any_of(state.free.begin(), state.free.end(), [](const FreeParameter& parameter) {
    return parameter.path.find('.') == std::string::npos && std::isinf(parameter.deviation);
  });
}

/// Terms that are on, held by what is known of them, may be others now.
void addReleases(const FitState& state, std::vector<Candidate>& candidates) {
  for (const FreeParameter& held : state.free) {
    const size_t dot = held.path.find('.');
    if (dot == std::string::npos || !std::isfinite(held.deviation)) continue;
    Candidate release;
    release.effect = held.path.substr(0, dot);
    release.parameter = held.path.substr(dot + 1);
    release.change = held.step;
    release.value = *findParameter(state.model, held.path) + held.step;
    release.release = true;
    candidates.push_back(release);
  }
}

/// Effects that are a number of the nominal model under another name.
void forgetNominal(std::vector<Candidate>& candidates) {
  static const std::set<std::string> kNumbers{"slip_ratio", "track_width", "actuator_lag",
                                              "command_delay"};
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [](const Candidate& candidate) {
                                    return kNumbers.count(candidate.effect) != 0;
                                  }),
                   candidates.end());
}

}  // namespace

Excitation excitationOf(const Rows& rows, const ModelDocument& model) {
  Excitation most;
  most.begin = std::numeric_limits<double>::infinity();
  for (const Drive& drive : rows.drives()) {
    most.voltage = most.voltage || !drive.voltage.empty();
    for (const Stretch& stretch : drive.stretches) {
      most.begin = std::min(most.begin, stretch.begin());
      most.end = std::max(most.end, stretch.end);
      for (const CommandSample& sample : stretch.commands) {
        const TrackCommand asked = model.vehicle.trackSpeeds(sample.command);
        most.track_speed =
            std::max({most.track_speed, std::abs(asked.left), std::abs(asked.right)});
      }
    }
  }
  for (const std::vector<MotionSample>& motion : rows.simulate(model.vehicle)) {
    for (size_t i = 1; i < motion.size(); ++i) {
      const double dt = motion[i].time - motion[i - 1].time;
      if (dt <= 0.0) continue;
      const Pose2 moved = between(motion[i - 1].T_map_body, motion[i].T_map_body);
      most.omega = std::max(most.omega, std::abs(moved.yaw) / dt);
      most.v_omega = std::max(most.v_omega, std::abs(moved.yaw * moved.x) / (dt * dt));
    }
  }
  return most;
}

std::vector<Candidate> candidatesFor(const ModelDocument& model, const Excitation& most) {
  static const std::set<std::string> kSecondNames{"crab", "yaw_rate_offset"};
  std::vector<Candidate> all;
  for (const Effect& effect : effectCatalogue())
    if (kSecondNames.count(effect.name) == 0) addCandidates(effect, model, most, all);
  return all;
}

std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& most) {
  std::vector<Candidate> candidates = candidatesFor(state.model, most);
  addReleases(state, candidates);
  if (isNominalFree(state)) forgetNominal(candidates);
  return candidates;
}

std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& most) {
  std::vector<Candidate> candidates;
  addCandidates(effectNamed(effect), state.model, most, candidates);
  if (isNominalFree(state)) forgetNominal(candidates);
  return candidates;
}

void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects) {
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&effects](const Candidate& candidate) {
                                    return std::find(effects.begin(), effects.end(),
                                                     candidate.effect) != effects.end();
                                  }),
                   candidates.end());
}

ModelDocument tried(const ModelDocument& model, const Candidate& candidate) {
  ModelDocument changed = model;
  for (const auto& [path, value] : candidate.shapes) numberIn(changed, path) = value;
  numberIn(changed, candidate.effect + "." + candidate.parameter) = candidate.value;
  return changed;
}

Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates) {
  Eigen::MatrixXd directions(state.predicted.size(), static_cast<Eigen::Index>(candidates.size()));
  // A change later on has the direction of the earliest one, from its own moment on.
  std::map<std::pair<std::string, double>, size_t> earliest;
  std::vector<size_t> simulated;
  std::vector<size_t> source(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) {
    source[i] = i;
    const Candidate& candidate = candidates[i];
    if (std::isfinite(candidate.since))
      source[i] =
          earliest.try_emplace({candidate.effect + "." + candidate.parameter, candidate.change}, i)
              .first->second;
    if (source[i] == i) simulated.push_back(i);
  }
  inParallel(simulated.size(), fitter.threads(), [&](size_t n) {
    const size_t i = simulated[n];
    directions.col(static_cast<Eigen::Index>(i)) =
        fitter.secant(state, tried(state.model, candidates[i]), candidates[i].change);
  });
  const std::vector<Row>& rows = fitter.rows().rows();
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (source[i] == i) continue;
    const auto column = static_cast<Eigen::Index>(i);
    directions.col(column) = directions.col(static_cast<Eigen::Index>(source[i]));
    for (size_t row = 0; row < rows.size(); ++row)
      if (rows[row].end <= candidates[i].since)
        directions(static_cast<Eigen::Index>(row), column) = 0.0;
  }
  return directions;
}

void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size,
                  const std::vector<char>& mask) {
  const std::string strength = candidate.effect + "." + candidate.parameter;
  if (candidate.release) {
    for (FreeParameter& held : state.free)
      if (held.path == strength) held.deviation = std::numeric_limits<double>::infinity();
    return;
  }
  for (const auto& [path, value] : candidate.shapes) numberIn(state.model, path) = value;
  // Thresholds begin at their probe, whose slope is known; the others at their first order size.
  const EffectParameter& known = parameterNamed(effectNamed(candidate.effect), candidate.parameter);
  const bool threshold =
      known.reciprocal() || (!known.probes.empty() && candidate.effect != "command_delay");
  const double from = candidate.value - candidate.change;
  const double begin =
      threshold ? candidate.value : std::clamp(from + size, known.min * 0.9, known.max * 0.9);
  for (const std::string& path : candidate.free) {
    FreeParameter parameter = freeParameter(state.model, path);
    double value = *findParameter(state.model, path);
    if (path == strength) value = begin == 0.0 ? 0.1 * known.typical : begin;
    parameter.expected = 0.0;
    fitter.add(state, parameter, value, mask);
  }
}

bool isVanishing(const std::string& effect, const std::string& parameter, double size) {
  return std::abs(size) <
         kVanished * std::abs(parameterNamed(effectNamed(effect), parameter).typical);
}

bool hasMoment(const std::string& effect) {
  return effect == "payload_change" || effect == "terrain_change";
}

}  // namespace tread::gap

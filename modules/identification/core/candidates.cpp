// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "modules/identification/core/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace tread::gap {
namespace {

constexpr double kGravity = 9.81;     // [m/s2]
constexpr double kSmallProbe = 0.25;  // of the typical value: smooth effects are linear up to there
constexpr double kVanished = 2e-3;    // of an effect's typical size
constexpr int kChanges = 15;          // number of times tested for a change
constexpr double kElsewhere = 0.1;    // of a given value: closer ones are covered by the slope
constexpr double kEdge = 0.06;        // share of the drive without changes at either end

/// The largest demand of a drive on a limited quantity, in the unit of the limit.
double demandOn(LimitedQuantity limited, const Excitation& most) {
  if (limited == LimitedQuantity::kTrackSpeed) return most.track_speed;
  return limited == LimitedQuantity::kYawRate ? most.omega : most.v_omega;
}

std::vector<double> probesOf(const EffectParameter& parameter, const Excitation& most) {
  if (parameter.limited == LimitedQuantity::kNone)
    return parameter.probes.empty() || parameter.search_from_slope
               ? std::vector<double>{kSmallProbe * parameter.typical}
               : parameter.probes;
  // Reciprocals of limits that act: slightly, and increasingly.
  std::vector<double> probes;
  const double demand = demandOn(parameter.limited, most);
  if (demand <= 0.0) return probes;
  for (double share : {0.92, 0.8, 0.65, 0.45}) {
    probes.push_back(1.0 / (share * demand));
    // A grip limit is a share of gravity.
    if (parameter.limited == LimitedQuantity::kLateralAcceleration) probes.back() *= kGravity;
  }
  return probes;
}

/// Values of other parameters with which a strength is tested.
struct Setting {
  std::vector<std::pair<std::string, double>> shapes;
  double since = kNotMeasured;
};

/// The change point at which a strength begins to act; none = it always acts.
const ChangePoint* changePointOf(const Effect& effect, const std::string& strength) {
  for (const ChangePoint& change : effect.search.change_points)
    if (contains(change.strengths, strength)) return &change;
  return nullptr;
}

/// The change point before another one of the same effect; none before the first.
const ChangePoint* previousTo(const Effect& effect, const ChangePoint& change) {
  return &change == &effect.search.change_points.front() ? nullptr : &change - 1;
}

/// Changes at times throughout the drive, later than the previous change of the same effect, which
/// they first repeat.
std::vector<Setting> changesOf(const Effect& effect, const ChangePoint& change,
                               const ModelDocument& model, const Excitation& most) {
  const ChangePoint* previous = previousTo(effect, change);
  const auto valueOf = [&](const std::string& name) {
    return *findParameter(model, effect.name + "." + name);
  };
  const double after = previous != nullptr ? valueOf(previous->time) + 1.0 : -1.0;
  std::vector<Setting> settings;
  const double length = most.end - most.begin;
  for (int i = 0; i < kChanges; ++i) {
    const double share = kEdge + (1.0 - 2.0 * kEdge) * i / (kChanges - 1.0);
    const double time = most.begin + share * length;
    if (time <= after) continue;
    settings.push_back({{{effect.name + "." + change.time, time}}, time});
    for (size_t n = 0; previous != nullptr && n < change.strengths.size(); ++n)
      settings.back().shapes.emplace_back(effect.name + "." + change.strengths[n],
                                          valueOf(previous->strengths[n]));
  }
  return settings;
}

std::vector<Setting> settingsFor(const Effect& effect, const std::string& strength,
                                 const ModelDocument& model, const Excitation& most) {
  if (const ChangePoint* change = changePointOf(effect, strength))
    return changesOf(effect, *change, model, most);
  for (const EffectParameter& shape : effect.parameters) {
    if (shape.role != ParameterRole::kShape) continue;
    std::vector<Setting> settings;
    for (double value : shape.probes)
      settings.push_back({{{effect.name + "." + shape.name, value}}});
    return settings;
  }
  return {{}};
}

/// Parameters fitted together with a strength.
std::vector<std::string> freedWith(const Effect& effect, const std::string& strength) {
  std::vector<std::string> names{strength};
  if (const ChangePoint* change = changePointOf(effect, strength))
    names.assign(change->strengths.begin(),
                 change->strengths.begin() + static_cast<std::ptrdiff_t>(change->fitted));
  for (const EffectParameter& shape : effect.parameters)
    if (shape.fitted) names.push_back(shape.name);
  for (std::string& name : names) name = effect.name + "." + name;
  return names;
}

/// Whether a strength of an effect can be switched on in this model.
bool isOpen(const Effect& effect, const EffectParameter& parameter, const ModelDocument& model,
            const Excitation& most) {
  if (parameter.role == ParameterRole::kShape || !effect.isOf(model.vehicle.layout())) return false;
  // A measured battery voltage itself shows the state of charge.
  const bool by_voltage = std::any_of(effect.parameters.begin(), effect.parameters.end(),
                                      [](const EffectParameter& one) { return one.needs_voltage; });
  if (by_voltage && parameter.needs_voltage != most.voltage) return false;
  const ChangePoint* change = changePointOf(effect, parameter.name);
  if (change == nullptr) return !isOn(effect, model);
  // The other strengths, for instance of a load that only shifts its centre, resemble a constant
  // from early on.
  const auto tested = change->strengths.begin() + static_cast<std::ptrdiff_t>(change->fitted);
  if (std::find(change->strengths.begin(), tested, parameter.name) == tested) return false;
  const ChangePoint* previous = previousTo(effect, *change);
  return !hasChanged(effect, *change, model) &&
         (previous == nullptr || hasChanged(effect, *previous, model));
}

/// All directions of an effect that can be switched on.
void addCandidates(const Effect& effect, const ModelDocument& model, const Excitation& most,
                   std::vector<Candidate>& all) {
  for (const EffectParameter& parameter : effect.parameters) {
    if (!isOpen(effect, parameter, model, most)) continue;
    for (double change : probesOf(parameter, most))
      for (const Setting& setting : settingsFor(effect, parameter.name, model, most)) {
        double begin = 0.0;
        for (const auto& [path, value] : setting.shapes)
          if (path == effect.name + "." + parameter.name) begin = value;
        all.push_back({effect.name, parameter.name, begin + change, change, setting.since,
                       setting.shapes, freedWith(effect, parameter.name),
                       std::isfinite(setting.since) ? setting.shapes.front().first : ""});
      }
  }
}

bool isNominalFree(const FitState& state) {
  return std::any_of(state.free.begin(), state.free.end(), [](const FreeParameter& parameter) {
    return parameter.path.find('.') == std::string::npos && std::isinf(parameter.deviation);
  });
}

Candidate releaseOf(const FreeParameter& term, double from, double to) {
  const size_t dot = term.path.find('.');
  Candidate release;
  release.effect = term.path.substr(0, dot);
  release.parameter = term.path.substr(dot + 1);
  release.change = to - from;
  release.value = to;
  release.release = true;
  return release;
}

/// Terms that are on may have changed: those with priors slightly, and limits and thresholds to
/// values that the drive would reach.
void addGivenTerms(const FitState& state, const Excitation& most,
                   std::vector<Candidate>& candidates) {
  for (const FreeParameter& term : state.free) {
    const EffectParameter* known = findEffectParameter(term.path);
    if (known == nullptr) continue;
    const double value = *findParameter(state.model, term.path);
    if (std::isfinite(term.deviation))
      candidates.push_back(releaseOf(term, value, value + term.step));
    if (!isGiven(term) || known->probes.empty() || known->search_from_slope) continue;
    for (const double probe : probesOf(*known, most)) {
      if (std::abs(probe - value) < kElsewhere * std::abs(value)) continue;
      candidates.push_back(releaseOf(term, value, probe));
      candidates.back().elsewhere = true;
    }
  }
}

void takeOut(std::vector<Candidate>& candidates,
             const std::function<bool(const Candidate&)>& which) {
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), which), candidates.end());
}

/// Free parameters of a state are no candidates, even if a fit has set their size to 0.
void forgetFree(const FitState& state, std::vector<Candidate>& candidates) {
  const auto isFree = [&state](const std::string& path) {
    return std::any_of(state.free.begin(), state.free.end(),
                       [&path](const FreeParameter& free) { return free.path == path; });
  };
  takeOut(candidates, [&](const Candidate& candidate) {
    return std::any_of(candidate.free.begin(), candidate.free.end(), isFree);
  });
}

/// Removes effects that equal a number of the nominal model.
void forgetNominal(std::vector<Candidate>& candidates) {
  takeOut(candidates, [](const Candidate& candidate) {
    return !effectNamed(candidate.effect).search.nominal.empty();
  });
}

}  // namespace

Excitation excitationOf(const Observations& data, const ModelDocument& model) {
  Excitation most;
  most.begin = std::numeric_limits<double>::infinity();
  most.voltage = !data.drives().empty();
  for (const Drive& drive : data.drives()) {
    most.voltage = most.voltage && isMeasured(drive.voltage);
    for (const Segment& segment : drive.segments) {
      most.begin = std::min(most.begin, segment.begin());
      most.end = std::max(most.end, segment.end);
      for (const CommandSample& sample : segment.commands) {
        most.track_speed =
            std::max(most.track_speed,
                     model.vehicle.unit() * driveOf(model.vehicle.layout(), sample.command));
      }
    }
  }
  for (const std::vector<MotionSample>& motion : data.simulate(model.vehicle)) {
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
  std::vector<Candidate> all;
  for (const Effect& effect : effectCatalogue())
    if (!effect.isSecondName(model.vehicle.layout()) && !effect.search.in_place)
      addCandidates(effect, model, most, all);
  return all;
}

std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& most) {
  std::vector<Candidate> candidates = candidatesFor(state.model, most);
  forgetFree(state, candidates);
  addGivenTerms(state, most, candidates);
  if (isNominalFree(state)) forgetNominal(candidates);
  return candidates;
}

std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& most) {
  std::vector<Candidate> candidates;
  addCandidates(effectNamed(effect), state.model, most, candidates);
  forgetFree(state, candidates);
  if (isNominalFree(state)) forgetNominal(candidates);
  return candidates;
}

void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects) {
  takeOut(candidates,
          [&](const Candidate& candidate) { return contains(effects, candidate.effect); });
}

ModelDocument tried(const ModelDocument& model, const Candidate& candidate) {
  ModelDocument changed = model;
  for (const auto& [path, value] : candidate.shapes) *findParameter(changed, path) = value;
  *findParameter(changed, candidate.path()) = candidate.value;
  return changed;
}

Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates) {
  Eigen::MatrixXd directions(state.predicted.size(), static_cast<Eigen::Index>(candidates.size()));
  // A later change has the direction of the earliest one, from its own time on.
  std::map<std::pair<std::string, double>, size_t> earliest;
  std::vector<size_t> simulated;
  std::vector<size_t> source(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) {
    source[i] = i;
    const Candidate& candidate = candidates[i];
    if (std::isfinite(candidate.since))
      source[i] = earliest.try_emplace({candidate.path(), candidate.change}, i).first->second;
    if (source[i] == i) simulated.push_back(i);
  }
  fitter.parallel()(simulated.size(), [&](size_t n) {
    const size_t i = simulated[n];
    directions.col(static_cast<Eigen::Index>(i)) =
        fitter.secant(state, tried(state.model, candidates[i]), candidates[i].change);
  });
  const std::vector<Observation>& data = fitter.data().all();
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (source[i] == i) continue;
    const auto column = static_cast<Eigen::Index>(i);
    directions.col(column) = directions.col(static_cast<Eigen::Index>(source[i]));
    for (size_t row = 0; row < data.size(); ++row)
      if (data[row].end <= candidates[i].since)
        directions(static_cast<Eigen::Index>(row), column) = 0.0;
  }
  return directions;
}

void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size) {
  const std::string strength = candidate.path();
  if (candidate.release) {
    for (FreeParameter& term : state.free)
      if (term.path == strength) {
        term.deviation = std::numeric_limits<double>::infinity();
        if (candidate.elsewhere) term.expected = 0.0;  // looked for once
      }
    if (!candidate.elsewhere) return;
    *findParameter(state.model, strength) = candidate.value;
    state.predicted = fitter.predict(state.model);
    fitter.renewJacobian(state);
    return;
  }
  for (const auto& [path, value] : candidate.shapes) *findParameter(state.model, path) = value;
  // Thresholds start at their probe, whose slope is known; the others at their first-order size.
  const EffectParameter& known = parameterNamed(effectNamed(candidate.effect), candidate.parameter);
  const bool threshold = known.reciprocal() || (!known.probes.empty() && !known.search_from_slope);
  const double from = candidate.value - candidate.change;
  const double begin =
      threshold ? candidate.value : std::clamp(from + size, known.min * 0.9, known.max * 0.9);
  for (const std::string& path : candidate.free) {
    FreeParameter parameter = freeParameter(state.model, path);
    double value = *findParameter(state.model, path);
    if (path == strength) value = begin == 0.0 ? 0.1 * known.typical : begin;
    parameter.expected = 0.0;
    fitter.add(state, parameter, value);
  }
}

bool isVanishing(const std::string& effect, const std::string& parameter, double size) {
  return std::abs(size) <
         kVanished * std::abs(parameterNamed(effectNamed(effect), parameter).typical);
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/vehicle/kernel.hpp"
#include "modules/identification/core/finding.hpp"
#include "tools/lab/gap/report/report.hpp"

/// Hand-made findings for testing the reports.
namespace tread::gap::samples {

inline bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

inline ModelDocument model() {
  ModelDocument model;
  model.vehicle.name = "sample";
  model.vehicle.full_speed = 1.1;
  model.vehicle.gauge = 0.6;
  model.vehicle.lag = 0.15;
  return model;
}

inline FoundEffect turnLimit() {
  FoundEffect effect;
  effect.name = "turn_power_limit";
  effect.parameters = {{"turn_power_limit.inverse_limit", "s/rad", 0.8, 0.78, 0.82, 0.0}};
  effect.runner_ups = {{"yaw_rate_skid", 21.5, 4.2}};
  effect.score = 41.0;
  effect.p_value = 0.0;
  effect.gain = 210.0;
  effect.gain_error = 21.0;
  return effect;
}

inline FoundEffect asymmetry() {
  FoundEffect effect;
  effect.name = "track_asymmetry";
  effect.parameters = {{"track_asymmetry.share", "1", -0.0298, -0.034, -0.026, 0.0}};
  effect.runner_ups = {{"yaw_pull", 3.1, 2.0}};
  effect.score = 17.0;
  effect.p_value = 0.003;
  effect.gain = 48.0;
  effect.gain_error = 9.0;
  return effect;
}

inline FoundEffect icrOffset() {
  FoundEffect effect;
  effect.name = "icr_offset";
  effect.parameters = {{"icr_offset.offset", "m", 0.11, 0.1, 0.12, 0.0}};
  effect.group = {"lever_arm_x"};
  effect.score = 22.0;
  effect.gain = 80.0;
  effect.gain_error = 9.0;
  return effect;
}

inline FoundEffect misalignment() {
  FoundEffect effect;
  effect.name = "heading_misalignment";
  effect.parameters = {{"heading_misalignment.angle", "rad", 0.05, 0.045, 0.055, 0.0}};
  effect.gain = 30.0;
  effect.gain_error = 4.0;
  return effect;
}

inline AtlasCurve curve(const std::string& channel, const std::string& variable) {
  AtlasCurve curve{channel, channel == "yaw rate" ? "rad/s" : "m/s", variable, "rad/s", {}, {}};
  for (int i = -4; i < 4; ++i) {
    const double middle = 0.5 * i + 0.25;
    const double before = -0.9 * std::copysign(std::max(0.0, std::abs(middle) - 1.2), middle);
    curve.before.push_back(
        {0.5 * i, 0.5 * i + 0.5, before, before - 0.06, before + 0.06, 40, std::abs(before) > 0.1});
    const double after = 0.01 * (i % 3);
    curve.after.push_back({0.5 * i, 0.5 * i + 0.5, after, after - 0.05, after + 0.05, 40, false});
  }
  return curve;
}

inline AtlasMap map() {
  AtlasMap map{"yaw rate", "rad/s", {-1.0, -0.5, 0.0, 0.5, 1.0}, {-2.0, -1.0, 0.0, 1.0, 2.0},
               {},         {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const bool driven = row + column > 0;
      map.before.push_back(driven ? 0.4 * (1.5 - row) : kNotMeasured);
      map.after.push_back(driven ? 0.02 * (column - row) : kNotMeasured);
    }
  return map;
}

inline Overlay overlay(double turn, double begin) {
  Overlay overlay;
  overlay.begin = begin;
  VehicleModel truth = model().vehicle;
  truth.effects.turn_power_limit = 0.8;
  const TrackCommand command{1.0 - turn, 1.0};
  const std::vector<TrackCommand> commands(40, command);
  overlay.measured = simulate(truth, commands, 0.05, steadyEntry(truth, {1.0, 1.0}));
  overlay.before = simulate(model().vehicle, commands, 0.05, steadyEntry(truth, {1.0, 1.0}));
  truth.effects.turn_power_limit = 0.85;
  overlay.after = simulate(truth, commands, 0.05, steadyEntry(truth, {1.0, 1.0}));
  const auto miss = [&](const std::vector<Pose2>& poses) {
    return (poses.back().position() - overlay.measured.back().position()).norm();
  };
  for (size_t i = 0; i < overlay.after.size(); ++i)
    overlay.band.push_back(0.004 * static_cast<double>(i));
  overlay.error_before = miss(overlay.before);
  overlay.error_after = miss(overlay.after);
  return overlay;
}

inline void addEvidence(GapFinding& finding) {
  finding.atlas.curves = {curve("yaw rate", "yaw rate"), curve("along", "speed x yaw rate")};
  finding.atlas.maps = {map()};
  for (int i = 0; i < 9; ++i) finding.shown.overlays.push_back(overlay(0.2 * i, 12.5 * i));
  for (int i = 0; i < 60; ++i)
    finding.shown.places.push_back({0, 0.1 * i, std::sin(0.2 * i), 0.1 + 0.01 * (i % 9), 0.03});
  finding.gap = Gap{2.0,
                    {{0.642, 0.91}, {0.357, 0.61}, 60},
                    {{0.451, 0.7}, {0.187, 0.31}, 60},
                    {{0.44, 0.6}, {0.3, 0.5}, 60},
                    EndErrors{{0.29, 0.41}, {0.1, 0.2}, 60},
                    true};
}

inline void addDetails(GapFinding& finding) {
  finding.identified.calibrated = {{"lag", "s", 0.17, 0.16, 0.18, 0.15},
                                   {"icr_offset.offset", "m", 0.02, 0.01, 0.03, 0.0}};
  finding.identified.not_excited = {"grip_limit", "slope_pitch"};
  finding.search.negligible = {"gyro_bias"};
  finding.search.candidates = {
      {"turn_power_limit", "inverse_limit", 41.0, 0.0, 0.8, 0.4},
      {"grip_limit", "inverse_limit", 0.1, 1.0, 0.9, std::numeric_limits<double>::infinity()},
      {"slip_ratio", "slip", 2.1, 0.4, 0.3, 0.021}};
  finding.source.log_notes = {{"a.lcmlog", "52 % of the poses repeat the one before"}};
  finding.source.blocks = 30;
  finding.source.block_length = 20.0;
  finding.adequacy.p_value = 0.41;
}

/// A finding with any verdict and everything that a report can show.
inline GapFinding finding(GapVerdict verdict) {
  GapFinding finding;
  finding.verdict = verdict;
  finding.source.seed = 7;
  finding.before = model();
  finding.identified.model = model();
  finding.identified.model.vehicle.lag = 0.17;
  finding.identified.model.covariance = {{"lag", "delay"}, {{1e-4, 0.95e-4}, {0.95e-4, 1e-4}}};
  finding.identified.model.envelope = Envelope{1.1, 2.4, 1.3};
  addDetails(finding);
  if (verdict == GapVerdict::kCannotTell) {
    finding.reason = "6 independent blocks of 20 s; 10 are needed: drive 2 minutes more";
    return finding;
  }
  addEvidence(finding);
  if (verdict == GapVerdict::kFound || verdict == GapVerdict::kPartial)
    finding.identified.effects = {turnLimit(), asymmetry()};
  if (verdict == GapVerdict::kAmbiguous) finding.identified.effects = {icrOffset()};
  if (verdict == GapVerdict::kMeasurement) finding.identified.effects = {misalignment()};
  if (verdict == GapVerdict::kPartial || verdict == GapVerdict::kNotInCatalogue)
    finding.adequacy.unexplained = {{"yaw rate", "speed x yaw rate", 9.1, 0.004, "yaw_rate_skid"}};
  for (const FoundEffect& effect : finding.identified.effects) {
    finding.search.steps.push_back({effect.name, false, effect.score, effect.p_value, effect.gain,
                                    effect.gain_error, effect.runner_ups, ""});
    for (const ParameterEstimate& estimate : effect.parameters)
      *findParameter(finding.identified.model, estimate.parameter) = estimate.value;
  }
  return finding;
}

inline std::vector<InputFile> inputs() {
  return {{InputFile::Role::kModel, "m.yaml", std::string(64, 'a')},
          {InputFile::Role::kTrain, "a.lcmlog", std::string(64, 'b')},
          {InputFile::Role::kTest, "b<c>.lcmlog", std::string(64, 'c')}};
}

}  // namespace tread::gap::samples

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Evidence of the motor currents about found effects.
#include "modules/identification/core/current_witness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "common/soundness/core/lag_table.hpp"
#include "modules/identification/core/motion_bins.hpp"
#include "modules/identification/core/witness.hpp"
#include "modules/identification/core/witness_blocks.hpp"

namespace tread::gap {
namespace {

constexpr double kCreeps = 0.03;      // [m/s] from which dry friction is fully developed
constexpr size_t kLeastBins = 500;    // with currents
constexpr double kUnlike = 0.05;      // of an effect, not in any other column
constexpr double kVisible = 0.01;     // of the motion, lower limit of an effect's RMS
constexpr double kSteady = 0.03;      // [m/s] of change between bins
constexpr double kLeastSteady = 0.2;  // of an effect's square, in steady motion
constexpr double kVaries = 0.01;      // of a current's square, about its mean magnitude
constexpr double kFollows = 0.5;      // of the currents' variance that the motion must explain

Both togetherOf(const Both& tracks) {
  return {0.5 * (tracks[0] + tracks[1]), 0.5 * (tracks[1] - tracks[0])};
}

/// Bins with the mean currents of the tracks in them [A].
struct Currents {
  std::vector<MotionBin> bins;
  std::vector<Both> tracks;
};

Currents measuredIn(const std::vector<MotionBin>& bins, const std::vector<Drive>& drives) {
  std::vector<std::array<RunningSums, 2>> sums;
  for (const Drive& drive : drives)
    sums.push_back(
        {currentSums(drive, &CurrentSample::left), currentSums(drive, &CurrentSample::right)});
  Currents measured;
  for (const MotionBin& bin : bins) {
    const auto left = sums[bin.drive][0][bin.segment].mean(bin.begin, bin.begin + kBin);
    const auto right = sums[bin.drive][1][bin.segment].mean(bin.begin, bin.begin + kBin);
    if (!left || !right || !std::isfinite(*left) || !std::isfinite(*right)) continue;
    measured.bins.push_back(bin);
    measured.tracks.push_back({*left, *right});
  }
  return measured;
}

/// Whether the current of a track is constant, so no measurement.
bool isStuck(const Currents& measured) {
  for (size_t side = 0; side < 2; ++side) {
    double sum = 0.0;
    double square = 0.0;
    for (const Both& current : measured.tracks) {
      sum += std::abs(current[side]);
      square += current[side] * current[side];
    }
    const double mean = sum / static_cast<double>(measured.tracks.size());
    if (!(square - sum * mean > kVaries * square)) return true;
  }
  return false;
}

/// Makes currents positive forwards, for either convention of the controller.
void orient(Currents& measured) {
  double forwards = 0.0;
  double driving = 0.0;
  for (size_t i = 0; i < measured.bins.size(); ++i)
    for (size_t side = 0; side < 2; ++side) {
      const double speed = measured.bins[i].tracks[side];
      forwards += measured.tracks[i][side] * speed;
      driving += measured.tracks[i][side] * std::abs(speed);
    }
  const bool by_direction = std::abs(forwards) >= std::abs(driving);
  const double sign = (by_direction ? forwards : driving) < 0.0 ? -1.0 : 1.0;
  for (size_t i = 0; i < measured.bins.size(); ++i)
    for (size_t side = 0; side < 2; ++side)
      measured.tracks[i][side] *=
          by_direction ? sign : std::copysign(sign, measured.bins[i].tracks[side]);
}

// Columns of a kind: the current, then its usual dependence, then each effect.
constexpr Eigen::Index kOrdinary = 6;
constexpr Eigen::Index kSpeed = 1;
constexpr Eigen::Index kOnes = kOrdinary;
constexpr Eigen::Index kEffects = 1 + kOrdinary;

double dryFriction(double speed) {
  return std::tanh(speed / kCreeps);
}

BlockGrams currentGrams(const Currents& measured, size_t effects) {
  const auto columns = kEffects + static_cast<Eigen::Index>(effects);
  BlockGrams blocks;
  Eigen::VectorXd row(columns);
  for (size_t i = 0; i < measured.bins.size(); ++i) {
    const MotionBin& bin = measured.bins[i];
    const Both current = togetherOf(measured.tracks[i]);
    const Both friction = togetherOf({dryFriction(bin.tracks[0]), dryFriction(bin.tracks[1])});
    for (size_t kind = 0; kind < 2; ++kind) {
      // Ground that is pushed aside also resists turning like dry friction.
      const double scrub = kind == 1 ? dryFriction(bin.speed[1]) : 0.0;
      row.head(kEffects) << current[kind], bin.speed[kind], bin.before[kind], bin.after[kind],
          friction[kind], scrub, 1.0;
      for (size_t e = 0; e < effects; ++e)
        row[kEffects + static_cast<Eigen::Index>(e)] = bin.lost[e][kind];
      if (row.allFinite()) gramsAt(blocks, bin.block, columns)[kind] += row * row.transpose();
    }
  }
  return blocks;
}

/// Least squares of the currents: each kind has its own usual dependence, all kinds the same
/// current per speed that an effect takes.
struct CurrentFit {
  Eigen::MatrixXd normal;
  Eigen::VectorXd values;  ///< usual ones of both kinds, then effects [A s/m]
  Both rest{};             ///< residual sum of squares, by kind

  Eigen::Index effectAt(size_t effect) const {
    return 2 * kOrdinary + static_cast<Eigen::Index>(effect);
  }
};

CurrentFit fitCurrents(const Grams& grams, const Both& weights) {
  const Eigen::Index effects = grams[0].cols() - kEffects;
  const Eigen::Index all = 2 * kOrdinary + effects;
  CurrentFit fit{Eigen::MatrixXd::Zero(all, all), {}, {}};
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(all);
  std::array<Eigen::MatrixXd, 2> select;
  for (size_t kind = 0; kind < 2; ++kind) {
    const auto at = static_cast<Eigen::Index>(kind) * kOrdinary;
    select[kind] = Eigen::MatrixXd::Zero(all, kOrdinary + effects);
    select[kind].block(at, 0, kOrdinary, kOrdinary).setIdentity();
    select[kind].bottomRightCorner(effects, effects).setIdentity();
    const Eigen::MatrixXd explaining =
        grams[kind].bottomRightCorner(kOrdinary + effects, kOrdinary + effects);
    fit.normal += weights[kind] * select[kind] * explaining * select[kind].transpose();
    pull += weights[kind] * select[kind] * grams[kind].col(0).tail(kOrdinary + effects);
  }
  for (Eigen::Index i = 0; i < all; ++i)
    if (!(fit.normal(i, i) > 0.0)) fit.normal(i, i) = 1.0;
  fit.values = fit.normal.ldlt().solve(pull);
  for (size_t kind = 0; kind < 2; ++kind) {
    Eigen::VectorXd mix(grams[kind].cols());
    mix << -1.0, select[kind].transpose() * fit.values;
    fit.rest[kind] = mix.dot(grams[kind] * mix);
  }
  return fit;
}

/// Weights of the kinds from the residuals of their currents.
Both weightsOf(const Grams& all) {
  Both weights{};
  for (size_t kind = 0; kind < 2; ++kind)
    weights[kind] = all[kind](0, 0) > 0.0 ? 1.0 / all[kind](0, 0) : 0.0;
  const CurrentFit fit = fitCurrents(all, weights);
  for (size_t kind = 0; kind < 2; ++kind)
    weights[kind] = fit.rest[kind] > 0.0 ? 1.0 / fit.rest[kind] : 0.0;
  return weights;
}

/// Current per speed, over the kinds of motion that an effect reduces; without the effects' own
/// currents.
double ordinaryPerSpeed(const Grams& grams, const CurrentFit& fit, size_t effect) {
  const Eigen::Index effects = grams[0].cols() - kEffects;
  double weighed = 0.0;
  double weight = 0.0;
  for (const Eigen::MatrixXd& of : grams) {
    const double square = of(kSpeed, kSpeed);
    if (!(square > 0.0)) continue;
    const double drawn = of(0, kSpeed) - of.row(kSpeed).tail(effects).dot(fit.values.tail(effects));
    const auto at = kEffects + static_cast<Eigen::Index>(effect);
    weighed += of(at, at) * drawn / square;
    weight += of(at, at);
  }
  return weight > 0.0 ? weighed / weight : 0.0;
}

/// Share of an effect that no other column can imitate.
double unlikeOthers(const CurrentFit& fit, size_t effect) {
  const Eigen::Index at = fit.effectAt(effect);
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(fit.normal.cols(), at);
  const double inverse = fit.normal.ldlt().solve(unit)[at];
  return inverse > 0.0 ? 1.0 / (inverse * fit.normal(at, at)) : 0.0;
}

/// Whether the currents follow the motion at all.
bool follows(const Grams& all, const CurrentFit& fit) {
  double varies = 0.0;
  for (const Eigen::MatrixXd& of : all)
    varies += of(0, 0) - of(0, kOnes) * of(0, kOnes) / of(kOnes, kOnes);
  return fit.rest[0] + fit.rest[1] < (1.0 - kFollows) * varies;
}

/// Whether an effect also reduces steady motion: reductions of changes alone cannot be
/// distinguished from the currents of inertia.
bool actsSteadily(const std::vector<MotionBin>& bins, size_t effect) {
  double all = 0.0;
  double steady = 0.0;
  for (const MotionBin& bin : bins)
    for (size_t kind = 0; kind < 2; ++kind) {
      const double square = bin.lost[effect][kind] * bin.lost[effect][kind];
      const double change = std::max(std::abs(bin.before[kind]), std::abs(bin.after[kind]));
      all += square;
      if (change < kSteady) steady += square;
    }
  return steady > kLeastSteady * all;
}

/// Whether an effect reduces the motion enough to be evaluated.
bool isVisible(const Grams& all, Eigen::Index effect, Eigen::Index speed) {
  const double taken = all[0](effect, effect) + all[1](effect, effect);
  const double moved = all[0](speed, speed) + all[1](speed, speed);
  return taken > kVisible * kVisible * moved;
}

}  // namespace

std::map<std::string, CurrentWitness> currentWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects) {
  const std::vector<Drive>& drives = fitter.data().drives();
  const std::vector<std::string> asked = askedOf(effects);
  if (asked.empty() || std::all_of(drives.begin(), drives.end(),
                                   [](const Drive& drive) { return drive.currents.empty(); }))
    return {};
  Currents measured = measuredIn(binsOf(fitter, state, asked), drives);
  if (measured.bins.size() < kLeastBins || isStuck(measured)) return {};
  orient(measured);
  const BlockGrams blocks = currentGrams(measured, asked.size());
  if (blocks.size() < 2) return {};
  const Grams all = sumOf(blocks);
  const Both weights = weightsOf(all);
  const CurrentFit fit = fitCurrents(all, weights);
  if (!follows(all, fit)) return {};
  const BlockEstimate rises = estimateOver(blocks, [&](const Grams& grams) {
    const CurrentFit of = fitCurrents(grams, weights);
    Eigen::VectorXd rise(static_cast<Eigen::Index>(asked.size()));
    for (size_t e = 0; e < asked.size(); ++e)
      rise[static_cast<Eigen::Index>(e)] =
          of.values[of.effectAt(e)] / ordinaryPerSpeed(grams, of, e);
    return rise;
  });
  std::map<std::string, CurrentWitness> witnesses;
  for (size_t e = 0; e < asked.size(); ++e) {
    const auto at = static_cast<Eigen::Index>(e);
    const double half = rises.quantile * rises.errors[at];
    if (!std::isfinite(half) || !(ordinaryPerSpeed(all, fit, e) > 0.0) ||
        !isVisible(all, kEffects + at, kSpeed) || !actsSteadily(measured.bins, e) ||
        unlikeOthers(fit, e) < kUnlike)
      continue;
    witnesses[asked[e]] = {rises.values[at], rises.values[at] - half, rises.values[at] + half};
  }
  return witnesses;
}

}  // namespace tread::gap

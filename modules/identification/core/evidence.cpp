// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>

#include "common/soundness/core/lag_table.hpp"
#include "modules/identification/core/likelihood.hpp"
#include "modules/identification/core/motion_bins.hpp"
#include "modules/identification/core/pruning.hpp"

namespace tread::gap {
namespace {

using Index = Eigen::Index;

/// Products of columns over rows, by kind of motion: driving, turning.
/** Columns: the measured quantity, its usual dependence, each effect. */
using Grams = std::array<Eigen::MatrixXd, 2>;
/// Those of each block of driving.
using BlockGrams = std::map<int, Grams>;

/// The Gram matrices of a block, zero (columns x columns) at first.
Grams& gramsAt(BlockGrams& blocks, int block, Index columns) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(columns, columns);
  return blocks.try_emplace(block, Grams{none, none}).first->second;
}

/// Sum over all blocks, at least one.
Grams sumOf(const BlockGrams& blocks) {
  Grams all = blocks.begin()->second;
  for (auto block = std::next(blocks.begin()); block != blocks.end(); ++block)
    for (size_t kind = 0; kind < all.size(); ++kind) all[kind] += block->second[kind];
  return all;
}

/// Least squares of the measured quantity: each kind has its own usual dependence, all kinds the
/// same coefficients of the effects.
struct ColumnFit {
  Eigen::MatrixXd normal;
  Eigen::VectorXd values;  ///< usual ones of both kinds, then effects
  Both rest{};             ///< residual sum of squares, by kind
};

ColumnFit fitColumns(const Grams& grams, Index usual, const Both& weights) {
  const Index effects = grams[0].cols() - 1 - usual;
  const Index all = 2 * usual + effects;
  ColumnFit fit{Eigen::MatrixXd::Zero(all, all), {}, {}};
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(all);
  std::array<Eigen::MatrixXd, 2> select;
  for (size_t kind = 0; kind < 2; ++kind) {
    select[kind] = Eigen::MatrixXd::Zero(all, usual + effects);
    select[kind].block(static_cast<Index>(kind) * usual, 0, usual, usual).setIdentity();
    select[kind].bottomRightCorner(effects, effects).setIdentity();
    const Eigen::MatrixXd explaining =
        grams[kind].bottomRightCorner(usual + effects, usual + effects);
    fit.normal += weights[kind] * select[kind] * explaining * select[kind].transpose();
    pull += weights[kind] * select[kind] * grams[kind].col(0).tail(usual + effects);
  }
  for (Index i = 0; i < all; ++i)
    if (!(fit.normal(i, i) > 0.0)) fit.normal(i, i) = 1.0;
  fit.values = fit.normal.ldlt().solve(pull);
  for (size_t kind = 0; kind < 2; ++kind) {
    Eigen::VectorXd mix(grams[kind].cols());
    mix << -1.0, select[kind].transpose() * fit.values;
    fit.rest[kind] = mix.dot(grams[kind] * mix);
  }
  return fit;
}

/// What a source measures about groups of effects.
struct Columns {
  std::vector<std::vector<std::string>> asked;  ///< groups with one answer, in order of columns
  BlockGrams blocks;
  /// Coefficients of the groups, from sums over blocks.
  std::function<Eigen::VectorXd(const Grams&)> estimate;
  /// Whether the answer about a group is clear; of all answers with their standard errors.
  std::function<bool(const std::vector<MeasuredEvidence>&, const Eigen::VectorXd& errors, size_t)>
      is_clear;
};

/// Estimates from all blocks together, with intervals from the jackknife over them.
void addEvidence(EvidenceSource source, const Columns& columns,
                 std::map<std::string, MeasuredEvidence>& evidence) {
  if (columns.asked.empty() || columns.blocks.size() < 2) return;
  const Grams all = sumOf(columns.blocks);
  const Eigen::VectorXd values = columns.estimate(all);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(values.size());
  for (const auto& [number, block] : columns.blocks) {
    const Grams others{all[0] - block[0], all[1] - block[1]};
    sums += (columns.estimate(others) - values).cwiseAbs2();
  }
  const auto count = static_cast<double>(columns.blocks.size());
  const Eigen::VectorXd errors = (sums * (count - 1.0) / count).cwiseSqrt();
  const double quantile = studentQuantile(count - 1.0);
  std::vector<MeasuredEvidence> answers;
  for (size_t i = 0; i < columns.asked.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const double half = quantile * errors[at];
    answers.push_back(
        {source, values[at], values[at] - half, values[at] + half, columns.asked[i].size() > 1});
  }
  for (size_t i = 0; i < answers.size(); ++i)
    if (std::isfinite(answers[i].high - answers[i].low) && columns.is_clear(answers, errors, i))
      for (const std::string& effect : columns.asked[i]) evidence[effect] = answers[i];
}

bool hasNone(const std::vector<Drive>& drives, const std::function<bool(const Drive&)>& measures) {
  return std::none_of(drives.begin(), drives.end(), measures);
}

/// Vehicle effects about which motor signals may be informative.
std::vector<std::string> askedOf(const std::vector<std::string>& effects) {
  std::vector<std::string> asked;
  for (const std::string& effect : effects) {
    const Effect& known = effectNamed(effect);
    if (known.kind() == EffectKind::kVehicle && !isLag(known)) asked.push_back(effect);
  }
  return asked;
}

// Wheel speeds.

constexpr double kUnlikeScale = 0.2;  // of the effect, in directions that are no scale
constexpr double kShown = 0.7;        // of the effect, outside of lateral motion
constexpr double kSharp = 0.25;       // largest standard error of an informative share
constexpr double kAlike = 0.8;        // correlation from which two effects are evaluated together
constexpr int kRounds = 60;           // until scales and shares have converged
constexpr size_t kLeastWheelRows = 100;  // with wheel speeds

/// The track speeds of a drive during the measurement of a row.
class WheelSpeeds {
 public:
  WheelSpeeds(const Drive& drive, double gauge)
      : turns_(drive.layout == VehicleLayout::kTracks),
        speed_(encoderSums(drive, [](const TrackCommand& c) { return 0.5 * (c.left + c.right); })),
        turn_(encoderSums(drive,
                          [gauge](const TrackCommand& c) { return (c.right - c.left) / gauge; })) {}

  std::optional<double> speed(const Observation& row, double late) const {
    return speed_[row.segment].mean(row.begin - late, row.end - late);
  }
  /// For a car, only the speed of the drive is measured.
  std::optional<double> turn(const Observation& row, double late) const {
    if (!turns_) return std::nullopt;
    return turn_[row.segment].mean(row.begin - late, row.end - late);
  }

 private:
  bool turns_;
  RunningSums speed_;
  RunningSums turn_;
};

/// Mean speed of a prediction in a row: the way along over its chord.
/** Removes the influence of yaw effects. The heading's row precedes it. */
double speedOf(const Observation& row, const Eigen::VectorXd& predicted, Index at) {
  const double turned = predicted[at - 1] * (row.end - row.begin);
  const double chord = std::abs(turned) < 1e-6 ? 1.0 : std::sin(turned) / turned;
  return std::abs(chord) > 0.3 ? predicted[at] / chord : kNotMeasured;
}

/// Gram matrices of the blocks; columns: wheels, prediction, and the change by each effect.
BlockGrams wheelGrams(const Fitter& fitter, const FitState& state,
                      const std::vector<Eigen::VectorXd>& without, size_t& rows) {
  const Observations& data = fitter.data();
  const MeasurementModel& ins = state.model.measurement;
  const auto columns = static_cast<Index>(2 + without.size());
  std::vector<WheelSpeeds> wheels;
  for (const Drive& drive : data.drives()) wheels.emplace_back(drive, state.model.vehicle.gauge);
  BlockGrams blocks;
  Eigen::VectorXd values(columns);
  for (size_t i = 0; i < data.all().size(); ++i) {
    const Observation& row = data.all()[i];
    const auto at = static_cast<Index>(i);
    const bool turning = row.channel == ObservedRate::kYawRate;
    if (!turning && row.channel != ObservedRate::kAlong) continue;
    const auto said = turning ? wheels[row.drive].turn(row, ins.ins_latency_gyro * ins.ins_latency)
                              : wheels[row.drive].speed(row, ins.ins_latency);
    if (!said) continue;
    const auto valueOf = [&](const Eigen::VectorXd& predicted) {
      return turning ? predicted[at] : speedOf(row, predicted, at);
    };
    values[0] = *said;
    values[1] = valueOf(state.predicted);
    for (size_t e = 0; e < without.size(); ++e)
      values[static_cast<Index>(2 + e)] = values[1] - valueOf(without[e]);
    if (!values.allFinite()) continue;
    values /= state.scales[at];
    gramsAt(blocks, row.block, columns)[turning ? 1 : 0] += values * values.transpose();
    ++rows;
  }
  return blocks;
}

/// Shares of the effects for which wheels = a (prediction - sum (1 - share) effect) fits best, a by
/// kind.
Eigen::VectorXd sharesOf(const Grams& grams) {
  const Index effects = grams[0].cols() - 2;
  Eigen::VectorXd hidden = Eigen::VectorXd::Constant(effects, 0.5);  // 1 - share
  for (int round = 0; round < kRounds; ++round) {
    Eigen::VectorXd mix(2 + effects);
    mix << 0.0, 1.0, -hidden;
    Grams rest{Eigen::MatrixXd::Zero(1 + effects, 1 + effects),
               Eigen::MatrixXd::Zero(1 + effects, 1 + effects)};
    for (size_t kind = 0; kind < 2; ++kind) {
      const double size = mix.dot(grams[kind] * mix);
      if (!(size > 0.0)) continue;
      const double scale = grams[kind].row(0).dot(mix) / size;
      // Columns: wheels less the scaled prediction, and each effect at that scale.
      rest[kind].col(0).tail(effects) =
          scale * (scale * grams[kind].col(1).tail(effects) - grams[kind].col(0).tail(effects));
      rest[kind].bottomRightCorner(effects, effects) =
          scale * scale * grams[kind].bottomRightCorner(effects, effects);
    }
    hidden = fitColumns(rest, 0, {1.0, 1.0}).values;
  }
  return Eigen::VectorXd::Ones(effects) - hidden;
}

/// Share of an effect that is no scale of the motion, because the wheels' own scale is unknown.
double unlikeScale(const Grams& grams, Index effect) {
  double own = 0.0;
  double all = 0.0;
  for (const Eigen::MatrixXd& of : grams) {
    all += of(effect, effect);
    if (of(1, 1) > 0.0) own += of(effect, effect) - of(1, effect) * of(1, effect) / of(1, 1);
  }
  return all > 0.0 ? own / all : 0.0;
}

/// Similarity of two effects in what wheels could show: the correlation of their directions.
double likeness(const Grams& grams, Index a, Index b) {
  double both = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (const Eigen::MatrixXd& of : grams) {
    both += of(a, b);
    first += of(a, a);
    second += of(b, b);
  }
  return first > 0.0 && second > 0.0 ? std::abs(both) / std::sqrt(first * second) : 0.0;
}

/// Whether an effect resembles another one with a different answer: the wheels cannot decide how to
/// divide what they show.
bool isContradicted(const Grams& grams, const std::vector<MeasuredEvidence>& answers,
                    size_t index) {
  for (size_t other = 0; other < answers.size(); ++other) {
    const MeasuredEvidence &one = answers[index], &two = answers[other];
    const bool agree = (one.confirms() && two.confirms()) || (one.refutes() && two.refutes());
    if (other != index && !agree &&
        likeness(grams, static_cast<Index>(2 + index), static_cast<Index>(2 + other)) > kAlike)
      return true;
  }
  return false;
}

/// Share of an effect outside of lateral motion.
double showsIn(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& without) {
  double shown = 0.0;
  double all = 0.0;
  for (Index i = 0; i < without.size(); ++i) {
    const ObservedRate channel = fitter.data().all()[static_cast<size_t>(i)].channel;
    if (channel == ObservedRate::kHeading) continue;
    const double size = std::pow((state.predicted[i] - without[i]) / state.scales[i], 2);
    all += size;
    if (channel != ObservedRate::kAcross) shown += size;
  }
  return all > 0.0 ? shown / all : 0.0;
}

/// Whether an effect is one factor on driving or on turning, like the wheels' scales.
bool isScale(const Effect& effect) {
  return contains(effect.search.nominal, "forward_gain") ||
         contains(effect.search.nominal, "yaw_gain");
}

Columns wheelColumns(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects) {
  if (hasNone(fitter.data().drives(), [](const Drive& drive) {
        return !drive.encoders.empty() && drive.layout != VehicleLayout::kOmni;
      }))
    return {};
  std::vector<std::vector<std::string>> groups;
  std::vector<std::string> lags;
  for (const std::string& effect : effects) {
    const Effect& known = effectNamed(effect);
    if (known.kind() != EffectKind::kVehicle || isScale(known)) continue;
    if (isLag(known))
      lags.push_back(effect);
    else
      groups.push_back({effect});
  }
  // The wheels cannot decide how a delay and two lags divide their total delay.
  if (!lags.empty()) groups.push_back(lags);
  Columns columns;
  std::vector<Eigen::VectorXd> without;
  for (const std::vector<std::string>& group : groups) {
    const Eigen::VectorXd predicted = switchedOff(fitter, state, group).predicted;
    if (showsIn(fitter, state, predicted) < kShown) continue;
    columns.asked.push_back(group);
    without.push_back(predicted);
  }
  size_t rows = 0;
  columns.blocks = wheelGrams(fitter, state, without, rows);
  if (rows < kLeastWheelRows || columns.blocks.empty()) return {};
  columns.estimate = sharesOf;
  columns.is_clear = [all = sumOf(columns.blocks)](const std::vector<MeasuredEvidence>& answers,
                                                   const Eigen::VectorXd& errors, size_t i) {
    const auto at = static_cast<Index>(i);
    return errors[at] < kSharp && unlikeScale(all, 2 + at) >= kUnlikeScale &&
           !isContradicted(all, answers, i);
  };
  return columns;
}

// Motor currents.

constexpr double kCreeps = 0.03;        // [m/s] from which dry friction is fully developed
constexpr size_t kLeastBins = 500;      // with currents
constexpr double kUnlikeOthers = 0.05;  // of an effect, not in any other column
constexpr double kVisible = 0.01;       // of the motion, lower limit of an effect's RMS
constexpr double kSteady = 0.03;        // [m/s] of change between bins
constexpr double kLeastSteady = 0.2;    // of an effect's square, in steady motion
constexpr double kVaries = 0.01;        // of a current's square, about its mean magnitude
constexpr double kFollows = 0.5;        // of the currents' variance that the motion must explain

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
constexpr Index kOrdinary = 6;
constexpr Index kSpeed = 1;
constexpr Index kOnes = kOrdinary;
constexpr Index kEffects = 1 + kOrdinary;

double dryFriction(double speed) {
  return std::tanh(speed / kCreeps);
}

/// Index of an effect among the values of a fit.
Index effectAt(size_t effect) {
  return 2 * kOrdinary + static_cast<Index>(effect);
}

BlockGrams currentGrams(const Currents& measured, size_t effects) {
  const auto columns = kEffects + static_cast<Index>(effects);
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
        row[kEffects + static_cast<Index>(e)] = bin.lost[e][kind];
      if (row.allFinite()) gramsAt(blocks, bin.block, columns)[kind] += row * row.transpose();
    }
  }
  return blocks;
}

/// Weights of the kinds from the residuals of their currents.
Both weightsOf(const Grams& all) {
  Both weights{};
  for (size_t kind = 0; kind < 2; ++kind)
    weights[kind] = all[kind](0, 0) > 0.0 ? 1.0 / all[kind](0, 0) : 0.0;
  const ColumnFit fit = fitColumns(all, kOrdinary, weights);
  for (size_t kind = 0; kind < 2; ++kind)
    weights[kind] = fit.rest[kind] > 0.0 ? 1.0 / fit.rest[kind] : 0.0;
  return weights;
}

/// Current per speed, over the kinds of motion that an effect reduces; without the effects' own
/// currents.
double ordinaryPerSpeed(const Grams& grams, const ColumnFit& fit, size_t effect) {
  const Index effects = grams[0].cols() - kEffects;
  double weighed = 0.0;
  double weight = 0.0;
  for (const Eigen::MatrixXd& of : grams) {
    const double square = of(kSpeed, kSpeed);
    if (!(square > 0.0)) continue;
    const double drawn = of(0, kSpeed) - of.row(kSpeed).tail(effects).dot(fit.values.tail(effects));
    const auto at = kEffects + static_cast<Index>(effect);
    weighed += of(at, at) * drawn / square;
    weight += of(at, at);
  }
  return weight > 0.0 ? weighed / weight : 0.0;
}

/// Share of an effect that no other column can imitate.
double unlikeOthers(const ColumnFit& fit, size_t effect) {
  const Index at = effectAt(effect);
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(fit.normal.cols(), at);
  const double inverse = fit.normal.ldlt().solve(unit)[at];
  return inverse > 0.0 ? 1.0 / (inverse * fit.normal(at, at)) : 0.0;
}

/// Whether the currents follow the motion at all.
bool follows(const Grams& all, const ColumnFit& fit) {
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
bool isVisible(const Grams& all, Index effect, Index speed) {
  const double taken = all[0](effect, effect) + all[1](effect, effect);
  const double moved = all[0](speed, speed) + all[1](speed, speed);
  return taken > kVisible * kVisible * moved;
}

Columns currentColumns(const Fitter& fitter, const FitState& state,
                       const std::vector<std::string>& effects) {
  const std::vector<Drive>& drives = fitter.data().drives();
  const std::vector<std::string> asked = askedOf(effects);
  if (asked.empty() || hasNone(drives, [](const Drive& drive) { return !drive.currents.empty(); }))
    return {};
  Currents measured = measuredIn(binsOf(fitter, state, asked), drives);
  if (measured.bins.size() < kLeastBins || isStuck(measured)) return {};
  orient(measured);
  Columns columns{{}, currentGrams(measured, asked.size()), {}, {}};
  if (columns.blocks.size() < 2) return {};
  const Grams all = sumOf(columns.blocks);
  const Both weights = weightsOf(all);
  const ColumnFit fit = fitColumns(all, kOrdinary, weights);
  if (!follows(all, fit)) return {};
  for (const std::string& effect : asked) columns.asked.push_back({effect});
  columns.estimate = [weights, count = asked.size()](const Grams& grams) {
    const ColumnFit of = fitColumns(grams, kOrdinary, weights);
    Eigen::VectorXd rise(static_cast<Index>(count));
    for (size_t e = 0; e < count; ++e)
      rise[static_cast<Index>(e)] = of.values[effectAt(e)] / ordinaryPerSpeed(grams, of, e);
    return rise;
  };
  columns.is_clear = [=, bins = std::move(measured.bins)](const std::vector<MeasuredEvidence>&,
                                                          const Eigen::VectorXd&, size_t e) {
    return ordinaryPerSpeed(all, fit, e) > 0.0 &&
           isVisible(all, kEffects + static_cast<Index>(e), kSpeed) && actsSteadily(bins, e) &&
           unlikeOthers(fit, e) >= kUnlikeOthers;
  };
  return columns;
}

// Battery voltage.

constexpr double kFactor =
    0.7;  // of an effect, described by one factor on each kind of motion in a block
constexpr double kFactorChanges = 0.05;    // of it, by which the factors of the blocks must differ
constexpr size_t kLeastVoltageBlocks = 8;  // with voltage

/// Sums over one block.
struct BlockMotion {
  size_t drive = 0;
  double bins = 0.0;
  double voltage = 0.0;               ///< [V] summed over bins
  double load = 0.0;                  ///< squared speeds of the tracks
  std::array<double, 2> square{};     ///< of the motion without the effect, by kind
  std::array<double, 2> with_lost{};  ///< that motion times the effect's part
  double lost_square = 0.0;

  double motion() const { return square[0] + square[1]; }
  /// Share of the motion that the effect takes.
  double factor() const { return (with_lost[0] + with_lost[1]) / motion(); }
};

/// The newest voltage at a time; NaN before the first one.
double voltageAt(const std::vector<VoltageSample>& voltage, double time) {
  const auto after =
      std::upper_bound(voltage.begin(), voltage.end(), time,
                       [](double t, const VoltageSample& sample) { return t < sample.time; });
  return after == voltage.begin() ? kNotMeasured : std::prev(after)->voltage;
}

/// Sums of the bins with a voltage, by block.
std::map<int, BlockMotion> blockMotions(const std::vector<MotionBin>& bins,
                                        const std::vector<Drive>& drives, size_t effect) {
  std::map<int, BlockMotion> blocks;
  for (const MotionBin& bin : bins) {
    if (!isMeasured(drives[bin.drive].voltage)) continue;
    const double voltage = voltageAt(drives[bin.drive].voltage, bin.begin + 0.5 * kBin);
    if (!(voltage > 0.0)) continue;
    BlockMotion& block = blocks[bin.block];
    block.drive = bin.drive;
    block.bins += 1.0;
    block.voltage += voltage;
    block.load += bin.tracks[0] * bin.tracks[0] + bin.tracks[1] * bin.tracks[1];
    for (size_t kind = 0; kind < 2; ++kind) {
      const double lost = bin.lost[effect][kind];
      const double without = bin.speed[kind] + lost;
      block.square[kind] += without * without;
      block.with_lost[kind] += without * lost;
      block.lost_square += lost * lost;
    }
  }
  for (auto block = blocks.begin(); block != blocks.end();)
    block = block->second.motion() > 0.0 ? std::next(block) : blocks.erase(block);
  return blocks;
}

/// Whether an effect is one factor on all driving and one on all turning of a block, which changes
/// between blocks.
bool isFactorOverTime(const std::map<int, BlockMotion>& blocks) {
  double all = 0.0, explained = 0.0, weight = 0.0, sum = 0.0;
  for (const auto& [number, block] : blocks) {
    all += block.lost_square;
    for (size_t kind = 0; kind < 2; ++kind)
      if (block.square[kind] > 0.0)
        explained += block.with_lost[kind] * block.with_lost[kind] / block.square[kind];
    weight += block.motion();
    sum += block.with_lost[0] + block.with_lost[1];
  }
  double changes = 0.0;
  for (const auto& [number, block] : blocks)
    changes += block.motion() * std::pow(block.factor() - sum / weight, 2);
  return all > 0.0 && explained > kFactor * all && changes > kFactorChanges * all;
}

/// Columns: drop of the voltage, load, ones for each drive, share of the motion that the effect
/// takes.
BlockGrams voltageGrams(const std::map<int, BlockMotion>& blocks, size_t drives) {
  std::vector<double> full(drives, 0.0);  // [V], of the block with the highest voltage
  for (const auto& [number, block] : blocks)
    full[block.drive] = std::max(full[block.drive], block.voltage / block.bins);
  const auto columns = static_cast<Index>(3 + drives);
  BlockGrams grams;
  for (const auto& [number, block] : blocks) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(columns);
    row[0] = 1.0 - block.voltage / block.bins / full[block.drive];
    row[1] = block.load / block.bins;
    row[static_cast<Index>(2 + block.drive)] = 1.0;
    row[columns - 1] = block.factor();
    // A block that hardly moves has no information about the factor.
    gramsAt(grams, number, columns)[0] += block.motion() * row * row.transpose();
  }
  return grams;
}

/// Of each effect that is a factor over time.
std::vector<Columns> voltageColumns(const Fitter& fitter, const FitState& state,
                                    const std::vector<std::string>& effects) {
  const std::vector<Drive>& drives = fitter.data().drives();
  const std::vector<std::string> asked = askedOf(effects);
  if (asked.empty() ||
      hasNone(drives, [](const Drive& drive) { return isMeasured(drive.voltage); }))
    return {};
  const std::vector<MotionBin> bins = binsOf(fitter, state, asked);
  std::vector<Columns> all;
  for (size_t e = 0; e < asked.size(); ++e) {
    const auto blocks = blockMotions(bins, drives, e);
    if (blocks.size() < kLeastVoltageBlocks || !isFactorOverTime(blocks)) continue;
    const auto usual = static_cast<Index>(1 + drives.size());
    all.push_back({{{asked[e]}},
                   voltageGrams(blocks, drives.size()),
                   [usual](const Grams& grams) -> Eigen::VectorXd {
                     return fitColumns(grams, usual, {1.0, 0.0}).values.tail(1);
                   },
                   [](const std::vector<MeasuredEvidence>&, const Eigen::VectorXd&, size_t) {
                     return true;
                   }});
  }
  return all;
}

}  // namespace

std::map<std::string, MeasuredEvidence> evidenceBy(EvidenceSource source, const Fitter& fitter,
                                                   const FitState& state,
                                                   const std::vector<std::string>& effects) {
  std::vector<Columns> all;
  if (source == EvidenceSource::kWheels) all = {wheelColumns(fitter, state, effects)};
  if (source == EvidenceSource::kCurrents) all = {currentColumns(fitter, state, effects)};
  if (source == EvidenceSource::kVoltage) all = voltageColumns(fitter, state, effects);
  std::map<std::string, MeasuredEvidence> evidence;
  for (const Columns& columns : all) addEvidence(source, columns, evidence);
  return evidence;
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/witness.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/soundness/core/lag_table.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/witness_blocks.hpp"

namespace tread::gap {
namespace {

constexpr double kUnlike = 0.2;     // of the effect, in directions that are no scale of the motion
constexpr double kShown = 0.7;      // of the effect, outside of lateral motion
constexpr double kSharp = 0.25;     // largest standard error of an informative share
constexpr double kAlike = 0.8;      // correlation from which two effects are evaluated together
constexpr int kRounds = 60;         // until scales and shares have converged
constexpr size_t kLeastRows = 100;  // with wheel speeds

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
double speedOf(const Observation& row, const Eigen::VectorXd& predicted, Eigen::Index at) {
  const double turned = predicted[at - 1] * (row.end - row.begin);
  const double chord = std::abs(turned) < 1e-6 ? 1.0 : std::sin(turned) / turned;
  return std::abs(chord) > 0.3 ? predicted[at] / chord : kNotMeasured;
}

/// Gram matrices of the blocks; columns: wheels, prediction, and the change by each effect.
BlockGrams gramsOf(const Fitter& fitter, const FitState& state,
                   const std::vector<Eigen::VectorXd>& without, size_t& rows) {
  const Observations& data = fitter.data();
  const MeasurementModel& ins = state.model.measurement;
  const auto columns = static_cast<Eigen::Index>(2 + without.size());
  std::vector<WheelSpeeds> wheels;
  for (const Drive& drive : data.drives()) wheels.emplace_back(drive, state.model.vehicle.gauge);
  BlockGrams blocks;
  Eigen::VectorXd values(columns);
  for (size_t i = 0; i < data.all().size(); ++i) {
    const Observation& row = data.all()[i];
    const auto at = static_cast<Eigen::Index>(i);
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
      values[static_cast<Eigen::Index>(2 + e)] = values[1] - valueOf(without[e]);
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
  const Eigen::Index effects = grams[0].cols() - 2;
  Eigen::VectorXd hidden = Eigen::VectorXd::Constant(effects, 0.5);  // 1 - share
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(effects, effects);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(effects);
    for (const Eigen::MatrixXd& of : grams) {
      Eigen::VectorXd mix = Eigen::VectorXd::Zero(of.cols());
      mix[1] = 1.0;
      mix.tail(effects) = -hidden;
      const double size = mix.dot(of * mix);
      if (!(size > 0.0)) continue;
      const double scale = of.row(0).dot(mix) / size;
      matrix += scale * scale * of.bottomRightCorner(effects, effects);
      pull += scale * (scale * of.col(1).tail(effects) - of.col(0).tail(effects));
    }
    for (Eigen::Index i = 0; i < effects; ++i)
      if (!(matrix(i, i) > 0.0)) matrix(i, i) = 1.0;
    hidden = matrix.ldlt().solve(pull);
  }
  return Eigen::VectorXd::Ones(effects) - hidden;
}

/// Share of an effect that is no scale of the motion, because the wheels' own scale is unknown.
double unlikeScale(const Grams& grams, Eigen::Index effect) {
  double own = 0.0;
  double all = 0.0;
  for (const Eigen::MatrixXd& of : grams) {
    all += of(effect, effect);
    if (of(1, 1) > 0.0) own += of(effect, effect) - of(1, effect) * of(1, effect) / of(1, 1);
  }
  return all > 0.0 ? own / all : 0.0;
}

/// Similarity of two effects in what wheels could show: the correlation of their directions.
double likeness(const Grams& grams, Eigen::Index a, Eigen::Index b) {
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

/// Whether two results agree about the location of their effects.
bool sayTheSame(const WheelWitness& one, const WheelWitness& other) {
  return (one.saysDrive() && other.saysDrive()) || (one.saysGround() && other.saysGround());
}

/// Which of the shares belong to an effect that resembles another one with a different answer: the
/// wheels cannot decide how to divide what they show.
std::vector<char> contradicted(const Grams& grams, const std::vector<WheelWitness>& witnesses) {
  std::vector<char> marked(witnesses.size(), 0);
  for (size_t i = 0; i < witnesses.size(); ++i)
    for (size_t k = i + 1; k < witnesses.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(2 + i);
      const auto beside = static_cast<Eigen::Index>(2 + k);
      if (likeness(grams, at, beside) > kAlike && !sayTheSame(witnesses[i], witnesses[k]))
        marked[i] = marked[k] = 1;
    }
  return marked;
}

/// Share of an effect outside of lateral motion.
double showsIn(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& without) {
  double shown = 0.0;
  double all = 0.0;
  for (Eigen::Index i = 0; i < without.size(); ++i) {
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

}  // namespace

std::map<std::string, WheelWitness> wheelWitnesses(const Fitter& fitter, const FitState& state,
                                                   const std::vector<std::string>& effects) {
  const std::vector<Drive>& drives = fitter.data().drives();
  if (std::all_of(drives.begin(), drives.end(), [](const Drive& drive) {
        return drive.encoders.empty() || drive.layout == VehicleLayout::kOmni;
      }))
    return {};
  std::vector<std::vector<std::string>> asked;
  std::vector<std::string> lags;
  for (const std::string& effect : effects) {
    const Effect& known = effectNamed(effect);
    if (known.kind() != EffectKind::kVehicle || isScale(known)) continue;
    if (isLag(known))
      lags.push_back(effect);
    else
      asked.push_back({effect});
  }
  // The wheels cannot decide how a delay and two lags divide their total delay.
  if (!lags.empty()) asked.push_back(lags);
  std::vector<Eigen::VectorXd> without;
  for (size_t i = 0; i < asked.size();) {
    const Eigen::VectorXd predicted = switchedOff(fitter, state, asked[i]).predicted;
    if (showsIn(fitter, state, predicted) < kShown) {
      asked.erase(asked.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    without.push_back(predicted);
    ++i;
  }
  size_t rows = 0;
  const BlockGrams blocks = gramsOf(fitter, state, without, rows);
  if (asked.empty() || rows < kLeastRows || blocks.size() < 2) return {};
  const BlockEstimate shares = estimateOver(blocks, sharesOf);
  std::vector<WheelWitness> all;
  for (size_t i = 0; i < asked.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double half = shares.quantile * shares.errors[at];
    all.push_back({shares.values[at], shares.values[at] - half, shares.values[at] + half,
                   asked[i].size() > 1});
  }
  const std::vector<char> unsure = contradicted(shares.all, all);
  std::map<std::string, WheelWitness> witnesses;
  for (size_t i = 0; i < asked.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!(shares.errors[at] < kSharp) || unlikeScale(shares.all, 2 + at) < kUnlike || unsure[i])
      continue;
    for (const std::string& effect : asked[i]) witnesses[effect] = all[i];
  }
  return witnesses;
}

}  // namespace tread::gap

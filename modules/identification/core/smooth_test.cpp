// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/smooth_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Cholesky>

#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/screening.hpp"

namespace tread::gap {
namespace {

constexpr size_t kFeatures = 320;
constexpr size_t kMostInputs = 3;  // of one feature
constexpr double kWidth = 1.5;     // deviations of an input over which a function is smooth
constexpr double kFarthest = 3.0;  // deviations; larger ones are clamped
constexpr double kRidge = 1.0;     // of each feature's own information
constexpr double kLeastUniqueShare =
    4e-4;                     // share of its information that is its own, as in ScoreTest
constexpr int kDraws = 9999;  // enough that a few of them exceed the level of one channel

/// Inputs in units of their deviation; those of both signs also as magnitudes.
struct Inputs {
  Eigen::MatrixXd values;      ///< rows x columns
  std::vector<size_t> source;  ///< of each column: its input
  Eigen::MatrixXd amplitudes;  ///< rows x 3: 1, speed, yaw rate
};

Eigen::VectorXd standardised(const Eigen::VectorXd& values) {
  const Eigen::ArrayXd off = values.array() - values.mean();
  const double deviation = std::sqrt(off.square().mean());
  if (!(deviation > 1e-9)) return Eigen::VectorXd::Zero(values.size());
  return (off / deviation).max(-kFarthest).min(kFarthest);
}

Inputs inputsFrom(const std::vector<Variable>& variables) {
  Inputs inputs;
  const Eigen::Index rows = variables.front().values.size();
  inputs.values.resize(rows, static_cast<Eigen::Index>(2 * variables.size()));
  const auto take = [&inputs](const Eigen::VectorXd& values, size_t source) {
    inputs.values.col(static_cast<Eigen::Index>(inputs.source.size())) = standardised(values);
    inputs.source.push_back(source);
  };
  for (size_t i = 0; i < variables.size(); ++i) {
    take(variables[i].values, i);
    if (variables[i].values.minCoeff() < 0.0) take(variables[i].values.cwiseAbs(), i);
  }
  inputs.amplitudes = Eigen::MatrixXd::Ones(rows, 3);
  for (Eigen::Index i : {0, 1}) {
    const Eigen::VectorXd& motion = variables[static_cast<size_t>(i)].values;
    const double size = std::sqrt(motion.squaredNorm() / static_cast<double>(rows));
    inputs.amplitudes.col(i + 1) = motion / std::max(size, 1e-9);
  }
  return inputs;
}

/// amplitude cos(sum of weight times column + phase)
struct Feature {
  std::vector<std::pair<size_t, double>> waves;  ///< column, weight
  double phase = 0.0;
  Eigen::Index amplitude = 0;

  double value(const Inputs& inputs, Eigen::Index row) const {
    double angle = phase;
    for (const auto& [column, weight] : waves)
      angle += weight * inputs.values(row, static_cast<Eigen::Index>(column));
    return inputs.amplitudes(row, amplitude) * std::cos(angle);
  }
  bool uses(const Inputs& inputs, size_t input) const {
    return std::any_of(waves.begin(), waves.end(),
                       [&](const auto& wave) { return inputs.source[wave.first] == input; });
  }
  bool usesOnly(const Inputs& inputs, size_t input) const {
    return std::all_of(waves.begin(), waves.end(),
                       [&](const auto& wave) { return inputs.source[wave.first] == input; });
  }
};

std::vector<Feature> drawFeatures(const Inputs& inputs, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> weight(0.0, 1.0 / kWidth);
  std::vector<Feature> features(kFeatures);
  for (size_t i = 0; i < kFeatures; ++i) {
    Feature& feature = features[i];
    feature.amplitude = static_cast<Eigen::Index>(i % 3);
    feature.phase = 2.0 * M_PI * static_cast<double>(random() >> 11U) * 0x1p-53;
    const size_t count = 1 + random() % kMostInputs;
    for (size_t n = 0; n < count; ++n) {
      const size_t column = random() % inputs.source.size();
      feature.waves.emplace_back(column, weight(random));
    }
  }
  return features;
}

/// The rows of some channels, and the free parameters' influence in all rows.
struct Rows {
  std::vector<size_t> of_channels;
  Eigen::VectorXd residuals;   ///< of all rows
  Eigen::VectorXd metric;      ///< 1 / scale^2 of rows that count
  Eigen::MatrixXd free_pulls;  ///< blocks x free
};

Rows rowsOf(const Fitter& fitter, const FitState& state,
            const std::vector<ObservedRate>& channels) {
  const std::vector<Observation>& all = fitter.data().all();
  Rows rows{{},
            fitter.data().residuals(state.predicted),
            Eigen::VectorXd::Zero(state.predicted.size()),
            Eigen::MatrixXd::Zero(fitter.data().blocks(), state.jacobian.cols())};
  for (size_t i = 0; i < all.size(); ++i) {
    if (!fitter.mask()[i]) continue;
    const auto row = static_cast<Eigen::Index>(i);
    rows.metric[row] = 1.0 / (state.scales[row] * state.scales[row]);
    rows.free_pulls.row(all[i].block) +=
        pullOf(rows.residuals[row], state.scales[row]) * state.jacobian.row(row);
    if (std::find(channels.begin(), channels.end(), all[i].channel) != channels.end())
      rows.of_channels.push_back(i);
  }
  return rows;
}

/// The features' pulls, each in units of its own information.
struct Pulls {
  Eigen::MatrixXd values;   ///< rows of the channels x features
  Eigen::MatrixXd blocks;   ///< blocks x features
  Eigen::MatrixXd overlap;  ///< features x features, with the ridge
};

/// The same, before orthogonalization to the free parameters.
Pulls rawPulls(const Fitter& fitter, const FitState& state, const Inputs& inputs,
               const std::vector<Feature>& features, const Rows& rows, Eigen::MatrixXd& shared) {
  const auto count = static_cast<Eigen::Index>(features.size());
  const auto number = static_cast<Eigen::Index>(rows.of_channels.size());
  Pulls pulls{
      Eigen::MatrixXd(number, count), Eigen::MatrixXd::Zero(fitter.data().blocks(), count), {}};
  Eigen::MatrixXd weighted(number, count);
  Eigen::MatrixXd jacobian(number, state.jacobian.cols());
  for (Eigen::Index r = 0; r < number; ++r) {
    const size_t at = rows.of_channels[static_cast<size_t>(r)];
    const auto row = static_cast<Eigen::Index>(at);
    for (Eigen::Index f = 0; f < count; ++f)
      pulls.values(r, f) = features[static_cast<size_t>(f)].value(inputs, row);
    pulls.blocks.row(fitter.data().all()[at].block) +=
        pullOf(rows.residuals[row], state.scales[row]) * pulls.values.row(r);
    weighted.row(r) = rows.metric[row] * pulls.values.row(r);
    jacobian.row(r) = state.jacobian.row(row);
  }
  pulls.overlap = pulls.values.transpose() * weighted;
  shared = jacobian.transpose() * weighted;
  return pulls;
}

Pulls pullsOf(const Fitter& fitter, const FitState& state, const Inputs& inputs,
              const std::vector<Feature>& features, const Rows& rows) {
  Eigen::MatrixXd shared;
  Pulls pulls = rawPulls(fitter, state, inputs, features, rows, shared);
  const Eigen::VectorXd whole = pulls.overlap.diagonal();
  const Eigen::MatrixXd imitated = imitation(state, rows.metric, shared);
  pulls.overlap -= shared.transpose() * imitated;
  pulls.blocks -= rows.free_pulls * imitated;
  for (Eigen::Index f = 0; f < whole.size(); ++f) {
    const double own = pulls.overlap(f, f);
    const double unit = own > kLeastUniqueShare * whole[f] ? 1.0 / std::sqrt(own) : 0.0;
    pulls.blocks.col(f) *= unit;
    pulls.values.col(f) *= unit;
    pulls.overlap.col(f) *= unit;
    pulls.overlap.row(f) *= unit;
  }
  pulls.overlap.diagonal().array() += kRidge;
  return pulls;
}

/// Mutual agreement of the blocks (blocks x blocks), by these features.
Eigen::MatrixXd agreement(const Pulls& pulls, const std::vector<Eigen::Index>& features) {
  const auto count = static_cast<Eigen::Index>(features.size());
  Eigen::MatrixXd overlap(count, count);
  Eigen::MatrixXd blocks(pulls.blocks.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index at = features[static_cast<size_t>(i)];
    blocks.col(i) = pulls.blocks.col(at);
    for (Eigen::Index j = 0; j < count; ++j)
      overlap(i, j) = pulls.overlap(at, features[static_cast<size_t>(j)]);
  }
  return blocks * overlap.ldlt().solve(blocks.transpose());
}

/// Standard deviation of the blocks' agreement under random signs.
double deviationOf(const Eigen::MatrixXd& agreement) {
  return std::sqrt(2.0 * (agreement.squaredNorm() - agreement.diagonal().squaredNorm()));
}

/// The blocks' agreement beyond random signs and the known rest, in standard deviations of chance.
double scoreOf(const Eigen::MatrixXd& agreement, double known = 0.0) {
  const double deviation = deviationOf(agreement);
  return deviation > 0.0 ? (agreement.sum() - agreement.trace() - known) / deviation : 0.0;
}

double chanceOf(const Eigen::MatrixXd& agreement, double known, uint64_t seed) {
  std::mt19937_64 random(seed);
  Eigen::VectorXd signs(agreement.rows());
  const double found = agreement.sum() - known;
  int larger = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (Eigen::Index b = 0; b < signs.size(); ++b) signs[b] = (random() >> 63U) != 0U ? 1.0 : -1.0;
    larger += !(signs.dot(agreement * signs) < found * (1.0 - 1e-12));
  }
  return (larger + 1.0) / (kDraws + 1.0);
}

/// Agreement of the blocks due to a function of root mean square 1.
/** A pull has (f + 1) / (f + 3) of its scale's slope, see ScoreTest. */
double agreementOfUnit(const Rows& rows) {
  double sum = 0.0;
  for (const size_t row : rows.of_channels) sum += rows.metric[static_cast<Eigen::Index>(row)];
  return sum * std::pow((kFreedom + 1.0) / (kFreedom + 3.0), 2);
}

/// The largest size that a known rest would have in another drive.
double mostKnown(const SmoothRest& rest, const std::vector<RestTerm>& known) {
  for (const RestTerm& term : known)
    if (term.condition == kAllConditions && term.channel == channelName(rest.channels.front()))
      return (1.0 + kRestVaries) * term.size + term.deviation;
  return 0.0;
}

/// Features with a property.
template <class Holds>
std::vector<Eigen::Index> featuresWhere(const std::vector<Feature>& features, Holds holds) {
  std::vector<Eigen::Index> chosen;
  for (size_t f = 0; f < features.size(); ++f)
    if (holds(features[f])) chosen.push_back(static_cast<Eigen::Index>(f));
  return chosen;
}

/// Whether an input varies from row to row, unlike a constant or unmeasured one.
bool varies(const Inputs& inputs, size_t input) {
  const auto first = std::find(inputs.source.begin(), inputs.source.end(), input);
  return !inputs.values.col(std::distance(inputs.source.begin(), first)).isZero(0.0);
}

/// The most informative input: alone, and in addition to all others.
/** Inputs are correlated, so that without one the others replace it: therefore its information
 * alone counts, too (the first and the last term of a Shapley value). Functions of an input that
 * does not vary are only the amplitudes, and carry no information about it. */
size_t mostTelling(const Pulls& pulls, const std::vector<Feature>& features, const Inputs& inputs) {
  size_t most = 0;
  double largest = -std::numeric_limits<double>::infinity();
  for (size_t input = 0; input <= inputs.source.back(); ++input) {
    if (!varies(inputs, input)) continue;
    const auto alone = featuresWhere(
        features, [&](const Feature& feature) { return feature.usesOnly(inputs, input); });
    const auto others = featuresWhere(
        features, [&](const Feature& feature) { return !feature.uses(inputs, input); });
    const double told = scoreOf(agreement(pulls, alone)) - scoreOf(agreement(pulls, others));
    if (told <= largest) continue;
    largest = told;
    most = input;
  }
  return most;
}

}  // namespace

std::vector<SmoothRest> smoothRests(const Fitter& fitter, const FitState& state,
                                    const std::vector<Variable>& variables,
                                    const std::vector<RestTerm>& known, double alpha,
                                    uint64_t seed) {
  const Inputs inputs = inputsFrom(variables);
  const std::vector<Feature> features = drawFeatures(inputs, seed);
  std::vector<SmoothRest> rests{{{ObservedRate::kYawRate, ObservedRate::kHeading}},
                                {{ObservedRate::kAlong}},
                                {{ObservedRate::kAcross}}};
  const auto all = featuresWhere(features, [](const Feature&) { return true; });
  fitter.parallel()(rests.size(), [&](size_t i) {
    SmoothRest& rest = rests[i];
    const Rows rows = rowsOf(fitter, state, rest.channels);
    if (rows.of_channels.empty()) return;
    const Pulls pulls = pullsOf(fitter, state, inputs, features, rows);
    const Eigen::MatrixXd agree = agreement(pulls, all);
    const double unit = agreementOfUnit(rows);
    const double beyond = agree.sum() - agree.trace();
    rest.size = std::sqrt(std::max(0.0, beyond) / unit);
    rest.deviation = std::sqrt((std::max(0.0, beyond) + deviationOf(agree)) / unit) - rest.size;
    const double expected = unit * std::pow(mostKnown(rest, known), 2);
    rest.score = scoreOf(agree, expected);
    rest.p_value =
        std::min(1.0, static_cast<double>(rests.size()) * chanceOf(agree, expected, seed));
    if (rest.p_value > alpha) return;
    rest.variable = variables[mostTelling(pulls, features, inputs)].name;
    const Eigen::VectorXd sizes =
        pulls.overlap.ldlt().solve(pulls.blocks.colwise().sum().transpose());
    const Eigen::VectorXd fitted = pulls.values * sizes;
    rest.function = Eigen::VectorXd::Zero(state.predicted.size());
    for (Eigen::Index r = 0; r < fitted.size(); ++r)
      rest.function[static_cast<Eigen::Index>(rows.of_channels[static_cast<size_t>(r)])] =
          fitted[r];
  });
  return rests;
}

}  // namespace tread::gap

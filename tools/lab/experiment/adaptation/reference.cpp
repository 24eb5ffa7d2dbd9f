// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

#include "common/recordings/sessions.hpp"

namespace tread::adaptation {
namespace {

/// Columns of TermTable for each velocity.
const std::array<std::vector<Eigen::Index>, kAxes>& termsOf() {
  static const std::array<std::vector<Eigen::Index>, kAxes> terms{
      {{0, 2, 1, 4}, {6, 0, 1}, {1, 3, 0, 5}}};
  return terms;
}

Eigen::MatrixXd chosen(const Eigen::MatrixXd& all, size_t axis) {
  const std::vector<Eigen::Index>& columns = termsOf()[axis];
  Eigen::MatrixXd some(all.rows(), static_cast<Eigen::Index>(columns.size()));
  for (size_t i = 0; i < columns.size(); ++i)
    some.col(static_cast<Eigen::Index>(i)) = all.col(columns[i]);
  return some;
}

/// Non-negative factors for which sums of terms are the expected squares.
/** Each square is weighted by the inverse of its expectation so far, and limited to nine times it
 * (three standard deviations) against pose failures. */
Eigen::Vector3d fitted(const std::vector<Eigen::Vector3d>& terms,
                       const std::vector<double>& squares) {
  constexpr int kSweeps = 100;
  constexpr double kLeast = 1e-6, kMost = 9.0;
  Eigen::Vector3d factors = Eigen::Vector3d::Constant(0.01);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Eigen::Index k = 0; k < 3; ++k) {
      double top = 0.0, bottom = 0.0;
      for (size_t i = 0; i < terms.size(); ++i) {
        const double expected = factors.dot(terms[i]);
        const double h = terms[i][k] / (expected * expected);
        top += h * (std::min(squares[i], kMost * expected) - expected + factors[k] * terms[i][k]);
        bottom += h * terms[i][k];
      }
      factors[k] = std::max(k == 0 ? kLeast : 0.0, top / bottom);
    }
  return factors;
}

/// Whether the commands are constant from 1 s before the previous piece on.
bool repeats(const SampledSession& session, size_t piece) {
  constexpr size_t kSteady = 20;  // samples
  if (piece == 0 || !session.goesOn(piece - 1)) return false;
  const SampledPiece& before = session.pieces[piece - 1];
  const std::vector<TrackCommand>& commands = session.segments[before.segment].commands;
  if (before.begin < kSteady) return false;
  const auto first = commands.begin() + static_cast<std::ptrdiff_t>(before.begin - kSteady);
  return std::all_of(first, first + kSteady + 2 * kPieceSamples,
                     [&](const TrackCommand& command) { return command == *first; });
}

}  // namespace

std::vector<Eigen::Vector2d> lagged(const SampledSegment& segment, double baseline,
                                    const Lag& lag) {
  const auto motionOf = [&](const TrackCommand& command) {
    const recordings::BodyCommand body = recordings::bodyCommand(command, baseline);
    return Eigen::Vector2d(body.v, body.w);
  };
  const auto late = static_cast<size_t>(std::lround(lag.delay / kPeriod));
  // Mean over a sample of the transition from `state` to a constant command.
  const double ratio = kPeriod / lag.time_constant;
  const double kept = std::exp(-ratio);
  const double mean = (1.0 - kept) / ratio;
  Eigen::Vector2d state = motionOf(segment.before);
  std::vector<Eigen::Vector2d> motion;
  for (size_t t = 0; t < segment.commands.size(); ++t) {
    const Eigen::Vector2d to = motionOf(t < late ? segment.before : segment.commands[t - late]);
    motion.push_back(to + mean * (state - to));
    state = to + kept * (state - to);
  }
  return motion;
}

Eigen::Vector3d NoiseModel::of(const Eigen::Vector2d& speed) const {
  Eigen::Vector3d noise;
  for (size_t axis = 0; axis < kAxes; ++axis)
    noise[static_cast<Eigen::Index>(axis)] =
        factors[axis].dot(Eigen::Vector3d(1.0, speed[0] * speed[0], speed[1] * speed[1]));
  return noise;
}

Eigen::Vector2d Sample::meanSpeed() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& speed : speeds) sum += speed.cwiseAbs();
  return sum / static_cast<double>(kParts);
}

const std::vector<Lag>& TermTable::lags() {
  static const std::vector<Lag> all = [] {
    std::vector<Lag> grid;
    for (const double delay : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5})
      for (const double time_constant : {0.1, 0.2, 0.3, 0.45, 0.65, 0.9})
        grid.push_back({delay, time_constant});
    return grid;
  }();
  return all;
}

Eigen::Matrix<double, 1, TermTable::kTerms> TermTable::terms(const Eigen::Vector2d& motion) {
  const double v = motion[0], w = motion[1];
  Eigen::Matrix<double, 1, kTerms> row;
  row << v, w, std::abs(w) * v, std::abs(v) * w, std::abs(v) * v, std::abs(w) * w, v * w;
  return row;
}

TermTable::TermTable(const SampledSession& session) {
  const auto pieces = static_cast<Eigen::Index>(session.pieces.size());
  twists_.resize(pieces, 3);
  for (Eigen::Index i = 0; i < pieces; ++i)
    twists_.row(i) = session.pieces[static_cast<size_t>(i)].mean_twist;
  for (const Lag& lag : lags()) {
    std::vector<std::vector<Eigen::Vector2d>> motions;
    for (const SampledSegment& segment : session.segments)
      motions.push_back(lagged(segment, session.baseline, lag));
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(pieces, kTerms);
    for (Eigen::Index i = 0; i < pieces; ++i) {
      const SampledPiece& piece = session.pieces[static_cast<size_t>(i)];
      for (size_t t = 0; t < kPieceSamples; ++t)
        means.row(i) += terms(motions[piece.segment][piece.begin + t]);
    }
    means_.push_back(means / static_cast<double>(kPieceSamples));
  }
}

void Reference::fit(const std::vector<const TermTable*>& training, size_t axis, size_t lag,
                    double& error, Eigen::VectorXd& coefficients) const {
  Eigen::Index rows = 0;
  for (const TermTable* table : training) rows += table->twists().rows();
  Eigen::MatrixXd A(rows, static_cast<Eigen::Index>(termsOf()[axis].size()));
  Eigen::VectorXd b(rows), deviation(rows);
  const NoiseModel noise;
  Eigen::Index row = 0;
  for (const TermTable* table : training) {
    const Eigen::Index n = table->twists().rows();
    A.middleRows(row, n) = chosen(table->of(lag), axis);
    b.segment(row, n) = table->twists().col(static_cast<Eigen::Index>(axis));
    for (Eigen::Index i = 0; i < n; ++i)
      deviation[row + i] = std::sqrt(noise.of(
          {table->twists()(i, 0), table->twists()(i, 2)})[static_cast<Eigen::Index>(axis)]);
    row += n;
  }
  A = deviation.cwiseInverse().asDiagonal() * A;
  b = b.cwiseQuotient(deviation);
  coefficients = recordings::huberFit(A, b, Eigen::VectorXd::Ones(rows), {1, 0.05});
  error = (A * coefficients - b).cwiseAbs().sum();
}

Reference::Reference(const std::vector<const TermTable*>& training) {
  for (size_t axis = 0; axis < kAxes; ++axis) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t lag = 0; lag < TermTable::lags().size(); ++lag) {
      double error = 0.0;
      Eigen::VectorXd coefficients;
      fit(training, axis, lag, error, coefficients);
      if (error >= least) continue;
      least = error;
      lag_[axis] = lag;
      coefficients_[axis] = coefficients;
    }
  }
}

Reference::Reference(const std::vector<const TermTable*>& training, const Reference& lags)
    : lag_(lags.lag_) {
  double error = 0.0;
  for (size_t axis = 0; axis < kAxes; ++axis)
    fit(training, axis, lag_[axis], error, coefficients_[axis]);
}

std::vector<Twist2> Reference::twists(const SampledSegment& segment, double baseline) const {
  std::array<std::vector<double>, kAxes> velocities;
  for (size_t axis = 0; axis < kAxes; ++axis)
    for (const Eigen::Vector2d& motion : lagged(segment, baseline, lag(axis))) {
      const auto terms = TermTable::terms(motion);
      double sum = 0.0;
      for (size_t i = 0; i < termsOf()[axis].size(); ++i)
        sum += coefficients_[axis][static_cast<Eigen::Index>(i)] * terms[termsOf()[axis][i]];
      velocities[axis].push_back(sum);
    }
  std::vector<Twist2> twists;
  for (size_t t = 0; t < segment.commands.size(); ++t)
    twists.push_back({velocities[0][t], velocities[1][t], velocities[2][t]});
  return twists;
}

Sample sampleOf(const std::vector<Twist2>& twists) {
  Sample sample;
  sample.twist.setZero();
  std::array<double, kParts> counts{};
  sample.speeds.fill(Eigen::Vector2d::Zero());
  for (size_t t = 0; t < twists.size(); ++t) {
    const Twist2& twist = twists[t];
    sample.twist += Eigen::Vector3d(twist.v_x, twist.v_y, twist.omega);
    const size_t part = t * kParts / twists.size();
    sample.speeds[part] += Eigen::Vector2d(twist.v_x, twist.omega);
    counts[part] += 1.0;
  }
  sample.twist /= static_cast<double>(twists.size());
  for (size_t part = 0; part < kParts; ++part)
    if (counts[part] > 0.0)
      sample.speeds[part] /= counts[part];
    else
      sample.speeds[part] = {sample.twist[0], sample.twist[2]};  // fewer samples than parts
  sample.residual.setZero();
  sample.noise.setOnes();
  return sample;
}

Predicted predicted(const SampledSession& session, const Reference& reference) {
  std::vector<std::vector<Twist2>> segments;
  for (const SampledSegment& segment : session.segments)
    segments.push_back(reference.twists(segment, session.baseline));
  Predicted all;
  for (const SampledPiece& piece : session.pieces) {
    const auto first = segments[piece.segment].begin() + static_cast<std::ptrdiff_t>(piece.begin);
    all.twists.emplace_back(first, first + kPieceSamples);
    Sample sample = sampleOf(all.twists.back());
    sample.residual = piece.mean_twist - sample.twist;
    sample.repeats = repeats(session, all.samples.size());
    all.samples.push_back(sample);
  }
  return all;
}

std::vector<Pose2> integrated(const std::vector<Twist2>& twists, double period) {
  std::vector<Pose2> poses;
  Pose2 at;
  for (const Twist2& twist : twists) {
    at = at * integrate(twist, period);
    poses.push_back(at);
  }
  return poses;
}

NoiseModel noiseOf(const std::vector<std::vector<Sample>>& sessions) {
  constexpr size_t kLeastPairs = 20;
  std::vector<Eigen::Vector3d> terms, squares;
  for (const std::vector<Sample>& session : sessions)
    for (size_t i = 1; i < session.size(); ++i) {
      if (!session[i].repeats) continue;
      const Eigen::Vector2d speed = session[i].meanSpeed();
      terms.push_back({1.0, speed[0] * speed[0], speed[1] * speed[1]});
      squares.push_back(0.5 * (session[i].residual - session[i - 1].residual).cwiseAbs2());
    }
  NoiseModel model;
  if (terms.size() < kLeastPairs) return model;
  for (size_t axis = 0; axis < kAxes; ++axis) {
    std::vector<double> of_axis;
    for (const Eigen::Vector3d& square : squares)
      of_axis.push_back(square[static_cast<Eigen::Index>(axis)]);
    model.factors[axis] = fitted(terms, of_axis);
  }
  return model;
}

}  // namespace tread::adaptation

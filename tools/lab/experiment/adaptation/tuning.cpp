// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/tuning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/recordings/sessions.hpp"
#include "tools/lab/experiment/adaptation/gain_rivals.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kRun = 31;  // pieces of a tuning run, which begins with a new rival

/// A run of samples as rows of functions, computed once for all tuning steps.
struct Rows {
  std::vector<Eigen::VectorXd> functions;
  std::vector<double> residuals, noise;
};

/// Runs of session i only, or of all other sessions.
std::vector<Rows> runsOf(const std::vector<Sample>& session, const Functions& functions,
                         Eigen::Index axis) {
  std::vector<Rows> runs;
  for (size_t i = 0; i < session.size(); ++i) {
    if (i % kRun == 0) runs.emplace_back();
    runs.back().functions.push_back(LinearRival::row(functions, session[i]));
    runs.back().residuals.push_back(session[i].residual[axis]);
    runs.back().noise.push_back(session[i].noise[axis]);
  }
  return runs;
}

double logLikelihood(const LinearTuning& tuning, const std::vector<Rows>& runs) {
  double sum = 0.0;
  for (const Rows& run : runs) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(tuning.deviation.size());
    Eigen::MatrixXd P = tuning.deviation.cwiseAbs2().asDiagonal();
    for (size_t i = 0; i < run.functions.size(); ++i)
      sum += LinearRival::step(tuning, run.functions[i], run.residuals[i], run.noise[i], x, P);
  }
  return sum;
}

/// Coordinate ascent by factors, with decreasing step.
template <class Goal>
void climb(std::vector<double*> numbers, const Goal& goal) {
  double best = goal();
  for (const double factor : {3.0, 3.0, 1.7, 1.3})
    for (double* number : numbers)
      for (const double by : {factor, 1.0 / factor})
        for (int times = 0; times < 4; ++times) {
          const double before = *number;
          *number *= by;
          const double now = goal();
          if (now > best) {
            best = now;
            continue;
          }
          *number = before;
          break;
        }
}

/// Assumed change between executions.
enum class Change { kNever, kForget, kWalk };

LinearTuning tuned(LinearTuning tuning, const std::vector<Rows>& runs, Change change) {
  LinearTuning best = tuning;
  double highest = -std::numeric_limits<double>::infinity();
  const std::vector<double> candidates = change == Change::kNever
                                             ? std::vector<double>{0.0}
                                             : std::vector<double>{0.0, 0.003, 0.01, 0.03, 0.1};
  for (const double rate : candidates) {
    LinearTuning one = tuning;
    if (change == Change::kForget) one.forgetting = 1.0 - rate;
    if (change == Change::kWalk) one.walk = rate;
    std::vector<double*> numbers{&one.noise};
    for (double& deviation : one.deviation) numbers.push_back(&deviation);
    climb(numbers, [&] { return logLikelihood(one, runs); });
    const double reached = logLikelihood(one, runs);
    if (reached <= highest) continue;
    highest = reached;
    best = one;
  }
  return best;
}

/// Tunes on all runs of all sessions.
std::unique_ptr<AxisRival> linearRival(size_t axis, const Functions& functions,
                                       const Eigen::VectorXd& deviation, Change change,
                                       const TrainingSamples& training) {
  LinearTuning tuning{deviation};
  if (change == Change::kForget) tuning.forgetting = 0.98;
  if (change == Change::kWalk) tuning.walk = 0.01;
  if (training.size() >= kLeastSessions) {
    std::vector<Rows> runs;
    for (const std::vector<Sample>& session : training)
      for (Rows& run : runsOf(session, functions, static_cast<Eigen::Index>(axis)))
        runs.push_back(std::move(run));
    tuning = tuned(tuning, runs, change);
  }
  return std::make_unique<LinearRival>(axis, functions, tuning);
}

std::unique_ptr<AxisRival> gainRival(size_t axis, Change change, const TrainingSamples& training) {
  if (axis == 1) return nullptr;  // sideways motion has no gain
  const Functions own = [axis](const Eigen::Vector2d& speed) {
    return Eigen::VectorXd::Constant(1, speed[axis == 0 ? 0 : 1]);
  };
  return linearRival(axis, own, Eigen::VectorXd::Constant(1, axis == 0 ? 0.08 : 0.16), change,
                     training);
}

Functions slipTerms(size_t axis) {
  return [axis](const Eigen::Vector2d& speed) -> Eigen::VectorXd {
    const double v = speed[0], w = speed[1];
    if (axis == 0) return Eigen::Vector3d(v, std::abs(w) * v, w);
    if (axis == 1) return Eigen::Vector3d(v * w, v, w);
    return Eigen::Vector3d(w, std::abs(v) * w, v);
  };
}

std::unique_ptr<AxisRival> slipRival(size_t axis, const TrainingSamples& training) {
  const Eigen::Vector3d deviations[] = {
      {0.06, 0.09, 0.03}, {0.09, 0.012, 0.05}, {0.16, 0.05, 0.012}};
  return linearRival(axis, slipTerms(axis), deviations[axis], Change::kForget, training);
}

/// Mean of |v| and |w| over training samples, at least 0.1: the initial length scale.
Eigen::Vector2d largestSpeed(const TrainingSamples& training) {
  Eigen::Vector2d largest(0.1, 0.1);
  for (const std::vector<Sample>& session : training)
    for (const Sample& sample : session) largest = largest.cwiseMax(sample.meanSpeed());
  return largest;
}

/// Random Fourier features of a squared exponential kernel over the speed.
class RandomFeatures {
 public:
  RandomFeatures(const Eigen::Vector2d& length, uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&] {
      return (static_cast<double>(random() >> 11) + 0.5) / 9007199254740992.0;
    };
    for (Eigen::Index i = 0; i < kCount; ++i) {
      const double radius = std::sqrt(-2.0 * std::log(uniform()));
      const double angle = 2.0 * kPi * uniform();
      frequencies_(i, 0) = radius * std::cos(angle) / length[0];
      frequencies_(i, 1) = radius * std::sin(angle) / length[1];
      phases_[i] = 2.0 * kPi * uniform();
    }
  }
  static constexpr Eigen::Index kCount = 48;
  Eigen::VectorXd operator()(const Eigen::Vector2d& speed) const {
    return std::sqrt(2.0 / kCount) * (frequencies_ * speed + phases_).array().cos().matrix();
  }

 private:
  Eigen::Matrix<double, kCount, 2> frequencies_;
  Eigen::Matrix<double, kCount, 1> phases_;
};

/// Weights of a session's residual map, shrunk to zero by `deviation`.
Eigen::VectorXd mapOf(const std::vector<Sample>& session, const Functions& features,
                      Eigen::Index axis, double deviation) {
  constexpr Eigen::Index kCount = RandomFeatures::kCount;
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kCount, kCount) / (deviation * deviation);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kCount);
  for (const Sample& sample : session) {
    const Eigen::VectorXd h = LinearRival::row(features, sample);
    information += h * h.transpose() / sample.noise[axis];
    sum += h * sample.residual[axis] / sample.noise[axis];
  }
  return information.ldlt().solve(sum);
}

/// The functions with the largest differences between maps, and their sizes.
struct Basis {
  Eigen::MatrixXd directions;  ///< features x count
  Eigen::VectorXd deviation;
};

Basis basisOf(const std::vector<Eigen::VectorXd>& maps, Eigen::Index count) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(maps.size()), RandomFeatures::kCount);
  for (size_t i = 0; i < maps.size(); ++i) all.row(static_cast<Eigen::Index>(i)) = maps[i];
  // Singular values and right singular vectors, from the smaller Gram matrix.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squared(all * all.transpose());
  count = std::min(count, all.rows());
  const Eigen::VectorXd values =
      squared.eigenvalues().reverse().head(count).cwiseMax(1e-12).cwiseSqrt();
  return {all.transpose() * squared.eigenvectors().rowwise().reverse().leftCols(count) *
              values.cwiseInverse().asDiagonal(),
          (values / std::sqrt(static_cast<double>(maps.size()))).cwiseMax(1e-4)};
}

Functions functionsOf(const Functions& features, const Basis& basis) {
  return [features, directions = basis.directions](const Eigen::Vector2d& speed) {
    return Eigen::VectorXd(directions.transpose() * features(speed));
  };
}

/// Number of functions, forgetting and noise are chosen on sessions that the basis was not learned
/// from.
std::unique_ptr<AxisRival> basisRival(size_t axis, const TrainingSamples& training, uint64_t seed) {
  if (training.size() < kLeastSessions) return nullptr;  // one ground shows no differences
  const auto column = static_cast<Eigen::Index>(axis);
  const Functions features = RandomFeatures(0.6 * largestSpeed(training), seed + axis);
  std::vector<Eigen::VectorXd> maps;
  constexpr double kMapDeviation = 0.3;
  for (const std::vector<Sample>& session : training)
    maps.push_back(mapOf(session, features, column, kMapDeviation));
  LinearTuning best;
  Eigen::Index best_count = 1;
  double highest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index count = 1; count <= 4; ++count) {
    std::vector<std::vector<Rows>> runs;
    std::vector<Eigen::VectorXd> deviations;
    for (size_t left_out = 0; left_out < training.size(); ++left_out) {
      std::vector<Eigen::VectorXd> others = maps;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
      const Basis basis = basisOf(others, count);
      runs.push_back(runsOf(training[left_out], functionsOf(features, basis), column));
      deviations.push_back(basis.deviation);
    }
    if (deviations.front().size() < count) break;
    for (const double forgetting : {1.0, 0.99, 0.97, 0.9}) {
      // Factors on all prior deviations and on the noise.
      double scale = 1.0, noise = 1.0;
      const auto goal = [&] {
        double sum = 0.0;
        for (size_t i = 0; i < runs.size(); ++i)
          sum += logLikelihood({scale * deviations[i], forgetting, 0.0, noise}, runs[i]);
        return sum;
      };
      climb({&scale, &noise}, goal);
      const double reached = goal();
      if (reached <= highest) continue;
      highest = reached;
      best_count = count;
      best = {Eigen::VectorXd::Constant(1, scale), forgetting, 0.0, noise};
    }
  }
  const Basis basis = basisOf(maps, best_count);
  best.deviation = best.deviation[0] * basis.deviation;
  return std::make_unique<LinearRival>(axis, functionsOf(features, basis), best);
}

std::unique_ptr<AxisRival> gpRival(size_t axis, const TrainingSamples& training) {
  KernelTuning tuning;
  tuning.length = 0.6 * largestSpeed(training);
  if (training.size() >= kLeastSessions)
    climb({&tuning.deviation, &tuning.length[0], &tuning.length[1], &tuning.noise}, [&] {
      double sum = 0.0;
      for (const std::vector<Sample>& session : training)
        for (size_t begin = 0; begin < session.size(); begin += kRun)
          sum += GaussianProcess::logLikelihood(axis, tuning, &session[begin],
                                                std::min(kRun, session.size() - begin));
      return sum;
    });
  return std::make_unique<GaussianProcess>(axis, tuning);
}

std::unique_ptr<AxisRival> axisRival(const std::string& name, size_t axis,
                                     const TrainingSamples& training, uint64_t seed) {
  if (name == "constant") return gainRival(axis, Change::kNever, training);
  if (name == "kalman") return gainRival(axis, Change::kWalk, training);
  if (name == "slip") return slipRival(axis, training);
  if (name == "basis") return basisRival(axis, training, seed);
  if (name == "gp") return gpRival(axis, training);
  throw std::invalid_argument("unknown rival '" + name + "'");
}

}  // namespace

const std::vector<std::string>& rivalNames() {
  static const std::vector<std::string> names{"constant", "kalman", "slip", "gp",
                                              "basis",    "rls2",   "rls3", "imm"};
  return names;
}

std::unique_ptr<Rival> hindsight(const std::vector<Sample>& session) {
  std::array<std::unique_ptr<AxisRival>, kAxes> axes;
  for (size_t axis = 0; axis < kAxes; ++axis) {
    const auto n = static_cast<Eigen::Index>(session.size());
    const Functions terms = slipTerms(axis);
    Eigen::MatrixXd A(n, 3);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Sample& sample = session[static_cast<size_t>(i)];
      const double deviation = std::sqrt(sample.noise[static_cast<Eigen::Index>(axis)]);
      A.row(i) = LinearRival::row(terms, sample) / deviation;
      b[i] = sample.residual[static_cast<Eigen::Index>(axis)] / deviation;
    }
    const Eigen::VectorXd x = recordings::huberFit(A, b, Eigen::VectorXd::Ones(n), {1, 0.05});
    axes[axis] =
        std::make_unique<LinearRival>(axis, terms, LinearTuning{Eigen::Vector3d::Zero()}, x);
  }
  return std::make_unique<AxisRivals>(std::move(axes));
}

std::unique_ptr<Rival> tunedRival(const std::string& name, const TrainingSamples& training,
                                  uint64_t seed) {
  if (auto rival = gainRival(name)) return rival;
  std::array<std::unique_ptr<AxisRival>, kAxes> axes;
  for (size_t axis = 0; axis < kAxes; ++axis) axes[axis] = axisRival(name, axis, training, seed);
  return std::make_unique<AxisRivals>(std::move(axes));
}

}  // namespace tread::adaptation

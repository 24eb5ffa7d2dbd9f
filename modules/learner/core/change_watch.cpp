// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/change_watch.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace tread::learner {
namespace {

/// Between two windows [s].
constexpr double kStep = 0.1;
/// Consecutive windows that must exceed the threshold.
constexpr int kInARow = 2;
/// Fewest steps at the end of a window for dating the change.
constexpr int kFewestSteps = 2;

Eigen::Index samplesOfStep(double period) {
  return std::max<Eigen::Index>(1, std::llround(kStep / period));
}

Eigen::Index stepsOf(double window, double period) {
  const double step = period * static_cast<double>(samplesOfStep(period));
  return std::max<Eigen::Index>(1, std::llround(window / step));
}

}  // namespace

double chiSquare3(double probability) {
  double low = 0.0, high = 200.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    const double exceeds =
        std::erfc(std::sqrt(0.5 * x)) + std::sqrt(2.0 * x / kPi) * std::exp(-0.5 * x);
    (exceeds > probability ? low : high) = x;
  }
  return 0.5 * (low + high);
}

ChangeWatch::ChangeWatch(const ChangeLimits& limits)
    : limits_(limits), threshold_(chiSquare3(limits.chance)) {}

/// x of the last samples before `end`, which may begin in the previous execution; nullopt if they
/// begin before the known motion.
std::optional<double> ChangeWatch::unlikeness(const LearningRule& rule, size_t pattern,
                                              const ConstTrajectory& measured, Eigen::Index end,
                                              Eigen::Index samples, double period) const {
  const Eigen::Index here = std::min(samples, end);
  const auto before = static_cast<size_t>((samples - here) / samplesOfStep(period));
  if (before > tail_.size()) return std::nullopt;
  auto departure = rule.departure(pattern, measured, end - here, here);
  if (!departure) return std::nullopt;
  if (before > 0) {
    // The uncertainty of the ground is common to both: their joint covariance is no smaller.
    const TwistDeparture& tail = tail_[before - 1];
    const double share = static_cast<double>(here) / static_cast<double>(samples);
    departure->mean = share * departure->mean + (1.0 - share) * tail.mean;
    departure->covariance = share * departure->covariance + (1.0 - share) * tail.covariance;
  }
  const Eigen::LDLT<Eigen::Matrix3d> root(departure->covariance);
  if (root.info() != Eigen::Success || !(root.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const double x = departure->mean.dot(root.solve(departure->mean));
  if (!std::isfinite(x)) return std::nullopt;
  return x;
}

std::optional<NoticedChange> ChangeWatch::notice(const LearningRule& rule, size_t pattern,
                                                 const ConstTrajectory& measured,
                                                 double period) const {
  const Eigen::Index step = samplesOfStep(period);
  const Eigen::Index steps = stepsOf(limits_.window, period);
  int far = 0;
  for (Eigen::Index end = step; end <= measured.rows(); end += step) {
    const auto x = unlikeness(rule, pattern, measured, end, steps * step, period);
    far = x && *x > threshold_ ? far + 1 : 0;
    if (far < kInARow) continue;
    Eigen::Index since = steps;
    double highest = *x;
    for (Eigen::Index last = steps - 1; last >= kFewestSteps; --last) {
      const auto of_last = unlikeness(rule, pattern, measured, end, last * step, period);
      if (!of_last || *of_last <= highest) continue;
      highest = *of_last;
      since = last;
    }
    return NoticedChange{static_cast<int>(std::max<Eigen::Index>(0, end - since * step)),
                         static_cast<int>(end)};
  }
  return std::nullopt;
}

void ChangeWatch::follow(const LearningRule& rule, size_t pattern, const ConstTrajectory& measured,
                         double period) {
  std::vector<TwistDeparture> tail;
  const Eigen::Index step = samplesOfStep(period);
  const Eigen::Index most = stepsOf(limits_.window, period) - 1;
  for (Eigen::Index last = 1; last <= most && last * step <= measured.rows(); ++last) {
    const auto departure =
        rule.departure(pattern, measured, measured.rows() - last * step, last * step);
    if (!departure) break;
    tail.push_back(*departure);
  }
  tail_ = std::move(tail);
}

std::vector<double> ChangeWatch::memory() const {
  std::vector<double> memory;
  for (const TwistDeparture& departure : tail_) {
    const Eigen::Matrix3d& S = departure.covariance;
    memory.insert(memory.end(), departure.mean.begin(), departure.mean.end());
    memory.insert(memory.end(), {S(0, 0), S(0, 1), S(0, 2), S(1, 1), S(1, 2), S(2, 2)});
  }
  return memory;
}

bool ChangeWatch::restore(const std::vector<double>& memory) {
  if (memory.size() % kEach != 0 ||
      !std::all_of(memory.begin(), memory.end(), [](double x) { return std::isfinite(x); }))
    return false;
  tail_.clear();
  for (size_t at = 0; at < memory.size(); at += kEach) {
    const double* const n = &memory[at];
    TwistDeparture departure{{n[0], n[1], n[2]}, {}};
    departure.covariance << n[3], n[4], n[5], n[4], n[6], n[7], n[5], n[7], n[8];
    tail_.push_back(departure);
  }
  return true;
}

}  // namespace tread::learner

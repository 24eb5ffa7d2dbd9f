// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/surface_bank.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tread::learner {
namespace {

/// Means go on moving after so many executions.
constexpr double kLongestMean = 200.0;
/// No bank is larger.
constexpr double kMostSurfaces = 1000.0;
/// No ground's corrections are, of whatever unit.
constexpr double kLargestCorrection = 1e9;

/// Log density without the constant; lowest where the matrix is none.
double logNormalOf(const Eigen::VectorXd& y, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  return -0.5 * root.matrixL().solve(y).squaredNorm() -
         root.matrixLLT().diagonal().array().log().sum();
}

/// P - PH S^-1 PH'.
void downdate(Eigen::MatrixXd& P, const Eigen::Matrix<double, Eigen::Dynamic, 3>& PH,
              const Eigen::Matrix3d& S) {
  const Eigen::Matrix3d inverse_root =
      S.llt().matrixL().solve(Eigen::Matrix3d::Identity()).transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, 3> root = PH.lazyProduct(inverse_root);
  for (Eigen::Index j = 0; j < P.cols(); ++j)
    P.col(j) =
        P.col(j) - root(j, 0) * root.col(0) - root(j, 1) * root.col(1) - root(j, 2) * root.col(2);
}

}  // namespace

double RememberedSurface::executions() const {
  return std::accumulate(driven.begin(), driven.end(), 0.0);
}

KnownSurface::KnownSurface(const GroundModel& model, RememberedSurface stored)
    : stored_(std::move(stored)) {
  // Pattern by pattern, as if all its executions were one: cheaper than the inverse, and P stays
  // symmetric to the bit.
  P_ = model.changeCovariance();
  const double share = std::min(1.0, kLongestMean / std::max(1.0, stored_.executions()));
  Eigen::Matrix<double, Eigen::Dynamic, 3> PH(model.dimension(), 3);
  for (size_t p = 0; p < model.patterns(); ++p) {
    if (stored_.driven[p] <= 0.0) continue;
    model.timesResponse(P_, p, PH);
    downdate(P_, PH,
             model.response(PH, p) + executionNoise(model, p) / (share * stored_.driven[p]));
  }
  for (size_t p = 0; p < model.patterns(); ++p) {
    model.timesResponse(P_, p, PH);
    spreads_.emplace_back(model.response(PH, p) + executionNoise(model, p));
  }
}

double KnownSurface::logLikelihood(const GroundModel& model, const TwistSample& sample) const {
  const Eigen::Vector3d y =
      plausible(sample.mean_twist) - model.meanTwistUnder(stored_.x, sample.pattern);
  return logNormal(y, spreads_[sample.pattern]);
}

std::shared_ptr<const KnownSurface> KnownSurface::after(const GroundModel& model,
                                                        const std::vector<TwistSample>& samples,
                                                        int64_t now) const {
  RememberedSurface next = stored_;
  Eigen::MatrixXd P = P_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> PH(model.dimension(), 3);
  for (const TwistSample& sample : samples) {
    const size_t p = sample.pattern;
    const Eigen::Vector3d y = plausible(sample.mean_twist) - model.meanTwistUnder(next.x, p);
    model.timesResponse(P, p, PH);
    const Eigen::Matrix3d S = model.response(PH, p) + scaledNoise(model.noise(p), next.noise);
    const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = PH * S.inverse();
    next.x += gain * y;
    downdate(P, PH, S);
    const Eigen::Vector3d seen = y.cwiseAbs2().cwiseQuotient(S.diagonal()).cwiseProduct(next.noise);
    const double share =
        1.0 / (SurfaceBank::kNoisePrior + std::min(next.executions(), kLongestMean));
    next.noise += share * (seen - next.noise);
    next.noise = next.noise.cwiseMax(SurfaceBank::kLeastNoise).cwiseMin(SurfaceBank::kMostNoise);
    next.driven[p] += 1.0;
  }
  next.last_met = now;
  // The covariance follows from the counts, so that a restored bank continues with the same bits.
  return std::make_shared<const KnownSurface>(model, std::move(next));
}

int64_t SurfaceBank::newest() const {
  int64_t newest = 0;
  for (const auto& known : surfaces_) newest = std::max(newest, known->stored().last_met);
  return newest;
}

size_t SurfaceBank::store(RememberedSurface surface, size_t capacity) {
  auto known = std::make_shared<const KnownSurface>(*model_, std::move(surface));
  if (surfaces_.size() < capacity) {
    surfaces_.push_back(std::move(known));
    return surfaces_.size() - 1;
  }
  const auto oldest = std::min_element(
      surfaces_.begin(), surfaces_.end(),
      [](const auto& a, const auto& b) { return a->stored().last_met < b->stored().last_met; });
  *oldest = std::move(known);
  return static_cast<size_t>(oldest - surfaces_.begin());
}

bool SurfaceBank::alike(size_t i, size_t j) const {
  const Eigen::VectorXd apart = surfaces_[i]->mean() - surfaces_[j]->mean();
  Eigen::MatrixXd spread = surfaces_[i]->covariance() + surfaces_[j]->covariance();
  const double log_same = logNormalOf(apart, spread);
  spread += model_->changeCovariance();
  // Most pairs are so far apart that a bound on the other density decides: (A + Q)^-1 <= Q^-1, and
  // a determinant is at most the product of the diagonal (Hadamard).
  const double log_other_at_least = -0.5 * apart.dot(model_->changeInformation() * apart) -
                                    0.5 * spread.diagonal().array().log().sum();
  if (log_same <= log_other_at_least) return false;
  return log_same > logNormalOf(apart, spread);
}

void SurfaceBank::merge(size_t i, size_t j) {
  const KnownSurface& a = *surfaces_[i];
  const KnownSurface& b = *surfaces_[j];
  const Eigen::LLT<Eigen::MatrixXd> root_a(a.covariance());
  const Eigen::LLT<Eigen::MatrixXd> root_b(b.covariance());
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(a.mean().size(), a.mean().size());
  const Eigen::MatrixXd information =
      root_a.solve(one) + root_b.solve(one) - model_->changeInformation();
  RememberedSurface both = a.stored();
  both.x = information.llt().solve(root_a.solve(a.mean()) + root_b.solve(b.mean()));
  const double share =
      b.stored().executions() / (a.stored().executions() + b.stored().executions());
  both.noise += share * (b.stored().noise - both.noise);
  for (size_t p = 0; p < both.driven.size(); ++p) both.driven[p] += b.stored().driven[p];
  both.last_met = std::max(both.last_met, b.stored().last_met);
  surfaces_[i] = std::make_shared<const KnownSurface>(*model_, std::move(both));
  surfaces_.erase(surfaces_.begin() + static_cast<std::ptrdiff_t>(j));
}

void SurfaceBank::save(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(surfaces_.size()));
  for (const auto& known : surfaces_) {
    const RememberedSurface& surface = known->stored();
    memory.push_back(static_cast<double>(surface.last_met));
    memory.insert(memory.end(), surface.x.data(), surface.x.data() + surface.x.size());
    memory.insert(memory.end(), surface.driven.begin(), surface.driven.end());
    memory.insert(memory.end(), surface.noise.data(), surface.noise.data() + 3);
  }
}

bool SurfaceBank::restore(const std::vector<double>& memory, size_t& at) {
  const auto dimension = static_cast<size_t>(model_->dimension());
  const size_t each = 4 + dimension + model_->patterns();
  if (memory.size() <= at) return false;
  const double count = memory[at];
  if (!isCount(count, kMostSurfaces)) return false;
  const size_t end = at + 1 + static_cast<size_t>(count) * each;
  if (memory.size() < end) return false;
  for (size_t i = at; i < end; ++i)
    if (!std::isfinite(memory[i])) return false;
  std::vector<RememberedSurface> read(static_cast<size_t>(count));
  size_t next = at + 1;
  for (RememberedSurface& surface : read) {
    if (!isCount(memory[next], kMostExecutions)) return false;
    surface.last_met = static_cast<int64_t>(memory[next++]);
    surface.x.resize(model_->dimension());
    for (Eigen::Index i = 0; i < surface.x.size(); ++i) surface.x[i] = memory[next++];
    surface.driven.resize(model_->patterns());
    for (double& driven : surface.driven) driven = memory[next++];
    for (Eigen::Index axis = 0; axis < 3; ++axis) surface.noise[axis] = memory[next++];
    if (surface.noise.minCoeff() < kLeastNoise || surface.noise.maxCoeff() > kMostNoise ||
        *std::min_element(surface.driven.begin(), surface.driven.end()) < 0.0 ||
        !(surface.executions() >= 1.0 && surface.executions() <= kMostExecutions) ||
        surface.x.cwiseAbs().maxCoeff() > kLargestCorrection)
      return false;
  }
  surfaces_.clear();
  for (RememberedSurface& surface : read)
    surfaces_.push_back(std::make_shared<const KnownSurface>(*model_, std::move(surface)));
  at = end;
  return true;
}

}  // namespace tread::learner

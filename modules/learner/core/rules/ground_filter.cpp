// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace tread::learner {
namespace {

constexpr double kLargestTwist = 100.0;

/// log(e^a + e^b).
double logSum(double a, double b) {
  const double highest = std::max(a, b);
  return highest + std::log(std::exp(a - highest) + std::exp(b - highest));
}

}  // namespace

double logNormal(const Eigen::Vector3d& y, const Eigen::Matrix3d& S) {
  constexpr double kThreeLogTwoPi = 5.513631199228036;
  const Eigen::LLT<Eigen::Matrix3d> root(S);
  const Eigen::Vector3d scaled = root.matrixL().solve(y);
  const double log_determinant = 2.0 * root.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (scaled.squaredNorm() + log_determinant + kThreeLogTwoPi);
}

Eigen::Vector3d plausible(const Eigen::Vector3d& twist) {
  return twist.cwiseMax(-kLargestTwist).cwiseMin(kLargestTwist);
}

GroundFilter::GroundFilter(std::shared_ptr<const GroundModel> model, const FilterConfig& config)
    : model_(std::move(model)),
      hazard_(config.hazard),
      drift_(config.drift),
      steady_(config.steady),
      caution_(config.caution * config.caution),
      x_(Eigen::VectorXd::Zero(model_->dimension())),
      P_(config.steady * model_->changeCovariance()),
      PH_(model_->dimension(), 3),
      apart_(model_->dimension()) {
  for (Hypothesis* hypothesis : {&stayed_, &changed_}) {
    hypothesis->PH.resize(model_->dimension(), 3);
    hypothesis->root.resize(model_->dimension(), 3);
    hypothesis->step.resize(model_->dimension());
  }
}

void GroundFilter::consider(Hypothesis& hypothesis, double kept, double opened, size_t executed,
                            const Eigen::Vector3d& y) {
  hypothesis.PH.noalias() = kept * PH_ + opened * model_->changeResponse(executed);
  const Eigen::Matrix3d spread = model_->response(hypothesis.PH, executed);
  const Eigen::Matrix3d R = scaledNoise(model_->noise(executed), noise_);
  hypothesis.log_density = logNormal(y, spread + R);
  const Eigen::Matrix3d S = spread + caution_ * R;
  hypothesis.log_likelihood = logNormal(y, S);
  const Eigen::LLT<Eigen::Matrix3d> cholesky(S);
  const Eigen::Vector3d gained = cholesky.solve(y);
  hypothesis.step.noalias() = hypothesis.PH.lazyProduct(gained);
  const Eigen::Matrix3d inverse_root =
      cholesky.matrixL().solve(Eigen::Matrix3d::Identity()).transpose();
  hypothesis.root.noalias() = hypothesis.PH.lazyProduct(inverse_root);
}

double GroundFilter::update(size_t executed, const Eigen::Vector3d& mean_twist) {
  const Eigen::Vector3d y = plausible(mean_twist) - model_->meanTwistUnder(x_, executed);
  model_->timesResponse(P_, executed, PH_);
  consider(stayed_, 1.0 - drift_, drift_ * steady_, executed, y);
  if (hazard_ <= 0.0 && drift_ <= 0.0) return follow();
  consider(changed_, 1.0, 1.0, executed, y);
  const double log_s = std::log(1.0 - hazard_) + stayed_.log_likelihood;
  const double log_c = std::log(hazard_) + changed_.log_likelihood;
  const double highest = std::max(log_s, log_c);
  const double total = std::exp(log_s - highest) + std::exp(log_c - highest);
  const double w_c = std::exp(log_c - highest) / total;
  const double w_s = 1.0 - w_c;
  change_probability_ = w_c;
  // Merged covariance: the mean of the two and what their means differ. Column by column, each
  // element by the same sums as its mirror image, so that P stays symmetric to the bit.
  const double kept = w_s * (1.0 - drift_) + w_c;
  const double opened = w_s * drift_ * steady_ + w_c;
  stayed_.root *= std::sqrt(w_s);
  changed_.root *= std::sqrt(w_c);
  apart_ = std::sqrt(w_s * w_c) * (stayed_.step - changed_.step);
  const Eigen::MatrixXd& Q = model_->changeCovariance();
  for (Eigen::Index j = 0; j < model_->dimension(); ++j) {
    const auto& r = stayed_.root;
    const auto& q = changed_.root;
    P_.col(j) = kept * P_.col(j) + opened * Q.col(j) + apart_[j] * apart_ -
                (r(j, 0) * r.col(0) + q(j, 0) * q.col(0)) -
                (r(j, 1) * r.col(1) + q(j, 1) * q.col(1)) -
                (r(j, 2) * r.col(2) + q(j, 2) * q.col(2));
  }
  x_ += w_s * stayed_.step + w_c * changed_.step;
  return logSum(std::log(1.0 - hazard_) + stayed_.log_density,
                std::log(hazard_) + changed_.log_density);
}

double GroundFilter::follow() {
  // What the general case comes to with w_s = 1: most of its sums are of zeros.
  change_probability_ = 0.0;
  const auto& root = stayed_.root;
  for (Eigen::Index j = 0; j < model_->dimension(); ++j)
    P_.col(j) =
        P_.col(j) - root(j, 0) * root.col(0) - root(j, 1) * root.col(1) - root(j, 2) * root.col(2);
  x_ += stayed_.step;
  return stayed_.log_density;
}

void GroundFilter::restartAt(const Eigen::VectorXd& x, double share) {
  x_ = x;
  P_ = share * model_->changeCovariance();
}

void GroundFilter::assign(const GroundFilter& other) {
  x_ = other.x_;
  P_ = other.P_;
  change_probability_ = other.change_probability_;
}

void GroundFilter::save(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(model_->dimension()));
  memory.push_back(change_probability_);
  memory.insert(memory.end(), x_.data(), x_.data() + x_.size());
  for (Eigen::Index j = 0; j < P_.cols(); ++j)
    for (Eigen::Index i = j; i < P_.rows(); ++i) memory.push_back(P_(i, j));
}

bool GroundFilter::restore(const std::vector<double>& memory, size_t& at) {
  const Eigen::Index n = model_->dimension();
  const auto needed = static_cast<size_t>(2 + n + n * (n + 1) / 2);
  if (memory.size() < at + needed || memory[at] != static_cast<double>(n)) return false;
  for (size_t i = at; i < at + needed; ++i)
    if (!std::isfinite(memory[i])) return false;
  change_probability_ = memory[at + 1];
  if (change_probability_ < 0.0 || change_probability_ > 1.0) return false;
  at += 2;
  for (Eigen::Index i = 0; i < n; ++i) x_[i] = memory[at++];
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) P_(i, j) = P_(j, i) = memory[at++];
  return P_.llt().info() == Eigen::Success;
}

std::string percent(double probability) {
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

PoseCovariance upperTriangle(const Eigen::Matrix3d& covariance) {
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

LocalFilter::LocalFilter(const RuleConfig& config, const PatternSet& shipped)
    : model_(std::make_shared<GroundModel>(config.filter, shipped)),
      filter_(model_, config.filter) {}

void LocalFilter::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  const Eigen::Vector3d mean_twist = meanTwist(measured, model_->period());
  if (!mean_twist.allFinite()) return;  // beyond all numbers
  filter_.update(executed, mean_twist);
  note.change_probability = filter_.changeProbability();
}

std::string LocalFilter::reason(const RuleNote& note) const {
  return note.change_probability > 0.5
             ? "the ground changed (" + percent(note.change_probability) + ")"
             : "the same ground (" + percent(1.0 - note.change_probability) + ")";
}

void LocalFilter::predict(size_t pattern, Trajectory prediction) const {
  model_->profile(pattern).integrate(model_->correctionOf(filter_.mean(), pattern), prediction);
}

Pose2 LocalFilter::predictEnd(size_t pattern) const {
  return model_->profile(pattern).integrateEnd(model_->correctionOf(filter_.mean(), pattern));
}

std::optional<PoseCovariance> LocalFilter::endCovariance(size_t pattern) const {
  const auto& J = model_->profile(pattern).endResponse();
  return upperTriangle(J * model_->covarianceOf(filter_.covariance(), pattern) * J.transpose() +
                       model_->endNoise(pattern));
}

void LocalFilter::assign(const LearningRule& other) {
  filter_.assign(static_cast<const LocalFilter&>(other).filter_);
}

std::vector<double> LocalFilter::memory() const {
  std::vector<double> memory;
  filter_.save(memory);
  return memory;
}

bool LocalFilter::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  GroundFilter restored = filter_;
  size_t at = 0;
  if (!restored.restore(memory, at) || at != memory.size()) return false;
  filter_ = restored;
  return true;
}

}  // namespace tread::learner

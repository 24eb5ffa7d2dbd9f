// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tread::learner {
namespace {

using Index = TwistCorrection::Index;
constexpr double kKernelRange = 0.6;  // [1] of the largest |v|, |w|
constexpr double kNear = 0.1, kMirrored = 0.7, kAlone = 0.2;
/// A pattern must turn and drive this much to tell of noise [rad, m].
constexpr double kLeastTurn = 0.1, kLeastLength = 0.2;

double squared(double value) {
  return value * value;
}

/// Kernels of the distance of two patterns, and of one to the other's mirror image.
struct Kernels {
  Eigen::MatrixXd near;
  Eigen::MatrixXd mirrored;
};

Kernels kernelsOf(const std::vector<TwistProfile>& profiles) {
  double v_max = 1e-6;
  double w_max = 1e-6;
  for (const TwistProfile& profile : profiles) {
    v_max = std::max(v_max, std::abs(profile.mean()[0]));
    w_max = std::max(w_max, std::abs(profile.mean()[2]));
  }
  const auto n = static_cast<Eigen::Index>(profiles.size());
  Kernels kernels{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Vector3d& a = profiles[static_cast<size_t>(i)].mean();
      const Eigen::Vector3d& b = profiles[static_cast<size_t>(j)].mean();
      const double dv2 = squared((a[0] - b[0]) / (kKernelRange * v_max));
      kernels.near(i, j) = std::exp(-0.5 * (dv2 + squared((a[2] - b[2]) / (kKernelRange * w_max))));
      kernels.mirrored(i, j) =
          std::exp(-0.5 * (dv2 + squared((a[2] + b[2]) / (kKernelRange * w_max))));
    }
  }
  return kernels;
}

/// Correlations of one axis' residuals; sign +1: equal in mirrored patterns, -1: opposite.
Eigen::MatrixXd correlations(const Kernels& kernels, double sign) {
  constexpr double kLeastSpread = 0.05;  // the odd kernel has no spread in straight patterns
  const Eigen::MatrixXd sum = kernels.near + sign * kernels.mirrored;
  const Eigen::ArrayXd scale = sum.diagonal().array().max(kLeastSpread).sqrt();
  Eigen::MatrixXd result = kNear * kernels.near;
  for (Eigen::Index i = 0; i < sum.rows(); ++i)
    for (Eigen::Index j = 0; j < sum.cols(); ++j)
      result(i, j) += kMirrored * sum(i, j) / (scale[i] * scale[j]);
  result.diagonal().array() += kAlone;
  return result;
}

/// Covariance of the mean twist that explains the recorded spread of a pattern's end; nothing where
/// it is unknown.
std::optional<Eigen::Matrix3d> recordedNoise(const MotionPattern& pattern,
                                             const TwistProfile& profile) {
  const PoseCovariance& known = pattern.end_covariance;
  if (!isKnown(known)) return std::nullopt;
  Eigen::Matrix3d covariance;
  covariance << known[0], known[1], known[2], known[1], known[3], known[4], known[2], known[4],
      known[5];
  const Eigen::FullPivLU<Eigen::Matrix3d> lever(profile.endLever());
  if (!lever.isInvertible()) return std::nullopt;
  const Eigen::Matrix3d inverse = lever.inverse();
  const Eigen::Matrix3d noise = inverse * covariance * inverse.transpose();
  // A file may hold any six numbers.
  if (!noise.allFinite() || noise.llt().info() == Eigen::NumericalIssue) return std::nullopt;
  return Eigen::Matrix3d(0.5 * (noise + noise.transpose()));
}

/// What the configuration expects, without the factor.
Eigen::Matrix3d expectedNoise(const TwistNoise& noise, const TwistProfile& profile) {
  const double v = profile.meanSpeed();
  const double w = profile.meanTurn();
  return Eigen::Vector3d(squared(noise.forward * v) + squared(noise.floor_speed),
                         squared(noise.lateral * v) + squared(noise.floor_speed),
                         squared(noise.yaw * w) + squared(noise.floor_yaw))
      .asDiagonal();
}

}  // namespace

Eigen::Matrix3d scaledNoise(const Eigen::Matrix3d& R, const Eigen::Vector3d& factors) {
  const Eigen::Vector3d root = factors.cwiseSqrt();
  return root.asDiagonal() * R * root.asDiagonal();
}

GroundModel::GroundModel(const FilterConfig& config, const PatternSet& shipped)
    : period_(shipped.periodSeconds()),
      dimension_(TwistCorrection::kCommon +
                 3 * static_cast<Eigen::Index>(shipped.patterns().size())) {
  for (const MotionPattern& pattern : shipped.patterns()) profiles_.emplace_back(pattern, period_);
  fillChangeCovariance(config);
  change_information_ = change_.llt().solve(Eigen::MatrixXd::Identity(dimension_, dimension_));
  fillNoise(config, shipped);
  for (size_t p = 0; p < profiles_.size(); ++p) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> QH(dimension_, 3);
    timesResponse(change_, p, QH);
    change_response_.push_back(QH);
  }
}

void GroundModel::fillChangeCovariance(const FilterConfig& config) {
  change_ = Eigen::MatrixXd::Zero(dimension_, dimension_);
  for (int i = 0; i < TwistCorrection::kCommon; ++i)
    change_(i, i) = squared(config.common_factor * config.common[static_cast<size_t>(i)]);
  const Kernels kernels = kernelsOf(profiles_);
  const Eigen::MatrixXd even = correlations(kernels, 1.0);
  const Eigen::MatrixXd odd = correlations(kernels, -1.0);
  const auto n = static_cast<Eigen::Index>(profiles_.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double sigma = config.residual[static_cast<size_t>(axis)];
        change_(TwistCorrection::kCommon + 3 * i + axis, TwistCorrection::kCommon + 3 * j + axis) =
            squared(sigma) * (axis == 1 ? odd(i, j) : even(i, j));
      }
    }
  }
}

void GroundModel::fillNoise(const FilterConfig& config, const PatternSet& shipped) {
  const double factor = squared(config.noise_factor);
  for (size_t p = 0; p < profiles_.size(); ++p) {
    Eigen::Matrix3d noise = expectedNoise(config.noise, profiles_[p]);
    if (const auto recorded = recordedNoise(shipped.patterns()[p], profiles_[p]))
      noise = (1.0 - config.recorded) * noise + config.recorded * *recorded;
    const Eigen::Matrix3d& lever = profiles_[p].endLever();
    noise_.push_back(factor * noise);
    end_noise_.push_back(lever * noise * lever.transpose());
  }
}

Correction10 GroundModel::correctionOf(const Eigen::VectorXd& x, size_t pattern) const {
  Correction10 correction;
  correction.head<TwistCorrection::kCommon>() = x.head<TwistCorrection::kCommon>();
  correction.tail<TwistCorrection::kOwn>() = x.segment<TwistCorrection::kOwn>(ownAt(pattern));
  return correction;
}

Eigen::Matrix<double, 10, 10> GroundModel::covarianceOf(const Eigen::MatrixXd& P,
                                                        size_t pattern) const {
  constexpr int common = TwistCorrection::kCommon;
  constexpr int own = TwistCorrection::kOwn;
  const Eigen::Index at = ownAt(pattern);
  Eigen::Matrix<double, 10, 10> covariance;
  covariance.topLeftCorner<common, common>() = P.topLeftCorner<common, common>();
  covariance.topRightCorner<common, own>() = P.block<common, own>(0, at);
  covariance.bottomLeftCorner<own, common>() = P.block<own, common>(at, 0);
  covariance.bottomRightCorner<own, own>() = P.block<own, own>(at, at);
  return covariance;
}

Eigen::Vector3d GroundModel::meanTwistUnder(const Eigen::VectorXd& x, size_t pattern) const {
  const TwistProfile& profile = profiles_[pattern];
  return profile.mean() + profile.meanResponse() * correctionOf(x, pattern);
}

void GroundModel::timesResponse(const Eigen::MatrixXd& P, size_t pattern,
                                Eigen::Matrix<double, Eigen::Dynamic, 3>& result) const {
  const auto& H = profiles_[pattern].meanResponse();
  result.noalias() = P.leftCols<TwistCorrection::kCommon>().lazyProduct(
      H.leftCols<TwistCorrection::kCommon>().transpose());
  result.noalias() += P.middleCols<TwistCorrection::kOwn>(ownAt(pattern))
                          .lazyProduct(H.rightCols<TwistCorrection::kOwn>().transpose());
}

Eigen::Matrix3d GroundModel::response(const Eigen::Matrix<double, Eigen::Dynamic, 3>& A,
                                      size_t pattern) const {
  const auto& H = profiles_[pattern].meanResponse();
  return H.leftCols<TwistCorrection::kCommon>() * A.topRows<TwistCorrection::kCommon>() +
         H.rightCols<TwistCorrection::kOwn>() * A.middleRows<TwistCorrection::kOwn>(ownAt(pattern));
}

}  // namespace tread::learner

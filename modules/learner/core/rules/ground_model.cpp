// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tread::learner {
namespace {

using Index = TwistCorrection::Index;
constexpr int kOwnForward = TwistCorrection::kCommon;
constexpr int kOwnLateral = TwistCorrection::kCommon + 1;
constexpr int kOwnYaw = TwistCorrection::kCommon + 2;

/// sin(x) / x and cos(x); the series are exact to 1e-16 where they are used.
struct HalfTurn {
  explicit HalfTurn(double x) {
    const double x2 = x * x;
    if (x2 > 0.01) {
      sinc = std::sin(x) / x;
      cosine = std::cos(x);
      return;
    }
    constexpr double k6 = 1.0 / 6.0, k20 = 1.0 / 20.0, k42 = 1.0 / 42.0, k72 = 1.0 / 72.0;
    constexpr double k12 = 1.0 / 12.0, k30 = 1.0 / 30.0, k56 = 1.0 / 56.0, k90 = 1.0 / 90.0;
    sinc = 1.0 - k6 * x2 * (1.0 - k20 * x2 * (1.0 - k42 * x2 * (1.0 - k72 * x2)));
    cosine =
        1.0 - 0.5 * x2 * (1.0 - k12 * x2 * (1.0 - k30 * x2 * (1.0 - k56 * x2 * (1.0 - k90 * x2))));
  }
  double sinc;
  double cosine;
};

/// Chord over arc of a sample that turns by 2 `half`. Beyond half a turn a sample the arc would be
/// ambiguous; its chord is taken.
double chordShare(double half, double sinc) {
  return std::abs(half) < 1.5 ? sinc : 1.0;
}

/// The motion of one sample, (v, s, w) times the period.
Eigen::Vector3d sampleMotion(const Pose2& from, const Pose2& to) {
  const double half = 0.5 * (to.yaw - from.yaw);
  const double c = std::cos(from.yaw + half);
  const double s = std::sin(from.yaw + half);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double arc_over_chord = 1.0 / chordShare(half, HalfTurn(half).sinc);
  return {arc_over_chord * (c * dx + s * dy), arc_over_chord * (c * dy - s * dx), 2.0 * half};
}

/// A correction beyond these is none that ground makes; predictions stay drivable.
constexpr double kLargestFactor = 3.0;
constexpr double kLargestBias = 0.5;  // [rad/m]

double clamped(double value, double low, double high) {
  return value < low ? low : (value > high ? high : value);
}

using Index = TwistCorrection::Index;
constexpr double kKernelRange = 0.6;  // [1] of the largest |v|, |w|
constexpr double kNear = 0.1, kMirrored = 0.7, kAlone = 0.2;

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

TwistProfile::TwistProfile(const MotionPattern& shipped, double period) : period_(period) {
  Pose2 last;
  mean_.setZero();
  for (const Pose2& pose : shipped.trajectory) {
    const Eigen::Vector3d twist = sampleMotion(last, pose) / period;
    forward_.push_back(twist[0]);
    lateral_.push_back(twist[1]);
    yaw_.push_back(twist[2]);
    last = pose;
  }
  measureResponses();
}

void TwistProfile::measureResponses() {
  const double share = 1.0 / static_cast<double>(forward_.size());
  mean_response_.setZero();
  end_response_.setZero();
  end_lever_.setZero();
  const Pose2 end = integrateEnd(Correction10::Zero());
  const Correction10 none = Correction10::Zero();
  std::vector<Pose2> poses;
  walk(none, [&](size_t, const Pose2& pose) { poses.push_back(pose); });
  Pose2 at;
  for (size_t t = 0; t < forward_.size(); ++t) {
    const double v = forward_[t];
    const double w = yaw_[t];
    Eigen::Matrix<double, 3, TwistCorrection::kAll> response;  // of this sample's twist
    response.setZero();
    response(0, Index::kForward) = response(0, kOwnForward) = v;
    response(0, Index::kTurnLoss) = -std::abs(w) * v;
    response(1, Index::kSideslip) = std::abs(v) * w;
    response(1, Index::kCrab) = response(1, kOwnLateral) = v;
    response(2, Index::kYaw) = response(2, kOwnYaw) = w;
    response(2, Index::kYawBySpeed) = std::abs(v) * w;
    response(2, Index::kYawBias) = v;
    mean_ += share * Eigen::Vector3d(v, lateral_[t], w);
    mean_speed_ += share * std::abs(v);
    mean_turn_ += share * std::abs(w);
    mean_response_ += share * response;
    // A change of this sample's twist moves the end: the step itself, and the turn about its place.
    const double middle = at.yaw + 0.5 * w * period_;
    const double c = std::cos(middle);
    const double s = std::sin(middle);
    const Pose2& next = poses[t];
    const double x_rest = end.x - 0.5 * (at.x + next.x);
    const double y_rest = end.y - 0.5 * (at.y + next.y);
    Eigen::Matrix3d lever;
    lever << c, -s, -y_rest, s, c, x_rest, 0.0, 0.0, 1.0;
    end_response_ += period_ * lever * response;
    end_lever_ += period_ * lever;
    at = next;
  }
}

template <typename Put>
Pose2 TwistProfile::walk(const Correction10& x, Put&& put) const {
  const double gain = 1.0 + x[Index::kForward] + x[kOwnForward];
  const double crab = clamped(x[Index::kCrab] + x[kOwnLateral], -1.0, 1.0);
  const double turn = 1.0 + x[Index::kYaw] + x[kOwnYaw];
  const double bias = clamped(x[Index::kYawBias], -kLargestBias, kLargestBias);
  Pose2 at;
  double c_at = 1.0, s_at = 0.0;  // of at.yaw, turned along instead of computed anew
  for (size_t t = 0; t < forward_.size(); ++t) {
    const double v = forward_[t];
    const double w = yaw_[t];
    const double forward = clamped(gain - x[Index::kTurnLoss] * std::abs(w), 0.0, kLargestFactor);
    const double yaw = clamped(turn + x[Index::kYawBySpeed] * std::abs(v), 0.0, kLargestFactor);
    const double slip = clamped(x[Index::kSideslip] * w, -1.0, 1.0);
    const double v_new = forward * v;
    const double s_new = lateral_[t] + slip * std::abs(v) + crab * v;
    const double w_new = yaw * w + bias * v;
    const double half = 0.5 * w_new * period_;
    const HalfTurn turned(half);
    const double chord = chordShare(half, turned.sinc) * period_;
    const double sine = half * turned.sinc;
    const double c = c_at * turned.cosine - s_at * sine;
    const double s = s_at * turned.cosine + c_at * sine;
    c_at = c * turned.cosine - s * sine;
    s_at = s * turned.cosine + c * sine;
    at.x += chord * (c * v_new - s * s_new);
    at.y += chord * (s * v_new + c * s_new);
    at.yaw += 2.0 * half;
    put(t, at);
  }
  return at;
}

void TwistProfile::integrate(const Correction10& correction, Trajectory prediction) const {
  walk(correction, [&](size_t t, const Pose2& pose) {
    const auto row = static_cast<Eigen::Index>(t);
    prediction(row, 0) = pose.x;
    prediction(row, 1) = pose.y;
    prediction(row, 2) = pose.yaw;
  });
}

Pose2 TwistProfile::integrateEnd(const Correction10& correction) const {
  return walk(correction, [](size_t, const Pose2&) {});
}

Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, double period) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Pose2 last;
  for (Eigen::Index t = 0; t < trajectory.rows(); ++t) {
    const Pose2 pose{trajectory(t, 0), trajectory(t, 1), trajectory(t, 2)};
    sum += sampleMotion(last, pose);
    last = pose;
  }
  return sum / (period * static_cast<double>(trajectory.rows()));
}

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

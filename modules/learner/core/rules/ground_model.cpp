// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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
constexpr double kLargestBias = 0.5;  // [rad/m]; [m] of push and shift

double clamped(double value, double low, double high) {
  return value < low ? low : (value > high ? high : value);
}

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

Kernels kernelsOf(const std::vector<PatternPart>& patterns) {
  double v_max = 1e-6;
  double w_max = 1e-6;
  for (const PatternPart& pattern : patterns) {
    v_max = std::max(v_max, std::abs(pattern.mean[0]));
    w_max = std::max(w_max, std::abs(pattern.mean[2]));
  }
  const auto n = static_cast<Eigen::Index>(patterns.size());
  Kernels kernels{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Vector3d& a = patterns[static_cast<size_t>(i)].mean;
      const Eigen::Vector3d& b = patterns[static_cast<size_t>(j)].mean;
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

/// Variances of the mean twist that explain the recorded spread of a pattern's end; nothing where
/// it is unknown.
std::optional<Eigen::Vector3d> recordedNoise(const MotionPattern& pattern,
                                             const TwistProfile& profile) {
  const PoseCovariance& known = pattern.end_covariance;
  if (!isKnown(known)) return std::nullopt;
  Eigen::Matrix3d covariance;
  covariance << known[0], known[1], known[2], known[1], known[3], known[4], known[2], known[4],
      known[5];
  const Eigen::FullPivLU<Eigen::Matrix3d> lever(profile.endLever());
  if (!lever.isInvertible()) return std::nullopt;
  const Eigen::Matrix3d inverse = lever.inverse();
  const Eigen::Vector3d noise = (inverse * covariance * inverse.transpose()).diagonal();
  // A file may hold any six numbers.
  if (!noise.allFinite() || noise.minCoeff() < 0.0) return std::nullopt;
  return noise;
}

}  // namespace

TwistProfile::TwistProfile(const MotionPattern& shipped, double period) : period_(period) {
  Pose2 last;
  for (const Pose2& pose : shipped.trajectory) {
    const Eigen::Vector3d twist = sampleMotion(last, pose) / period;
    forward_.push_back(twist[0]);
    lateral_.push_back(twist[1]);
    yaw_.push_back(twist[2]);
    last = pose;
  }
  measureResponses();
}

/// Change of a sample's twist per unit of each correction.
Eigen::Matrix<double, 3, TwistCorrection::kAll> sampleResponse(double v, double w) {
  Eigen::Matrix<double, 3, TwistCorrection::kAll> response;
  response.setZero();
  response(0, Index::kForward) = response(0, kOwnForward) = v;
  response(0, Index::kTurnLoss) = -std::abs(w) * v;
  response(0, Index::kPush) = response(1, Index::kShift) = w;
  response(1, Index::kSideslip) = std::abs(v) * w;
  response(1, Index::kCrab) = response(1, kOwnLateral) = v;
  response(2, Index::kYaw) = response(2, kOwnYaw) = w;
  response(2, Index::kYawBySpeed) = std::abs(v) * w;
  response(2, Index::kYawBias) = v;
  return response;
}

void TwistProfile::measureResponses() {
  end_response_.setZero();
  end_lever_.setZero();
  const CorrectionVector none = CorrectionVector::Zero();
  std::vector<Pose2> poses;
  const Pose2 end = walk(none, [&](size_t, const Pose2& pose) { poses.push_back(pose); });
  Pose2 at;
  for (size_t t = 0; t < forward_.size(); ++t) {
    // A change of this sample's twist moves the end: the step itself, and the turn about its place.
    const double middle = at.yaw + 0.5 * yaw_[t] * period_;
    const double c = std::cos(middle);
    const double s = std::sin(middle);
    const Pose2& next = poses[t];
    const double x_rest = end.x - 0.5 * (at.x + next.x);
    const double y_rest = end.y - 0.5 * (at.y + next.y);
    Eigen::Matrix3d lever;
    lever << c, -s, -y_rest, s, c, x_rest, 0.0, 0.0, 1.0;
    end_response_ += period_ * lever * sampleResponse(forward_[t], yaw_[t]);
    end_lever_ += period_ * lever;
    at = next;
  }
}

PatternPart TwistProfile::part(Eigen::Index samples) const {
  PatternPart part;
  part.samples = samples;
  part.mean.setZero();
  Eigen::Matrix<double, 3, TwistCorrection::kAll> response;
  response.setZero();
  for (size_t t = 0; t < static_cast<size_t>(samples); ++t) {
    part.mean += Eigen::Vector3d(forward_[t], lateral_[t], yaw_[t]);
    response += sampleResponse(forward_[t], yaw_[t]);
    part.metres += period_ * std::abs(forward_[t]);
  }
  const double share = 1.0 / static_cast<double>(samples);
  part.mean *= share;
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto row = static_cast<Eigen::Index>(velocity);
    part.own[velocity] = share * response(row, TwistCorrection::kCommon + row);
    for (Eigen::Index i = 0; i < kTerms; ++i)
      part.common[velocity][static_cast<size_t>(i)] = share * response(row, kTerms * row + i);
  }
  return part;
}

Eigen::Vector2d TwistProfile::meanSpeed(Eigen::Index samples) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (size_t t = 0; t < static_cast<size_t>(samples); ++t)
    sum += Eigen::Vector2d(std::abs(forward_[t]), std::abs(yaw_[t]));
  return sum / static_cast<double>(samples);
}

Eigen::Vector3d TwistProfile::change(Eigen::Index samples) const {
  const auto last = static_cast<size_t>(samples - 1);
  return {forward_[last] - forward_[0], lateral_[last] - lateral_[0], yaw_[last] - yaw_[0]};
}

template <typename Put>
Pose2 TwistProfile::walk(const CorrectionVector& x, Put&& put) const {
  const double gain = 1.0 + x[Index::kForward] + x[kOwnForward];
  const double crab = clamped(x[Index::kCrab] + x[kOwnLateral], -1.0, 1.0);
  const double turn = 1.0 + x[Index::kYaw] + x[kOwnYaw];
  const double bias = clamped(x[Index::kYawBias], -kLargestBias, kLargestBias);
  const double push = clamped(x[Index::kPush], -kLargestBias, kLargestBias);
  const double shift = clamped(x[Index::kShift], -kLargestBias, kLargestBias);
  Pose2 at;
  double c_at = 1.0, s_at = 0.0;  // of at.yaw, turned along instead of computed anew
  for (size_t t = 0; t < forward_.size(); ++t) {
    const double v = forward_[t];
    const double w = yaw_[t];
    const double forward = clamped(gain - x[Index::kTurnLoss] * std::abs(w), 0.0, kLargestFactor);
    const double yaw = clamped(turn + x[Index::kYawBySpeed] * std::abs(v), 0.0, kLargestFactor);
    const double slip = clamped(x[Index::kSideslip] * w, -1.0, 1.0);
    const double v_new = forward * v + push * w;
    const double s_new = lateral_[t] + slip * std::abs(v) + crab * v + shift * w;
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

void TwistProfile::integrate(const CorrectionVector& correction, Trajectory prediction) const {
  walk(correction, [&](size_t t, const Pose2& pose) {
    const auto row = static_cast<Eigen::Index>(t);
    prediction(row, 0) = pose.x;
    prediction(row, 1) = pose.y;
    prediction(row, 2) = pose.yaw;
  });
}

Pose2 TwistProfile::integrateEnd(const CorrectionVector& correction) const {
  return walk(correction, [](size_t, const Pose2&) {});
}

Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, Eigen::Index samples, double period) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Pose2 last;
  for (Eigen::Index t = 0; t < samples; ++t) {
    const Pose2 pose{trajectory(t, 0), trajectory(t, 1), trajectory(t, 2)};
    sum += sampleMotion(last, pose);
    last = pose;
  }
  return sum / (period * static_cast<double>(samples));
}

GroundModel::GroundModel(const GroundConfig& config, const PatternSet& shipped)
    : period_(shipped.periodSeconds()), noise_(config.noise) {
  for (const MotionPattern& pattern : shipped.patterns()) {
    profiles_.emplace_back(pattern, period_);
    const auto recorded = recordedNoise(pattern, profiles_.back());
    recorded_share_.push_back(recorded ? config.recorded : 0.0);
    recorded_.push_back(recorded.value_or(Eigen::Vector3d::Zero()));
  }
  for (size_t p = 0; p < profiles_.size(); ++p) whole_.push_back(part(p, profiles_[p].samples()));
  fillSpread(config);
}

PatternPart GroundModel::part(size_t pattern, Eigen::Index samples) const {
  const TwistProfile& profile = profiles_[pattern];
  PatternPart part = profile.part(samples);
  part.pattern = pattern;
  const Eigen::Vector2d speed = profile.meanSpeed(samples);
  const double seconds = period_ * static_cast<double>(samples);
  const double moved = squared(noise_.position / seconds) + squared(noise_.turning * speed[1]);
  // A profile that comes later by dt loses dt of its change: no gain of ground explains that.
  const Eigen::Vector3d late = noise_.lag / seconds * profile.change(samples);
  const Eigen::Vector3d expected =
      Eigen::Vector3d(squared(noise_.forward * speed[0]) + moved,
                      squared(noise_.lateral * speed[0]) + moved,
                      squared(noise_.yaw * speed[1]) + squared(noise_.wander * speed[0]) +
                          squared(noise_.heading / seconds)) +
      late.cwiseAbs2();
  // A turn on the spot moves, too: half a metre for a radian.
  constexpr double kMetresPerRadian = 0.5;
  part.shape = squared(noise_.shape * (part.metres + kMetresPerRadian * speed[1] * seconds)) +
               squared(noise_.position);
  const double share = recorded_share_[pattern];
  constexpr double kLeast = 0.05;
  // A recording of nothing is no proof that an execution is exact.
  part.noise = ((1.0 - share) * expected + share * recorded_[pattern]).cwiseMax(kLeast * expected);
  return part;
}

void GroundModel::fillSpread(const GroundConfig& config) {
  const Kernels kernels = kernelsOf(whole_);
  const auto n = static_cast<Eigen::Index>(profiles_.size());
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    Eigen::MatrixXd& spread = spread_[velocity];
    spread = Eigen::MatrixXd::Zero(kTerms + n, kTerms + n);
    for (Eigen::Index i = 0; i < kTerms; ++i)
      spread(i, i) =
          squared(config.common[static_cast<size_t>(kTerms) * velocity + static_cast<size_t>(i)]);
    spread.bottomRightCorner(n, n) =
        squared(config.residual[velocity]) * correlations(kernels, velocity == 1 ? -1.0 : 1.0);
  }
}

}  // namespace tread::learner

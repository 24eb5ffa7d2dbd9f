// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/twist_profile.hpp"

#include <cmath>

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

}  // namespace tread::learner

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_model.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <optional>
#include <string>

#include <Eigen/LU>

namespace tread::learner {
namespace {

// Distribution of corrections on a ground of scale 1, relative to gain, to turns and to yaw gain
// [1].
constexpr double kCrabSpread = 0.2;
constexpr double kShearSpread = 0.3;  // times isotropy: along one axis it is gain and crab
constexpr double kTurnLossSpread = 0.7;
constexpr double kSideslipSpread = 0.7;
constexpr double kShiftSpread = 0.5;
constexpr double kYawBySpeedSpread = 0.6;
/// Share of yaw bias that differs between patterns [1].
constexpr double kBiasApart = 0.5;
/// A turn on the spot moves half as much as straight driving at the same track speed.
constexpr double kTurnMoves = 0.5;
/// Share of the recorded spread of ends in the noise, if there is one [1].
constexpr double kRecorded = 0.9;
/// Lower limit of the turn rate's scale for a set that hardly turns: [1] of v_ref / lever.
constexpr double kLeastTurn = 0.2;

/// Larger corrections are not caused by ground; predictions stay drivable.
constexpr double kLargestFactor = 3.0;
constexpr double kLargestBias = 0.5;     // [rad/m]
constexpr double kLargestLag = 1.0;      // [s] ice: a second to full speed
constexpr double kLargestTurnLag = 0.5;  // [s]
/// Of the velocity's lag: variation between executions, relative to the possible error of a set.
constexpr double kLagNoise = 0.3;
/// The turn rate at an end of a pattern is its mean over this [s].
constexpr double kEndOfTurn = 0.15;
/// [s] in which an entry deviation decays, for the part that affects a pattern.
constexpr double kGone = 0.5;

/// sin(x) / x and cos(x); the series are exact to 1e-16 in the range used.
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

/// Ratio of chord to arc for a sample that turns by 2 `half`. Beyond half a turn per sample the arc
/// would be ambiguous, so the chord is used.
double chordShare(double half, double sinc) {
  return std::abs(half) < 1.5 ? sinc : 1.0;
}

/// The motion of one sample, its twist times the period.
Eigen::Vector3d sampleMotion(const Pose2& from, const Pose2& to) {
  const double half = 0.5 * (to.yaw - from.yaw);
  const double c = std::cos(from.yaw + half);
  const double s = std::sin(from.yaw + half);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double arc_over_chord = 1.0 / chordShare(half, HalfTurn(half).sinc);
  return {arc_over_chord * (c * dx + s * dy), arc_over_chord * (c * dy - s * dx), 2.0 * half};
}

/// Change of a sample's twist per unit of each correction.
struct Response {
  /// `change`: of the velocity since the previous sample, per second.
  Response(const BodyScale& scale, const Eigen::Vector3d& twist, const Eigen::Vector2d& change) {
    const Eigen::Vector2d V = twist.head<2>();
    const Eigen::Vector2d left(-V[1], V[0]);  // J V
    const double w = twist[2];
    const double speed = V.norm();
    velocity.col(TwistCorrection::kGain) = V;
    velocity.col(TwistCorrection::kCrab) = left;
    velocity.col(TwistCorrection::kShear) << V[0], -V[1];
    velocity.col(TwistCorrection::kShearAcross) << V[1], V[0];
    velocity.col(TwistCorrection::kTurnLoss) = -std::abs(w) / scale.turn * V;
    velocity.col(TwistCorrection::kSideslip) = w / scale.turn * left;
    velocity.col(TwistCorrection::kShiftX) << w * scale.speed / scale.turn, 0.0;
    velocity.col(TwistCorrection::kShiftY) << 0.0, w * scale.speed / scale.turn;
    velocity.col(TwistCorrection::kLag) = -change;
    const double moves = std::hypot(speed, kTurnMoves * scale.speed / scale.turn * w);
    own.col(0) = moves * scale.axis;
    own.col(1) = moves * Eigen::Vector2d(-scale.axis[1], scale.axis[0]);
    yaw << w, w * speed / scale.speed, V[0], V[1], 0.0;  // the lag: for a part as a whole
    yaw_own = w;
    bias_own = speed;
  }
  Eigen::Matrix<double, 2, TwistCorrection::kVelocity> velocity;
  Eigen::Matrix2d own;
  Eigen::Matrix<double, 1, TwistCorrection::kTurning> yaw;
  double yaw_own, bias_own;
};

/// Covariance of the mean twist that explains the recorded spread of a pattern's end; nullopt if
/// that is unknown.
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
  // A file may contain any six numbers.
  if (!noise.allFinite() || noise.diagonal().minCoeff() < 0.0) return std::nullopt;
  return noise;
}

}  // namespace

Eigen::Vector3d TwistCorrection::added(const PatternPart& part) const {
  Eigen::Vector3d added;
  added.head<2>() = part.velocity * common.head<kVelocity>() + part.own * own.head<2>();
  added[2] = part.yaw * common.tail<kTurning>();
  added[2] += part.yaw_own * own[kYawOwn] + part.bias_own * own[kBiasOwn];
  return added;
}

TwistProfile::TwistProfile(const MotionPattern& shipped, double period) : period_(period) {
  std::vector<Pose2> poses{{}};
  for (const Pose2& pose : shipped.trajectory) {
    twists_.emplace_back(sampleMotion(poses.back(), pose) / period);
    poses.push_back(pose);
  }
  // A change of a sample's twist moves the end by the step itself, and by the rotation about its
  // position.
  end_lever_.setZero();
  for (size_t t = 0; t < twists_.size(); ++t) {
    const double middle = poses[t].yaw + 0.5 * twists_[t][2] * period_;
    const double c = std::cos(middle);
    const double s = std::sin(middle);
    Eigen::Matrix3d lever;
    lever << c, -s, -(poses.back().y - 0.5 * (poses[t].y + poses[t + 1].y)), s, c,
        poses.back().x - 0.5 * (poses[t].x + poses[t + 1].x), 0.0, 0.0, 1.0;
    end_lever_ += period_ * lever;
  }
}

PatternPart TwistProfile::part(const BodyScale& scale, Eigen::Index first,
                               Eigen::Index samples) const {
  PatternPart part;
  part.first = first;
  part.samples = samples;
  part.mean.setZero();
  part.velocity.setZero();
  part.own.setZero();
  part.yaw.setZero();
  const double share = 1.0 / static_cast<double>(samples);
  for (auto t = static_cast<size_t>(first); t < static_cast<size_t>(first + samples); ++t) {
    const Eigen::Vector2d before = twists_[t > 0 ? t - 1 : 0].head<2>();
    const Response response(scale, twists_[t], (twists_[t].head<2>() - before) / period_);
    part.mean += share * twists_[t];
    part.velocity += share * response.velocity;
    part.own += share * response.own;
    part.yaw += share * response.yaw;
    part.yaw_own += share * response.yaw_own;
    part.bias_own += share * response.bias_own;
    part.turning += share * std::abs(twists_[t][2]);
  }
  part.yaw[TwistCorrection::kYawLag - TwistCorrection::kVelocity] =
      lossByLag(scale, first, samples);
  part.speed = part.bias_own;
  part.metres = part.speed * period_ * static_cast<double>(samples);
  const double length = part.mean.head<2>().norm();
  const Eigen::Vector2d along =
      length > 1e-9 ? Eigen::Vector2d(part.mean.head<2>() / length) : scale.axis;
  part.to_path << along[0], along[1], -along[1], along[0];
  part.velocity = part.to_path * part.velocity;
  part.own = part.to_path * part.own;
  return part;
}

/// Mean loss of turn rate in the first samples, per second of lag of turns: change of the rate from
/// their beginning to their end, over the time; minus the part that looks like a gain.
double TwistProfile::lossByLag(const BodyScale& scale, Eigen::Index first,
                               Eigen::Index samples) const {
  const auto edge = static_cast<Eigen::Index>(std::lround(kEndOfTurn / period_));
  const Eigen::Index n = std::clamp<Eigen::Index>(edge, 1, std::max<Eigen::Index>(1, samples / 3));
  double change = 0.0, mean = 0.0;
  for (Eigen::Index t = 0; t < samples; ++t) {
    const double w = twists_[static_cast<size_t>(first + t)][2];
    mean += w / static_cast<double>(samples);
    if (t < n) change -= w / static_cast<double>(n);
    if (t >= samples - n) change += w / static_cast<double>(n);
  }
  return scale.lag_as_turn * mean - change / (period_ * static_cast<double>(samples));
}

/// Velocity this many samples before t, held at both ends.
Eigen::Vector2d TwistProfile::velocityBefore(double samples, size_t t) const {
  if (samples == 0.0) return twists_[t].head<2>();
  const double at =
      std::clamp(static_cast<double>(t) - samples, 0.0, static_cast<double>(twists_.size() - 1));
  const auto before = static_cast<size_t>(at);
  const size_t after = std::min(before + 1, twists_.size() - 1);
  return twists_[before].head<2>() +
         (at - static_cast<double>(before)) * (twists_[after] - twists_[before]).head<2>();
}

template <typename Put>
Pose2 TwistProfile::walk(const BodyScale& scale, const TwistCorrection& x, Put&& put) const {
  const auto& c = x.common;
  const auto within = [](double value, double most) { return std::clamp(value, -most, most); };
  const double crab = within(c[TwistCorrection::kCrab], 1.0);
  const double shear = within(c[TwistCorrection::kShear], 1.0);
  const double across = within(c[TwistCorrection::kShearAcross], 1.0);
  const Eigen::Vector2d shift(within(c[TwistCorrection::kShiftX], 1.0),
                              within(c[TwistCorrection::kShiftY], 1.0));
  const Eigen::Vector2d bias(within(c[TwistCorrection::kBiasX], kLargestBias),
                             within(c[TwistCorrection::kBiasY], kLargestBias));
  const double bias_own = within(x.own[TwistCorrection::kBiasOwn], kLargestBias);
  const double r_along = within(x.own[TwistCorrection::kAlong], 1.0);
  const double r_across = within(x.own[TwistCorrection::kAcross], 1.0);
  const Eigen::Vector2d own(scale.axis[0] * r_along - scale.axis[1] * r_across,
                            scale.axis[1] * r_along + scale.axis[0] * r_across);
  const double turn = scale.speed / scale.turn;
  const double late = within(c[TwistCorrection::kLag], kLargestLag) / period_;
  const double lost =
      within(c[TwistCorrection::kYawLag], kLargestTurnLag) * lossByLag(scale, 0, samples());
  Pose2 at;
  double c_at = 1.0, s_at = 0.0;  // of at.yaw, updated by rotation instead of recomputed
  for (size_t t = 0; t < twists_.size(); ++t) {
    const Eigen::Vector2d V = velocityBefore(late, t);
    const double v = V[0], s = V[1], w = twists_[t][2];
    const double speed = std::sqrt(v * v + s * s);
    const double gain = std::clamp(
        1.0 + c[TwistCorrection::kGain] - c[TwistCorrection::kTurnLoss] * std::abs(w) / scale.turn,
        0.0, kLargestFactor);
    const double side = within(crab + c[TwistCorrection::kSideslip] * w / scale.turn, 1.0);
    const double moves = std::sqrt(speed * speed + squared(kTurnMoves * turn * w));
    const double v_new =
        v * gain - s * side + shear * v + across * s + turn * w * shift[0] + moves * own[0];
    const double s_new =
        s * gain + v * side - shear * s + across * v + turn * w * shift[1] + moves * own[1];
    const double yaw = std::clamp(1.0 + c[TwistCorrection::kYaw] + x.own[TwistCorrection::kYawOwn] +
                                      c[TwistCorrection::kYawBySpeed] * speed / scale.speed,
                                  0.0, kLargestFactor);
    const double w_new = yaw * w + bias[0] * v + bias[1] * s + bias_own * speed + lost;
    const double half = 0.5 * w_new * period_;
    const HalfTurn turned(half);
    const double chord = chordShare(half, turned.sinc) * period_;
    const double sine = half * turned.sinc;
    const double c_mid = c_at * turned.cosine - s_at * sine;
    const double s_mid = s_at * turned.cosine + c_at * sine;
    c_at = c_mid * turned.cosine - s_mid * sine;
    s_at = s_mid * turned.cosine + c_mid * sine;
    at.x += chord * (c_mid * v_new - s_mid * s_new);
    at.y += chord * (s_mid * v_new + c_mid * s_new);
    at.yaw += 2.0 * half;
    put(t, at);
  }
  return at;
}

void TwistProfile::integrate(const BodyScale& scale, const TwistCorrection& correction,
                             Trajectory prediction) const {
  walk(scale, correction, [&](size_t t, const Pose2& pose) {
    const auto row = static_cast<Eigen::Index>(t);
    prediction(row, 0) = pose.x;
    prediction(row, 1) = pose.y;
    prediction(row, 2) = pose.yaw;
  });
}

Pose2 TwistProfile::integrateEnd(const BodyScale& scale, const TwistCorrection& correction) const {
  return walk(scale, correction, [](size_t, const Pose2&) {});
}

Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, Eigen::Index first,
                          Eigen::Index samples, double period) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Pose2 last;
  if (first > 0)
    last = {trajectory(first - 1, 0), trajectory(first - 1, 1), trajectory(first - 1, 2)};
  for (Eigen::Index t = first; t < first + samples; ++t) {
    const Pose2 pose{trajectory(t, 0), trajectory(t, 1), trajectory(t, 2)};
    sum += sampleMotion(last, pose);
    last = pose;
  }
  return sum / (period * static_cast<double>(samples));
}

GroundModel::GroundModel(const GroundConfig& config, const PatternSet& shipped)
    : period_(shipped.periodSeconds()), noise_(config.noise) {
  std::map<std::string, size_t> classes;
  for (const MotionClass& motion : shipped.content().classes) {
    classes.emplace(motion.name, class_twists_.size());
    class_twists_.emplace_back(motion.twist.v_x, motion.twist.v_y, motion.twist.omega);
  }
  for (const MotionPattern& pattern : shipped.patterns()) {
    profiles_.emplace_back(pattern, period_);
    entry_classes_.push_back(classes.at(pattern.entry_class));
    const auto recorded = recordedNoise(pattern, profiles_.back());
    recorded_share_.push_back(recorded ? kRecorded : 0.0);
    recorded_.push_back(recorded.value_or(Eigen::Matrix3d::Zero()));
  }
  measureScale(config.lever);
  for (size_t p = 0; p < profiles_.size(); ++p)
    whole_.push_back(part(p, 0, profiles_[p].samples()));
  fillAlike();
  const double shear = kShearSpread * scale_.isotropy;
  const double bias = 1.0;
  spread_ << 1.0, kCrabSpread, shear, shear, kTurnLossSpread, kSideslipSpread, kShiftSpread,
      kShiftSpread, config.noise.lag, 1.0, kYawBySpeedSpread, bias, bias, config.noise.lag;
  spread_ = spread_.cwiseAbs2().eval();
}

/// Reference speeds, and main axis of the set's motion: half the angle of the sum of squared
/// velocities.
void GroundModel::measureScale(double lever) {
  scale_ = {1e-3, 0.0, lever};
  std::complex<double> sum;
  double length = 1e-12;
  for (const TwistProfile& profile : profiles_) {
    const PatternPart all = profile.part({}, 0, profile.samples());
    scale_.speed = std::max(scale_.speed, all.speed);
    scale_.turn = std::max(scale_.turn, all.turning);
    const std::complex<double> mean(all.mean[0], all.mean[1]);
    sum += mean * mean;
    length += std::norm(mean);
  }
  scale_.turn = std::max(scale_.turn, kLeastTurn * scale_.speed / lever);
  scale_.isotropy = std::clamp(1.0 - std::abs(sum) / length, 0.0, 1.0);
  if (std::abs(sum) > 1e-9 * length) {
    const double angle = 0.5 * std::arg(sum);
    scale_.axis = {std::cos(angle), std::sin(angle)};
  }
  double as_gain = 0.0, turns = 1e-12;
  for (const TwistProfile& profile : profiles_) {
    const PatternPart all = profile.part(scale_, 0, profile.samples());
    as_gain -= all.mean[2] * all.yaw[TwistCorrection::kYawLag - TwistCorrection::kVelocity];
    turns += squared(all.mean[2]);
  }
  scale_.lag_as_turn = as_gain / turns;
}

PatternPart GroundModel::part(size_t pattern, Eigen::Index first, Eigen::Index samples) const {
  const TwistProfile& profile = profiles_[pattern];
  PatternPart part = profile.part(scale_, first, samples);
  part.pattern = pattern;
  part.entry_class = entry_classes_[pattern];
  const double seconds = period_ * static_cast<double>(samples);
  const double before = period_ * static_cast<double>(first);
  part.settling = std::exp(-before / kGone) * (1.0 - std::exp(-seconds / kGone)) / seconds;
  const double moved = squared(noise_.position / seconds) + squared(noise_.turning * part.turning);
  Eigen::Matrix3d to_path = Eigen::Matrix3d::Identity();
  to_path.topLeftCorner<2, 2>() = part.to_path;
  // A profile that lags by dt loses dt times its derivative.
  const Eigen::Vector3d change = profile.twists()[static_cast<size_t>(first + samples - 1)] -
                                 profile.twists()[static_cast<size_t>(first)];
  Eigen::Vector3d late = noise_.lag / seconds * (to_path * change);
  late.head<2>() *= kLagNoise;
  const Eigen::Vector3d expected =
      Eigen::Vector3d(squared(noise_.forward * part.speed) + moved,
                      squared(noise_.lateral * part.speed) + moved,
                      squared(noise_.yaw * part.turning) + squared(noise_.wander * part.speed) +
                          squared(noise_.heading / seconds)) +
      late.cwiseAbs2();
  // A turn on the spot counts as motion, too: half a metre per radian.
  constexpr double kMetresPerRadian = 0.5;
  part.shape = squared(noise_.shape * (part.metres + kMetresPerRadian * part.turning * seconds)) +
               squared(noise_.position);
  const double share = recorded_share_[pattern];
  const Eigen::Vector3d recorded = (to_path * recorded_[pattern] * to_path.transpose()).diagonal();
  constexpr double kLeast = 0.05;
  // A recorded spread of zero does not prove that an execution is exact.
  part.noise = ((1.0 - share) * expected + share * recorded).cwiseMax(kLeast * expected);
  return part;
}

Eigen::Vector3d GroundModel::besideClass(size_t pattern, const Twist2& entry) const {
  return Eigen::Vector3d(entry.v_x, entry.v_y, entry.omega) -
         class_twists_[entry_classes_[pattern]];
}

void GroundModel::fillAlike() {
  constexpr double kRange = 0.6;         // [1] of v_ref, w_ref
  constexpr double kLeastSpread = 0.05;  // the odd kernel has no spread in straight patterns
  const auto n = static_cast<Eigen::Index>(whole_.size());
  Eigen::MatrixXd near(n, n), mirrored(n, n);
  const auto scaled = [&](const PatternPart& part, double mirror) {
    const Eigen::Vector2d& a = scale_.axis;
    const double along = a[0] * part.mean[0] + a[1] * part.mean[1];
    const double across = a[0] * part.mean[1] - a[1] * part.mean[0];
    return Eigen::Vector3d(along / (kRange * scale_.speed),
                           mirror * across / (kRange * scale_.speed),
                           mirror * part.mean[2] / (kRange * scale_.turn));
  };
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Vector3d a = scaled(whole_[static_cast<size_t>(i)], 1.0);
      const PatternPart& other = whole_[static_cast<size_t>(j)];
      near(i, j) = std::exp(-0.5 * (a - scaled(other, 1.0)).squaredNorm());
      mirrored(i, j) = std::exp(-0.5 * (a - scaled(other, -1.0)).squaredNorm());
    }
  for (int own = 0; own < TwistCorrection::kOwn; ++own) {
    const double sign =
        own == TwistCorrection::kAcross || own == TwistCorrection::kBiasOwn ? -1.0 : 1.0;
    const Eigen::MatrixXd sum = near + sign * mirrored;
    const Eigen::ArrayXd size = sum.diagonal().array().max(kLeastSpread).sqrt();
    const double i = scale_.isotropy;
    Eigen::MatrixXd& alike = alike_[static_cast<size_t>(own)];
    alike = ((1.0 - i) * 0.1 + i * 0.6) * near;
    alike += (1.0 - i) * 0.7 *
             (sum.array() / (size.matrix() * size.matrix().transpose()).array()).matrix();
    alike.diagonal().array() += (1.0 - i) * 0.2 + i * 0.4;
  }
}

namespace {

double entry(const Eigen::MatrixXd& matrix, const PatternPart& a, const PatternPart& b) {
  return matrix(static_cast<Eigen::Index>(a.pattern), static_cast<Eigen::Index>(b.pattern));
}

}  // namespace

VelocityBank::Blocks GroundModel::velocity(const PatternPart& a, const PatternPart& b) const {
  constexpr int kLag = TwistCorrection::kLag;
  constexpr int kTurns = TwistCorrection::kTurnLoss;
  const Eigen::Vector2d alike(entry(alike_[TwistCorrection::kAlong], a, b),
                              entry(alike_[TwistCorrection::kAcross], a, b));
  return {a.velocity.leftCols<kTurns>() * spread_.head<kTurns>().asDiagonal() *
              b.velocity.leftCols<kTurns>().transpose(),
          a.velocity.middleCols<kLag - kTurns>(kTurns) *
              spread_.segment<kLag - kTurns>(kTurns).asDiagonal() *
              b.velocity.middleCols<kLag - kTurns>(kTurns).transpose(),
          a.own * alike.asDiagonal() * b.own.transpose(),
          spread_[kLag] * a.velocity.col(kLag) * b.velocity.col(kLag).transpose(),
          squared(kEntrySpread) * a.entry.head<2>() * b.entry.head<2>().transpose()};
}

double GroundModel::biasApart() const {
  return squared(kBiasApart);
}

YawBank::Blocks GroundModel::yaw(const PatternPart& a, const PatternPart& b) const {
  using One = YawBank::Block;
  return {
      One(a.yaw[0] * b.yaw[0] * spread_[TwistCorrection::kYaw] +
          a.yaw[1] * b.yaw[1] * spread_[TwistCorrection::kYawBySpeed]),
      One(a.yaw[2] * b.yaw[2] + a.yaw[3] * b.yaw[3] +
          biasApart() * a.bias_own * b.bias_own * entry(alike_[TwistCorrection::kBiasOwn], a, b)),
      One(a.yaw_own * b.yaw_own * entry(alike_[TwistCorrection::kYawOwn], a, b)),
      One(spread_[TwistCorrection::kYawLag] * a.yaw[4] * b.yaw[4]),
      One(squared(kEntrySpread) * a.entry[2] * b.entry[2])};
}

}  // namespace tread::learner

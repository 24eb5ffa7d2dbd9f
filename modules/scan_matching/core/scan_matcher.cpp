// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/scan_matcher.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/geometry/principal_axes.hpp"
#include "modules/scan_matching/core/pose_search.hpp"

namespace tread::scan_matching {
namespace {

using Eigen::Matrix3d;

constexpr int64_t kLeast = 1'000;  // [us] between scans
constexpr int64_t kLongest =
    3'000'000;                  // [us] the same: beyond it nothing is known about the motion
constexpr double kBent = 0.01;  // [m] by which a wrong twist may distort a sweep
constexpr double kLever = 5.0;  // [m] distance at which turning distorts it

double secondsOf(int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

/// Standard deviation of the position along its worst direction [m].
double positionStd(const Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, principalAxes(covariance.topLeftCorner<2, 2>()).variances[1]));
}

double yawStd(const Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, covariance(2, 2)));
}

double bentBy(const Twist2& was, const Twist2& is, double duration) {
  return duration *
         (std::hypot(is.v_x - was.v_x, is.v_y - was.v_y) + kLever * std::abs(is.omega - was.omega));
}

}  // namespace

ScanMatcher::ScanMatcher(const ScanMatcherConfig& config)
    : config_(config),
      filter_(config.motion, config.start),
      map_(static_cast<size_t>(config.key_scans), 1.2 * config.points.range_max) {}

MatchedPose ScanMatcher::take(const Sweep& sweep) {
  const int64_t middle = sweep.first + (sweep.last - sweep.first) / 2;
  if (middle_ && middle < *middle_ + kLeast) return describe(sweep, MatchOutcome::kNotNewer);
  if (middle_ && middle > *middle_ + kLongest) {
    // Its motion in the meantime is unknown.
    filter_ = MotionFilter(config_.motion, filter_.pose());
    map_.clear();
  } else if (middle_) {
    const double dt = secondsOf(middle - *middle_);
    filter_.predict(dt);
    filter_.constrain(dt, sweep.standing);
  }
  middle_ = middle;
  const MatchOutcome outcome = process(sweep);
  watch(sweep, outcome);
  return describe(sweep, outcome);
}

MatchOutcome ScanMatcher::process(const Sweep& sweep) {
  const Twist2 before = filter_.twist();
  if (map_.empty()) return begin(sweep, match(sweep, before).points);
  Match best = match(sweep, before);
  if (best.outcome != MatchOutcome::kMatched) return best.outcome;
  const MotionFilter predicted = filter_;
  correct(best.registration);
  // The twist is better known now than when the sweep was undistorted.
  if (bentBy(before, filter_.twist(), secondsOf(sweep.last - sweep.first)) > kBent) {
    const Twist2 after = filter_.twist();
    const MotionFilter corrected = filter_;
    filter_ = predicted;
    Match again = match(sweep, after);
    if (again.outcome == MatchOutcome::kMatched) {
      best = std::move(again);
      correct(best.registration);
    } else {
      filter_ = corrected;
    }
  }
  fitted_ = sweep.last;
  const bool determined = best.registration.undetermined == 0;
  if (determined) unfixed_.setZero();
  if (isKey()) addKeyScan(best.points);
  return determined ? MatchOutcome::kMatched : MatchOutcome::kUndetermined;
}

MatchOutcome ScanMatcher::begin(const Sweep& sweep, const std::vector<ScanPoint>& points) {
  if (static_cast<int>(points.size()) < config_.min_points) return MatchOutcome::kTooFew;
  fitted_ = sweep.last;
  new_track_ = true;
  position_known_ = heading_known_ = true;
  addKeyScan(points);
  unfixed_.setZero();
  return MatchOutcome::kFirst;
}

ScanMatcher::Match ScanMatcher::match(const Sweep& sweep, const Twist2& twist) const {
  Match result;
  result.points = scanPoints(sweep.returns, sweep.p_body_sensor, twist,
                             secondsOf(sweep.last - sweep.first), config_.points);
  for (ScanPoint& point : result.points)
    point.doubtful = (point.p - sweep.p_body_sensor).norm() > sweep.trusted_range;
  if (static_cast<int>(result.points.size()) < config_.min_points || map_.empty()) return result;
  const PosePrior prior{filter_.pose(), filter_.poseCovariance()};
  const auto lay = [&](const Pose2& start) {
    const Registration laid =
        registerScan(result.points, map_, start, prior, sweep.p_body_sensor, config_.registration);
    if (laid.misfit < result.registration.misfit) result.registration = laid;
  };
  const bool doubtful = positionStd(prior.covariance) > config_.search_std ||
                        yawStd(prior.covariance) > 0.5 * config_.search_std;
  lay(prior.T_map_body);
  if (doubtful || !fits(result.registration)) lay(searchPose(result.points, map_, prior));
  result.outcome = fits(result.registration) ? MatchOutcome::kMatched : MatchOutcome::kNoFit;
  return result;
}

bool ScanMatcher::fits(const Registration& registration) const {
  return registration.matched >= config_.min_points && registration.overlap >= config_.min_overlap;
}

void ScanMatcher::correct(const Registration& registration) {
  const Matrix3d information = filter_.poseCovariance().inverse() + registration.information;
  filter_.update(registration.T_map_body, information.inverse());
}

bool ScanMatcher::isKey() const {
  const Pose2 step = between(map_.newest(), filter_.pose());
  return std::hypot(step.x, step.y) >= config_.key_distance ||
         std::abs(wrapAngle(step.yaw)) >= config_.key_turn;
}

/// A covariance of the newest key scan, propagated to a pose: a yaw error there acts as a lever.
Matrix3d ScanMatcher::carried(const Matrix3d& covariance, const Pose2& T_map_body) const {
  if (map_.empty()) return covariance;
  Matrix3d J = Matrix3d::Identity();
  J(0, 2) = -(T_map_body.y - map_.newest().y);
  J(1, 2) = T_map_body.x - map_.newest().x;
  return J * covariance * J.transpose();
}

void ScanMatcher::addKeyScan(const std::vector<ScanPoint>& points) {
  drift_ = carried(drift_, filter_.pose()) + filter_.poseCovariance();
  unfixed_ = carried(unfixed_, filter_.pose()) + filter_.poseCovariance();
  filter_.anchor();
  map_.add(filter_.pose(), points);
}

/// Updates what is still known, and restarts if nothing has fitted for long.
void ScanMatcher::watch(const Sweep& sweep, MatchOutcome outcome) {
  const Matrix3d unfixed = carried(unfixed_, filter_.pose()) + filter_.poseCovariance();
  const bool position = positionStd(unfixed) <= config_.max_position_std;
  const bool heading = yawStd(unfixed) <= config_.max_yaw_std;
  const bool fixed = outcome == MatchOutcome::kMatched;
  if (fixed && !(position_known_ && heading_known_)) new_track_ = true;
  position_known_ = position && (position_known_ || fixed);
  heading_known_ = heading && (heading_known_ || fixed || outcome == MatchOutcome::kUndetermined);
  const bool lost = !position_known_ || !heading_known_;
  if (outcome == MatchOutcome::kNoFit && lost &&
      secondsOf(sweep.last - fitted_) >= config_.new_map_after) {
    map_.clear();
  }
}

MatchedPose ScanMatcher::describe(const Sweep& sweep, MatchOutcome outcome) {
  MotionFilter at_last = filter_;
  at_last.predict(std::max(0.0, secondsOf(sweep.last - *middle_)));
  MatchedPose pose;
  pose.utime = sweep.last;
  pose.outcome = outcome;
  pose.T_map_body = at_last.pose();
  pose.v_body = at_last.twist();
  pose.local = at_last.poseCovariance();
  pose.covariance = carried(drift_, pose.T_map_body) + pose.local;
  const bool usable = outcome != MatchOutcome::kNotNewer && !map_.empty();
  pose.position_known = usable && position_known_;
  pose.heading_known = usable && heading_known_;
  if (pose.position_known && pose.heading_known) pose.new_track = std::exchange(new_track_, false);
  return pose;
}

}  // namespace tread::scan_matching

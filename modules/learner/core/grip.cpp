// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/grip.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace tread::learner {
namespace {

constexpr double kSpeedWindow = 0.2;  // [s] over which a velocity is a mean
constexpr double kSlideWindow = 0.4;  // [s] over shorter times INS noise of 1 cm looks like a slide
constexpr double kChange = 0.2;       // [s] over which an acceleration is a mean
constexpr double kLate = 0.3;         // [s] by which the vehicle may respond later than predicted
constexpr double kSettles = 0.3;      // [s] at least, to see whether a speed still changes
constexpr double kLeastAsked = 0.8;   // [m/s2] smaller requests are uninformative about the ground
constexpr double kLeastGiven = 0.15;  // [m/s2] less means a vehicle that is held, or does not drive
constexpr double kGaveWay = 0.5;      // [1] of the request
constexpr double kGaveWayAtOnce = 0.3;    // [1] known real grounds leave .4 of the speed
constexpr double kHolds = 0.7;            // [1] of the request at which it gave way
constexpr double kGoesOn = 0.3;           // [1] of its acceleration, after it should have settled
constexpr double kLeastSlide = 0.25;      // [m/s] sideways
constexpr double kSlideShare = 0.15;      // [1] of the speed
constexpr double kLeastSlideGiven = 0.3;  // [m/s2] a slide is no evidence for less
constexpr double kTurns = 0.1;            // [rad/s]
constexpr double kMostTurn = 3.0;         // [1] of the pattern's turn
constexpr double kLevel = 0.05;  // [rad] on steeper ground gravity also accelerates the vehicle

/// Mean velocity about an instant, body frame.
struct Speed {
  double time = 0.0;                                   ///< [s] since the start
  double forward = 0.0;                                ///< [m/s]
  double left = 0.0;                                   ///< [m/s]
  double turn = 0.0;                                   ///< [rad/s]
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< start frame [m/s]
};

Speed meanBetween(const Pose2& from, const Pose2& to, double time, double seconds) {
  const double yaw = 0.5 * (from.yaw + to.yaw);
  const double dx = (to.x - from.x) / seconds, dy = (to.y - from.y) / seconds;
  return {time,
          std::cos(yaw) * dx + std::sin(yaw) * dy,
          std::cos(yaw) * dy - std::sin(yaw) * dx,
          (to.yaw - from.yaw) / seconds,
          {dx, dy}};
}

/// Velocities over a window, from the entry on. `poses` after each period, without the start.
std::vector<Speed> speedsOf(const std::vector<Pose2>& poses, size_t count, double period,
                            double window, const Twist2& entry) {
  const auto steps = static_cast<size_t>(std::max(1.0, std::round(window / period)));
  std::vector<Speed> speeds;
  if (std::isfinite(entry.v_x))
    speeds.push_back({0.0, entry.v_x, entry.v_y, entry.omega, {entry.v_x, entry.v_y}});
  const double seconds = static_cast<double>(steps) * period;
  for (size_t k = steps; k <= count; ++k) {
    const Pose2 from = k == steps ? Pose2{} : poses[k - steps - 1];
    speeds.push_back(
        meanBetween(from, poses[k - 1], static_cast<double>(k) * period - 0.5 * seconds, seconds));
  }
  return speeds;
}

/// The largest change of the forward speed over kChange.
struct Change {
  double acceleration = 0.0;  ///< [m/s2] mean of the changes of at least half its size
  size_t from = 0, to = 0;    ///< indices
};

/// In the direction of `sign`, between two times [s]. The mean, because the largest of many noisy
/// changes is mostly noise.
Change largestChange(const std::vector<Speed>& speeds, double sign, double since, double until) {
  std::vector<double> changes;
  Change most;
  for (size_t i = 0; i < speeds.size(); ++i) {
    if (speeds[i].time < since || speeds[i].time > until) continue;
    size_t j = i + 1;
    while (j < speeds.size() && speeds[j].time - speeds[i].time < kChange - 1e-9) ++j;
    if (j == speeds.size()) break;
    const double a =
        sign * (speeds[j].forward - speeds[i].forward) / (speeds[j].time - speeds[i].time);
    changes.push_back(a);
    if (a > most.acceleration) most = {a, i, j};
  }
  double sum = 0.0;
  int count = 0;
  for (const double a : changes) {
    if (!(a >= 0.5 * most.acceleration)) continue;
    sum += a;
    ++count;
  }
  if (count > 0) most.acceleration = sum / count;
  return most;
}

double forwardAt(const std::vector<Speed>& speeds, double time) {
  const auto after = std::find_if(speeds.begin(), speeds.end(),
                                  [time](const Speed& at) { return at.time >= time; });
  if (after == speeds.begin()) return speeds.front().forward;
  if (after == speeds.end()) return speeds.back().forward;
  const Speed &a = *(after - 1), &b = *after;
  return a.forward + (time - a.time) / (b.time - a.time) * (b.forward - a.forward);
}

/// Whether the speed still changes after the pattern's has settled.
bool goesOn(const std::vector<Speed>& measured, const std::vector<Speed>& asked, double sign,
            const Change& given) {
  constexpr double kSettled = 0.1;  // [1] of the total change
  const double first = asked.front().forward, last = asked.back().forward;
  const double near = std::max(0.05, kSettled * std::abs(last - first));
  double settled = 0.0;
  for (const Speed& at : asked)
    if (std::abs(at.forward - last) > near) settled = at.time;
  const double left = measured.back().time - settled;
  if (left < kSettles) return false;
  const double more = sign * (measured.back().forward - forwardAt(measured, settled));
  return more > kGoesOn * given.acceleration * left;
}

/// Evidence from a start or a stop.
std::optional<GripSign> alongSign(const std::vector<Speed>& measured,
                                  const std::vector<Speed>& shipped) {
  constexpr double kEver = 1e9;
  const Change faster = largestChange(shipped, 1.0, 0.0, kEver);
  const Change slower = largestChange(shipped, -1.0, 0.0, kEver);
  const double sign = faster.acceleration >= slower.acceleration ? 1.0 : -1.0;
  const Change& change = sign > 0.0 ? faster : slower;
  if (change.acceleration < kLeastAsked) return std::nullopt;
  // A vehicle that enters at another speed is asked for another change.
  const double start = shipped[change.from].time, end = shipped[change.to].time;
  const double asked =
      std::min(change.acceleration,
               sign * (shipped[change.to].forward - forwardAt(measured, start)) / (end - start));
  if (asked < kLeastAsked || measured.back().time < end - 1e-9) return std::nullopt;
  Change given = largestChange(measured, sign, start, start + kLate);
  const bool goes_on = goesOn(measured, shipped, sign, given);
  // A change that continues is measured over its whole duration.
  if (goes_on)
    given.acceleration = std::min(given.acceleration,
                                  sign * (measured.back().forward - measured[given.from].forward) /
                                      (measured.back().time - measured[given.from].time));
  if (given.acceleration < kLeastGiven) return std::nullopt;
  const double share = given.acceleration / asked;
  if (share < kGaveWayAtOnce || (share < kGaveWay && goes_on))
    return GripSign{given.acceleration, asked, true};
  return GripSign{std::min(given.acceleration, asked), asked, false};
}

/// Evidence from a slide.
std::optional<GripSign> slideSign(const std::vector<Speed>& measured,
                                  const std::vector<Speed>& shipped) {
  std::optional<GripSign> slide;
  for (size_t i = 0; i < std::min(measured.size(), shipped.size()); ++i) {
    const Speed &at = measured[i], &wanted = shipped[i];
    // A body origin beside the centre of rotation moves sideways in proportion to the turn rate.
    double left = wanted.left;
    if (std::abs(wanted.turn) > kTurns) left *= std::clamp(at.turn / wanted.turn, 0.0, kMostTurn);
    const double speed = at.velocity.norm();
    if (!(std::abs(at.left - left) >= std::max(kLeastSlide, kSlideShare * speed))) continue;
    // If it moves less sideways than it should, it does not slide.
    if (std::abs(at.left) <= std::abs(left)) continue;
    size_t j = i + 1;
    while (j < measured.size() && measured[j].time - at.time < kChange - 1e-9) ++j;
    if (j >= std::min(measured.size(), shipped.size())) break;
    const double seconds = measured[j].time - at.time;
    const double given =
        std::max(kLeastSlideGiven, (measured[j].velocity - at.velocity).norm() / seconds);
    const double asked = (shipped[j].velocity - wanted.velocity).norm() / seconds;
    if (!slide || given < slide->acceleration)
      slide = GripSign{given, std::max({given, asked, GripEstimator::kUnseen}), true};
  }
  return slide;
}

}  // namespace

std::optional<GripSign> gripSign(const Measurement& measured, const MotionPattern& shipped,
                                 const MotionClass& entry_class, double period) {
  const bool comparable = measured.gate == Gate::kNone || measured.gate == Gate::kEntryTwist;
  if (!comparable || measured.context.tilt.inclination > kLevel) return std::nullopt;
  const size_t count =
      std::min({measured.covered, measured.trajectory.size(), shipped.trajectory.size()});
  const auto speeds = [&](const std::vector<Pose2>& poses, double window, const Twist2& entry) {
    return speedsOf(poses, count, period, window, entry);
  };
  const Twist2 unknown = Context{}.entry;
  const std::vector<Speed> over_slide = speeds(measured.trajectory, kSlideWindow, unknown);
  if (const auto slide = slideSign(over_slide, speeds(shipped.trajectory, kSlideWindow, unknown)))
    return slide;
  const std::vector<Speed> driven =
      speeds(measured.trajectory, kSpeedWindow, measured.context.entry);
  const std::vector<Speed> wanted = speeds(shipped.trajectory, kSpeedWindow, entry_class.twist);
  if (driven.size() < 2 || wanted.size() < 2) return std::nullopt;
  return alongSign(driven, wanted);
}

void GripEstimator::take(const GripSign& sign, int64_t started) {
  if (!newest_ || newest_->started != started) {
    if (newest_) settled_ = after(settled_, *newest_);
    newest_ = Felt{{}, started, metres_};
    ++count_;
  }
  newest_->sign = sign;
}

double GripEstimator::believed(const Belief& belief, double metres) {
  return belief.base * std::exp((metres - belief.base_metres) / kForget);
}

GripEstimator::Belief GripEstimator::after(Belief belief, const Felt& felt) {
  const auto keep = [](std::deque<double>& last, double acceleration) {
    last.push_back(acceleration);
    if (last.size() > kLast) last.pop_front();
  };
  const double acceleration = felt.sign.acceleration;
  if (felt.sign.gave_way) {
    keep(belief.gave, acceleration);
    belief.held.clear();
    belief.base = *std::max_element(belief.gave.begin(), belief.gave.end());
    belief.base_metres = felt.metres;
    belief.asked = std::max({belief.asked, felt.sign.asked, belief.base});
  } else if (belief.gave.empty() || acceleration >= kHolds * belief.asked) {
    belief.gave.clear();
    belief.asked = 0.0;
    keep(belief.held, acceleration);
  } else if (acceleration > believed(belief, felt.metres)) {
    belief.base = acceleration;
    belief.base_metres = felt.metres;
  }
  return belief;
}

Grip GripEstimator::grip() const {
  const Belief belief = newest_ ? after(settled_, *newest_) : settled_;
  const double now = believed(belief, metres_);
  if (!belief.gave.empty() && now < belief.asked) return {now, true};
  const double sum = std::accumulate(belief.held.begin(), belief.held.end(), kUnseen);
  return {std::max(kUnseen, sum / static_cast<double>(belief.held.size() + 1)), false};
}

}  // namespace tread::learner

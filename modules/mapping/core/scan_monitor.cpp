// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/scan_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace tread::mapping {
namespace {

/// Scans remembered by their bits: a device may repeat a few in turn.
constexpr size_t kRemembered = 32;
/// Repeated bits with this many returns are a defect after this little motion [m, rad] ...
constexpr size_t kManyReturns = 20;
constexpr double kLittleWay = 0.15;
constexpr double kLittleTurn = 3.0 / 180.0 * kPi;
/// ... and with fewer after this; with still fewer they prove nothing, because an object may move
/// with the robot.
constexpr int kFewReturns = 3;
constexpr double kWay = 0.5;
constexpr double kTurn = 10.0 / 180.0 * kPi;

/// Returns of the last good scan that must be hit again, as a minimum and as a share, and the share
/// of these that is missed.
constexpr double kLeastExpected = 5.0;
constexpr double kExpectedShare = 0.5;
constexpr double kSeenThrough = 0.9;
/// How long the last good scan predicts what must be there [us]; while doubted without limit.
constexpr int64_t kMoment = 600'000;

/// On steeper ground a level range finder looks along the ground: returns from a hillside come and
/// go as the robot rolls [rad].
constexpr double kSteep = 0.25;

/// Spacing of kept good scans [m, rad], and distances over which they are compared.
constexpr double kKeepWay = 0.2;
constexpr double kKeepTurn = 6.0 / 180.0 * kPi;
constexpr size_t kKept = 16;
constexpr double kForgotten = 10.0;  // [m]
struct Distance {
  double way, turn;
};
constexpr Distance kCompared[] = {{0.2, 0.1}, {0.5, 0.26}, {1.2, 0.6}};

/// Number of compared points of a scan.
constexpr size_t kSample = 90;
/// Points of a scan that must miss an earlier one for a suspicion; and points that a defect must
/// explain if only one earlier scan is missed: fitting several by chance is rare.
constexpr size_t kLeastMissed = 12;
constexpr double kLeastAlone = 30.0;
/// ... or if earlier scans, which fit each other, would have the same defect: rises seen from
/// different positions look like that.
constexpr double kLeastAlways = 60.0;

/// How long an inconclusive scan is not compared with later ones [us].
constexpr int64_t kUndecided = 1'500'000;

constexpr size_t kJudged = 5;
constexpr int kSure = 3;
constexpr int64_t kGoodAgain = 1'000'000;  // [us]
/// How long after a verdict a single suspicion gives the next [us].
constexpr int64_t kProbation = 60'000'000;

bool beyond(double way, double turn, double least_way, double least_turn) {
  return way > least_way || turn > least_turn;
}

Eigen::Matrix2d turnedBy(double angle) {
  return Eigen::Rotation2Dd(angle).matrix();
}

double turnOf(const PlaneMove& move) {
  return std::abs(std::atan2(move(1, 0), move(0, 0)));
}

}  // namespace

ScanDefect ScanMonitor::update(const ToldScan& told, const PoseAt& poseAt) {
  const Eigen::Isometry3d& T = told.scan.T_body_sensor;
  level_ = T.linear()(2, 2) > 0.97;
  T_body_sensor_.linear() = turnedBy(std::atan2(T.linear()(1, 0), T.linear()(0, 0)));
  T_body_sensor_.translation() = T.translation().head<2>();
  const auto suspicion = suspect(told, poseAt);
  if (!suspicion) return ScanDefect::kNone;
  judge(*suspicion, told.scan.utime);
  return suspicion->defect;
}

std::optional<ScanSuspicion> ScanMonitor::suspect(const ToldScan& told, const PoseAt& poseAt) {
  if (told.scan.beams.empty()) return ScanSuspicion{ScanDefect::kEmpty};
  if (repeats(told)) return ScanSuspicion{ScanDefect::kFrozen};
  if (!level_) return ScanSuspicion{};
  if (told.scan.T_map_body_last.linear()(2, 2) < std::cos(kSteep)) return std::nullopt;
  return compare(told.scan, poseAt);
}

std::optional<ScanSuspicion> ScanMonitor::compare(const Scan& scan, const PoseAt& poseAt) {
  ScanView view(scan, robot_, height_);
  const bool sees = !view.points().empty();
  if (!apart(scan.utime)) {
    // A scene does not change from many returns to none at once.
    if (!sees && newest_ && newest_->points().size() >= kManyReturns)
      return ScanSuspicion{ScanDefect::kSeesThrough};
    const std::vector<ScanDoubt> doubts = this->doubts(view);
    const ScanSuspicion best = explain(view, doubts, poseAt);
    if (best.defect != ScanDefect::kNone) return best;
    if (seesThrough(scan)) return ScanSuspicion{ScanDefect::kSeesThrough};
    if (undecided(view, doubts, poseAt)) {
      unsettled_ = true;
      return std::nullopt;
    }
    // A doubted range finder without returns has not proved to be good.
    if (!sees && doubted()) return std::nullopt;
  }
  keep(std::move(view));
  return ScanSuspicion{};
}

bool ScanMonitor::repeats(const ToldScan& told) {
  const auto known = std::find_if(bits_.begin(), bits_.end(), [&](const Bits& bits) {
    return bits.fingerprint == told.fingerprint;
  });
  if (known == bits_.end()) {
    bits_.push_back({told.fingerprint, told.scan.T_map_body_last, told.scan.utime});
    if (bits_.size() > kRemembered) bits_.pop_front();
    return false;
  }
  Bits bits = *known;
  bits_.erase(known);
  const Eigen::Isometry3d motion = bits.T_map_body.inverse() * told.scan.T_map_body_last;
  bits.moved = std::max(bits.moved, motion.translation().norm());
  bits.turned = std::max(bits.turned, Eigen::AngleAxisd(motion.linear()).angle());
  ++bits.repeats;
  bits_.push_back(bits);
  const auto returns = returnsOf(told.scan);
  if (returns >= static_cast<int64_t>(kManyReturns))
    return beyond(bits.moved, bits.turned, kLittleWay, kLittleTurn);
  return returns >= kFewReturns && beyond(bits.moved, bits.turned, kWay, kTurn);
}

int64_t ScanMonitor::returnsOf(const Scan& scan) const {
  return std::count_if(scan.beams.begin(), scan.beams.end(), [&](const Beam& beam) {
    return beam.hit && !isOwnBody(scan.T_body_sensor * beam.end, robot_, height_);
  });
}

bool ScanMonitor::doubted() const {
  return unsettled_ || verdict_ != ScanDefect::kNone ||
         (!recent_.empty() && recent_.back().defect != ScanDefect::kNone);
}

bool ScanMonitor::onProbation(int64_t utime) const {
  return convicted_ && utime - *convicted_ < kProbation;
}

bool ScanMonitor::apart(int64_t utime) const {
  return newest_ && !doubted() && utime - newest_->utime() > kMoment;
}

bool ScanMonitor::seesThrough(const Scan& scan) const {
  if (!newest_) return false;
  const ScanView::SeenThrough seen = newest_->seenThrough(scan);
  const auto all = static_cast<double>(newest_->points().size());
  return seen.expected >= std::max(kLeastExpected, kExpectedShare * all) &&
         seen.through >= kSeenThrough * seen.expected;
}

std::vector<const ScanView*> ScanMonitor::references(const ScanView& view) const {
  std::vector<const ScanView*> references;
  if (newest_) references.push_back(&*newest_);
  for (const Distance& distance : kCompared) {
    const auto far = std::find_if(views_.rbegin(), views_.rend(), [&](const ScanView& kept) {
      const PlaneMove motion = kept.T_map_sensor().inverse() * view.T_map_sensor();
      return beyond(motion.translation().norm(), turnOf(motion), distance.way, distance.turn);
    });
    if (far == views_.rend()) break;
    // The newest one may be among those along the path.
    const bool again = !references.empty() && far->utime() == references.back()->utime();
    if (!again) references.push_back(&*far);
  }
  return references;
}

std::optional<PlaneMove> ScanMonitor::sensorAt(int64_t utime, const PoseAt& poseAt) const {
  const auto T_map_body = poseAt(utime);
  if (!T_map_body) return std::nullopt;
  const Eigen::Vector3d ahead = T_map_body->linear().col(0);
  PlaneMove plane = PlaneMove::Identity();
  plane.linear() = turnedBy(std::atan2(ahead.y(), ahead.x()));
  plane.translation() = T_map_body->translation().head<2>();
  return plane * T_body_sensor_;
}

std::optional<PlaneMove> ScanMonitor::placed(const ScanSuspicion& suspicion, const ScanView& view,
                                             const ScanView& reference,
                                             const PoseAt& poseAt) const {
  const PlaneMove T_reference_map = reference.T_map_sensor().inverse();
  if (suspicion.defect != ScanDefect::kDelayed) {
    const double side = suspicion.defect == ScanDefect::kMirrored ? -1.0 : 1.0;
    PlaneMove wrong = PlaneMove::Identity();
    wrong.linear() = turnedBy(suspicion.angle) * Eigen::Vector2d(1.0, side).asDiagonal();
    const PlaneMove told = T_reference_map * view.T_map_sensor();
    return suspicion.always ? PlaneMove(wrong.inverse() * told * wrong) : told * wrong;
  }
  const auto delay = static_cast<int64_t>(1e6 * suspicion.delay);
  const auto then = sensorAt(view.utime() - delay, poseAt);
  if (!then) return std::nullopt;
  if (!suspicion.always) return T_reference_map * *then;
  const auto reference_then = sensorAt(reference.utime() - delay, poseAt);
  if (!reference_then) return std::nullopt;
  return reference_then->inverse() * *then;
}

std::vector<ScanDoubt> ScanMonitor::doubts(const ScanView& view) const {
  std::vector<ScanDoubt> doubts;
  for (const ScanView* reference : references(view)) {
    const PlaneMove told = reference->T_map_sensor().inverse() * view.T_map_sensor();
    ScanDoubt doubt{reference, told, {}, {}, {}};
    for (const Eigen::Vector2d& point : reference->inPlane(view, kSample)) {
      const ScanView::Fit fit = reference->fit(told * point);
      if (fit == ScanView::Fit::kMatch) doubt.matched.push_back(point);
      if (fit == ScanView::Fit::kMiss) doubt.missed.push_back(point);
      if (fit == ScanView::Fit::kHidden) doubt.hidden.push_back(point);
    }
    if (doubt.missed.size() + doubt.hidden.size() >= kLeastMissed)
      doubts.push_back(std::move(doubt));
  }
  return doubts;
}

ScanSuspicion ScanMonitor::explain(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                                   const PoseAt& poseAt) const {
  ScanSuspicion best;
  if (doubts.empty()) return best;
  // A defect that begins now fits the newest good scan worst; a robot that starts with old scans
  // does not show this, and is trusted less after a verdict.
  const bool sudden = doubts.front().reference == &*newest_ || onProbation(view.utime());
  const double least_sudden = doubts.size() > 1 ? kLeastMissed : kLeastAlone;
  static const std::vector<ScanSuspicion> kAll = scanHypotheses();
  for (const ScanSuspicion& hypothesis : kAll) {
    if (!sudden && !hypothesis.always) continue;
    const double least = hypothesis.always ? kLeastAlways : least_sudden;
    const ScanSuspicion weighed = weigh(hypothesis, view, doubts, poseAt);
    if (weighed.gain >= least && weighed.gain > best.gain) best = weighed;
  }
  return best;
}

ScanSuspicion ScanMonitor::weigh(ScanSuspicion suspicion, const ScanView& view,
                                 const std::vector<ScanDoubt>& doubts, const PoseAt& poseAt) const {
  size_t explained = 0, tried = 0;
  for (const ScanDoubt& doubt : doubts) {
    const auto T_reference_scan = placed(suspicion, view, *doubt.reference, poseAt);
    const double gain = T_reference_scan ? gainOf(suspicion.defect, *T_reference_scan, doubt) : 0.0;
    // From farther away much was hidden: the nearest two decide, and half of all.
    if (++tried <= 2 && gain <= 0.0) return {};
    const double apart = 1e-6 * static_cast<double>(view.utime() - doubt.reference->utime());
    if (tried == 1 && !beyondMotion(*T_reference_scan, doubt, apart)) return {};
    suspicion.gain += gain;
    explained += gain > 0.0 ? 1 : 0;
  }
  // A small delay explains much by chance: there all must agree.
  const bool delayed = suspicion.defect == ScanDefect::kDelayed;
  const size_t needed =
      delayed ? doubts.size() : std::max(std::min<size_t>(2, doubts.size()), doubts.size() / 2);
  return explained >= needed ? suspicion : ScanSuspicion{};
}

bool ScanMonitor::undecided(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                            const PoseAt& poseAt) const {
  if (!newest_ || view.utime() - newest_->utime() > kUndecided || doubts.empty()) return false;
  const ScanDoubt& nearest = doubts.front();
  if (nearest.reference == &*newest_ && nearest.mostMissed()) return true;
  const auto suspected = std::find_if(
      recent_.rbegin(), recent_.rend(),
      [](const ScanSuspicion& suspicion) { return suspicion.defect >= ScanDefect::kMirrored; });
  if (suspected == recent_.rend()) return false;
  const auto T_reference_scan = placed(*suspected, view, *nearest.reference, poseAt);
  return T_reference_scan && balanceOf(*T_reference_scan, nearest) >= 0;
}

void ScanMonitor::keep(ScanView view) {
  const PlaneMove& T_map_sensor = view.T_map_sensor();
  const auto motion = [&](const ScanView& kept) {
    return PlaneMove(kept.T_map_sensor().inverse() * T_map_sensor);
  };
  while (!views_.empty() && motion(views_.front()).translation().norm() > kForgotten)
    views_.pop_front();
  const bool moved = views_.empty() || beyond(motion(views_.back()).translation().norm(),
                                              turnOf(motion(views_.back())), kKeepWay, kKeepTurn);
  if (moved) views_.push_back(view);
  if (views_.size() > kKept) views_.pop_front();
  newest_ = std::move(view);
  unsettled_ = false;
}

void ScanMonitor::judge(const ScanSuspicion& suspicion, int64_t utime) {
  recent_.push_back(suspicion);
  if (recent_.size() > kJudged) recent_.pop_front();
  if (suspicion.defect == ScanDefect::kNone) {
    if (utime - last_suspected_ < kGoodAgain) return;
    verdict_ = ScanDefect::kNone;
    return words_.clear();
  }
  last_suspected_ = utime;
  // Old or mirrored scans look good while the robot stands: after a verdict they are trusted less.
  const auto agreeing =
      std::count_if(recent_.begin(), recent_.end(),
                    [&](const ScanSuspicion& other) { return agree(suspicion, other); });
  if (verdict_ == ScanDefect::kNone && agreeing < (onProbation(utime) ? 1 : kSure)) return;
  convicted_ = utime;
  if (verdict_ != ScanDefect::kNone) return;
  verdict_ = suspicion.defect;
  words_ = wordsOf(suspicion);
}

std::string ScanMonitor::wordsOf(const ScanSuspicion& suspicion) const {
  std::ostringstream line;
  line << std::fixed << describe(suspicion);
  if (suspicion.defect == ScanDefect::kFrozen)
    line << " " << std::setprecision(2) << bits_.back().moved << " m and turned "
         << std::setprecision(0) << bits_.back().turned * 180.0 / kPi
         << " deg: it is frozen; restart it";
  return line.str();
}

}  // namespace tread::mapping

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

/// So many scans are remembered by their bits: a device may repeat a few in turn.
constexpr size_t kRemembered = 32;
/// Repeated bits with so many returns are a defect after so little motion [m, rad] ...
constexpr int kManyReturns = 20;
constexpr double kLittleWay = 0.15;
constexpr double kLittleTurn = 3.0 / 180.0 * kPi;
/// ... and with fewer after this; with fewer still they prove nothing: something may move along.
constexpr int kFewReturns = 3;
constexpr double kWay = 0.5;
constexpr double kTurn = 10.0 / 180.0 * kPi;

/// Returns of the last good scan that must be hit again, at least and as a share, and the share of
/// these that is not.
constexpr double kLeastExpected = 5.0;
constexpr double kExpectedShare = 0.5;
constexpr double kSeenThrough = 0.9;
/// The last good scan tells for so long what must be there [us]; while doubted without end.
constexpr int64_t kMoment = 600'000;

/// Good scans are kept every so far [m, rad], and compared with over these distances.
constexpr double kKeepWay = 0.2;
constexpr double kKeepTurn = 6.0 / 180.0 * kPi;
constexpr size_t kKept = 16;
constexpr double kForgotten = 10.0;  // [m]
struct Distance {
  double way, turn;
};
constexpr Distance kCompared[] = {{0.2, 0.1}, {0.5, 0.26}, {1.2, 0.6}};

/// Points of a scan that are compared.
constexpr size_t kSample = 90;
/// A defect explains at least so many that do not fit as told, and this share of those of which
/// the reference knows anything ...
constexpr int kLeastExplained = 12;
constexpr double kLeastShare = 0.75;
/// ... and more, where only one earlier scan does not fit: what fits several by chance is rare.
constexpr double kLeastAlone = 30.0;
/// ... in so many of twelve sectors, and each that it breaks counts as so many.
constexpr int kLeastSectors = 3;
constexpr int kBroken = 4;

constexpr double kAngleStep = 4.0 / 180.0 * kPi;
constexpr double kLeastAngle = 12.0 / 180.0 * kPi;
constexpr double kDelayStep = 0.1;  // [s]
constexpr double kLeastDelay = 0.2;
constexpr double kMostDelay = 1.55;

constexpr size_t kJudged = 5;
constexpr int kSure = 3;
constexpr int64_t kGoodAgain = 1'000'000;  // [us]

/// Points that a place of a scan explains, less what it breaks; 0 if it is no explanation.
double gainOf(const PlaneMove& T_reference_scan, const ScanView& reference,
              const std::vector<Eigen::Vector2d>& missed,
              const std::vector<Eigen::Vector2d>& matched) {
  int explained = 0, unexplained = 0, broken = 0;
  std::array<bool, 12> sectors{};
  for (const Eigen::Vector2d& point : missed) {
    const ScanView::Fit fit = reference.fit(T_reference_scan * point);
    unexplained += fit == ScanView::Fit::kMiss ? 1 : 0;
    if (fit != ScanView::Fit::kMatch) continue;
    ++explained;
    const double bearing = std::atan2(point.y(), point.x()) + kPi;
    sectors[std::min<size_t>(11, static_cast<size_t>(bearing / kPi * 6.0))] = true;
  }
  if (explained < kLeastExplained || explained < kLeastShare * (explained + unexplained) ||
      std::count(sectors.begin(), sectors.end(), true) < kLeastSectors)
    return 0.0;
  for (const Eigen::Vector2d& point : matched)
    broken += reference.fit(T_reference_scan * point) == ScanView::Fit::kMatch ? 0 : 1;
  const double gain = explained - kBroken * broken;
  return gain < 0.5 * explained ? 0.0 : gain;
}

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
  const Suspicion suspicion = suspect(told, poseAt);
  judge(suspicion, told.scan.utime);
  return suspicion.defect;
}

ScanMonitor::Suspicion ScanMonitor::suspect(const ToldScan& told, const PoseAt& poseAt) {
  const Scan& scan = told.scan;
  if (scan.beams.empty()) return {ScanDefect::kEmpty};
  if (repeats(told)) return {ScanDefect::kFrozen};
  if (!level_) return {};
  ScanView view(scan, robot_, height_);
  // Between scans that are far apart too much may change.
  const bool doubted = !recent_.empty() && recent_.back().defect != ScanDefect::kNone;
  const bool apart = newest_ && !doubted && scan.utime - newest_->utime() > kMoment;
  const Suspicion best = apart ? Suspicion{} : explain(view, poseAt);
  if (best.defect != ScanDefect::kNone) return best;
  if (seesThrough(scan)) return {ScanDefect::kSeesThrough};
  keep(std::move(view));
  return best;
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
  const auto returns =
      std::count_if(told.scan.beams.begin(), told.scan.beams.end(), [&](const Beam& beam) {
        return beam.hit && !isOwnBody(told.scan.T_body_sensor * beam.end, robot_, height_);
      });
  if (returns >= kManyReturns) return beyond(bits.moved, bits.turned, kLittleWay, kLittleTurn);
  return returns >= kFewReturns && beyond(bits.moved, bits.turned, kWay, kTurn);
}

bool ScanMonitor::seesThrough(const Scan& scan) const {
  if (!newest_ ||
      (scan.utime - newest_->utime() > kMoment && recent_.back().defect == ScanDefect::kNone))
    return false;
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
    const bool again = far != views_.rend() && &*far == references.back();
    if (far != views_.rend() && !again) references.push_back(&*far);
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

std::optional<PlaneMove> ScanMonitor::placed(const Suspicion& suspicion, const ScanView& view,
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

std::vector<ScanMonitor::Doubt> ScanMonitor::doubts(const ScanView& view) const {
  std::vector<Doubt> doubts;
  for (const ScanView* reference : references(view)) {
    const PlaneMove told = reference->T_map_sensor().inverse() * view.T_map_sensor();
    Doubt doubt{reference, {}, {}};
    for (const Eigen::Vector2d& point : reference->inPlane(view, kSample)) {
      const ScanView::Fit fit = reference->fit(told * point);
      if (fit == ScanView::Fit::kMiss) doubt.missed.push_back(point);
      if (fit == ScanView::Fit::kMatch) doubt.matched.push_back(point);
    }
    if (doubt.missed.size() >= kLeastExplained) doubts.push_back(std::move(doubt));
  }
  return doubts;
}

ScanMonitor::Suspicion ScanMonitor::explain(const ScanView& view, const PoseAt& poseAt) const {
  const std::vector<Doubt> doubts = this->doubts(view);
  Suspicion best;
  if (doubts.empty()) return best;
  const double least = doubts.size() > 1 ? kLeastExplained : kLeastAlone;
  static const std::vector<Suspicion> kAll = hypotheses();
  for (Suspicion suspicion : kAll) {
    size_t explained = 0, tried = 0;
    for (const Doubt& doubt : doubts) {
      const auto T_reference_scan = placed(suspicion, view, *doubt.reference, poseAt);
      const double gain = T_reference_scan ? gainOf(*T_reference_scan, *doubt.reference,
                                                    doubt.missed, doubt.matched)
                                           : 0.0;
      suspicion.gain += gain;
      explained += gain > 0.0 ? 1 : 0;
      // From farther away much was hidden: the nearest two decide, and half of all.
      if (++tried <= 2 && gain <= 0.0) break;
    }
    // A little delay explains much that is none: there all must agree.
    const bool delayed = suspicion.defect == ScanDefect::kDelayed;
    const size_t needed =
        delayed ? doubts.size() : std::max(std::min<size_t>(2, doubts.size()), doubts.size() / 2);
    if (tried == doubts.size() && explained >= needed && suspicion.gain >= least &&
        suspicion.gain > best.gain)
      best = suspicion;
  }
  return best;
}

std::vector<ScanMonitor::Suspicion> ScanMonitor::hypotheses() {
  std::vector<Suspicion> all;
  for (double angle = 0.0; angle < 2.0 * kPi - kAngleStep / 2.0; angle += kAngleStep) {
    if (std::abs(wrapAngle(angle)) > kLeastAngle - 1e-6) {
      all.push_back({ScanDefect::kTurned, 0.0, angle, 0.0, false});
      all.push_back({ScanDefect::kTurned, 0.0, angle, 0.0, true});
    }
    // Of motion alone, mirrored and turned is hardly told from turned.
    all.push_back({ScanDefect::kMirrored, 0.0, angle, 0.0, false});
    if (angle == 0.0) all.push_back({ScanDefect::kMirrored, 0.0, angle, 0.0, true});
  }
  for (double delay = kLeastDelay; delay < kMostDelay; delay += kDelayStep)
    for (const bool always : {false, true})
      all.push_back({ScanDefect::kDelayed, 0.0, 0.0, delay, always});
  return all;
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
}

bool ScanMonitor::agree(const Suspicion& a, const Suspicion& b) {
  // What needs no motion to be sure may change: far ranges that repeat are frozen ones, too.
  const auto plain = [](ScanDefect defect) {
    return defect != ScanDefect::kNone && defect <= ScanDefect::kSeesThrough;
  };
  if (plain(a.defect) && plain(b.defect)) return true;
  return a.defect == b.defect && a.always == b.always &&
         std::abs(wrapAngle(a.angle - b.angle)) < 2.5 * kAngleStep &&
         std::abs(a.delay - b.delay) < 1.5 * kDelayStep;
}

void ScanMonitor::judge(const Suspicion& suspicion, int64_t utime) {
  recent_.push_back(suspicion);
  if (recent_.size() > kJudged) recent_.pop_front();
  if (suspicion.defect == ScanDefect::kNone) {
    if (utime - last_suspected_ < kGoodAgain) return;
    verdict_ = ScanDefect::kNone;
    return words_.clear();
  }
  last_suspected_ = utime;
  if (verdict_ != ScanDefect::kNone ||
      std::count_if(recent_.begin(), recent_.end(),
                    [&](const Suspicion& other) { return agree(suspicion, other); }) < kSure)
    return;
  verdict_ = suspicion.defect;
  words_ = describe(suspicion);
}

std::string ScanMonitor::describe(const Suspicion& suspicion) const {
  std::ostringstream line;
  line << std::fixed;
  switch (suspicion.defect) {
    case ScanDefect::kNone:
      break;
    case ScanDefect::kEmpty:
      return "no beam of its scans measures anything: is it covered or dazzled, or broken?";
    case ScanDefect::kSeesThrough:
      return "its scans see nothing where something stood a moment ago: is it covered or broken?";
    case ScanDefect::kMirrored:
      return "its scans fit the motion only if they are mirrored: is it upside down, or does it "
             "number its beams the other way round?";
    case ScanDefect::kFrozen:
      line << "it repeats bit for bit what it saw before the robot moved " << std::setprecision(2)
           << bits_.back().moved << " m and turned " << std::setprecision(0)
           << bits_.back().turned * 180.0 / kPi << " deg: it is frozen; restart it";
      break;
    case ScanDefect::kTurned:
      line << "its scans fit the motion only if they are turned by about " << std::setprecision(0)
           << std::abs(wrapAngle(suspicion.angle)) * 180.0 / kPi
           << " deg: compare range_finder in robot.yaml with how it is mounted";
      break;
    case ScanDefect::kDelayed:
      line << "its scans fit the motion of about " << std::setprecision(1) << suspicion.delay
           << " s earlier: they are old ones under new times; restart it";
      break;
  }
  return line.str();
}

}  // namespace tread::mapping

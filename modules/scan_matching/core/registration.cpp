// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/registration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "common/statistics/statistics.hpp"

namespace tread::scan_matching {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostIterations = 25;
constexpr int kWideIterations = 4;      // with the large radius, at least
constexpr double kWideRadius = 0.5;     // [m] to a partner
constexpr double kNarrowRadius = 0.25;  // [m] the same, once the alignment is nearly right
constexpr double kSmallShift = 1e-4;    // [m], and [rad] at 10 m
constexpr double kCauchy = 2.4;         // [1] of the scale: where a weight has fallen to a half
constexpr double kScatterNoise = 0.05;  // [m] lower limit for a scatter's partner
constexpr double kScatterDoubt =
    0.1;  // [1] of a scatter's information is chance: it always finds partners
constexpr double kStraightness = 0.03;  // [rad] limit of walls' straightness
constexpr double kClear = 6.0;          // [1] from which a direction is determined
constexpr double kPiece = 2.0;          // [m] of one object that share an error
constexpr size_t kFewestOfPiece = 3;    // fewest points for a mean
constexpr size_t kFewestPieces = 5;     // fewest pieces for estimating their shared error
constexpr double kUsualShared = 0.02;   // [m] that error with fewer pieces
constexpr double kLeaves = 2.0;         // [1] of their distance: error of a partner in a scatter
constexpr double kApart = 0.5;          // [m] between neighbours: another object
constexpr double kBad = 0.1;  // [m] residual that makes a point as bad as one without a partner

Vector2d leftOf(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// A point of the scan and its partner.
struct Pair {
  Vector2d lever;   ///< from the body to the point, map axes [m]
  Vector2d offset;  ///< from the partner to the point [m]
  const ScanPoint* partner = nullptr;
  double weight = 0.0;    ///< [1/m2] of its residual
  bool doubtful = false;  ///< never seen from near: may be ground

  bool isLine() const { return partner->shape == Shape::kLine; }
  double residual() const { return isLine() ? partner->normal.dot(offset) : offset.norm(); }
  /// Derivative of the offset along an axis with respect to x, y, yaw.
  Vector3d jacobian(const Vector2d& axis) const {
    return {axis.x(), axis.y(), axis.dot(leftOf(lever))};
  }
};

std::vector<Pair> pairsAt(const std::vector<ScanPoint>& points, const LocalMap& map,
                          const Pose2& T_map_body, const Vector2d& p_body_sensor, double radius) {
  const Vector2d p_map_sensor = T_map_body * p_body_sensor;
  std::vector<Pair> pairs;
  pairs.reserve(points.size());
  for (const ScanPoint& point : points) {
    const Vector2d p_map = T_map_body * point.p;
    const ScanPoint* partner = map.nearest(p_map, radius, p_map_sensor);
    if (partner == nullptr) continue;
    pairs.push_back({p_map - T_map_body.position(), p_map - partner->p, partner, 0.0,
                     point.doubtful && partner->doubtful});
  }
  return pairs;
}

/// Robust standard deviation of the residuals of one shape, at least `least`.
double scaleOf(const std::vector<Pair>& pairs, bool lines, double least) {
  std::vector<double> sizes;
  for (const Pair& pair : pairs)
    if (pair.isLine() == lines) sizes.push_back(std::abs(pair.residual()));
  return std::max(least, 1.4826 * upperMedian(std::move(sizes)));
}

/// The end of the piece of one object that begins at a pair.
size_t pieceFrom(const std::vector<Pair>& pairs, size_t begin) {
  size_t end = begin + 1;
  double length = 0.0;
  for (; end < pairs.size() && length <= kPiece; ++end) {
    const double step = (pairs[end].lever - pairs[end - 1].lever).norm();
    if (step > kApart || pairs[end].isLine() != pairs[begin].isLine() ||
        pairs[end].doubtful != pairs[begin].doubtful)
      break;
    length += step;
  }
  return end;
}

/// A piece of one object, as a range of pairs.
struct Piece {
  size_t begin;
  size_t end;
  double weight = 0.0;  ///< [1/m2] of its points together
  double offset = 0.0;  ///< [m] mean residual
};

std::vector<Piece> piecesOf(const std::vector<Pair>& pairs) {
  std::vector<Piece> pieces;
  for (size_t begin = 0; begin < pairs.size(); begin = pieces.back().end) {
    Piece piece{begin, pieceFrom(pairs, begin)};
    for (size_t i = piece.begin; i < piece.end; ++i) {
      piece.weight += pairs[i].weight;
      piece.offset += pairs[i].weight * pairs[i].residual();
    }
    piece.offset /= std::max(1e-9, piece.weight);
    pieces.push_back(piece);
  }
  return pieces;
}

/// Robust standard deviation of the mean residuals of whole pieces [m], at least `least`; the fit
/// has removed three degrees of freedom.
double sharedError(const std::vector<Pair>& pairs, const std::vector<Piece>& pieces, double least) {
  std::vector<double> offsets;
  for (const Piece& piece : pieces)
    if (pairs[piece.begin].isLine() && piece.end - piece.begin >= kFewestOfPiece)
      offsets.push_back(std::abs(piece.offset));
  const size_t count = offsets.size();
  if (count < kFewestPieces) return std::max(least, kUsualShared);
  const double fitted = std::sqrt(static_cast<double>(count) / static_cast<double>(count - 3));
  return std::max(least, 1.4826 * upperMedian(std::move(offsets)) * fitted);
}

/// Reduces the weights to those that the errors behind the residuals allow. The nearest leaf is
/// mostly a different one, at about the distance between leaves. And any number of points on an
/// object gives no more information than their shared error allows.
void limitWeights(std::vector<Pair>& pairs, double surface_noise) {
  for (Pair& pair : pairs) {
    if (pair.isLine()) continue;
    const double apart = kLeaves * pair.partner->spread;
    pair.weight /= 1.0 + pair.weight * apart * apart;
  }
  const std::vector<Piece> pieces = piecesOf(pairs);
  const double shared = sharedError(pairs, pieces, surface_noise);
  for (const Piece& piece : pieces) {
    const double share = 1.0 / (1.0 + piece.weight * shared * shared);
    for (size_t i = piece.begin; i < piece.end; ++i) pairs[i].weight *= share;
  }
}

/// Limits pieces that may be ground to the information that this error allows [m].
void doubt(std::vector<Pair>& pairs, double ground_noise) {
  for (const Piece& piece : piecesOf(pairs)) {
    if (!pairs[piece.begin].doubtful) continue;
    const double share = 1.0 / (1.0 + piece.weight * ground_noise * ground_noise);
    for (size_t i = piece.begin; i < piece.end; ++i) pairs[i].weight *= share;
  }
}

/// Sets the weights; returns the scale of the lines [m].
double weigh(std::vector<Pair>& pairs, const RegistrationConfig& config) {
  const double line = scaleOf(pairs, true, config.range_noise);
  const double scatter = scaleOf(pairs, false, kScatterNoise);
  for (Pair& pair : pairs) {
    const double scale = pair.isLine() ? line : scatter;
    const double far = pair.residual() / (kCauchy * scale);
    pair.weight = 1.0 / ((1.0 + far * far) * scale * scale);
  }
  doubt(pairs, config.ground_noise);
  return line;
}

/// Information of the pairs, and the part due to chance.
struct Normal {
  Matrix3d told = Matrix3d::Zero();    ///< H
  Matrix3d chance = Matrix3d::Zero();  ///< F
  Vector3d gradient = Vector3d::Zero();
};

void addAxis(const Pair& pair, const Vector2d& axis, Normal& normal) {
  const Vector3d j = pair.jacobian(axis);
  normal.told += pair.weight * j * j.transpose();
  normal.gradient += pair.weight * axis.dot(pair.offset) * j;
}

Normal normalOf(const std::vector<Pair>& pairs) {
  Normal normal;
  for (const Pair& pair : pairs) {
    const Vector2d lever_axis(1.0, pair.lever.squaredNorm());
    normal.chance.diagonal() += kStraightness * kStraightness * pair.weight *
                                Vector3d(lever_axis.x(), lever_axis.x(), lever_axis.y());
    if (pair.isLine()) {
      addAxis(pair, pair.partner->normal, normal);
      const Vector3d along = pair.jacobian(leftOf(pair.partner->normal));
      normal.chance += pair.weight * pair.partner->normal_variance * along * along.transpose();
    } else {
      Normal scatter;
      addAxis(pair, Vector2d::UnitX(), scatter);
      addAxis(pair, Vector2d::UnitY(), scatter);
      normal.told += scatter.told;
      normal.gradient += scatter.gradient;
      normal.chance += kScatterDoubt * scatter.told;
    }
  }
  return normal;
}

/// The determined part of a scan's information: nothing remains in the other directions.
struct Determined {
  Matrix3d told = Matrix3d::Zero();         ///< for the steps
  Matrix3d information = Matrix3d::Zero();  ///< without the part due to chance
  Vector3d gradient = Vector3d::Zero();
  int undetermined = 3;
};

Determined determinedOf(const Normal& normal) {
  Determined out;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix3d> solver(normal.told, normal.chance);
  if (solver.info() != Eigen::Success) return out;
  // The columns v of V: V' F V = 1, V' H V = diag(m); so H = W diag(m) W' with W = F V.
  const Matrix3d& V = solver.eigenvectors();
  const Matrix3d W = normal.chance * V;
  out.undetermined = 0;
  for (int i = 0; i < 3; ++i) {
    const double clear = solver.eigenvalues()[i];
    if (!(clear >= kClear)) {
      ++out.undetermined;
      continue;
    }
    out.told += clear * W.col(i) * W.col(i).transpose();
    out.information += (clear - 1.0) * W.col(i) * W.col(i).transpose();
    out.gradient += W.col(i) * V.col(i).dot(normal.gradient);
  }
  return out;
}

Vector3d differenceOf(const Pose2& to, const Pose2& from) {
  return {to.x - from.x, to.y - from.y, wrapAngle(to.yaw - from.yaw)};
}

}  // namespace

/// Mean badness of the points, 0..1; one without a partner has 1.
double misfitOf(const std::vector<Pair>& pairs, size_t points) {
  double fit = 0.0;
  for (const Pair& pair : pairs) {
    const double bad = pair.residual() / kBad;
    fit += 1.0 / (1.0 + bad * bad);
  }
  return 1.0 - fit / std::max(1.0, static_cast<double>(points));
}

Registration registerScan(const std::vector<ScanPoint>& points, const LocalMap& map,
                          const Pose2& start, const PosePrior& prior, const Vector2d& p_body_sensor,
                          const RegistrationConfig& config) {
  Registration result;
  result.T_map_body = start;
  const Matrix3d prior_information = prior.covariance.inverse();
  double radius = kWideRadius;
  for (int i = 0; i < kMostIterations; ++i) {
    std::vector<Pair> pairs = pairsAt(points, map, result.T_map_body, p_body_sensor, radius);
    result.noise = weigh(pairs, config);
    result.matched = static_cast<int>(pairs.size());
    const Determined scan = determinedOf(normalOf(pairs));
    result.misfit = misfitOf(pairs, points.size());
    limitWeights(pairs, config.surface_noise);
    result.information = determinedOf(normalOf(pairs)).information;
    result.undetermined = scan.undetermined;
    const Matrix3d H = scan.told + prior_information;
    const Vector3d from_prior = differenceOf(result.T_map_body, prior.T_map_body);
    const Vector3d step = -H.ldlt().solve(scan.gradient + prior_information * from_prior);
    result.T_map_body.x += step.x();
    result.T_map_body.y += step.y();
    result.T_map_body.yaw += step.z();
    const bool settled =
        step.head<2>().norm() < kSmallShift && std::abs(step.z()) < 0.1 * kSmallShift;
    if (settled && radius <= kNarrowRadius) break;
    if (settled || i + 1 >= kWideIterations) radius = kNarrowRadius;
  }
  if (!points.empty()) result.overlap = result.matched / static_cast<double>(points.size());
  return result;
}

}  // namespace tread::scan_matching

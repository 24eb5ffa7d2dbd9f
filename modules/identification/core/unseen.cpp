// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/unseen.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr size_t kTypical = 6;
constexpr size_t kWorst = 3;
constexpr size_t kLeastForBand = 20;
constexpr double kShare = 0.9;  // of the executions that the band holds

/// An execution with how uncertain the position is along its path, up to a factor.
struct Shown {
  Overlay overlay;
  std::vector<double> spread;  ///< [m] at each point
  double error = 0.0;          ///< [m] at the end, scaled to the horizon
};

double scaleOf(const ChannelNoise& noise, double activity) {
  return std::hypot(noise.still, noise.share * activity);
}

std::vector<double> spreadOf(const Overlay& overlay, const Noise& noise) {
  const double dt = overlay.duration / static_cast<double>(overlay.after.size() - 1);
  const auto of = [&noise](Channel channel) { return noise[static_cast<size_t>(channel)]; };
  double heading = 0.0;
  double along = 0.0;
  double across = 0.0;
  std::vector<double> spread{0.0};
  for (size_t i = 1; i < overlay.after.size(); ++i) {
    const Pose2 moved = between(overlay.after[i - 1], overlay.after[i]);
    const double way = moved.position().norm();
    along += dt * scaleOf(of(Channel::kAlong), way / dt);
    across += dt * scaleOf(of(Channel::kAcross), way / dt) + heading * way;
    heading += dt * scaleOf(of(Channel::kHeading), std::abs(moved.yaw) / dt);
    spread.push_back(std::hypot(along, across));
  }
  return spread;
}

std::vector<Shown> shownOf(const std::vector<Unseen>& unseen, const ModelDocument& before,
                           const Noise& noise, std::vector<PlaceError>& places) {
  std::vector<Shown> all;
  for (const Unseen& part : unseen) {
    const OverlayMaker maker(*part.rows, before, part.model);
    for (const EndError& error : part.errors) {
      Shown shown;
      shown.overlay = maker.of(error);
      shown.overlay.drive += part.first_drive;
      shown.spread = spreadOf(shown.overlay, noise);
      shown.error = error.position;
      const Eigen::Vector2d place = maker.middleOf(error);
      places.push_back({shown.overlay.drive, place.x(), place.y(), shown.overlay.error_before,
                        shown.overlay.error_after});
      all.push_back(std::move(shown));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Shown& a, const Shown& b) { return a.error < b.error; });
  return all;
}

/// With what factor spreads hold the share of all executions, at each point.
std::vector<double> factorsOf(const std::vector<Shown>& all) {
  std::vector<double> factors;
  for (size_t point = 0; point < all.front().spread.size(); ++point) {
    std::vector<double> ratios;
    for (const Shown& shown : all) {
      const double apart =
          (shown.overlay.measured[point].position() - shown.overlay.after[point].position()).norm();
      ratios.push_back(shown.spread[point] > 0.0 ? apart / shown.spread[point] : 0.0);
    }
    const auto at = ratios.begin() +
                    static_cast<std::ptrdiff_t>(kShare * static_cast<double>(ratios.size() - 1));
    std::nth_element(ratios.begin(), at, ratios.end());
    factors.push_back(*at);
  }
  return factors;
}

}  // namespace

ShownExecutions shownExecutions(const std::vector<Unseen>& unseen, const ModelDocument& before,
                                const Noise& noise) {
  ShownExecutions result;
  std::vector<Shown> all = shownOf(unseen, before, noise, result.places);
  if (all.empty()) return result;
  if (all.size() >= kLeastForBand) {
    const std::vector<double> factors = factorsOf(all);
    for (Shown& shown : all)
      for (size_t point = 0; point < factors.size(); ++point)
        shown.overlay.band.push_back(factors[point] * shown.spread[point]);
  }
  const size_t typical = std::min(kTypical, all.size());
  for (size_t i = 0; i < typical; ++i)
    result.overlays.push_back(all[all.size() * (i + 1) / (kTypical + 2)].overlay);
  for (size_t i = 0; i < std::min(kWorst, all.size()); ++i)
    result.overlays.push_back(all[all.size() - 1 - i].overlay);
  return result;
}

}  // namespace tread::gap

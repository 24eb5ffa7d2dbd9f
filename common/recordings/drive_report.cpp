// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "common/report/text.hpp"

#include "common/recordings/drive_book.hpp"

namespace tread::drive_patterns {
namespace {

/// Root mean square of the mean twist's deviations, per component.
Twist2 spreadOf(const LocalMotion& motion) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TwistProfile& deviation : motion.deviations)
    sum += deviation.vector().head<3>().cwiseAbs2();
  sum = (sum / static_cast<double>(motion.deviations.size())).cwiseSqrt();
  return {sum[0], sum[1], sum[2]};
}

std::string windowsLine(const SurfaceSummary& surface) {
  std::string text =
      formatted("%s: %zu steady windows used", surface.surface.c_str(), surface.windows);
  for (const auto& [reason, count] : surface.left_out)
    text += formatted(", %d left out: %s", count, reason.c_str());
  text += "\n  from";
  for (const std::string& session : surface.sessions) text += " " + session;
  return text + "\n";
}

std::string motionLine(const std::string& name, const LocalMotion& motion) {
  const Twist2& mean = motion.mean.mean;
  const Twist2 spread = spreadOf(motion);
  return formatted("  %-14s %7.3f %7.3f %7.3f   %6.3f %6.3f %6.3f   %7zu %6.2f %10zu %6zu\n",
                   name.c_str(), mean.v_x, mean.v_y, mean.omega, spread.v_x, spread.v_y,
                   spread.omega, motion.windows, motion.reach, 2 * motion.deviations.size(),
                   motion.implausible);
}

}  // namespace

std::string reportOf(const DriveBook& drives) {
  std::string text = "robot: " + drives.robot + "\n";
  for (const std::string& note : drives.notes) text += note + "\n";
  const std::vector<MotionPattern>& patterns = drives.book.patterns.patterns();
  for (const SurfaceSummary& surface : drives.surfaces) {
    text += "\n" + windowsLine(surface);
    text +=
        formatted("  %-14s %23s   %20s   %7s %6s %10s %6s\n", "pattern", "v_x m/s, v_y m/s, w r/s",
                  "spread of executions", "windows", "reach", "recordings", "unfit");
    for (size_t p = 0; p < patterns.size(); ++p)
      text += motionLine(patterns[p].name, surface.motions[p]);
  }
  return text;
}

}  // namespace tread::drive_patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/core/ins_faults.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "common/geometry/degrees.hpp"

namespace tread::setup {
namespace {

constexpr double kStudent = 2.2;  // 95 % quantile for that many parts

}  // namespace

std::string fixedText(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string inMetres(double value) {
  return fixedText(value, 2) + " m";
}

std::string inDegrees(double angle) {
  return fixedText(toDegrees(angle), 0) + " deg";
}

ConfidenceInterval leavingOneOut(double best, const std::vector<double>& parts, bool is_angle) {
  const auto count = static_cast<double>(parts.size());
  const auto off = [&](double part) { return is_angle ? wrapAngle(part - best) : part - best; };
  double mean = 0.0, squares = 0.0;
  for (const double part : parts) mean += off(part) / count;
  for (const double part : parts) squares += std::pow(off(part) - mean, 2);
  const double reach = kStudent * std::sqrt(squares * (count - 1.0) / count);
  return {best, best - reach, best + reach};
}

WiringFault insMirrored(bool by_path) {
  return {FaultKind::kInsMirrored,
          {},
          0.0,
          by_path ? "the INS is mirrored: its heading turns opposite to its path; "
                    "set the sense of its heading at the device (clockwise from north)"
                  : "the INS is mirrored, or the observation is wrong: a turn to the left is "
                    "measured as one "
                    "to the right; check its mounting and axes, and repeat"};
}

WiringFault insTurned(const ConfidenceInterval& yaw, const std::string& or_else) {
  return {FaultKind::kInsTurned,
          {},
          yaw.value,
          "the INS is turned by " + inDegrees(yaw.value) + " (" + inDegrees(yaw.low) + " to " +
              inDegrees(yaw.high) +
              ") from its configured mounting; set ins: mounting of robot.yaml" + or_else};
}

WiringFault insElsewhere(const ConfidenceInterval& x, const ConfidenceInterval& y) {
  return {FaultKind::kInsElsewhere,
          {},
          std::hypot(x.value, y.value),
          "the INS measures " + inMetres(x.value) + " ahead and " + inMetres(y.value) +
              " left of its configured position; set ins: antenna of robot.yaml"};
}

WiringFault nothingMoves() {
  return {FaultKind::kNoMotion,
          {},
          0.0,
          "nothing moves, or the INS is frozen: release the emergency stop, look at fuses and the "
          "power stage; check that the INS's position changes when you move it"};
}

}  // namespace tread::setup

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/execution/stop_reason.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread::motor {

/// Attitude of the body as the INS measured it; NaN = not measured.
struct InsTilt {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  int64_t utime = 0;             ///< [us] of the measurement
  double roll = kUnknown;        ///< [rad] left side up positive
  double pitch = kUnknown;       ///< [rad] nose down positive
  double roll_rate = kUnknown;   ///< [rad/s]
  double pitch_rate = kUnknown;  ///< [rad/s]
};

/// Watches roll, pitch and their rates against the robot's hard limits.
/** A value counts as beyond its limit when measurements have said so for 100 ms and three times: a
 * bump does not stop the robot. It counts as within again 3 degrees (degrees a second) below the
 * limit, after half a second. Roll and pitch that are not measured count as beyond: who cannot see
 * a limit must not drive by it. Rates that the device does not measure are passed over. */
class TiltWatch {
 public:
  explicit TiltWatch(const std::optional<TiltLimits>& limits) : limits_(limits) {}

  /// A measurement received at now [us]; one that is not newer than the last is passed over.
  void receive(const InsTilt& tilt, int64_t now);
  /// What stops the robot at now [us]: it has just come beyond a limit. Stands for a second, so
  /// that arming by hand is needed, and is possible, while the robot is still beyond: only a person
  /// drives it out of there. Call it in each step: silence counts as beyond, too.
  Reason fault(int64_t now);
  /// Why no program may drive: it is beyond a limit still; none = within.
  const Reason& beyond() const { return beyond_; }

 private:
  struct Check {
    const char* what;
    const char* unit;
    double value;  ///< [rad, rad/s]
    double limit;
  };
  struct Since {
    std::optional<int64_t> utime;  ///< [us] of the first measurement of its kind
    int count = 0;
  };

  std::array<Check, 4> checks(const InsTilt& tilt) const;
  Reason worst(const InsTilt& tilt, double relief) const;
  void tell(const Reason& what, int64_t now);

  std::optional<TiltLimits> limits_;
  std::optional<int64_t> newest_;    ///< [us]
  std::optional<int64_t> heard_at_;  ///< [us] of a measurement, or of the first step
  Since bad_;
  std::optional<int64_t> good_since_;  ///< [us]
  Reason beyond_;
  int64_t began_ = 0;  ///< [us] when it came beyond
};

}  // namespace tread::motor

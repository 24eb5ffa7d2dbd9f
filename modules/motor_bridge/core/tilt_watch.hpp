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

/// Attitude of the body measured by the INS; NaN = not measured.
struct InsTilt {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  int64_t utime = 0;             ///< [us] of the measurement
  double roll = kUnknown;        ///< [rad] left side up positive
  double pitch = kUnknown;       ///< [rad] nose down positive
  double roll_rate = kUnknown;   ///< [rad/s]
  double pitch_rate = kUnknown;  ///< [rad/s]
};

/// Checks roll, pitch and their rates against the robot's hard limits.
/** A value counts as exceeded after 100 ms and three measurements beyond its limit, so that a bump
 * does not stop the robot. It counts as within the limit again half a second after falling 3
 * degrees (degrees a second) below it. Roll and pitch that are not measured count as exceeded,
 * because an unobserved limit must not be relied on. Rates that the device does not measure are
 * ignored. */
class TiltWatch {
 public:
  explicit TiltWatch(const std::optional<TiltLimits>& limits) : limits_(limits) {}

  /// A measurement received at now [us]; ignored if it is not newer than the last.
  void receive(const InsTilt& tilt, int64_t now);
  /// Stop reason at now [us]: a limit has just been exceeded. It stands for a second, so that
  /// arming for manual control is required, and is possible while the limit is still exceeded: only
  /// a person drives the robot out of there. Call it in each step: silence counts as exceeded, too.
  Reason fault(int64_t now);
  /// Why no program may drive: a limit is still exceeded; no reason = within limits.
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
  int64_t began_ = 0;  ///< [us] when the limit was exceeded
};

}  // namespace tread::motor

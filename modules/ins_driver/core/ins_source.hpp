// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <GeographicLib/LocalCartesian.hpp>

#include "common/geometry/se2.hpp"
#include "common/geometry/se3.hpp"
#include "lcmtypes/enums.hpp"

namespace tread::ins {

/// A point on the WGS84 ellipsoid [rad].
struct GeoPoint {
  double latitude = 0.0;   ///< north positive
  double longitude = 0.0;  ///< east positive
};

/// The map frame's origin on Earth.
struct GeoOrigin {
  GeoPoint point;         ///< WGS84 [rad]
  double altitude = 0.0;  ///< above mean sea level [m]
  double yaw = 0.0;       ///< direction of the map's x axis, counter-clockwise from east [rad]
};

/// The map frame as the tangent plane of the Earth at the origin.
/** Heights are above mean sea level throughout: not every device reports the geoid separation, and
 * omitting it scales the plane by less than 2e-5 (100 m of 6378 km). */
class LocalFrame {
 public:
  explicit LocalFrame(const GeoOrigin& origin)
      : origin_(origin),
        cartesian_(origin.point.latitude * kDegPerRad, origin.point.longitude * kDegPerRad,
                   origin.altitude) {}

  /// p_map of a point [m].
  Eigen::Vector3d toMap(const GeoPoint& point, double altitude) const {
    double east = 0.0, north = 0.0, up = 0.0;
    cartesian_.Forward(point.latitude * kDegPerRad, point.longitude * kDegPerRad, altitude, east,
                       north, up);
    const double c = std::cos(origin_.yaw);
    const double s = std::sin(origin_.yaw);
    return {c * east + s * north, c * north - s * east, up};
  }
  const GeoOrigin& origin() const { return origin_; }

 private:
  static constexpr double kDegPerRad = 180.0 / kPi;

  GeoOrigin origin_;
  GeographicLib::LocalCartesian cartesian_;
};

inline constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

/// The device's measurements of one instant, for the body in the map. NaN = not measured.
struct InsEstimate {
  int64_t utime = 0;        ///< host time of the measurement [us]
  int64_t device_utc = -1;  ///< [us] since 1970-01-01; -1 before the device sent a date
  Eigen::Vector3d p_map_body = Eigen::Vector3d::Constant(kUnmeasured);  ///< [m]
  Eigen::Quaterniond R_map_body = {kUnmeasured, kUnmeasured, kUnmeasured, kUnmeasured};
  /// Forward and left: velocity over the level ground; up: along the vertical [m/s].
  Eigen::Vector3d v_body = Eigen::Vector3d::Constant(kUnmeasured);
  Eigen::Vector3d rate_body = Eigen::Vector3d::Constant(kUnmeasured);     ///< [rad/s]
  Eigen::Vector3d position_std = Eigen::Vector3d::Constant(kUnmeasured);  ///< along map axes [m]
  /// Roll, pitch, yaw [rad]
  Eigen::Vector3d attitude_std = Eigen::Vector3d::Constant(kUnmeasured);
  /// While the heading is unknown p_map_body is the position of this point of the body [m].
  Eigen::Vector3d p_body_point = Eigen::Vector3d::Zero();
  int32_t status = InsStatus::kGood;  ///< bits of InsStatus
  int satellites = -1;                ///< -1 unknown
};

/// Source of a heading.
enum class HeadingSource : uint8_t {
  kAttitude,     ///< the inertial solution
  kDualAntenna,  ///< the baseline between two antennas, or a heading that the device reports
                 ///< separately
  kCourse        ///< the direction of motion
};

/// The device's mounting in the vehicle, and which of its data are trusted.
struct InsConfig {
  /// The device's reference point (antenna or INS reference), in body [m].
  Eigen::Vector3d p_body_antenna = Eigen::Vector3d::Zero();
  /// The GNSS antenna in body, if the device reports its position while the INS has no solution;
  /// absent: the same point [m].
  std::optional<Eigen::Vector3d> p_body_gnss;
  /// Rotation of the device's forward-left-up axes in body [rad].
  YawPitchRoll body_device;
  /// The map's origin on Earth; absent: the first good fix, x to the east.
  std::optional<GeoOrigin> origin;
  /// A fix with a larger dilution of precision does not become the origin [1].
  double origin_max_hdop = 5.0;
  /// Nor does one whose reported standard deviation along a horizontal axis is larger [m].
  double origin_max_std = 5.0;
  /// Positions further from the origin are refused: the plane no longer fits the Earth (20 km: 31 m
  /// too low) [m].
  double max_distance = 20000.0;
  /// Below this speed the course is noise: the velocity counts as zero [m/s].
  double standstill_speed = 0.1;
  /// Top speed of the vehicle: a position farther away than it allows is a jump [m/s].
  double max_speed = 10.0;
  /// Distance that never counts as a jump [m].
  double jump_slack = 0.5;
  /// Minimum delay from the measurement to the first byte: by the device and the line [us].
  int64_t latency_us = 0;
  /// Silence on the line that ends an epoch [us].
  int64_t quiet_us = 10'000;
  /// Kind of message that ends each epoch, so that there is no need to wait for silence; counted as
  /// in the device's reader.
  std::optional<size_t> last_type;
  /// Longest time by which an attitude is extrapolated to a later position [us].
  int64_t attitude_hold_us = 60'000;
  /// Window of the arrival filter [us].
  int64_t offset_window_us = 10'000'000;
  /// Nominal time between positions, for detecting gaps [us]; 0 = learn it.
  int64_t period_us = 0;
  /// Also publish instants at which only the attitude was measured, with the position extrapolated
  /// by the velocity. While positions arrive, instants to which none can be extrapolated are left
  /// out.
  bool attitude_epochs = true;
  /// Longest time by which a position is extrapolated [us].
  int64_t position_hold_us = 150'000;
  /// Trusted headings, the best first. The course is not among them by default: a tracked vehicle
  /// drives backwards, and its nose need not point in the direction of motion.
  std::vector<HeadingSource> headings = {HeadingSource::kAttitude, HeadingSource::kDualAntenna};
  /// Below this speed the course is not used as heading [m/s].
  double course_min_speed = 1.0;
  /// False: the vehicle has no reverse gear, so that its nose points in the direction of motion.
  /// True: the previous heading distinguishes forwards and backwards, see CourseHeading.
  bool drives_backward = true;
  /// Direction of the baseline from the first to the second antenna, from the device's forward axis
  /// counter-clockwise [rad].
  double baseline_yaw = 0.0;
  /// GPS time minus UTC, for devices that send only GPS time [s].
  int64_t leap_seconds = 18;
  /// Geoid above the ellipsoid, for devices that send only heights above the ellipsoid; absent:
  /// such heights are unknown until the device sends it [m].
  std::optional<double> geoid_separation;
  /// Sample rate of the IMU of a NovAtel receiver that sends rates per sample; 0 = learn it [Hz].
  double imu_rate = 0.0;
};

/// How often each reason applied, by words such as "GGA: field count".
using ReasonCounts = std::map<std::string, int64_t>;

/// Totals of the received bytes and messages.
struct InsTally {
  int64_t bytes = 0;
  int64_t stray_bytes = 0;  ///< in no message
  int64_t messages = 0;
  ReasonCounts decoded;  ///< by the message's name
  ReasonCounts refused;  ///< by the reason
};

struct AssemblerCounts;

/// What to check when a device is silent or incomplete; parts of HEALTH's lines.
struct InsAdvice {
  std::string silent;       ///< no bytes come
  std::string unreadable;   ///< what is missing among the bytes, for instance "no good sentence"
  std::string no_position;  ///< bytes are understood, but without a position
  std::string no_heading;
  /// Messages of the protocol arrive, but none is good: their common defect. Empty = none arrive,
  /// or there is no common defect.
  std::string refused{};
};

/// An INS at the end of a byte stream: the interface for further kinds.
/** Pure: bytes and time [us] are arguments. Pass bytes with the time at which they were read, then
 * call next() until it returns nullopt. */
class InsSource {
 public:
  virtual ~InsSource() = default;

  /// Takes bytes that were read at `arrival`.
  virtual void push(std::string_view bytes, int64_t arrival) = 0;
  /// The next complete estimate; `now` decides whether the line has been quiet.
  virtual std::optional<InsEstimate> next(int64_t now) = 0;
  /// The link was closed or the log has ended: incomplete data end here.
  virtual void interrupt() = 0;

  /// The map's origin on Earth, if known: configured, or the first good fix.
  virtual std::optional<GeoOrigin> origin() const = 0;
  /// Host time of the last well-formed message, also of an unused kind; nullopt before the first.
  virtual std::optional<int64_t> lastMessage() const = 0;
  /// Number of positions refused because they are too far from the origin, and the last one's
  /// distance [m].
  virtual std::pair<int64_t, double> tooFar() const = 0;
  /// The newest time reported by the device [us], in its own count.
  virtual std::optional<int64_t> deviceTime() const = 0;
  virtual InsTally tally() const = 0;
  virtual const AssemblerCounts& epochs() const = 0;
  /// Why bytes were not understood so far, in words.
  virtual std::string refusals() const = 0;
  /// The input of a pose that is too slow compared with the others, in words: over the last whole 5
  /// s before `now`; empty if there is none.
  virtual std::string slowInput(int64_t now) = 0;
  virtual InsAdvice advice() const = 0;
  /// Counters by name, in words, in the order of HEALTH.
  virtual std::vector<std::pair<std::string, int64_t>> counters() const = 0;
};

/// Makes the source; the map's origin is given if it is known.
using MakeInsSource =
    std::function<std::unique_ptr<InsSource>(const std::optional<GeoOrigin>& origin)>;

/// Makes sources of a kind; a given origin replaces the configured one.
template <class Source>
MakeInsSource sourceOf(const InsConfig& config) {
  return [config](const std::optional<GeoOrigin>& origin) {
    InsConfig with_origin = config;
    if (origin) with_origin.origin = origin;
    return std::make_unique<Source>(with_origin);
  };
}

}  // namespace tread::ins

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

namespace tread::ins {

/// A point on the WGS84 ellipsoid [rad].
struct GeoPoint {
  double latitude = 0.0;   ///< north positive
  double longitude = 0.0;  ///< east positive
};

/// A day of the Gregorian calendar.
struct CivilDate {
  int year = 1970;
  int month = 1;
  int day = 1;
};

/// Fix quality of GGA (NMEA 0183 v4.11, GGA field 6).
enum class FixQuality : uint8_t {
  kNone = 0,
  kStandard = 1,
  kDifferential = 2,
  kPrecise = 3,
  kRtkFixed = 4,
  kRtkFloat = 5,
  kEstimated = 6,
  kManual = 7,
  kSimulator = 8,
  kAugmented = 9,  ///< not of the standard: NovAtel's word for a fix with SBAS corrections
};

// All times are UTC, microseconds since midnight. A field that the device left empty, or that it
// marks as invalid, is absent. Angles are in the house's sense: yaw counter-clockwise from east,
// nose down positive.

/// Position fix.
struct Gga {
  std::optional<int64_t> time_of_day;
  FixQuality quality = FixQuality::kNone;
  std::optional<GeoPoint> position;  ///< absent without a fix, and for typed-in or simulated ones
  std::optional<double> altitude;    ///< above mean sea level [m]; absent with the position
  std::optional<double> geoid_separation;  ///< mean sea level above the ellipsoid [m]
  std::optional<double> hdop;              ///< horizontal dilution of precision [1]
  std::optional<int> satellites;
};

/// Recommended minimum: position, speed, course, date.
struct Rmc {
  std::optional<int64_t> time_of_day;
  std::optional<GeoPoint> position;  ///< this and the following only if the status is A
  std::optional<double> speed;       ///< over ground [m/s]
  std::optional<double> course;      ///< direction of motion as a yaw [rad]
  std::optional<CivilDate> date;
};

/// Course and speed over ground.
struct Vtg {
  std::optional<double> speed;   ///< [m/s]
  std::optional<double> course;  ///< direction of motion as a yaw [rad]
};

/// True heading.
struct Hdt {
  std::optional<double> yaw;  ///< [rad]
};

/// Inertial attitude; the form of OxTS, NovAtel, Applanix, Trimble and Hemisphere, not Ashtech's
/// own.
struct Pashr {
  std::optional<int64_t> time_of_day;
  std::optional<double> yaw;    ///< [rad]
  std::optional<double> roll;   ///< right side down positive, about x forward [rad]
  std::optional<double> pitch;  ///< nose down positive, about y left [rad]; the device says nose up
  std::optional<double> heave;  ///< [m]
  std::optional<double> roll_std;   ///< [rad]
  std::optional<double> pitch_std;  ///< [rad]
  std::optional<double> yaw_std;    ///< [rad]
  std::optional<int> gnss_quality;
  std::optional<int> imu_status;  ///< the makers do not agree what it means: kept, not interpreted
};

/// Rate of turn.
struct Rot {
  std::optional<double>
      yaw_rate;  ///< [rad/s], counter-clockwise positive; the device says clockwise
};

/// Time and date.
struct Zda {
  std::optional<int64_t> time_of_day;
  std::optional<CivilDate> date;
};

using NmeaSentence = std::variant<Gga, Rmc, Vtg, Hdt, Pashr, Rot, Zda>;

inline constexpr size_t kSentenceTypes = std::variant_size_v<NmeaSentence>;

/// Names in the order of NmeaSentence.
inline constexpr const char* kSentenceNames[kSentenceTypes] = {"GGA",   "RMC", "VTG", "HDT",
                                                               "PASHR", "ROT", "ZDA"};

/// UTC time of day of a sentence, where it has one [us].
std::optional<int64_t> timeOfDay(const NmeaSentence& sentence);

}  // namespace tread::ins

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/command.hpp"

namespace tread {

/// A steady motion in which patterns begin and end (a trim): the effect of a pattern depends on the
/// motion before it.
struct MotionClass {
  std::string name;  ///< for instance rest, cruise, reverse
  Twist2 twist;      ///< v_body of the steady motion
  Command steady;    ///< the command that maintains it

  /// Whether the vehicle is at rest in it: less than 0.02 m/s and 0.02 rad/s.
  bool standing() const {
    return std::hypot(twist.v_x, twist.v_y) < 0.02 && std::abs(twist.omega) < 0.02;
  }
};

/// Upper triangle of a planar pose covariance: xx xy xyaw yy yyaw yawyaw [m2, m rad, rad2]; NaN =
/// unknown.
using PoseCovariance = std::array<double, 6>;

/// A covariance that has not been determined.
inline constexpr PoseCovariance kUnknownCovariance = {
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

/// A command series U and the trajectory R that it is expected to produce (paper, section III).
struct MotionPattern {
  int id = 0;  ///< unique within its set
  std::string name;
  std::string entry_class;        ///< name of the class in which it must begin
  std::string exit_class;         ///< name of the class in which it ends
  std::vector<Command> commands;  ///< U = (u_1..u_T); never changes
  std::vector<Pose2> trajectory;  ///< R = (r_1..r_T): T_start_body after u_t, yaw unwrapped
  /// Of the prediction r_T: all six finite, or all six NaN = unknown.
  PoseCovariance end_covariance = kUnknownCovariance;
  int times_learned = 0;  ///< executions of this pattern that changed R

  const Pose2& end() const { return trajectory.back(); }
  /// Length of the path through the origin and all r_t [m].
  double pathLength() const { return lengthOfPath(trajectory); }
};

/// Contents of a pattern set, not yet checked.
struct PatternSetContent {
  std::string name;
  int64_t version = 1;         ///< increases forever; >= 1
  int64_t parent_version = 0;  ///< 0 = none
  int64_t utime = 0;           ///< [us] of the newest measurement in it; 0 = shipped
  CommandChannels channels = trackChannels(CommandKind::kPower);
  int64_t period_us = 50'000;  ///< each command is held this long
  std::vector<MotionClass> classes;
  std::vector<MotionPattern> patterns;
};

/// A checked, immutable pattern set; copies share their content, so that passing a set is cheap.
class PatternSet {
 public:
  /// Checks and freezes. On failure returns nullopt and one clear line in `why`: pattern, what,
  /// what is allowed.
  /** Checked: names and ids unique; T >= 1 and |U| = |R|; all numbers finite; one to eight
   * channels, their ranges within commandLimit() of their kinds; commands within the ranges and 0
   * beyond the last channel; steps of R at most 20 m/s and 20 rad/s, the
   * first one taken from the origin; classes exist and each is used by a pattern (the bus carries
   * classes only with patterns); version >= 1; period 5 ms..1 s; at most 1000 patterns of at most
   * 1000 samples, and 2000 numbers in their commands. */
  static std::optional<PatternSet> make(PatternSetContent content, std::string& why);
  /// Upper limit for versions: more than the robot's life in milliseconds.
  static constexpr int64_t kHighestVersion = 1'000'000'000'000;

  const PatternSetContent& content() const { return *content_; }
  int64_t version() const { return content_->version; }
  const std::vector<MotionPattern>& patterns() const { return content_->patterns; }
  double periodSeconds() const { return static_cast<double>(content_->period_us) * 1e-6; }
  /// The pattern with this id, or nullptr.
  const MotionPattern* find(int id) const;
  const MotionPattern* findByName(const std::string& name) const;
  /// The class with this name; throws std::out_of_range for a name that no pattern of the set has.
  const MotionClass& classNamed(const std::string& name) const;
  /// Whether `next` may follow `previous` smoothly: its entry class is the exit class of
  /// `previous`.
  bool joinable(const MotionPattern& previous, const MotionPattern& next) const;
  /// Patterns that begin in a class, in the order of the set.
  std::vector<const MotionPattern*> startingIn(const std::string& entry_class) const;
  /// Over everything but utime; equal content has an equal checksum on every machine; never
  /// negative.
  int64_t checksum() const { return checksum_; }

 private:
  PatternSet(std::shared_ptr<const PatternSetContent> content, int64_t checksum)
      : content_(std::move(content)), checksum_(checksum) {}

  std::shared_ptr<const PatternSetContent> content_;
  int64_t checksum_ = 0;
};

/// `found` and all classes that can be reached from them by chains of patterns; if `backwards`, all
/// classes from which they can be reached.
std::set<std::string> connectedClasses(const PatternSet& set, std::set<std::string> found,
                                       bool backwards);

/// For each pattern, in the order of the set: the shortest path from standstill through it to
/// standstill [m]; infinite if no chain leads there.
std::vector<double> restToRestLengths(const PatternSet& set);

/// Limits of PatternSet::make; the file reader reports the same limits.
struct PatternLimits {
  static constexpr double kMaxSpeed = 20.0;           ///< [m/s], twists and steps of R
  static constexpr double kMaxYawRate = 20.0;         ///< [rad/s]
  static constexpr int64_t kMinPeriodUs = 5'000;      ///< [us]
  static constexpr int64_t kMaxPeriodUs = 1'000'000;  ///< [us]
  static constexpr size_t kMaxPatterns = 1000;
  static constexpr size_t kMaxSamples = 1000;
  static constexpr size_t kMaxNumbers = 2000;  ///< samples x channels: capacity of a PROGRAM
  static constexpr size_t kMaxNameLength = 64;
};

}  // namespace tread

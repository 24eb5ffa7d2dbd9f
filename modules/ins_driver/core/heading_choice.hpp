// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "modules/ins_driver/core/attitude_memory.hpp"
#include "modules/ins_driver/core/device_epoch.hpp"

namespace tread::ins {

/// Uses the course over ground as heading if nothing better is measured.
/** The course gives the vehicle's axis, but not its direction of travel along it. A reference
 * decides: the previous heading, updated with the measured yaw rate. Without a measured rate the
 * reference is valid only while the vehicle moves faster than course_min_speed, because it cannot
 * reverse its motion without slowing down. Without a reference, or for a course more than 60
 * degrees off the axis in both directions (sliding, or an unseen turn), there is no heading. A
 * vehicle that never drives backwards needs no reference. */
class CourseHeading {
 public:
  explicit CourseHeading(const InsConfig& config) : config_(config) {}

  /// Updates the reference to an instant.
  void advance(int64_t utime, const std::optional<GroundVelocity>& velocity,
               const std::optional<double>& yaw_rate);
  /// Sets the reference to a heading from a better source.
  void learn(double yaw);
  /// The heading of a moving vehicle.
  /** The reference point may swing about the body's origin while the vehicle turns; the body itself
   * is assumed to move along its nose. */
  std::optional<Heading> of(const GroundVelocity& velocity, double yaw_rate);
  void clear() { reference_.reset(); }
  /// Courses for which nose and tail could not be distinguished.
  int64_t refused() const { return refused_; }

 private:
  InsConfig config_;
  std::optional<double> reference_;
  int64_t utime_ = 0;        ///< of the last instant
  int64_t known_utime_ = 0;  ///< when the reference was last certain
  int64_t refused_ = 0;
};

/// How often each heading was used.
struct HeadingCounts {
  std::array<int64_t, 3> used{};  ///< in the order of HeadingSource
  int64_t outranked = 0;          ///< not used: a better one was measured shortly before
};

/// Chooses the heading of an instant among its sources, in the configured order.
/** A worse heading is ignored for a second after a better one: otherwise two sources with different
 * biases would alternate in the track. */
class HeadingChoice {
 public:
  explicit HeadingChoice(const InsConfig& config) : order_(config.headings), course_(config) {}

  /// `yaw_rate`: measured, about the vertical [rad/s], if there is one.
  std::optional<Attitude> attitudeOf(const DeviceEpoch& epoch, int64_t utime,
                                     const std::optional<double>& yaw_rate);
  void clear();
  const HeadingCounts& counts() const { return counts_; }
  int64_t coursesRefused() const { return course_.refused(); }

 private:
  std::optional<Heading> headingOf(const DeviceEpoch& epoch, HeadingSource source,
                                   const std::optional<double>& yaw_rate);
  bool outranked(const DeviceEpoch& epoch, size_t rank, int64_t utime) const;

  std::vector<HeadingSource> order_;
  CourseHeading course_;
  std::optional<size_t> last_rank_;
  int64_t last_utime_ = 0;
  HeadingCounts counts_;
};

}  // namespace tread::ins

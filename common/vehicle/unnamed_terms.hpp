// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se2.hpp"

// Terms outside the catalogue's effects: a piecewise linear function of the kernel's state at each
// instant, estimated from a drive.
namespace tread {

/// The kernel's state at an instant, before any unnamed term acts.
struct TermInputs {
  double v = 0.0;             ///< [m/s] forward speed
  double omega = 0.0;         ///< [rad/s] yaw rate
  double v_change = 0.0;      ///< [m/s2] relative to the last kTermMemory seconds
  double omega_change = 0.0;  ///< [rad/s2] the same of the yaw rate
  double turned = 0.0;        ///< [1] direction of the recent turns, -1..1
  double forward = 0.0;       ///< [m/s] mean of the commanded track speeds
  double turning = 0.0;       ///< [m/s] half of their difference, right less left
};

/// An input with its name in formulas.
struct TermInput {
  const char* name;
  double TermInputs::*value;
};

/// All of them.
inline constexpr TermInput kTermInputs[] = {{"v", &TermInputs::v},
                                            {"yaw_rate", &TermInputs::omega},
                                            {"v_change", &TermInputs::v_change},
                                            {"yaw_rate_change", &TermInputs::omega_change},
                                            {"turns_before", &TermInputs::turned},
                                            {"forward_command", &TermInputs::forward},
                                            {"turning_command", &TermInputs::turning}};

/// Memory of the kernel for these inputs; first-order low-passes of the motion.
struct TermMemory {
  double v = 0.0;       ///< [m/s]
  double omega = 0.0;   ///< [rad/s]
  double turned = 0.0;  ///< [1]
};

inline constexpr double kTermMemory = 0.4;  ///< [s] time constant of the memory of v and yaw rate
inline constexpr double kSignWidth =
    0.05;  ///< [m/s or rad/s] width of the transition of a smooth sign
inline constexpr double kTurnsMemory =
    0.8;  ///< [rad] of turning after which earlier turns are forgotten

/// A quantity on which a term may depend. The names are those of the conditions in the adequacy
/// test.
struct TermCondition {
  const char* name;
  const char* unit;
  double (*value)(const TermInputs&);
  const char* formula;  ///< the same as a formula
};

/// All of them.
const std::vector<TermCondition>& termConditions();

/// One by name; nullptr if unknown.
const TermCondition* findTermCondition(const std::string& name);

/// What a term changes.
enum class TermChannel { kYawRate, kSpeed, kSideways };

/// "yaw rate", "v", "v_y".
const char* termChannelName(TermChannel channel);
/// rad/s or m/s.
const char* termChannelUnit(TermChannel channel);

/// A term: a curve over one condition, times a second one or times 1.
/** The curve is linear between `at` and constant beyond; the factor is clamped to its range. Both
 * ranges are those of the drive, so that the term is bounded outside. */
struct UnnamedTerm {
  std::string name;
  TermChannel channel = TermChannel::kYawRate;
  const TermCondition* condition = nullptr;  ///< of termConditions(), never null in a model
  const TermCondition* times = nullptr;      ///< of termConditions(); nullptr = factor 1
  double times_low = 0.0;                    ///< range of the factor
  double times_high = 0.0;
  std::vector<double> at;      ///< ascending, in the unit of the condition
  std::vector<double> values;  ///< [rad/s or m/s, over the unit of the factor] at these

  /// The factor at an instant.
  double factor(const TermInputs& inputs) const;
  /// The value of the curve at a value of the condition.
  double curve(double condition) const;
  /// Contribution to the channel [rad/s or m/s].
  double value(const TermInputs& inputs) const {
    return factor(inputs) * curve(condition->value(inputs));
  }
};

inline constexpr size_t kLeastTermValues = 2;
inline constexpr size_t kMostTermValues = 6;
/// Largest magnitude of a term's value, in the unit of its channel.
inline constexpr double kLargestTermValue = 10.0;

/// The two values of `at` that enclose a condition, and the weight of the upper one.
/** Outside of `at`: the end values, with a weight of 0 or 1. `at` has at least two values in order.
 */
std::pair<size_t, double> placeOnCurve(const std::vector<double>& at, double condition);

/// Change of a body twist by all terms.
Twist2 twistOf(const std::vector<UnnamedTerm>& terms, const TermInputs& inputs);

/// Inputs of the mean motion over dt [s]; the memory advances by dt. Commands are left at 0.
TermInputs remember(double v, double omega, double dt, TermMemory& memory);

/// Inputs of a motion at this instant. Commands are left at 0.
TermInputs inputsNow(double v, double omega, const TermMemory& memory);

}  // namespace tread

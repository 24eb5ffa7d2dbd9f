// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/vehicle/effects.hpp"
#include "common/vehicle/formula.hpp"
#include "common/vehicle/model.hpp"

// How the kernel applies effects that are described by files (effect_file.hpp).
namespace tread {

/// What an added effect changes: the speed asked of a track's drive, or, after the body's inertia,
/// the same quantities as unnamed terms.
enum class LawTarget { kTrack, kYawRate, kSpeed, kSideways };

/// The law of an added effect: the quantity it changes, and the formula of its new value.
struct AddedLaw {
  LawTarget changes = LawTarget::kYawRate;
  /// In quantitiesOf(changes), the effect's parameters, and `memory` if it has one.
  std::shared_ptr<const Formula> formula;
  /// What the memory follows, and its time constant [s]; null without a memory. With a time
  /// constant of 0 the memory equals its target.
  std::shared_ptr<const Formula> follows{};
  std::shared_ptr<const Formula> over{};
};

inline constexpr const char* kMemoryName = "memory";  ///< in formulas

/// The names of all targets in files, in the order of LawTarget.
const std::vector<std::string>& lawTargetNames();

/// The quantities that a formula for a target may use besides the effect's parameters.
/** For a track: speed (after the effects of the catalogue that act on the command), other (of the
 * other track), side (1 left, -1 right). Otherwise: motion and commands as in unnamed terms, left
 * and right (tracks on the ground), moving (0 at standstill, 1 from 0.05 m/s on), and v_y. Always:
 * gauge, session_time, battery_drop, roll, pitch. */
const std::vector<std::string>& quantitiesOf(LawTarget target);

/// Quantities known to the kernel at the point where motion is changed.
struct LawInputs {
  TermInputs motion;
  TrackCommand tracks;  ///< [m/s] on the ground
  DriveContext context;
  double gauge = 0.0;   ///< [m]
  double moving = 0.0;  ///< [1]
};

/// The values of all memories of the added effects, in the order of the catalogue; two values for
/// an effect on tracks.
using AddedMemory = std::vector<double>;

/// The added effects that are on in a model; each simulation has its own instance.
/** Each depends on the motion without any of them, and their changes are summed; NaN changes
 * nothing, and no change exceeds kLargestTermValue. A memory begins in its steady state. */
class AddedEffects {
 public:
  explicit AddedEffects(const EffectValues& values);

  bool changeTracks() const { return !tracks_.empty(); }
  bool changeMotion() const { return !motion_.empty(); }

  /// Speeds asked of the drives [m/s]; memories advance by dt (0 = they stay).
  TrackCommand tracks(const TrackCommand& asked, double gauge, const DriveContext& context,
                      double dt);
  /// Forward speed, yaw rate and, in `v_y`, lateral motion; all as they are before any law.
  Twist2 changes(const LawInputs& inputs, const Twist2& v_body, double dt);

  /// Sets the memories to their steady values for these inputs.
  void settleTracks(const TrackCommand& asked, double gauge, const DriveContext& context);
  void settleMotion(const LawInputs& inputs, const Twist2& v_body);

  AddedMemory memory() const;
  /// Restores memories of the same model; a vector of another size is ignored.
  void remember(const AddedMemory& memory);

 private:
  /// A law with its compiled formulas and memories: one for each track, or one for the motion.
  class Acting {
   public:
    Acting(const AddedLaw& law, const std::vector<double>& parameters);

    LawTarget changes() const { return changes_; }
    void set(size_t place, double value) const;
    /// The change of a value, after the memory has advanced by dt.
    double change(double value, size_t memory, double dt);
    void settle(size_t memory);

    std::array<double, 2> memories{};
    bool remembers() const { return follows_.has_value(); }

   private:
    LawTarget changes_;
    FormulaUse formula_;
    std::optional<FormulaUse> follows_;
    std::optional<FormulaUse> over_;
    size_t memory_place_;
  };

  static void setTrack(const Acting& acting, const TrackCommand& asked, double side, double gauge,
                       const DriveContext& context);
  static void setMotion(const Acting& acting, const LawInputs& inputs, double v_y);

  std::vector<Acting> tracks_;
  std::vector<Acting> motion_;
};

}  // namespace tread

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

// Effects that files describe (effect_file.hpp), where the kernel applies them.
namespace tread {

/// What an added effect changes: the speed that the drive of a track is asked for, or, after the
/// body's inertia, what unnamed terms change.
enum class LawTarget { kTrack, kYawRate, kSpeed, kSideways };

/// The law of an added effect: one quantity, and the formula of what becomes of it.
struct AddedLaw {
  LawTarget changes = LawTarget::kYawRate;
  /// Of quantitiesOf(changes), the effect's parameters, and `memory` where it has one.
  std::shared_ptr<const Formula> formula;
  /// What the memory follows, and in what time [s]; none without a memory. A memory that follows in
  /// no time is what it follows.
  std::shared_ptr<const Formula> follows{};
  std::shared_ptr<const Formula> over{};
};

inline constexpr const char* kMemoryName = "memory";  ///< in formulas

/// The names of all targets in files, in the order of LawTarget.
const std::vector<std::string>& lawTargetNames();

/// What a formula for a target may name beside the effect's parameters.
/** Of a track: speed (after the effects of the catalogue that act on the command), other (of the
 * other track), side (1 left, -1 right). Else: motion and commands as unnamed terms know them, left
 * and right (tracks on the ground), moving (0 at standstill, 1 from 0.05 m/s on), and v_y. Always:
 * gauge, session_time, battery_drop, roll, pitch. */
const std::vector<std::string>& quantitiesOf(LawTarget target);

/// What the kernel knows where motion is changed.
struct LawInputs {
  TermInputs motion;
  TrackCommand tracks;  ///< [m/s] on the ground
  DriveContext context;
  double gauge = 0.0;   ///< [m]
  double moving = 0.0;  ///< [1]
};

/// What the memories of the added effects hold, in the order of the catalogue; of a track twice.
using AddedMemory = std::vector<double>;

/// The added effects that are on in a model; one each for every simulation.
/** Each depends on the motion without any of them, and what they change is summed; what is no
 * number changes nothing, and nothing changes by more than kLargestTermValue. A memory begins as
 * after a long time. */
class AddedEffects {
 public:
  explicit AddedEffects(const EffectValues& values);

  bool changeTracks() const { return !tracks_.empty(); }
  bool changeMotion() const { return !motion_.empty(); }

  /// Speeds that the drives are asked for [m/s]; memories move on by dt (0 = they stay).
  TrackCommand tracks(const TrackCommand& asked, double gauge, const DriveContext& context,
                      double dt);
  /// Forward speed, yaw rate and, in `v_y`, motion to the side; all of them before any law.
  Twist2 changes(const LawInputs& inputs, const Twist2& v_body, double dt);

  /// Has memories follow what is so for long.
  void settleTracks(const TrackCommand& asked, double gauge, const DriveContext& context);
  void settleMotion(const LawInputs& inputs, const Twist2& v_body);

  AddedMemory memory() const;
  /// Of the same model; another size is left alone.
  void remember(const AddedMemory& memory);

 private:
  /// A law with its formulas, and what it remembers: of both tracks, or of the motion.
  class Acting {
   public:
    Acting(const AddedLaw& law, const std::vector<double>& parameters);

    LawTarget changes() const { return changes_; }
    void set(size_t place, double value) const;
    /// By how much it changes a value, after its memory has moved on by dt.
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

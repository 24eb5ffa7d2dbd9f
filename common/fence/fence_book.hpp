// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/fence/fence.hpp"

namespace tread {

/// A request about fences, as sent: add one fence, or remove all of a name.
struct FenceRequest {
  std::string by;
  bool removes = false;
  Fence fence;  ///< without corners to remove
};

/// Result of a request.
enum class FenceReceipt {
  kAdded,
  kKnown,  ///< is in force already
  kRemoved,
  kNotThere,   ///< no fence of that name, or one of the robot's own
  kForbidden,  ///< its sender does not hold the robot
  kInvalid,
  kFull
};
/// In words, for counters: "of another operator than the one who holds the robot".
const char* describe(FenceReceipt receipt);

/// Placeholder in a book for fences that were lost: nothing drives while it is there. It forbids
/// all ground.
Fence lostFences();

/// The fences in force: the robot's own, and those added by operators.
/** An additional fence only restricts the robot and is accepted from everybody, like a stop:
 * several fences may have the same name. Only the operator who holds the robot may remove fences,
 * and the robot's own stay. In a full book, strangers' fences, the oldest first, give way to
 * fences of the operator who holds the robot. */
class FenceBook {
 public:
  static constexpr size_t kMost = 32;
  /// Of all fences together: the motor bridge checks every one in each step.
  static constexpr size_t kMostCorners = 512;

  explicit FenceBook(std::vector<Fence> own = {})
      : fences_(std::move(own)), own_(fences_.size()), lasting_(own_) {}

  /// Whether a robot can monitor this many fences and corners.
  static bool fit(const std::vector<Fence>& fences);

  /// `holds`: the sender holds the robot.
  FenceReceipt take(const FenceRequest& request, bool holds);

  /// The robot's own first.
  const std::vector<Fence>& fences() const { return fences_; }
  size_t own() const { return own_; }
  /// Why nothing may drive, and what to do; empty = all fences are known.
  std::string bar() const;
  /// How many fences precede the strangers': the robot's own and the holders'.
  size_t lasting() const { return lasting_; }
  /// Increases with each change.
  int64_t revision() const { return revision_; }

 private:
  FenceReceipt add(const Fence& fence, bool holds);
  FenceReceipt remove(const std::string& name, bool holds);

  std::vector<Fence> fences_;  ///< the robot's own, then holders', then strangers', oldest first
  size_t own_;
  size_t lasting_;  ///< how many fences are not strangers'
  int64_t revision_ = 0;
};

/// One line each: kind, number of corners, all x and y [m], name.
std::string toText(const std::vector<Fence>& fences);
/// Parses such lines; `broken` counts those that cannot be read.
std::vector<Fence> fencesFrom(const std::string& text, int& broken);

}  // namespace tread

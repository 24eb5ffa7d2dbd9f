// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/fence/fence.hpp"

namespace tread {

/// A request about fences, as sent: one more fence, or all of a name gone.
struct FenceRequest {
  std::string by;
  bool removes = false;
  Fence fence;  ///< without corners if it removes
};

/// What came of a request.
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

/// Stands in a book for fences that are not known any more: nothing drives while one of its name is
/// there. Keeps out of everywhere.
Fence lostFences();

/// The fences in force: the robot's own, and what operators have added.
/** One more fence only narrows, and is taken from everybody, as a stop is: fences of one name are
 * kept side by side. Removing widens: only the operator who holds the robot may do it, and the
 * robot's own fences stay. When the book is full, strangers' fences make room for one of the
 * operator who holds the robot, the oldest first. */
class FenceBook {
 public:
  static constexpr size_t kMost = 32;
  /// Of all fences: the motor bridge looks at all of them in each of its steps.
  static constexpr size_t kMostCorners = 512;

  explicit FenceBook(std::vector<Fence> own = {})
      : fences_(std::move(own)), own_(fences_.size()), lasting_(own_) {}

  /// Whether a robot can look after so many fences and corners.
  static bool fit(const std::vector<Fence>& fences);

  /// `holds`: the sender holds the robot.
  FenceReceipt take(const FenceRequest& request, bool holds);

  /// The robot's own first.
  const std::vector<Fence>& fences() const { return fences_; }
  size_t own() const { return own_; }
  /// Why nothing may drive, and what to do; empty = the fences are known.
  std::string bar() const;
  /// The robot's own and those of who held it: how many come before strangers'.
  size_t lasting() const { return lasting_; }
  /// Counts up with each change.
  int64_t revision() const { return revision_; }

 private:
  FenceReceipt add(const Fence& fence, bool holds);
  FenceReceipt remove(const std::string& name, bool holds);

  std::vector<Fence> fences_;  ///< the robot's own, then holders', then strangers', oldest first
  size_t own_;
  size_t lasting_;  ///< how many are not strangers'
  int64_t revision_ = 0;
};

/// One line each: kind, number of corners, all x and y [m], name.
std::string toText(const std::vector<Fence>& fences);
/// The fences of such lines, as far as they can be read; `broken` counts the others.
std::vector<Fence> fencesFrom(const std::string& text, int& broken);

}  // namespace tread

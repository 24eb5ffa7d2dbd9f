// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::pattern_recorder {

/// Chooses which pattern to drive next, so that each is driven often enough, entered in its class,
/// and the vehicle stays near where it began.
/** Looks several patterns ahead along joinable chains. A chain counts what it drives of patterns
 * that are needed, those that lag behind most, which makes left and right take turns; it loses by
 * time and by ending far away. Every pattern of it leaves a way to standing within the room.
 * Patterns are given by their place in the set. */
class Tour {
 public:
  /// `room` [m]: distance from where it began that ends of patterns keep.
  /** Throws std::runtime_error if no class stands still (steady command 0, 0), or a class cannot be
   * reached from there or left for it. */
  Tour(const PatternSet& set, double room);

  /// The best pattern to join to a motion class at a pose; `needed` executions by pattern.
  /** Where nothing is needed any more, the one that leads to standing. Nothing where it stands and
   * either nothing is needed or no pattern stays within the room. */
  std::optional<size_t> next(const std::string& motion_class, const Pose2& T_home_body,
                             const std::vector<int>& needed) const;

  /// The class in which to begin: the first of the set that stands still.
  const std::string& standing() const { return class_names_[standing_]; }

 private:
  /// A pattern as the search sees it.
  struct Step {
    size_t pattern;
    size_t to;  ///< class in which it ends
    Pose2 T_start_end;
    double duration;  ///< [s]
  };
  /// The quickest way from a class to standing.
  struct Way {
    double duration = -1.0;  ///< [s]; negative = none
    Pose2 T_start_end;
    std::optional<size_t> first;  ///< pattern to begin with; nothing where it stands already
  };
  struct Search;

  size_t classIndex(const std::string& name) const;
  void findWays();
  void requireConnected(const PatternSet& set) const;

  double room_;
  std::vector<std::string> class_names_;
  size_t standing_ = 0;
  std::vector<std::vector<Step>> steps_;  ///< by class in which they begin
  std::vector<Way> ways_;                 ///< by class
};

}  // namespace tread::pattern_recorder

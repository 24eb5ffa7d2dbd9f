// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/vehicle/model.hpp"

namespace tread::patterns {

/// What a recipe is made for: limits of the robot, and what is wished.
struct RecipeWish {
  std::string name;
  double max_command = 1.0;    ///< in the unit of the model's kind
  double max_steering = 0.5;   ///< [rad] of a car
  std::vector<double> speeds;  ///< [m/s] forwards; empty = full, and where there are enough
                               ///< patterns crawl and slow
  int patterns = 40;           ///< at most
  double gap = 1.0;            ///< [m] width of the narrowest gap that it must pass
  double seconds = 0.0;        ///< [s] that a pattern lasts, about; 0 = by the robot's lag
  double acceleration = 4.0;   ///< [m/s2] the most that patterns ask of the ground
  double period = 0.05;        ///< [s] of a command
  /// [m] within which it drives from standing through a pattern to standing, with those speeds.
  double room = std::numeric_limits<double>::infinity();
};

/// A motion that is commanded: of a car with the steering angle [rad] in the place of the yaw rate.
struct Wanted {
  double forward = 0.0;  ///< [m/s]
  double left = 0.0;     ///< [m/s] of a holonomic base
  double turn = 0.0;     ///< [rad/s] as if nothing slipped

  double speed() const { return std::hypot(forward, left); }
  Wanted mirrored() const { return {forward, -left, -turn}; }
  /// The same turn at a share of the speed.
  Wanted slower(double share) const { return {share * forward, share * left, turn}; }
};

/// A steady motion straight on or aside in which patterns begin and end.
struct DesignedClass {
  std::string name;
  Wanted motion;
  int level = 0;            ///< of its speed among those in its direction; 0 = rest
  std::vector<double> row;  ///< the steady command as a recipe gives it
};

/// A pattern that could be in the set.
struct CandidatePattern {
  size_t entry = 0;                       ///< class
  size_t exit = 0;                        ///< class
  std::vector<std::vector<double>> rows;  ///< as in a recipe: commands, then seconds
  Pose2 end;                              ///< as the model foretells
  double seconds = 0.0;
};

/// One candidate, or one and its mirror image.
using CandidatePair = std::vector<CandidatePattern>;

/// All that a vehicle could do in one pattern: turns of many strengths and durations from class to
/// class.
/** A pattern turns, at the speed of its exit class or as fast as it can turn so, and then holds its
 * exit class's steady command until it has settled; between two equal classes it may also turn to
 * and fro. Joined are equal classes, rest and all others, and neighbouring speeds. */
class CandidateFamily {
 public:
  /// Throws std::runtime_error, one line, where the wish is beyond the robot. The model must live
  /// as long.
  CandidateFamily(const VehicleModel& model, const RecipeWish& wish);

  const std::vector<DesignedClass>& classes() const { return classes_; }
  const std::vector<CandidatePair>& pairs() const { return pairs_; }
  /// [s] that a pattern at full speed lasts at most.
  double seconds() const { return longest_; }
  /// [m/s] of the fastest class
  double top() const { return top_; }

 private:
  struct Held {
    Wanted motion;
    double seconds;
  };

  void makeClasses();
  std::vector<double> chosenSpeeds() const;
  void addClass(const std::string& name, const Wanted& motion, int level);
  size_t mirrorOf(size_t index) const;
  bool joined(size_t entry, size_t exit) const;
  double topSpeed() const;
  double hardestTurn() const;
  bool drivable(const Wanted& motion) const;
  /// The fastest at which it can turn so; nothing where it cannot.
  std::optional<Wanted> withinReach(const Wanted& motion) const;
  double longest(double speed) const;
  std::vector<double> row(const Wanted& motion) const;
  double sideCommand(double speed, bool left) const;
  double sideSpeed(double command, bool left) const;

  void join(size_t entry, size_t exit);
  void addStraight(size_t entry, size_t exit);
  void addOnTheSpot();
  void addTurns(size_t entry, size_t exit, const Wanted& base);
  void addHeld(size_t entry, size_t exit, const Wanted& motion, bool to_and_fro);
  void add(size_t entry, size_t exit, std::vector<Held> helds);
  CandidatePattern made(size_t entry, size_t exit, const std::vector<Held>& helds) const;

  const VehicleModel& model_;
  RecipeWish wish_;
  double hold_ = 0.0;     ///< [s]
  double longest_ = 0.0;  ///< [s] of a pattern at full speed
  double top_ = 0.0;      ///< [m/s] of the fastest class
  std::vector<DesignedClass> classes_;
  std::vector<CandidatePair> pairs_;
};

}  // namespace tread::patterns

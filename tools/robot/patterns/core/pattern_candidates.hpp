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

/// Requirements on a recipe: limits of the robot, and wishes.
struct RecipeWish {
  std::string name;
  double max_command = 1.0;   ///< in the unit of the model's kind
  double max_steering = 0.5;  ///< [rad] of a car
  /// [m/s] forwards; empty = full speed, with enough patterns also two slower ones
  std::vector<double> speeds;
  int patterns = 40;          ///< at most
  double gap = 1.0;           ///< [m] width of the narrowest gap that it must pass
  double seconds = 0.0;       ///< [s] approximate duration of a pattern; 0 = from the robot's lag
  double acceleration = 4.0;  ///< [m/s2] largest acceleration, which the ground must support
  double period = 0.05;       ///< [s] between commands
  /// [m] length in which the robot must be able to drive from standstill through a pattern to
  /// standstill, at those speeds.
  double room = std::numeric_limits<double>::infinity();
};

/// A commanded motion; for a car `turn` is the steering angle [rad].
struct Wanted {
  double forward = 0.0;  ///< [m/s]
  double left = 0.0;     ///< [m/s] of a holonomic base
  double turn = 0.0;     ///< [rad/s] without slip

  double speed() const { return std::hypot(forward, left); }
  Wanted mirrored() const { return {forward, -left, -turn}; }
  /// The same turn at a fraction of the speed.
  Wanted slower(double share) const { return {share * forward, share * left, turn}; }
};

/// A steady straight motion, forwards, backwards or sideways, in which patterns begin and end.
struct DesignedClass {
  std::string name;
  Wanted motion;
  int level = 0;            ///< rank of its speed within its direction; 0 = rest
  std::vector<double> row;  ///< the steady command, as a row of a recipe
};

/// A candidate for the set.
struct CandidatePattern {
  size_t entry = 0;                       ///< class
  size_t exit = 0;                        ///< class
  std::vector<std::vector<double>> rows;  ///< as in a recipe: commands and seconds
  Pose2 end;                              ///< predicted by the model
  double seconds = 0.0;
};

/// A candidate, and its mirror image if there is one.
using CandidatePair = std::vector<CandidatePattern>;

/// All feasible patterns of a vehicle: turns of many strengths and durations between classes.
/** A pattern turns at the speed of its exit class, or at the highest speed that allows the turn. It
 * then holds its exit class's steady command until it has settled. Between equal classes it may
 * also turn one way and back. Patterns connect a class with itself, rest with every class, and
 * neighbouring speeds. */
class CandidateFamily {
 public:
  /// Throws std::runtime_error, one line, if the wish exceeds the robot's limits. The model must
  /// outlive this.
  CandidateFamily(const VehicleModel& model, const RecipeWish& wish);

  const std::vector<DesignedClass>& classes() const { return classes_; }
  const std::vector<CandidatePair>& pairs() const { return pairs_; }
  /// [s] longest pattern at full speed.
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
  /// The motion slowed down until the turn is feasible; nullopt if it never is.
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

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/core/recipe_design.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "common/geometry/degrees.hpp"

namespace tread::patterns {
namespace {

constexpr double kCell = 0.05;     // [1] of the gap: end points closer together share a cell
constexpr double kSpotTurn = 0.6;  // [rad] of the mandatory turns on the spot
constexpr double kSlight = 0.3;    // [1] of the gap: smaller turns count as straight
// [1] weight of a metre ahead relative to one sideways: the next pattern continues ahead
constexpr double kAlongCounts = 0.3;
constexpr double kRestCounts = 0.2;  // [1] rest counts as a class of this share of the full speed
constexpr double kBackwardsCounts = 0.3;  // [1] relative to the same speed forwards
constexpr double kChangeCounts = 0.25;    // [1] of a change of class relative to staying in it
constexpr double kSpot = 0.1;             // [m] largest motion of a turn on the spot
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kStraightAway = 0.02;  // [rad] smaller is straight

/// End of a pattern, with all components in comparable lengths [m].
using Place = std::array<double, 5>;

double squaredDistance(const Place& a, const Place& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// The reachable end points from one class.
struct Reachable {
  std::vector<Place> places;
  std::vector<double> counts;   ///< [1] weight of each end point; sum over all classes 1
  std::vector<double> nearest;  ///< [m2] squared distance to the nearest end of the set
};

/// Weight of a class: the distance typically driven in it, mostly forwards.
double weightOf(const Wanted& motion, double top) {
  if (motion.speed() == 0.0) return kRestCounts;
  return (motion.forward > 0.0 ? 1.0 : kBackwardsCounts) * motion.speed() / top;
}

/// Chooses pairs from the candidates greedily.
class Coverage {
 public:
  Coverage(const CandidateFamily& family, const RecipeWish& wish)
      : family_(family), wish_(wish), reachable_(family.classes().size()) {
    const size_t classes = family.classes().size();
    for (size_t entry = 0; entry < classes; ++entry)
      for (size_t exit = 0; exit < classes; ++exit) addPlaces(entry, exit);
    double all = 0.0;
    for (const Reachable& from : reachable_)
      all = std::accumulate(from.counts.begin(), from.counts.end(), all);
    for (Reachable& from : reachable_)
      for (double& count : from.counts) count /= all;
  }

  /// [m]
  double dispersion() const {
    double sum = 0.0;
    for (const Reachable& from : reachable_)
      for (size_t i = 0; i < from.places.size(); ++i) sum += from.counts[i] * from.nearest[i];
    return std::sqrt(sum);
  }

  void take(const CandidatePair& pair) {
    for (const CandidatePattern& candidate : pair) {
      const Place place = placeOf(candidate);
      Reachable& from = reachable_[candidate.entry];
      for (size_t i = 0; i < from.places.size(); ++i)
        from.nearest[i] = std::min(from.nearest[i], squaredDistance(from.places[i], place));
    }
  }

  /// Decrease of the squared dispersion per pattern of the pair [m2]. The mirror image covers the
  /// mirrored end points.
  double gain(const CandidatePair& pair) const {
    double sum = 0.0;
    const Place place = placeOf(pair.front());
    const Reachable& from = reachable_[pair.front().entry];
    for (size_t i = 0; i < from.places.size(); ++i)
      sum +=
          from.counts[i] * std::max(0.0, from.nearest[i] - squaredDistance(from.places[i], place));
    return sum;
  }

 private:
  void addPlaces(size_t entry, size_t exit) {
    std::set<std::array<long, 5>> seen;
    std::vector<Place> places;
    for (const CandidatePair& pair : family_.pairs())
      for (const CandidatePattern& candidate : pair) {
        if (candidate.entry != entry || candidate.exit != exit) continue;
        const Place place = placeOf(candidate);
        std::array<long, 5> cell{};
        for (size_t i = 0; i < place.size(); ++i)
          cell[i] = std::lround(place[i] / (kCell * wish_.gap));
        if (seen.insert(cell).second) places.push_back(place);
      }
    double all = 0.0;
    for (const Place& place : places) all += countOf(place);
    const auto weight_of = [&](size_t i) {
      return weightOf(family_.classes()[i].motion, family_.top());
    };
    const double weight =
        weight_of(entry) * (entry == exit ? 1.0 : kChangeCounts * weight_of(exit));
    Reachable& from = reachable_[entry];
    for (const Place& place : places) {
      from.places.push_back(place);
      from.counts.push_back(weight * countOf(place) / all);
      from.nearest.push_back(squaredDistance(place, {}) + wish_.gap * wish_.gap);
    }
  }

  /// A hard turn may deviate more than a slight one, by the same relative error.
  double countOf(const Place& place) const {
    const double turn = std::hypot(place[1], place[2]), least = kSlight * wish_.gap;
    return 1.0 / (turn * turn + least * least);
  }

  Place placeOf(const CandidatePattern& candidate) const {
    const Wanted& exit = family_.classes()[candidate.exit].motion;
    return {kAlongCounts * candidate.end.x, candidate.end.y, wish_.gap * candidate.end.yaw,
            family_.seconds() * exit.forward, family_.seconds() * exit.left};
  }

  const CandidateFamily& family_;
  const RecipeWish& wish_;
  std::vector<Reachable> reachable_;  ///< by entry class
};

bool isStraight(const CandidatePattern& candidate) {
  return std::abs(candidate.end.yaw) < kStraightAway;
}

/// The pair whose first pattern has the least `cost`; none if all are infinite.
template <class Cost>
const CandidatePair* cheapest(const CandidateFamily& family, const Cost& cost) {
  const CandidatePair* best = nullptr;
  double least = kNever;
  for (const CandidatePair& pair : family.pairs()) {
    if (!(cost(pair.front()) < least)) continue;
    least = cost(pair.front());
    best = &pair;
  }
  return best;
}

/// Mandatory pairs: without them a class cannot be reached, kept or left, or the vehicle cannot
/// turn.
std::vector<const CandidatePair*> neededPairs(const CandidateFamily& family, bool is_car) {
  const std::vector<DesignedClass>& classes = family.classes();
  std::vector<const CandidatePair*> needed;
  const auto need = [&](const auto& cost) {
    const CandidatePair* pair = cheapest(family, cost);
    if (pair != nullptr) needed.push_back(pair);
  };
  for (size_t entry = 0; entry < classes.size(); ++entry)
    for (size_t exit = 0; exit < classes.size(); ++exit)
      // Straight on as far as possible; changes of speed as early as possible.
      need([&](const CandidatePattern& c) {
        if (c.entry != entry || c.exit != exit || c.rows.size() != 1) return kNever;
        return entry == exit ? -c.seconds : c.seconds;
      });
  if (!is_car) {
    need([&](const CandidatePattern& c) {
      const bool on_the_spot = c.entry == 0 && c.exit == 0 && c.end.position().norm() < kSpot;
      return on_the_spot ? std::abs(std::abs(c.end.yaw) - kSpotTurn) : kNever;
    });
    return needed;
  }
  for (const double sign : {1.0, -1.0})
    need([&](const CandidatePattern& c) {
      const bool fits = c.entry == c.exit && sign * classes[c.entry].motion.forward > 0.0;
      return fits ? -std::abs(c.end.yaw) : kNever;
    });
  return needed;
}

std::string sizedName(const std::string& name, double size) {
  return name + "_" + std::to_string(std::lround(std::abs(size)));
}

std::string nameOf(const std::vector<DesignedClass>& classes, const CandidatePattern& candidate) {
  const Pose2& end = candidate.end;
  const double degrees = toDegrees(end.yaw);
  const std::string& from = classes[candidate.entry].name;
  const std::string& to = classes[candidate.exit].name;
  const bool turns = !isStraight(candidate);
  const std::string side = (turns ? end.yaw : end.y) > 0.0 ? "left" : "right";
  if (candidate.entry == 0 && candidate.exit == 0) {
    if (std::abs(end.yaw) > end.position().norm()) return sizedName("turn_" + side, degrees);
    if (std::abs(end.y) > std::abs(end.x)) return sizedName("step_" + side, 100.0 * end.y);
    const std::string step = end.x < 0.0 ? "step_back" : "step_forward";
    return turns ? sizedName(step + "_" + side, degrees) : sizedName(step, 100.0 * end.x);
  }
  std::string name = from + "_to_" + to;
  if (candidate.entry == candidate.exit) name = from;
  if (candidate.entry == 0) name = "start_" + to;
  if (candidate.exit == 0) name = "stop_" + from;
  if (turns) return sizedName(name + "_" + side, degrees);
  if (candidate.rows.size() == 1)
    return candidate.entry == candidate.exit
               ? sizedName(name + "_straight", 100.0 * end.position().norm())
               : name;
  return sizedName(name + "_lane_" + side, 100.0 * end.y);
}

DesignedPattern designed(const CandidateFamily& family, const CandidatePair& pair,
                         std::set<std::string>& names) {
  DesignedPattern pattern;
  pattern.made = pair;
  for (const CandidatePattern& candidate : pair) {
    const std::string plain = nameOf(family.classes(), candidate);
    std::string name = plain;
    for (int more = 2; !names.insert(name).second; ++more)
      name = plain + "_" + std::to_string(more);
    pattern.names.push_back(name);
  }
  return pattern;
}

}  // namespace

int DesignedRecipe::count() const {
  size_t sum = 0;
  for (const DesignedPattern& pattern : patterns) sum += pattern.names.size();
  return static_cast<int>(sum);
}

DesignedRecipe designRecipe(const VehicleModel& model, const RecipeWish& wish) {
  const CandidateFamily family(model, wish);
  Coverage coverage(family, wish);
  DesignedRecipe recipe{wish.name, wish.period, family.classes(), {}};
  std::set<std::string> names;
  const auto take = [&](const CandidatePair& pair, bool needed) {
    recipe.patterns.push_back(designed(family, pair, names));
    DesignedPattern& pattern = recipe.patterns.back();
    pattern.needed = needed;
    pattern.before = coverage.dispersion();
    coverage.take(pair);
    pattern.after = coverage.dispersion();
  };
  for (const CandidatePair* pair : neededPairs(family, model.isCar())) take(*pair, true);
  if (recipe.count() > wish.patterns)
    throw std::runtime_error(
        std::to_string(wish.patterns) + " patterns are too few: " + std::to_string(recipe.count()) +
        " are needed to reach and leave " + std::to_string(recipe.classes.size()) +
        " motion classes; take more patterns or fewer speeds");
  for (;;) {
    const CandidatePair* best = nullptr;
    double most = 0.0;
    for (const CandidatePair& pair : family.pairs()) {
      if (recipe.count() + static_cast<int>(pair.size()) > wish.patterns) continue;
      const double gain = coverage.gain(pair);
      if (gain <= most) continue;
      most = gain;
      best = &pair;
    }
    if (best == nullptr) return recipe;
    take(*best, false);
  }
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/comparison.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace tread::patterns {
namespace {

constexpr double kDegrees = 180.0 / kPi;
constexpr double kShortestWay = 0.25;  // [m] of which a share is told

template <typename... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// A pattern of both sets.
struct Pair {
  const MotionPattern* a;
  const MotionPattern* b;

  double distance() const { return std::hypot(b->end().x - a->end().x, b->end().y - a->end().y); }
  /// Of the way that `a` predicts; of a turn on the spot it says nothing.
  std::string share() const {
    const double length = a->pathLength();
    return length >= kShortestWay ? line("%.1f", 100.0 * distance() / length) : "-";
  }
  double turn() const { return (b->end().yaw - a->end().yaw) * kDegrees; }
};

std::vector<Pair> pairsOf(const PatternSet& a, const PatternSet& b, const std::string& name_a,
                          const std::string& name_b, std::string& remarks) {
  std::vector<Pair> pairs;
  for (const MotionPattern& pattern : a.patterns()) {
    const MotionPattern* other = b.findByName(pattern.name);
    if (other == nullptr)
      remarks += line("'%s' is only in %s.\n", pattern.name.c_str(), name_a.c_str());
    else if (other->commands != pattern.commands || a.content().kind != b.content().kind ||
             a.content().period_us != b.content().period_us)
      remarks +=
          line("'%s' has other commands in the two sets; not compared.\n", pattern.name.c_str());
    else
      pairs.push_back({&pattern, other});
  }
  for (const MotionPattern& pattern : b.patterns())
    if (a.findByName(pattern.name) == nullptr)
      remarks += line("'%s' is only in %s.\n", pattern.name.c_str(), name_b.c_str());
  return pairs;
}

std::string row(const Pair& pair) {
  const Pose2& a = pair.a->end();
  const Pose2& b = pair.b->end();
  return line("%-16s  %7.3f %7.3f %7.1f  %7.3f %7.3f %7.1f  %7.3f %7.3f %7.1f  %6.3f %5s\n",
              pair.a->name.c_str(), a.x, a.y, a.yaw * kDegrees, b.x, b.y, b.yaw * kDegrees,
              b.x - a.x, b.y - a.y, pair.turn(), pair.distance(), pair.share().c_str());
}

std::string inWords(const std::vector<Pair>& pairs) {
  const Pair* furthest = &pairs.front();
  const Pair* turned = &pairs.front();
  for (const Pair& pair : pairs) {
    if (pair.distance() > furthest->distance()) furthest = &pair;
    if (std::abs(pair.turn()) > std::abs(turned->turn())) turned = &pair;
  }
  if (furthest->distance() == 0.0 && turned->turn() == 0.0) return "Both predict the same ends.\n";
  return line("The position differs most in '%s': b ends %.3f m from a, which drives %.3f m.\n",
              furthest->a->name.c_str(), furthest->distance(), furthest->a->pathLength()) +
         line("The heading differs most in '%s': a turns %.1f deg, b %.1f deg.\n",
              turned->a->name.c_str(), turned->a->end().yaw * kDegrees,
              turned->b->end().yaw * kDegrees);
}

}  // namespace

std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b) {
  std::string remarks;
  const std::vector<Pair> pairs = pairsOf(a, b, name_a, name_b, remarks);
  if (pairs.empty()) return remarks + "The two sets have no pattern in common.\n";
  std::string text =
      line("Ends of a = %s and b = %s, in m and deg:\n", name_a.c_str(), name_b.c_str());
  text += line("%-16s  %7s %7s %7s  %7s %7s %7s  %7s %7s %7s  %6s %5s\n", "name", "a x", "a y",
               "a deg", "b x", "b y", "b deg", "b-a x", "b-a y", "b-a deg", "m off", "%");
  for (const Pair& pair : pairs) text += row(pair);
  return text + remarks + inWords(pairs);
}

}  // namespace tread::patterns

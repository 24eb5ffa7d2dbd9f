// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/set_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "common/report/text.hpp"

namespace tread::patterns {
namespace {

bool isLetter(const std::string& text, size_t at) {
  return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0;
}

/// Whether the word is at this place and not part of another one: "upright" does not contain
/// "right".
bool wordAt(const std::string& text, size_t at, const std::string& word) {
  return text.compare(at, word.size(), word) == 0 && (at == 0 || !isLetter(text, at - 1)) &&
         !isLetter(text, at + word.size());
}

double negated(double value) {
  return value == 0.0 ? 0.0 : -value;
}

}  // namespace

Command mirroredCommand(const Command& command, const CommandChannels& channels) {
  Command image = command;
  if (kindOfTracks(channels)) std::swap(image[0], image[1]);
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i].kind == CommandKind::kSteeringAngle) image[i] = negated(command[i]);
  return image;
}

namespace {

/// The class with left and right exchanged: itself if it goes straight.
const MotionClass* mirrorClass(const PatternSet& set, const std::string& name) {
  const MotionClass& motion = set.classNamed(name);
  for (const MotionClass& other : set.content().classes)
    if (other.steady == mirroredCommand(motion.steady, set.content().channels) &&
        (other.name == name || other.steady != motion.steady))
      return &other;
  return nullptr;
}

/// Why a pattern that turns cannot be mirrored; empty if it can.
std::string obstacle(const PatternSet& set, const MotionPattern& pattern) {
  for (const std::string& name : {pattern.entry_class, pattern.exit_class})
    if (mirrorClass(set, name) == nullptr)
      return "class '" + name + "' turns, and the set has no mirror image of it";
  const std::string name = mirroredName(pattern.name);
  if (set.findByName(name) != nullptr)
    return "the name '" + name + "' belongs to a pattern that is not its mirror image";
  return "";
}

std::string quoted(const std::string& name) {
  return "pattern '" + name + "'";
}

void add(PatternSetContent& content, MotionPattern pattern, std::vector<std::string>& notes) {
  int highest = 0;
  for (const MotionPattern& other : content.patterns) highest = std::max(highest, other.id);
  pattern.id = highest + 1;
  notes.push_back(quoted(pattern.name) + " added with id " + std::to_string(pattern.id));
  content.patterns.push_back(std::move(pattern));
}

void requireWorkFor(const PatternSet& set, const std::string& name) {
  const MotionPattern* pattern = set.findByName(name);
  if (pattern == nullptr)
    throw std::runtime_error("no " + quoted(name) + " in set '" + set.content().name + "'");
  if (!turns(*pattern, set.content().channels))
    throw std::runtime_error(quoted(name) + " goes straight: it is its own mirror image");
  if (const MotionPattern* partner = mirrorPartner(set, *pattern))
    throw std::runtime_error(quoted(name) + " already has its mirror image: '" + partner->name +
                             "'");
  if (const std::string why = obstacle(set, *pattern); !why.empty())
    throw std::runtime_error(quoted(name) + " cannot be mirrored: " + why);
}

constexpr double kDegrees = 180.0 / kPi;

std::string spread(const PoseCovariance& covariance) {
  if (std::isnan(covariance[0])) return "unknown";
  return formatted("%.3f %.3f %4.1f", std::sqrt(covariance[0]), std::sqrt(covariance[3]),
                   std::sqrt(covariance[5]) * kDegrees);
}

std::string row(const MotionPattern& pattern, double period) {
  const Pose2& end = pattern.end();
  return formatted("%4d  %-16s %-8s %-8s %5.2f %7.3f  %7.3f %7.3f %7.1f  %s\n", pattern.id,
                   pattern.name.c_str(), pattern.entry_class.c_str(), pattern.exit_class.c_str(),
                   static_cast<double>(pattern.commands.size()) * period, pattern.pathLength(),
                   end.x, end.y, end.yaw * kDegrees, spread(pattern.end_covariance).c_str());
}

constexpr double kShortestWay = 0.25;  // [m] shorter paths have no meaningful relative error

/// A pattern of both sets.
struct Pair {
  const MotionPattern* a;
  const MotionPattern* b;

  double distance() const { return std::hypot(b->end().x - a->end().x, b->end().y - a->end().y); }
  /// Difference relative to the path of `a`; empty for a turn on the spot.
  std::string share() const {
    const double length = a->pathLength();
    return length >= kShortestWay ? formatted("%.1f", 100.0 * distance() / length) : "-";
  }
  double turn() const { return (b->end().yaw - a->end().yaw) * kDegrees; }
};

std::vector<Pair> pairsOf(const PatternSet& a, const PatternSet& b, const std::string& name_a,
                          const std::string& name_b, std::string& remarks) {
  std::vector<Pair> pairs;
  for (const MotionPattern& pattern : a.patterns()) {
    const MotionPattern* other = b.findByName(pattern.name);
    if (other == nullptr) {
      remarks += formatted("'%s' is only in %s.\n", pattern.name.c_str(), name_a.c_str());
      continue;
    }
    pairs.push_back({&pattern, other});
    if (other->commands != pattern.commands || a.content().channels != b.content().channels ||
        a.content().period_us != b.content().period_us)
      remarks += formatted("'%s' has other commands in the two sets.\n", pattern.name.c_str());
  }
  for (const MotionPattern& pattern : b.patterns())
    if (a.findByName(pattern.name) == nullptr)
      remarks += formatted("'%s' is only in %s.\n", pattern.name.c_str(), name_b.c_str());
  return pairs;
}

std::string pairRow(const Pair& pair) {
  const Pose2& a = pair.a->end();
  const Pose2& b = pair.b->end();
  return formatted("%-16s  %7.3f %7.3f %7.1f  %7.3f %7.3f %7.1f  %7.3f %7.3f %7.1f  %6.3f %5s\n",
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
  return formatted(
             "The position differs most in '%s': b ends %.3f m from a, which drives %.3f m.\n",
             furthest->a->name.c_str(), furthest->distance(), furthest->a->pathLength()) +
         formatted("The heading differs most in '%s': a turns %.1f deg, b %.1f deg.\n",
                   turned->a->name.c_str(), turned->a->end().yaw * kDegrees,
                   turned->b->end().yaw * kDegrees);
}

constexpr double kSpeedOff = 0.15;  // [m/s] at the end; a third of the learner's gate
constexpr double kTurnOff = 0.20;   // [rad/s]
constexpr double kShareOff = 0.10;  // [1] of the class's own speed or rate, if larger
constexpr double kEndSpan = 0.1;    // [s] over which the twist at the end is taken

void adviseClasses(const PatternSet& set, std::vector<std::string>& advice) {
  std::set<std::string> standing;
  for (const MotionClass& motion : set.content().classes)
    if (motion.steady == Command{}) standing.insert(motion.name);
  if (standing.empty()) {
    advice.push_back(
        "no class stands still (steady command all 0): a robot can neither start nor stop with "
        "this "
        "set");
    return;
  }
  const std::set<std::string> reached = connectedClasses(set, standing, false);
  const std::set<std::string> left = connectedClasses(set, standing, true);
  for (const MotionClass& motion : set.content().classes) {
    if (reached.count(motion.name) == 0)
      advice.push_back(formatted(
          "class '%s' cannot be reached from standing: no chain of patterns leads into it",
          motion.name.c_str()));
    if (left.count(motion.name) == 0)
      advice.push_back(
          formatted("class '%s' cannot be left: no chain of patterns leads to standing",
                    motion.name.c_str()));
  }
}

void advisePartner(const PatternSet& set, const MotionPattern& pattern,
                   std::vector<std::string>& advice) {
  if (turns(pattern, set.content().channels) && mirrorPartner(set, pattern) == nullptr)
    advice.push_back(
        formatted("pattern '%s' has no mirror image; add it with tread-patterns mirror",
                  pattern.name.c_str()));
}

/// Mean twist over the last kEndSpan of a trajectory.
Twist2 twistAtEnd(const MotionPattern& pattern, double period) {
  const size_t count = pattern.trajectory.size();
  const auto wanted = static_cast<size_t>(std::max(1.0, std::round(kEndSpan / period)));
  const size_t span = std::min(wanted, count);
  const Pose2 before = span < count ? pattern.trajectory[count - 1 - span] : Pose2{};
  return twistTo(between(before, pattern.end()), static_cast<double>(span) * period);
}

void adviseEnd(const PatternSet& set, const MotionPattern& pattern,
               std::vector<std::string>& advice) {
  const Twist2 end = twistAtEnd(pattern, set.periodSeconds());
  const Twist2& wanted = set.classNamed(pattern.exit_class).twist;
  const double speed_off = std::hypot(end.v_x - wanted.v_x, end.v_y - wanted.v_y);
  const double turn_off = std::abs(end.omega - wanted.omega);
  const double speed_limit = std::max(kSpeedOff, kShareOff * std::hypot(wanted.v_x, wanted.v_y));
  const double turn_limit = std::max(kTurnOff, kShareOff * std::abs(wanted.omega));
  if (speed_off <= speed_limit && turn_off <= turn_limit) return;
  advice.push_back(formatted(
      "pattern '%s' ends with %.2f m/s, %.2f m/s to the left and %.2f rad/s; its exit class '%s' "
      "has %.2f, %.2f and %.2f: the next pattern starts differently from its prediction",
      pattern.name.c_str(), end.v_x, end.v_y, end.omega, pattern.exit_class.c_str(), wanted.v_x,
      wanted.v_y, wanted.omega));
}

void adviseCovariances(const PatternSet& set, std::vector<std::string>& advice) {
  std::string names;
  size_t unknown = 0;
  for (const MotionPattern& pattern : set.patterns()) {
    if (!std::isnan(pattern.end_covariance[0])) continue;
    ++unknown;
    names += (names.empty() ? "'" : ", '") + pattern.name + "'";
  }
  if (unknown == set.patterns().size()) names = "all patterns";
  if (unknown > 0) advice.push_back("unknown end covariance of " + names);
}

}  // namespace

bool turns(const MotionPattern& pattern, const CommandChannels& channels) {
  return std::any_of(pattern.commands.begin(), pattern.commands.end(), [&](const Command& command) {
    return mirroredCommand(command, channels) != command;
  });
}

std::string mirroredName(const std::string& name) {
  std::string result;
  for (size_t at = 0; at < name.size();) {
    if (wordAt(name, at, "left")) {
      result += "right";
      at += 4;
    } else if (wordAt(name, at, "right")) {
      result += "left";
      at += 5;
    } else {
      result += name[at++];
    }
  }
  return result == name ? name + "_mirrored" : result;
}

const MotionPattern* mirrorPartner(const PatternSet& set, const MotionPattern& pattern) {
  const MotionClass* entry = mirrorClass(set, pattern.entry_class);
  const MotionClass* exit = mirrorClass(set, pattern.exit_class);
  if (entry == nullptr || exit == nullptr) return nullptr;
  const auto isImage = [&](const Command& a, const Command& b) {
    return a == mirroredCommand(b, set.content().channels);
  };
  for (const MotionPattern& other : set.patterns())
    if (other.entry_class == entry->name && other.exit_class == exit->name &&
        std::equal(other.commands.begin(), other.commands.end(), pattern.commands.begin(),
                   pattern.commands.end(), isImage))
      return &other;
  return nullptr;
}

MotionPattern mirrored(const MotionPattern& pattern, const CommandChannels& channels) {
  MotionPattern image = pattern;
  image.name = mirroredName(pattern.name);
  image.times_learned = 0;
  for (Command& command : image.commands) command = mirroredCommand(command, channels);
  for (Pose2& pose : image.trajectory) pose = {pose.x, negated(pose.y), negated(pose.yaw)};
  // The signs of xy and x-yaw change; y and yaw change sign together.
  for (const size_t i : {size_t{1}, size_t{2}})
    image.end_covariance[i] = negated(image.end_covariance[i]);
  return image;
}

namespace {

/// The mirror image of a pattern, between the mirror images of its classes.
MotionPattern imageIn(const PatternSet& set, const MotionPattern& pattern) {
  MotionPattern image = mirrored(pattern, set.content().channels);
  image.entry_class = mirrorClass(set, pattern.entry_class)->name;
  image.exit_class = mirrorClass(set, pattern.exit_class)->name;
  return image;
}

}  // namespace

PatternSet withMirrors(const PatternSet& set, const std::optional<std::string>& only,
                       std::vector<std::string>& notes) {
  notes.clear();
  if (only) requireWorkFor(set, *only);
  PatternSetContent content = set.content();
  for (const MotionPattern& pattern : set.patterns()) {
    if (only && pattern.name != *only) continue;
    if (!turns(pattern, set.content().channels) || mirrorPartner(set, pattern) != nullptr) continue;
    if (const std::string why = obstacle(set, pattern); !why.empty())
      notes.push_back(quoted(pattern.name) + " not mirrored: " + why);
    else
      add(content, imageIn(set, pattern), notes);
  }
  std::string why;
  auto result = PatternSet::make(std::move(content), why);
  if (!result) throw std::runtime_error("the mirrored set is not valid: " + why);
  return *result;
}

namespace {

/// "power" or "track speed" of two tracks, else the names of the channels.
std::string commandWords(const CommandChannels& channels) {
  const auto kind = kindOfTracks(channels);
  if (!kind) return describe(channels);
  return *kind == CommandKind::kPower ? "power" : "track speed";
}

std::string listed(const Command& command, size_t channels) {
  std::string text;
  for (size_t i = 0; i < channels; ++i) text += formatted(i == 0 ? "%g" : ", %g", command[i]);
  return text;
}

}  // namespace

std::string table(const PatternSet& set) {
  const PatternSetContent& content = set.content();
  std::string text =
      formatted("%s: version %lld, %zu patterns, %s, %g ms a sample\n", content.name.c_str(),
                static_cast<long long>(content.version), content.patterns.size(),
                commandWords(content.channels).c_str(), set.periodSeconds() * 1e3);
  for (const MotionClass& motion : content.classes)
    text += formatted("  %-8s %.3f m/s, %.3f m/s to the left, %.3f rad/s at command %s\n",
                      motion.name.c_str(), motion.twist.v_x, motion.twist.v_y, motion.twist.omega,
                      listed(motion.steady, content.channels.size()).c_str());
  text += formatted("%4s  %-16s %-8s %-8s %5s %7s  %7s %7s %7s  %s\n", "id", "name", "entry",
                    "exit", "s", "m", "end x", "end y", "deg", "spread x y m, deg");
  for (const MotionPattern& pattern : content.patterns) text += row(pattern, set.periodSeconds());
  return text;
}

std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b) {
  std::string remarks;
  const std::vector<Pair> pairs = pairsOf(a, b, name_a, name_b, remarks);
  if (pairs.empty()) return remarks + "The two sets have no pattern in common.\n";
  std::string text =
      formatted("Ends of a = %s and b = %s, in m and deg:\n", name_a.c_str(), name_b.c_str());
  text += formatted("%-16s  %7s %7s %7s  %7s %7s %7s  %7s %7s %7s  %6s %5s\n", "name", "a x", "a y",
                    "a deg", "b x", "b y", "b deg", "b-a x", "b-a y", "b-a deg", "m off", "%");
  for (const Pair& pair : pairs) text += pairRow(pair);
  return text + remarks + inWords(pairs);
}

std::vector<std::string> adviceFor(const PatternSet& set) {
  std::vector<std::string> advice;
  adviseClasses(set, advice);
  for (const MotionPattern& pattern : set.patterns()) {
    advisePartner(set, pattern, advice);
    adviseEnd(set, pattern, advice);
  }
  adviseCovariances(set, advice);
  return advice;
}

}  // namespace tread::patterns

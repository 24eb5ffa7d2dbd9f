// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

#include "common/pattern/pattern_check.hpp"

namespace tread {
namespace {

// Based on Fowler-Noll-Vo 1a, 64 bit (offset basis and prime as published by its authors), but word
// by word: an eighth of the time. Folding mixes high bits into low ones, which the product alone
// does not.
class Hash {
 public:
  void add(uint64_t value) {
    value_ = (value_ ^ value) * 0x100000001b3U;
    value_ ^= value_ >> 29;
  }
  void add(int64_t value) { add(static_cast<uint64_t>(value)); }
  void add(double value) {
    uint64_t bits = 0x7ff8000000000000U;  // the one NaN
    if (!std::isnan(value)) std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(const std::string& text) {
    add(static_cast<uint64_t>(text.size()));
    for (const char c : text) add(static_cast<uint64_t>(static_cast<unsigned char>(c)));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325U;
};

/// Two tracks are identified by their kind alone, so that sets in old logs keep their checksums.
void addChannels(Hash& hash, const CommandChannels& channels) {
  const auto kind = kindOfTracks(channels);
  hash.add(kind ? static_cast<int64_t>(*kind) : 0);
  if (kind) return;
  hash.add(static_cast<uint64_t>(channels.size()));
  for (const CommandChannel& channel : channels) {
    hash.add(channel.name);
    hash.add(static_cast<int64_t>(channel.kind));
    hash.add(channel.lowest);
    hash.add(channel.highest);
  }
}

void addCommand(Hash& hash, const Command& command, size_t channels) {
  for (size_t i = 0; i < channels; ++i) hash.add(command[i]);
}

void addClass(Hash& hash, const MotionClass& motion, size_t channels) {
  hash.add(motion.name);
  for (const double value : {motion.twist.v_x, motion.twist.v_y, motion.twist.omega})
    hash.add(value);
  addCommand(hash, motion.steady, channels);
}

void addPattern(Hash& hash, const MotionPattern& pattern, size_t channels) {
  hash.add(static_cast<int64_t>(pattern.id));
  hash.add(pattern.name);
  hash.add(pattern.entry_class);
  hash.add(pattern.exit_class);
  hash.add(static_cast<uint64_t>(pattern.commands.size()));
  for (const Command& command : pattern.commands) addCommand(hash, command, channels);
  hash.add(static_cast<uint64_t>(pattern.trajectory.size()));
  for (const Pose2& pose : pattern.trajectory) {
    hash.add(pose.x);
    hash.add(pose.y);
    hash.add(pose.yaw);
  }
  for (const double value : pattern.end_covariance) hash.add(value);
  hash.add(static_cast<int64_t>(pattern.times_learned));
}

/// FNV-1a (64 bit), word by word and folded, over a canonical form of the content, cut to 63 bits
/// so that it is never negative.
/** Includes name, version, parent, channels, period, classes by name, patterns in their order;
 * numbers by their bit patterns, little-endian, every NaN the same. Excludes utime, which is a
 * time stamp of the content. */
int64_t checksumOf(const PatternSetContent& content) {
  Hash hash;
  hash.add(content.name);
  hash.add(content.version);
  hash.add(content.parent_version);
  addChannels(hash, content.channels);
  hash.add(content.period_us);
  std::vector<const MotionClass*> classes;
  for (const MotionClass& motion : content.classes) classes.push_back(&motion);
  std::sort(classes.begin(), classes.end(),
            [](const MotionClass* a, const MotionClass* b) { return a->name < b->name; });
  hash.add(static_cast<uint64_t>(classes.size()));
  for (const MotionClass* motion : classes) addClass(hash, *motion, content.channels.size());
  hash.add(static_cast<uint64_t>(content.patterns.size()));
  for (const MotionPattern& pattern : content.patterns)
    addPattern(hash, pattern, content.channels.size());
  return static_cast<int64_t>(hash.value() & 0x7fffffffffffffffU);
}

}  // namespace

std::optional<PatternSet> PatternSet::make(PatternSetContent content, std::string& why) {
  why.clear();
  if (const auto problem = firstProblem(content)) {
    why = problem->line(content);
    return std::nullopt;
  }
  const int64_t checksum = checksumOf(content);
  return PatternSet(std::make_shared<const PatternSetContent>(std::move(content)), checksum);
}

const MotionPattern* PatternSet::find(int id) const {
  for (const MotionPattern& pattern : patterns())
    if (pattern.id == id) return &pattern;
  return nullptr;
}

const MotionPattern* PatternSet::findByName(const std::string& name) const {
  for (const MotionPattern& pattern : patterns())
    if (pattern.name == name) return &pattern;
  return nullptr;
}

const MotionClass& PatternSet::classNamed(const std::string& name) const {
  for (const MotionClass& motion : content_->classes)
    if (motion.name == name) return motion;
  throw std::out_of_range("pattern set '" + content_->name + "' has no motion class '" + name +
                          "'");
}

bool PatternSet::joinable(const MotionPattern& previous, const MotionPattern& next) const {
  return previous.exit_class == next.entry_class;
}

std::vector<const MotionPattern*> PatternSet::startingIn(const std::string& entry_class) const {
  std::vector<const MotionPattern*> starting;
  for (const MotionPattern& pattern : patterns())
    if (pattern.entry_class == entry_class) starting.push_back(&pattern);
  return starting;
}

std::set<std::string> connectedClasses(const PatternSet& set, std::set<std::string> found,
                                       bool backwards) {
  for (size_t before = 0; before != found.size();) {
    before = found.size();
    for (const MotionPattern& pattern : set.patterns()) {
      const std::string& from = backwards ? pattern.exit_class : pattern.entry_class;
      const std::string& to = backwards ? pattern.entry_class : pattern.exit_class;
      if (found.count(from) > 0) found.insert(to);
    }
  }
  return found;
}

std::vector<double> restToRestLengths(const PatternSet& set) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::map<std::string, double> from_rest;
  for (const MotionClass& each : set.content().classes)
    from_rest[each.name] = each.standing() ? 0.0 : kFar;
  std::map<std::string, double> to_rest = from_rest;
  const auto shorten = [](double& length, double other) {
    const bool shorter = other < length;
    length = std::min(length, other);
    return shorter;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const MotionPattern& pattern : set.patterns()) {
      const double length = pattern.pathLength();
      double& after = from_rest[pattern.exit_class];
      double& before = to_rest[pattern.entry_class];
      changed |= shorten(after, from_rest[pattern.entry_class] + length);
      changed |= shorten(before, to_rest[pattern.exit_class] + length);
    }
  }
  std::vector<double> lengths;
  for (const MotionPattern& pattern : set.patterns())
    lengths.push_back(from_rest[pattern.entry_class] + pattern.pathLength() +
                      to_rest[pattern.exit_class]);
  return lengths;
}

}  // namespace tread

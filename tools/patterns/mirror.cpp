// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/mirror.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

namespace tread::patterns {
namespace {

bool isLetter(const std::string& text, size_t at) {
  return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0;
}

/// Whether the word stands at this place, not as a part of another: upright is no right.
bool wordAt(const std::string& text, size_t at, const std::string& word) {
  return text.compare(at, word.size(), word) == 0 && (at == 0 || !isLetter(text, at - 1)) &&
         !isLetter(text, at + word.size());
}

double negated(double value) {
  return value == 0.0 ? 0.0 : -value;
}

/// The class that is this one with left and right exchanged: itself where it goes straight.
const MotionClass* mirrorClass(const PatternSet& set, const std::string& name) {
  const MotionClass& motion = set.classNamed(name);
  if (motion.steady.left == motion.steady.right) return &motion;
  for (const MotionClass& other : set.content().classes)
    if (other.steady.left == motion.steady.right && other.steady.right == motion.steady.left)
      return &other;
  return nullptr;
}

/// Why a pattern that turns cannot be mirrored; empty if it can.
std::string obstacle(const PatternSet& set, const MotionPattern& pattern) {
  for (const std::string& name : {pattern.entry_class, pattern.exit_class})
    if (mirrorClass(set, name) == nullptr)
      return "class '" + name + "' turns, and its mirror image is no class of the set";
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
  if (!turns(*pattern))
    throw std::runtime_error(quoted(name) + " goes straight: it is its own mirror image");
  if (const MotionPattern* partner = mirrorPartner(set, *pattern))
    throw std::runtime_error(quoted(name) + " has its mirror image already: '" + partner->name +
                             "'");
  if (const std::string why = obstacle(set, *pattern); !why.empty())
    throw std::runtime_error(quoted(name) + " cannot be mirrored: " + why);
}

}  // namespace

bool turns(const MotionPattern& pattern) {
  return std::any_of(pattern.commands.begin(), pattern.commands.end(),
                     [](const TrackCommand& command) { return command.left != command.right; });
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
  const auto isImage = [](const TrackCommand& a, const TrackCommand& b) {
    return a.left == b.right && a.right == b.left;
  };
  for (const MotionPattern& other : set.patterns())
    if (other.entry_class == entry->name && other.exit_class == exit->name &&
        std::equal(other.commands.begin(), other.commands.end(), pattern.commands.begin(),
                   pattern.commands.end(), isImage))
      return &other;
  return nullptr;
}

MotionPattern mirrored(const MotionPattern& pattern) {
  MotionPattern image = pattern;
  image.name = mirroredName(pattern.name);
  image.times_learned = 0;
  for (TrackCommand& command : image.commands) std::swap(command.left, command.right);
  for (Pose2& pose : image.trajectory) pose = {pose.x, negated(pose.y), negated(pose.yaw)};
  // Of x with y and of x with yaw; y and yaw change sign together.
  for (const size_t i : {size_t{1}, size_t{2}})
    image.end_covariance[i] = negated(image.end_covariance[i]);
  return image;
}

namespace {

/// The mirror image, between the mirror images of its classes.
MotionPattern imageIn(const PatternSet& set, const MotionPattern& pattern) {
  MotionPattern image = mirrored(pattern);
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
    if (!turns(pattern) || mirrorPartner(set, pattern) != nullptr) continue;
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

}  // namespace tread::patterns

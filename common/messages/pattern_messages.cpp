// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/pattern_messages.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"

namespace tread {
namespace {

pattern_set_part_t partOf(const PatternSet& set, size_t index) {
  const PatternSetContent& content = set.content();
  const MotionPattern& pattern = content.patterns[index];
  auto part = blank<pattern_set_part_t>();
  part.utime = content.utime;
  part.set_version = content.version;
  part.parent_version = content.parent_version;
  part.set_checksum = set.checksum();
  part.set_name = content.name;
  part.part = static_cast<int32_t>(index);
  part.part_count = static_cast<int32_t>(content.patterns.size());
  part.set_pattern_id = pattern.id;
  part.pattern_name = pattern.name;
  part.set_command_kind = static_cast<int16_t>(content.kind);
  part.set_period = static_cast<int32_t>(content.period_us);
  part.entry_class = pattern.entry_class;
  part.exit_class = pattern.exit_class;
  part.times_learned = pattern.times_learned;
  std::copy(pattern.end_covariance.begin(), pattern.end_covariance.end(), part.end_covariance);
  return part;
}

}  // namespace

std::vector<pattern_set_part_t> toMessages(const PatternSet& set) {
  std::vector<pattern_set_part_t> parts;
  for (size_t i = 0; i < set.patterns().size(); ++i) {
    const MotionPattern& pattern = set.patterns()[i];
    pattern_set_part_t part = partOf(set, i);
    const auto fillClass = [&](const std::string& name, double(&twist)[3], double(&steady)[2]) {
      const MotionClass& motion = set.classNamed(name);
      twist[0] = motion.twist.v_x;
      twist[1] = motion.twist.v_y;
      twist[2] = motion.twist.omega;
      steady[0] = motion.steady.left;
      steady[1] = motion.steady.right;
    };
    fillClass(pattern.entry_class, part.entry_twist, part.entry_steady);
    fillClass(pattern.exit_class, part.exit_twist, part.exit_steady);
    part.num_samples = static_cast<int32_t>(pattern.commands.size());
    for (const TrackCommand& command : pattern.commands)
      part.command.push_back({command.left, command.right});
    for (const Pose2& pose : pattern.trajectory)
      part.trajectory.push_back({pose.x, pose.y, pose.yaw});
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "tests/tools/robot/patterns/few_patterns.hpp"
#include "tools/robot/patterns/set_text.hpp"

using namespace tread;
using namespace tread::patterns;

const CommandChannels kTracks = trackChannels(CommandKind::kPower);

TEST_CASE("The name of a mirror image exchanges left and right, words only") {
  CHECK(mirroredName("left") == "right");
  CHECK(mirroredName("turn_right_90") == "turn_left_90");
  CHECK(mirroredName("left then right") == "right then left");
  CHECK(mirroredName("upright") == "upright_mirrored");
  CHECK(mirroredName("bow") == "bow_mirrored");
}

TEST_CASE("A mirror image has y, yaw and their covariances with x negated") {
  const MotionPattern left = *kit::withoutRight().findByName("left");
  const MotionPattern right = mirrored(left, kTracks);
  CHECK(right.name == "right");
  CHECK(right.commands[0][0] == left.commands[0][1]);
  CHECK(right.commands[0][1] == left.commands[0][0]);
  CHECK(right.end().x == left.end().x);
  CHECK(right.end().y == -left.end().y);
  CHECK(right.end().yaw == -left.end().yaw);
  CHECK(right.end_covariance == PoseCovariance{1e-4, -2e-5, -3e-5, 4e-4, 5e-5, 6e-4});
}

TEST_CASE("Mirroring adds what is missing, once") {
  std::vector<std::string> notes;
  const PatternSet once = withMirrors(kit::withoutRight(), std::nullopt, notes);
  CHECK(notes == std::vector<std::string>{"pattern 'right' added with id 5"});
  REQUIRE(once.findByName("right") != nullptr);
  const PatternSet twice = withMirrors(once, std::nullopt, notes);
  CHECK(notes.empty());
  CHECK(twice.checksum() == once.checksum());
}

TEST_CASE("A mirror image of the shipped set's patterns is the shipped partner") {
  const PatternSet shipped =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  for (const MotionPattern& pattern : shipped.patterns()) {
    INFO(pattern.name);
    const MotionPattern* partner = mirrorPartner(shipped, pattern);
    CHECK((partner != nullptr) == true);
    if (!turns(pattern, shipped.content().channels)) continue;
    const MotionPattern image = mirrored(pattern, shipped.content().channels);
    CHECK(image.name == partner->name);
    for (size_t t = 0; t < image.trajectory.size(); ++t) {
      CHECK(image.trajectory[t].y == partner->trajectory[t].y);
      CHECK(image.trajectory[t].yaw == partner->trajectory[t].yaw);
    }
  }
}

TEST_CASE("What cannot be mirrored is refused by name and noted in passing") {
  std::vector<std::string> notes;
  const PatternSet set = kit::withoutRight();
  CHECK_THROWS_WITH(withMirrors(set, "lift", notes), "no pattern 'lift' in set 'few'");
  CHECK_THROWS_WITH(withMirrors(set, "straight", notes), Catch::Contains("its own mirror image"));
  const PatternSet taken = kit::setOf({kit::pattern(1, "left", {0.4, 0.5}, {0.5, 0.0, 0.1}),
                                       kit::pattern(2, "right", {0.5, 0.3}, {0.4, 0.0, -0.2})});
  CHECK_THROWS_WITH(withMirrors(taken, "left", notes), Catch::Contains("belongs to a pattern"));
  CHECK(withMirrors(taken, std::nullopt, notes).patterns().size() == 2);
  CHECK(notes.size() == 2);
  PatternSetContent turning = set.content();
  turning.classes[0].steady = {0.4, 0.5};
  std::string why;
  const PatternSet turns_always = *PatternSet::make(turning, why);
  CHECK_THROWS_WITH(withMirrors(turns_always, "left", notes),
                    Catch::Contains("class 'cruise' turns"));
}

TEST_CASE("Between classes that turn, the mirror image is between their mirror images") {
  PatternSetContent content;
  content.name = "turning";
  content.period_us = 100'000;
  content.classes = {{"left", {0.5, 0.0, 0.2}, {0.4, 0.6}},
                     {"right", {0.5, 0.0, -0.2}, {0.6, 0.4}}};
  content.patterns = {kit::pattern(1, "left", {0.4, 0.6}, {0.5, 0.0, 0.2}, "left", "left"),
                      kit::pattern(2, "hold", {0.6, 0.4}, {0.5, 0.0, -0.2}, "right", "right"),
                      kit::pattern(3, "swing_left", {0.3, 0.6}, {0.5, 0.0, 0.2}, "right", "left")};
  std::string why;
  const PatternSet set = PatternSet::make(content, why).value();
  REQUIRE(mirrorPartner(set, set.patterns()[0]) != nullptr);
  CHECK(mirrorPartner(set, set.patterns()[0])->name == "hold");
  std::vector<std::string> notes;
  const PatternSet mirrored_set = withMirrors(set, std::nullopt, notes);
  CHECK(notes.size() == 1);
  const MotionPattern* image = mirrored_set.findByName("swing_right");
  REQUIRE(image != nullptr);
  CHECK(image->entry_class == "left");
  CHECK(image->exit_class == "right");
}

TEST_CASE("The mirror image of a mirror image is the pattern itself, with its own name") {
  const PatternSet shipped =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  for (const MotionPattern& pattern : shipped.patterns()) {
    if (!turns(pattern, shipped.content().channels)) continue;
    INFO(pattern.name);
    const MotionPattern twice = mirrored(mirrored(pattern, kTracks), kTracks);
    CHECK(twice.name == pattern.name);
    CHECK(twice.commands == pattern.commands);
    CHECK(twice.end_covariance == pattern.end_covariance);
    REQUIRE(twice.trajectory.size() == pattern.trajectory.size());
    for (size_t t = 0; t < twice.trajectory.size(); ++t) {
      CHECK(twice.trajectory[t].x == pattern.trajectory[t].x);
      CHECK(twice.trajectory[t].y == pattern.trajectory[t].y);
      CHECK(twice.trajectory[t].yaw == pattern.trajectory[t].yaw);
    }
  }
}

TEST_CASE("A mirror image was never learned, and keeps the length of its path") {
  MotionPattern left = *kit::withoutRight().findByName("left");
  left.times_learned = 7;
  const MotionPattern right = mirrored(left, kTracks);
  CHECK(right.times_learned == 0);
  CHECK(right.pathLength() == left.pathLength());
  // A straight sample has no negative zero, which a file would contain as -0.
  MotionPattern straight = *kit::withoutRight().findByName("straight");
  for (const Pose2& pose : mirrored(straight, kTracks).trajectory) {
    CHECK_FALSE(std::signbit(pose.y));
    CHECK_FALSE(std::signbit(pose.yaw));
  }
}

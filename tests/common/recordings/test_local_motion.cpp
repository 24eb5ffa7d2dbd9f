// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/recordings/csv_table.hpp"
#include "tests/common/recordings/synthetic_drives.hpp"

using namespace tread;
using namespace tread::recordings;
using namespace tread::samples;

namespace {

const Ground kGround = linearGround(0.9, 0.5, -0.1);

double distance(const TwistLine& a, const TwistLine& b) {
  return (a.vector() - b.vector()).cwiseAbs().maxCoeff();
}

std::string complaint(const std::vector<SurfaceWindows>& windows, const PatternRecipe& recipe) {
  try {
    recordingsOf(windows, recipe, 1.0, 2);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("windows of commands around a pattern's are moved to its own command") {
  const auto windows = drawnWindows(kGround, 60, 0.0, 3);
  for (const PatternWish& wish : defaultRecipe().patterns) {
    CAPTURE(wish.name);
    const LocalMotion motion = localMotion(windows, wish.command, defaultRecipe());
    CHECK(distance(motion.mean, kGround(wish.command)) < 1e-9);
    CHECK(motion.windows == 30);
  }
}

TEST_CASE("some windows that are far off hardly move the mean") {
  auto windows = drawnWindows(kGround, 60, 0.02, 4);
  for (size_t i = 0; i < windows.size(); i += 9) {
    windows[i].profile.mean.omega += 3.0;
    windows[i].profile.mean.v_x -= 2.0;
  }
  const BodyCommand left{2.5, 1.5};
  const LocalMotion motion = localMotion(windows, left, defaultRecipe());
  CHECK(std::abs(motion.mean.mean.omega - kGround(left).mean.omega) < 0.03);
  CHECK(std::abs(motion.mean.mean.v_x - kGround(left).mean.v_x) < 0.03);
}

TEST_CASE("recordings vary about the mean as the windows of one step do, with both signs") {
  const auto windows = drawnWindows(kGround, 60, 0.1, 5);
  const LocalMotion motion = localMotion(windows, {2.5, 1.5}, defaultRecipe());
  const auto profiles = recordedProfiles(motion);
  REQUIRE(profiles.size() == 30);
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  double square = 0.0;
  for (const TwistLine& profile : profiles) {
    mean += profile.vector() / 30.0;
    square += std::pow(profile.mean.omega - motion.mean.mean.omega, 2) / 30.0;
  }
  CHECK((mean - motion.mean.vector()).cwiseAbs().maxCoeff() < 1e-12);
  // Windows differ by a uniform draw in +-0.1 with opposite signs: 2 u / sqrt(2), u of 0.058.
  CHECK(std::sqrt(square) == Approx(0.1 / std::sqrt(3.0) * std::sqrt(2.0)).epsilon(0.3));
}

TEST_CASE("a step in which the poses failed tells nothing of how executions differ") {
  auto windows = drawnWindows(kGround, 60, 0.05, 5);
  for (size_t i = 0; i < windows.size(); i += 16) windows[i].profile.slope.v_x += 2.0;
  const LocalMotion motion = localMotion(windows, {2.5, 1.5}, defaultRecipe());
  CHECK(motion.deviations.size() == 15);
  CHECK(motion.implausible > 0);
  for (const TwistLine& deviation : motion.deviations) CHECK(std::abs(deviation.slope.v_x) < 0.1);
}

TEST_CASE("mirrored drives make mirrored patterns") {
  const Ground skewed = [](const BodyCommand& command) {
    return TwistLine{
        {0.9 * command.v - 0.05 * std::abs(command.w) * command.v,
         0.1 * command.v * command.w + 0.02 * command.v, 0.5 * command.w + 0.03 * command.v},
        {0.0, 0.01, 0.02}};
  };
  auto windows = drawnWindows(skewed, 60, 0.05, 6);
  const LocalMotion left = localMotion(windows, {2.5, 1.5}, defaultRecipe());
  for (SteadyWindow& window : windows) {
    window.command.w = -window.command.w;
    window.profile = window.profile.mirrored();
  }
  const LocalMotion right = localMotion(windows, {2.5, -1.5}, defaultRecipe());
  CHECK(distance(right.mean, left.mean.mirrored()) < 1e-9);
  REQUIRE(right.deviations.size() == left.deviations.size());
  for (size_t i = 0; i < left.deviations.size(); ++i)
    CHECK(distance(right.deviations[i], left.deviations[i].mirrored()) < 1e-12);
}

TEST_CASE("the order of the windows does not matter") {
  auto windows = drawnWindows(kGround, 40, 0.1, 8);
  const LocalMotion before = localMotion(windows, {1.8, -2.2}, defaultRecipe());
  std::reverse(windows.begin(), windows.end());
  const LocalMotion after = localMotion(windows, {1.8, -2.2}, defaultRecipe());
  CHECK(before.mean.vector() == after.mean.vector());
}

TEST_CASE("each pattern begins and ends in its own steady motion, the mean of the surfaces") {
  const DriveRecordings drives =
      recordingsOf({{"soft", {"s"}, drawnWindows(linearGround(0.8, 0.4, 0.0), 60, 0.0, 3), {}},
                    {"hard", {"h"}, drawnWindows(linearGround(1.0, 0.6, 0.0), 60, 0.0, 3), {}}},
                   defaultRecipe(), 1.0, 2);
  const PatternSet& set = drives.recordings.patterns;
  REQUIRE(set.patterns().size() == 8);
  CHECK(set.content().channels == trackChannels(CommandKind::kTrackSpeed));
  CHECK(set.content().period_us == 50'000);
  const MotionPattern& left = *set.findByName("left");
  CHECK(left.commands.size() == 40);
  CHECK(left.commands.front() == Command{1.75, 3.25});
  CHECK(left.entry_class == left.exit_class);
  const MotionClass& steady = set.classNamed(left.entry_class);
  CHECK(steady.twist.v_x == Approx(0.9 * 2.5).margin(1e-6));
  CHECK(steady.twist.omega == Approx(0.5 * 1.5).margin(1e-6));
  CHECK(drives.recordings.surfaces[0].executions[0][0].back().x ==
        Approx(0.8 * 2.5 * 2.0).margin(1e-5));
  // For a single surface the classes have that surface's steady motion.
  const PatternSet soft = averagedSet(drives, 0);
  CHECK(soft.classNamed("left").twist.omega == Approx(0.4 * 1.5).margin(1e-6));
  CHECK(soft.findByName("left")->end().yaw == Approx(0.4 * 1.5 * 2.0).margin(1e-4));
}

TEST_CASE("too few windows, or too few surfaces, are one clear line") {
  const auto many = drawnWindows(kGround, 60, 0.1, 3);
  auto halves = many;
  for (size_t i = 0; i < halves.size(); ++i) halves[i].window = 1;
  const auto few = drawnWindows(kGround, 8, 0.1, 3);
  CHECK(complaint({{"a", {}, many, {}}}, defaultRecipe()) ==
        "1 comparable surface(s) 'a', 2 are needed");
  CHECK(complaint({{"a", {}, many, {}}, {"b", {}, few, {}}}, defaultRecipe()) ==
        "1 comparable surface(s) 'a', 2 are needed (surface 'b' left out: only 16 steady windows; "
        "30 are needed around each pattern's command)");
  CHECK(complaint({{"a", {}, many, {}}, {"b", {}, halves, {}}}, defaultRecipe())
            .find("only 0 steps with two steady windows that agree; 15 are needed") !=
        std::string::npos);
  CHECK(complaint({{"a b", {}, many, {}}, {"a (b)", {}, many, {}}}, defaultRecipe()) ==
        "two surfaces would both be called 'a_b'; rename one in sessions.csv");
}

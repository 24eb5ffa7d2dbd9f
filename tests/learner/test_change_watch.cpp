// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Changes of ground detected while a pattern runs.
#include <catch2/catch.hpp>

#include <limits>
#include <random>

#include "modules/learner/core/change_watch.hpp"
#include "modules/learner/core/learner.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

constexpr double kOfSample = 0.05;
constexpr int64_t kOnePattern = 1'000'000;  // [us] duration of a pattern
constexpr GroundEffect kSlippery{0.55, 0.6, 0.0, 0.0};

/// The first samples of a pattern on one ground, the rest on another.
std::vector<Pose2> changing(const std::vector<Pose2>& shipped, const GroundEffect& from,
                            const GroundEffect& to, size_t at) {
  const std::vector<Pose2> before = under(from, shipped), after = under(to, shipped);
  std::vector<Pose2> driven;
  for (size_t t = 0; t < shipped.size(); ++t) {
    const std::vector<Pose2>& ground = t < at ? before : after;
    const Pose2 step = t > 0 ? between(ground[t - 1], ground[t]) : ground[0];
    driven.push_back(t > 0 ? driven.back() * step : step);
  }
  return driven;
}

/// Poses as rows.
struct Rows {
  explicit Rows(const std::vector<Pose2>& poses) { fill(poses, numbers); }
  ConstTrajectory all() const {
    return {numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3};
  }
  std::vector<double> numbers;
};

Rows beginning(const std::vector<Pose2>& poses, size_t samples) {
  return Rows({poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(samples)});
}

/// A rule that has driven on the meadow for some time.
Pupil atHome(std::mt19937_64& random) {
  Pupil pupil(ruleConfig("multi_model"), richSet());
  driveAny(pupil, kMeadow, kCalm, 60, random);
  return pupil;
}

}  // namespace

TEST_CASE("ground that changes inside a pattern is noticed while it runs, and since when") {
  std::mt19937_64 random(1);
  Pupil pupil = atHome(random);
  for (const size_t pattern : {kAhead, kTurnLeft, kBack})
    for (const size_t at : {0, 4, 8}) {
      INFO("pattern " << pattern << ", changes at " << at);
      ChangeWatch watch;
      watch.follow(pupil.rule(), kAhead, Rows(under(kMeadow, pupil.shipped(kAhead))).all(),
                   kOfSample);
      const Rows driven(changing(pupil.shipped(pattern), kMeadow, kSlippery, at));
      const auto change = watch.notice(pupil.rule(), pattern, driven.all(), kOfSample);
      REQUIRE(change.has_value());
      CHECK(change->noticed <= static_cast<int>(at) + 12);
      CHECK(std::abs(change->after - static_cast<int>(at)) <= 3);
    }
}

TEST_CASE("a change late in a pattern is noticed in the next one, which is on the new ground") {
  std::mt19937_64 random(2);
  Pupil pupil = atHome(random);
  ChangeWatch watch;
  const Rows last(changing(pupil.shipped(kAhead), kMeadow, kSlippery, 16));
  REQUIRE_FALSE(watch.notice(pupil.rule(), kAhead, last.all(), kOfSample).has_value());
  watch.follow(pupil.rule(), kAhead, last.all(), kOfSample);
  const Rows next(under(kSlippery, pupil.shipped(kTurnLeft)));
  const auto change = watch.notice(pupil.rule(), kTurnLeft, next.all(), kOfSample);
  REQUIRE(change.has_value());
  CHECK(change->after == 0);
  // Sooner than from this pattern alone, which needs the whole window.
  ChangeWatch alone;
  const auto later = alone.notice(pupil.rule(), kTurnLeft, next.all(), kOfSample);
  REQUIRE(later.has_value());
  CHECK(change->noticed < later->noticed);
}

TEST_CASE("executions that scatter as they did are no change") {
  std::mt19937_64 random(3);
  Pupil pupil = atHome(random);
  ChangeWatch watch;
  int noticed = 0;
  constexpr int kExecutions = 400;
  for (int n = 0; n < kExecutions; ++n) {
    const size_t pattern = random() % pupil.patterns();
    const std::vector<Pose2> driven = under(drawn(kMeadow, kCalm, random), pupil.shipped(pattern));
    const Rows rows(driven);
    noticed += watch.notice(pupil.rule(), pattern, rows.all(), kOfSample) ? 1 : 0;
    watch.follow(pupil.rule(), pattern, rows.all(), kOfSample);
    pupil.learn(pattern, driven);
  }
  CHECK(noticed <= kExecutions / 100);
}

TEST_CASE("one bad pose is no change of ground") {
  std::mt19937_64 random(4);
  Pupil pupil = atHome(random);
  std::vector<Pose2> driven = under(kMeadow, pupil.shipped(kAhead));
  driven[17].y += 0.3;
  const ChangeWatch watch;
  CHECK_FALSE(watch.notice(pupil.rule(), kAhead, Rows(driven).all(), kOfSample).has_value());
}

TEST_CASE("a beginning says the same as the whole, as soon as it is long enough") {
  std::mt19937_64 random(5);
  Pupil pupil = atHome(random);
  const std::vector<Pose2> driven = changing(pupil.shipped(kAhead), kMeadow, kSlippery, 3);
  const ChangeWatch watch;
  const auto whole = watch.notice(pupil.rule(), kAhead, Rows(driven).all(), kOfSample);
  REQUIRE(whole.has_value());
  for (size_t samples = 1; samples <= driven.size(); ++samples) {
    INFO(samples);
    const auto part =
        watch.notice(pupil.rule(), kAhead, beginning(driven, samples).all(), kOfSample);
    REQUIRE(part.has_value() == (static_cast<int>(samples) >= whole->noticed));
    if (!part) continue;
    CHECK(part->after == whole->after);
    CHECK(part->noticed == whole->noticed);
  }
}

TEST_CASE("a rule that does not know what to expect notices nothing") {
  Pupil pupil(ruleConfig("collective"), richSet());
  const ChangeWatch watch;
  const Rows driven(under(kSlippery, pupil.shipped(kAhead)));
  CHECK_FALSE(watch.notice(pupil.rule(), kAhead, driven.all(), kOfSample).has_value());
}

TEST_CASE("the watch restores to the bit, and refuses what is none of its numbers") {
  std::mt19937_64 random(6);
  Pupil pupil = atHome(random);
  ChangeWatch watch;
  watch.follow(pupil.rule(), kAhead, Rows(under(kMeadow, pupil.shipped(kAhead))).all(), kOfSample);
  const std::vector<double> memory = watch.memory();
  REQUIRE(memory.size() == 7 * ChangeWatch::kEach);
  ChangeWatch restored;
  REQUIRE(restored.restore(memory));
  CHECK(restored.memory() == memory);
  std::vector<double> cut = memory;
  cut.pop_back();
  CHECK_FALSE(restored.restore(cut));
  std::vector<double> lost = memory;
  lost[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(restored.restore(lost));
  CHECK(restored.memory() == memory);
}

TEST_CASE("what lies before a change teaches nothing of the ground behind it") {
  std::mt19937_64 random(7);
  const Pupil home = atHome(random);
  Pupil told(home), untold(home);
  const std::vector<Pose2> driven = changing(home.shipped(kAhead), kMeadow, kSlippery, 10);
  Context context;
  context.changed_after = 10;
  const RuleNote note = told.learn(kAhead, driven, context);
  untold.learn(kAhead, driven);
  CHECK(note.change_probability > 0.9);
  CHECK(meanEndError(told, kSlippery) < 0.6 * meanEndError(untold, kSlippery));
  // The previous ground is remembered, and recognized.
  driveAny(told, kMeadow, kCalm, 3, random);
  CHECK(meanEndError(told, kMeadow) < 0.02);
}

TEST_CASE("a change that proves to be none is said") {
  std::mt19937_64 random(8);
  Pupil pupil = atHome(random);
  Context context;
  context.changed_after = 0;
  int none = 0;
  none += pupil.learn(kAhead, under(kMeadow, pupil.shipped(kAhead)), context).no_change ? 1 : 0;
  for (int n = 0; n < 10; ++n) none += driveAny(pupil, kMeadow, kCalm, 1, random).no_change ? 1 : 0;
  CHECK(none == 1);
  none = 0;
  pupil.learn(kAhead, under(kSlippery, pupil.shipped(kAhead)), context);
  for (int n = 0; n < 10; ++n)
    none += driveAny(pupil, kSlippery, kCalm, 1, random).no_change ? 1 : 0;
  CHECK(none == 0);
}

TEST_CASE("the learner takes a change that it notices for the set that is planned with next") {
  const RuleConfig config = ruleConfig("multi_model");
  Learner learner(config, smallSet());
  const std::vector<Pose2> usual = smallSet().find(kStraight)->trajectory;
  int64_t ended = 0;
  for (int n = 0; n < 40; ++n)
    REQUIRE(learner.learn(kStraight, fair(usual), {}, ended += kOnePattern).changed);
  Learner restored(config, smallSet());
  REQUIRE(restored.restore(learner.set(), learner.residuals(), learner.memory()));
  const std::vector<Pose2> driven = changing(usual, kMeadow, kSlippery, 4);
  Measurement part = fair(driven);
  part.covered = 15;
  for (Learner* each : {&learner, &restored}) {
    REQUIRE(each->follow(kStraight, part, 3, ended + kOnePattern * 3 / 4));
    // It reflects the rest of the pattern, not all of it.
    CHECK(each->set().find(kStraight)->end().x < 0.65);
    const Correction correction = each->learn(kStraight, fair(driven), {}, ended + kOnePattern);
    REQUIRE(correction.changed_after.has_value());
    CHECK(std::abs(*correction.changed_after - 4) <= 2);
    CHECK(correction.reason.find("another ground while it ran") != std::string::npos);
    CHECK_FALSE(each->learn(kStraight, fair(under(kSlippery, usual)), {}, ended + 2 * kOnePattern)
                    .changed_after.has_value());
  }
  CHECK(restored.set().checksum() == learner.set().checksum());
  CHECK(restored.memory() == learner.memory());
}

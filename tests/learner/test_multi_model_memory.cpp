// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Rules write their state and read it back bit by bit, or reject it.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/helpers.hpp"
#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

/// Executes random patterns; every third is incomplete if the rule learns from those.
void driveOn(Pupil& pupil, const GroundEffect& ground, int executions, std::mt19937_64& random) {
  for (int i = 0; i < executions; ++i) {
    const size_t p = random() % pupil.patterns();
    std::vector<Pose2> measured = under(drawn(ground, kCalm, random), pupil.shipped(p));
    if (pupil.rule().learnsParts() && i % 3 == 2) measured.resize(1 + random() % measured.size());
    pupil.learn(p, measured);
  }
}

/// Data that the learner stores in addition to the memory.
TrajectoryTable published(const Pupil& pupil) {
  PatternSetContent content = pupil.set().content();
  for (size_t p = 0; p < pupil.patterns(); ++p)
    content.patterns[p].trajectory = pupil.prediction(p);
  return TrajectoryTable(content.patterns);
}

/// On its third ground, with the second one in memory.
const Pupil& experienced() {
  static const Pupil kPupil = [] {
    Pupil pupil(ruleConfig("multi_model"), richSet());
    std::mt19937_64 random(1);
    driveOn(pupil, kMeadow, 20, random);
    driveOn(pupil, kMud, 30, random);
    driveOn(pupil, kRoad, 6, random);
    return pupil;
  }();
  return kPupil;
}

/// Whether a rule with other knowledge accepts a memory; if not it must be unchanged.
bool restores(const std::vector<double>& memory) {
  static const Pupil kOther = [] {
    Pupil pupil(ruleConfig("multi_model"), richSet());
    std::mt19937_64 random(2);
    driveOn(pupil, kRoad, 15, random);
    return pupil;
  }();
  static const std::vector<double> kBefore = kOther.everything();
  Pupil pupil(kOther);
  const std::vector<double> remembered = pupil.rule().memory();
  const bool restored = pupil.rule().restore(TrajectoryTable(pupil.set().patterns()), memory);
  if (!restored) {
    REQUIRE(pupil.rule().memory() == remembered);
    REQUIRE(pupil.everything() == kBefore);
  }
  return restored;
}

std::vector<double> memoryOf(const Pupil& pupil) {
  return Pupil(pupil).rule().memory();
}

/// Offsets in the memory of seven patterns.
enum Place : size_t {
  kClockAt,
  kChangesAt,
  kMetresAt,
  kGroundAt,
  kCalmAt,
  kSearchingAt,
  kNoticedAt,
  kScatterAt,
  kEffectsAt = kScatterAt + 5 * 7,
  kSurfacesAt = kEffectsAt + 5 * 6 + 4,
  kFirstAt,  ///< the hypothesis of the shipped set's ground
};
constexpr size_t kEachPart = 20;

/// The same within a hypothesis, whose banks have so many scales.
struct Hypothesis {
  explicit Hypothesis(size_t at, const Surface& surface)
      : weight(at),
        velocity(at + 3 + TwistCorrection::kCommon + TwistCorrection::kOwn * 7),
        yaw(velocity + 7 * surface.velocity().scales().size()),
        factors(yaw + 7 * surface.yaw().scales().size()) {}

  size_t weight, velocity, yaw, factors;
  size_t last_met = weight + 1, since = weight + 2, centre = weight + 3;
  size_t noise = factors + 3 * 7, executions = noise + 3, parts = executions + 1;
  /// Pattern, first, samples, count, sums and squares; the same of entries
  size_t part = parts + 1;

  /// Offset of the next hypothesis, or of the number of new ones.
  size_t end(const std::vector<double>& memory) const {
    return part + kEachPart * static_cast<size_t>(memory[parts]);
  }
};

}  // namespace

TEST_CASE("a restored rule goes on to the bit, after any number of executions") {
  for (const Rule& rule : ruleNames()) {
    INFO(rule);
    for (const int learned : {0, 1, 4, 10, 75, 140}) {
      INFO(learned << " executions");
      Pupil first(ruleConfig(rule), richSet());
      std::mt19937_64 random(7);
      driveOn(first, kMeadow, std::min(learned, 30), random);
      driveOn(first, kMud, std::clamp(learned - 30, 0, 60), random);
      driveOn(first, kRoad, std::max(0, learned - 90), random);
      Pupil second(ruleConfig(rule), richSet());
      std::mt19937_64 other(learned);
      driveOn(second, kRoad, learned % 7, other);
      REQUIRE(second.rule().restore(published(first), first.rule().memory()));
      REQUIRE(second.rule().remembered() == first.rule().remembered());
      for (int i = 0; i < 60; ++i) {
        REQUIRE(second.everything() == first.everything());
        for (size_t p = 0; p < first.patterns(); ++p)
          REQUIRE(second.rule().endCovariance(p) == first.rule().endCovariance(p));
        std::mt19937_64 same = random;
        const GroundEffect& ground = i < 20 ? kMud : kRoad;
        driveOn(first, ground, 1, random);
        driveOn(second, ground, 1, same);
      }
      REQUIRE(second.rule().memory() == first.rule().memory());
    }
  }
}

TEST_CASE("a memory that is cut off anywhere, or longer, is refused whole") {
  const std::vector<double> memory = memoryOf(experienced());
  REQUIRE(restores(memory));
  for (size_t length = 0; length < memory.size(); length += length < 200 ? 1 : 7)
    REQUIRE_FALSE(restores({memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(length)}));
  std::vector<double> longer = memory;
  longer.push_back(0.0);
  REQUIRE_FALSE(restores(longer));
}

TEST_CASE("a memory with what is not a number anywhere is refused whole") {
  const std::vector<double> memory = memoryOf(experienced());
  for (size_t at = 0; at < memory.size(); ++at)
    for (const double wrong : {kNan, tread::testing::kInf, -tread::testing::kInf}) {
      std::vector<double> damaged = memory;
      damaged[at] = wrong;
      REQUIRE_FALSE(restores(damaged));
    }
}

TEST_CASE("a memory with a number that cannot be is refused whole") {
  const std::vector<double> memory = memoryOf(experienced());
  REQUIRE(memory[kClockAt] == 57.0);
  REQUIRE(memory[kSurfacesAt] == 2.0);
  const auto refused = [&](size_t at, const std::vector<double>& values) {
    for (const double value : values) {
      INFO("number " << at << " is " << value);
      std::vector<double> damaged = memory;
      damaged[at] = value;
      CHECK_FALSE(restores(damaged));
    }
  };
  refused(kClockAt, {-1.0, 0.5, 1.0, 1e300});
  refused(kChangesAt, {-1.0, 1e300});
  refused(kMetresAt, {-1.0, 1e5});
  refused(kGroundAt, {-1.0, 0.5, 58.0, 1e300});
  refused(kCalmAt, {-2.0, 2.0, 1e300});
  refused(kSearchingAt, {-2.0, 2.0, 1e300});
  refused(kNoticedAt, {-1.0, 0.5, 2.0, 1e300});
  refused(kScatterAt, {-1.0, 1e300});
  refused(kScatterAt + 1, {-1.0, 1e300});
  refused(kEffectsAt, {-1e4, 1e300});            // an effect
  refused(kEffectsAt + 6, {-1.0, 0.0, 1e300});   // its variance
  refused(kEffectsAt + 12, {-1e4, 1e300});       // what it gained
  refused(kEffectsAt + 18, {-1.0, 0.5, 2.0});    // whether it counts
  refused(kEffectsAt + 24, {-1e4, 1e300});       // mean of the inputs
  refused(kEffectsAt + 30, {-1.0, 1e300});       // executions
  refused(kEffectsAt + 31, {-1.0, 0.5, 1e300});  // ground
  refused(kEffectsAt + 32, {-1.0, 1e300});       // first voltage
  refused(kEffectsAt + 33, {-1.0, 1.0, 1e300});  // sag
  refused(kSurfacesAt, {-1.0, 0.0, 0.5, 1.0, 3.0, 66.0, 1e9, 1e300});
  Pupil knowing(experienced());
  const Surface &shipped = asMultiModel(knowing).surface(0),
                &other = asMultiModel(knowing).surface(1);
  const Hypothesis first(kFirstAt, shipped), second(first.end(memory), other);
  const size_t fresh = second.end(memory);
  REQUIRE(memory[fresh] >= 1.0);
  REQUIRE(memory[fresh] <= 8.0);
  refused(fresh, {-1.0, 0.5, memory[fresh] - 1.0, memory[fresh] + 1.0, 9.0, 1e300});
  for (const Hypothesis& each : {first, second, Hypothesis(fresh + 1, other)}) {
    refused(each.weight, {-0.5, memory[each.weight] + 0.01, 2.0, 1e300});
    refused(each.last_met, {-1.0, 0.5, 58.0, 1e300});
    refused(each.since, {-1.0, 0.5, 58.0, 1e300});
    refused(each.centre, {1e300, -1e300});
    refused(each.velocity, {-0.1, 0.0, 1e300});      // a variance
    refused(each.velocity + 5, {-1.0, 0.0, 1e300});  // a factor on the noise
    refused(each.yaw + 6, {-0.1, 0.0, 2.0});         // a weight
    refused(each.factors, {0.0, -1.0, 51.0, 1e300});
    refused(each.noise, {0.0, -1.0, 51.0, 1e300});
    refused(each.executions, {-1.0, memory[each.executions] + 1.0, 1e300});
    refused(each.parts, {-1.0, 0.5, memory[each.parts] + 1.0, 1e9, 1e300});
    if (memory[each.parts] < 1.0) continue;
    refused(each.part, {-1.0, 0.5, 7.0, 1e300});
    refused(each.part + 1, {-1.0, 0.5, 20.0, 1e300});
    refused(each.part + 2, {-1.0, 0.0, 0.5, 21.0, 1e300});
    refused(each.part + 3, {-1.0, 0.0, memory[each.part + 3] + 0.5, 1e300});
    refused(each.part + 4, {1e300, -1e300});
    refused(each.part + 7, {-1e-3});
    refused(each.part + 10, {-1.0, 0.5, 2.0, 1e300});
    refused(each.part + 11, {1e300, -1e300});
    refused(each.part + 14, {-1e-3});
    refused(each.part + 17, {1e300, -1e300});
  }
}

TEST_CASE("the memory of another rule or of another set is refused") {
  Pupil single(ruleConfig("single"), richSet());
  Pupil knowing(experienced());
  Pupil small(ruleConfig("multi_model"), smallSet());
  const TrajectoryTable rich(richSet().patterns());
  REQUIRE_FALSE(knowing.rule().restore(rich, single.rule().memory()));
  REQUIRE_FALSE(knowing.rule().restore(rich, small.rule().memory()));
  REQUIRE_FALSE(small.rule().restore(TrajectoryTable(smallSet().patterns()), memoryOf(knowing)));
  REQUIRE(memoryOf(knowing) == memoryOf(experienced()));
  // Rules with predictions only continue from any; but they must have the same shape.
  REQUIRE(single.rule().restore(rich, knowing.rule().memory()));
  REQUIRE_FALSE(single.rule().restore(TrajectoryTable(smallSet().patterns()), {}));
}

TEST_CASE("more surfaces than there is room for now are kept until the next one makes room") {
  RuleConfig config = ruleConfig("multi_model");
  config.ground.capacity = 1;
  Pupil more(experienced());
  std::mt19937_64 random(3);
  driveOn(more, kRoad, 40, random);
  REQUIRE(more.rule().remembered() == 3);
  Pupil roomless(config, richSet());
  REQUIRE(roomless.rule().restore(TrajectoryTable(richSet().patterns()), memoryOf(more)));
  REQUIRE(roomless.rule().remembered() == 3);
  REQUIRE(memoryOf(roomless) == memoryOf(more));
  driveOn(roomless, kMud, 20, random);
  REQUIRE(roomless.rule().remembered() == 3);
  // A fourth ground: now there is space for one besides the shipped set's.
  driveOn(roomless, {0.7, 0.8, -0.1, 0.0}, 40, random);
  REQUIRE(roomless.rule().remembered() == 2);
}

TEST_CASE("more surfaces than there is room for whatever the configuration are refused") {
  const std::vector<double> memory = memoryOf(experienced());
  Pupil knowing(experienced());
  const size_t second = Hypothesis(kFirstAt, asMultiModel(knowing).surface(0)).end(memory);
  const size_t fresh = Hypothesis(second, asMultiModel(knowing).surface(1)).end(memory);
  // Copies of the second surface, with weight 0.
  const auto with = [&](int64_t copies) {
    std::vector<double> more(memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(fresh));
    more[kSurfacesAt] += static_cast<double>(copies);
    for (int64_t i = 0; i < copies; ++i) {
      more.push_back(0.0);
      more.insert(more.end(), memory.begin() + static_cast<std::ptrdiff_t>(second) + 1,
                  memory.begin() + static_cast<std::ptrdiff_t>(fresh));
    }
    more.insert(more.end(), memory.begin() + static_cast<std::ptrdiff_t>(fresh), memory.end());
    return more;
  };
  REQUIRE(restores(with(GroundConfig::kMostSurfaces - 1)));
  REQUIRE_FALSE(restores(with(GroundConfig::kMostSurfaces)));
}

TEST_CASE("whatever single number of a memory is changed, what is taken predicts numbers") {
  const std::vector<double> memory = memoryOf(experienced());
  std::mt19937_64 random(4);
  for (int i = 0; i < effort(3000); ++i) {
    std::vector<double> damaged = memory;
    constexpr double kValues[] = {0.0, 1.0, -1.0, 0.5, 3.0, 1e-300, 1e8, -1e8, 1e15, 1e300};
    damaged[random() % memory.size()] = kValues[random() % 10];
    Pupil pupil(ruleConfig("multi_model"), richSet());
    if (!pupil.rule().restore(TrajectoryTable(richSet().patterns()), damaged)) continue;
    driveOn(pupil, kMud, 3, random);
    for (size_t p = 0; p < pupil.patterns(); ++p) {
      REQUIRE(std::isfinite(pupil.end(p).x + pupil.end(p).y + pupil.end(p).yaw));
      const PoseCovariance covariance = *pupil.rule().endCovariance(p);
      for (const double number : covariance) REQUIRE(std::isfinite(number));
    }
  }
}

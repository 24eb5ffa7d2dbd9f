// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Missions with causes that only the test knows.
#include <catch2/catch.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/why/faulty_missions.hpp"
#include "tools/robot/why/debrief.hpp"

using namespace tread;
using namespace tread::testing;
using namespace tread::why;

namespace {

struct Score {
  int missions = 0;
  int right = 0;
  std::string wrong;
};

/// Debriefs the missions of some seeds.
Score scoreOf(uint64_t first, uint64_t count, bool tells) {
  Score score;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    const samples::OwnFolder folder;
    const FaultyMission mission = driveFaulty(seed, folder.path("drive.lcmlog"));
    const Debrief drive = debrief(readTimeline({folder.path("drive.lcmlog")}, kInsStep));
    for (const Finding& finding : drive.findings) REQUIRE_FALSE(finding.evidence.empty());
    const Finding* const worst = drive.worst();
    const bool right = worst != nullptr && mission.causes.count(worst->cause) > 0;
    ++score.missions;
    score.right += right ? 1 : 0;
    const std::string line = std::to_string(seed) + " " + mission.fault + ": " +
                             (worst == nullptr ? "nothing" : worst->cause + ": " + worst->sentence);
    if (!right) {
      score.wrong += line + "\n";
      if (tells) std::printf("WRONG %s\n%s\n", line.c_str(), textOf(drive, -1.0).c_str());
    } else if (tells) {
      std::printf("right %s\n", line.c_str());
    }
    std::fflush(stdout);
  }
  return score;
}

uint64_t numberFrom(const char* variable, uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace

TEST_CASE(
    "the cause of a faulty mission is found, of each kind one, and nothing is said without "
    "evidence") {
  // Seeds that were never used for tuning: the results are in RESULTS.md.
  const Score score = scoreOf(70'000, faultKinds(), false);
  CAPTURE(score.wrong);
  CHECK(score.right >= score.missions - 2);
}

TEST_CASE("figures of causes found in faulty missions", "[.figures]") {
  const Score score =
      scoreOf(numberFrom("TREAD_WHY_SEED", 1000), numberFrom("TREAD_WHY_COUNT", 40), true);
  std::printf("right: %d of %d\n", score.right, score.missions);
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The cases of a study.
#include <catch2/catch.hpp>

#include <map>
#include <set>

#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/suite.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::shortPlan;

namespace {

/// Cases of a suite by kind; nulls and singles by length and noise.
struct Counts {
  explicit Counts(const std::vector<CasePlan>& plans) {
    for (const CasePlan& plan : plans) {
      ++kinds[plan.kind];
      names.insert(plan.name);
      const std::string condition = (plan.minutes > 5.0 ? "long " : "short ") + plan.noise;
      if (plan.kind == CaseKind::kNull) ++nulls[condition];
      if (plan.kind == CaseKind::kSingle) singles[condition].insert(plan.effects.front());
      if (plan.kind == CaseKind::kSingle)
        different.insert(plan.effects.front() + std::to_string(plan.size) + condition);
    }
  }
  std::map<CaseKind, int> kinds;
  std::set<std::string> names;
  std::map<std::string, int> nulls;
  std::map<std::string, std::set<std::string>> singles;
  std::set<std::string> different;
};

}  // namespace

TEST_CASE("the full suite has every effect in all sizes and noises, short logs, and other kinds") {
  const auto plans = suiteOf("full", 10.0, 1);
  Counts counts(plans);
  CHECK(counts.names.size() == plans.size());
  CHECK(counts.different.size() == 38 * (9 + 2));
  for (const char* condition : {"long mid", "long high", "short mid", "short high"}) {
    CAPTURE(condition);
    CHECK(counts.nulls[condition] == 100);
    CHECK(counts.singles[condition].size() == 38);
  }
  CHECK(counts.kinds[CaseKind::kPair] == 200);
  CHECK(counts.kinds[CaseKind::kUnknown] >= 90);
  CHECK(counts.kinds[CaseKind::kDegenerate] >= 90);
  CHECK(counts.kinds[CaseKind::kBad] == 8 * static_cast<int>(defectNames().size()));
}

TEST_CASE("the medium suite has the same mix in a fifth of the cases") {
  const auto plans = suiteOf("medium", 10.0, 1);
  Counts counts(plans);
  CHECK(counts.names.size() == plans.size());
  CHECK(plans.size() == 253);
  CHECK(counts.singles["long mid"].size() == 38);
  CHECK(counts.singles["long high"].size() == 38);
  CHECK(counts.singles["short mid"].size() == 19);
  CHECK(counts.singles["short high"].size() == 19);
  CHECK(counts.kinds[CaseKind::kNull] == 60);
  CHECK(counts.nulls["short mid"] + counts.nulls["short high"] == 20);
  CHECK(counts.kinds[CaseKind::kPair] == 20);
  CHECK(counts.kinds[CaseKind::kUnknown] == 20);
  CHECK(counts.kinds[CaseKind::kDegenerate] == 8);
  CHECK(counts.kinds[CaseKind::kBad] == 18);
}

TEST_CASE("two hidden effects of a pair can be told apart and built together") {
  for (const CasePlan& plan : suiteOf("full", 10.0, 1)) {
    if (plan.kind != CaseKind::kPair) continue;
    REQUIRE(plan.effects.size() == 2);
    CHECK(plan.effects[0] != plan.effects[1]);
    for (const std::string& other : effectNamed(plan.effects[0]).group)
      CHECK(plan.effects[1] != other);
  }
}

TEST_CASE("names in a suite are mixed: neighbours are of different kinds") {
  const auto plans = suiteOf("full", 10.0, 1);
  int changes = 0;
  for (size_t i = 1; i < plans.size(); ++i) changes += plans[i].kind != plans[i - 1].kind ? 1 : 0;
  CHECK(changes > static_cast<int>(plans.size()) / 2);
}

TEST_CASE("every case of the small suite can be made") {
  for (const CasePlan& plan : suiteOf("small", 0.5, 2)) {
    CAPTURE(plan.name, plan.defect);
    CHECK_NOTHROW(makeCase(plan));
  }
}

TEST_CASE("groups that no drive tells apart are made with the right answers beside the truth") {
  for (const DegenerateGroup& group : degenerateGroups())
    for (const std::string& hidden : group.hidden) {
      CAPTURE(hidden);
      CasePlan plan = shortPlan({hidden});
      plan.minutes = 0.5;
      plan.kind = CaseKind::kDegenerate;
      plan.group = group.right;
      plan.choice = group.choice;
      const std::string truth = makeCase(plan).truth;
      for (const std::string& right : group.right)
        CHECK(truth.find("\"" + right + "\"") != std::string::npos);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <set>

#include "tests/study/score/scorer.hpp"

namespace tread::blindtest {
namespace {

/// Some of the single cases, with words for them.
struct Slice {
  std::string what;
  Test among;
};

/// Every figure of single effects of 4.7 and 3.5.
void addFigures(Scorer& scorer, const Slice& slice) {
  scorer.in("single: " + slice.what);
  const Test excited = both(slice.among, isExcited);
  for (const bool long_log : {true, false})
    for (const char* noise : {"low", "mid", "high"})
      scorer.share(
          std::string("named, ") + (long_log ? "10 min, " : "200 s, ") + noise + " noise, excited",
          both(excited, both(isLong(long_log), noiseIs(noise))), allFound);
  scorer.share("exactly the truth, 10 min, mid noise, excited",
               both(excited, both(isLong(true), noiseIs("mid"))), flag(&Judgement::exact));
  scorer.share("named, excited", excited, allFound);
  scorer.share("  of these on in the nominal model, and moved", excited, flag(&Judgement::moved));
  scorer.share("first name right, excited", excited, flag(&Judgement::first_right));
  scorer.share("named or beside a name, excited", excited, flag(&Judgement::listed));
  scorer.share("exactly right, excited", excited, flag(&Judgement::exact));
  scorer.share("nothing named, excited", excited, flag(&Judgement::nothing));
  scorer.share("only wrong names", slice.among, flag(&Judgement::only_wrong));
  scorer.figure("gap closed, median", slice.among, closedOf, 0.5);
  scorer.figure("gap closed, 10th percentile", slice.among, closedOf, 0.1);
  scorer.figure("gap closed by medians of the end errors instead of rms, median", slice.among,
                closedMediansOf, 0.5);
  scorer.figure("parameter error, median", slice.among, parameterErrorsOf, 0.5);
  scorer.figure("parameter error, 90th percentile", slice.among, parameterErrorsOf, 0.9);
  scorer.coverage("95 % intervals that hold the truth", slice.among);
}

Test isSingle(const std::string& name) {
  return [name](const JudgedCase& one) {
    return one.record.truth.kind == "single" && one.record.truth.effects.front().name == name;
  };
}

bool isHardlyThere(const JudgedCase& one) {
  return !one.judgement.excited;
}

void addByEffect(Scorer& scorer) {
  std::set<std::string> names, not_excited;
  for (const JudgedCase& one : scorer.cases()) {
    if (one.record.truth.kind != "single") continue;
    const std::string& name = one.record.truth.effects.front().name;
    names.insert(name);
    if (isHardlyThere(one)) not_excited.insert(name);
  }
  scorer.in("single by effect");
  for (const std::string& name : names) scorer.share(name, isSingle(name), allFound);
  scorer.in("not excited: changes the motion by less than 5 % of the noise");
  for (const std::string& name : not_excited) scorer.share(name, isSingle(name), isHardlyThere);
}

}  // namespace

void addSingles(Scorer& scorer) {
  const Test single = isKind("single");
  const std::vector<Slice> slices{
      {"all", single},
      {"vehicle", both(single, effectKindIs("vehicle"))},
      {"measurement", both(single, effectKindIs("measurement"))},
      {"form as in the catalogue", both(single, shapeIs("same"))},
      {"form only like the catalogue's", both(single, shapeIs("other"))},
      {"changed in the 1 kHz dynamics", both(single, formIs("physical"))},
      {"changed in the motion or what is said of it", both(single, formIs("kinematic"))}};
  for (const Slice& slice : slices) addFigures(scorer, slice);
  scorer.in("single by size and noise, 10 min");
  for (const double size : {1.0, 2.0, 4.0})
    for (const char* noise : {"low", "mid", "high"})
      scorer.share(
          "named, size " + std::to_string(static_cast<int>(size)) + ", " + noise +
              " noise, excited",
          both(both(both(single, isExcited), isLong(true)), both(sizeIs(size), noiseIs(noise))),
          allFound);
  addByEffect(scorer);
}

}  // namespace tread::blindtest

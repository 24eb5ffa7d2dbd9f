// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/scores.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/study/score/scorer.hpp"

namespace tread::blindtest {
namespace {

void addNullMusts(Scorer& scorer) {
  const Test null = isKind("null");
  scorer.share("false positives: an effect named in a null log", null, flag(&Judgement::alarm),
               Must{0.05, false, {}, 0.08, 400});
  scorer.share(
      "false positives: an effect named, all start values wrong", isKind("wrong_start"),
      [](const JudgedCase& one) { return !one.record.answer.effects.empty(); },
      Must{0.03, false, {}, {}, 400});
  scorer.share("  CANNOT_TELL or an error there", isKind("wrong_start"), flag(&Judgement::refused));
  scorer.share("  any verdict but NO_DISCREPANCY in a null log", null,
               [](const JudgedCase& one) { return one.record.answer.verdict != "NO_DISCREPANCY"; });
}

void addNameMusts(Scorer& scorer) {
  const Test excited = both(isKind("single"), isExcited);
  const auto of = [&](bool long_log, const char* noise) {
    return both(excited, both(isLong(long_log), noiseIs(noise)));
  };
  scorer.share("truth named, single, 10 min, mid noise, excited", of(true, "mid"), allFound,
               Must{0.95});
  scorer.share("truth named, single, 10 min, high noise, excited", of(true, "high"), allFound,
               Must{0.90});
  scorer.share("truth named, single, 200 s, mid noise, excited", of(false, "mid"), allFound,
               Must{0.88});
  scorer.share("truth named, single, 200 s, high noise, excited", of(false, "high"), allFound,
               Must{0.70});
  scorer.share("exactly the truth, single, 10 min, mid noise, excited", of(true, "mid"),
               flag(&Judgement::exact), Must{0.90});
  scorer.share("only wrong names, single", isKind("single"), flag(&Judgement::only_wrong),
               Must{0.03, false});
  scorer.share("both of two named, 10 min, mid noise", both(isKind("pair"), noiseIs("mid")),
               allFound, Must{0.80});
}

void addNumberMusts(Scorer& scorer) {
  const Test named = [](const JudgedCase& one) {
    return one.record.truth.kind == "single" || one.record.truth.kind == "pair";
  };
  scorer.figure("gap closed against the oracle when named, median", named, closedOf, 0.5,
                Must{0.97});
  scorer.figure("gap closed against the oracle when named, 10th percentile", named, closedOf, 0.1,
                Must{0.90});
  scorer.figure("parameter error, median", named, parameterErrorsOf, 0.5, Must{0.05, false});
  scorer.figure("parameter error, 90th percentile", named, parameterErrorsOf, 0.9,
                Must{0.20, false});
  scorer.coverage("95 % intervals that hold the truth", named, Must{0.90, true, 0.98});
}

std::vector<double> secondsOf(const JudgedCase& one) {
  if (!std::isfinite(one.seconds)) return {};
  return {one.seconds};
}

/// Some of the single cases, with a description.
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

void addNulls(Scorer& scorer) {
  scorer.in("null");
  for (const bool long_log : {true, false})
    for (const char* noise : {"low", "mid", "high"}) {
      const Test among = both(isKind("null"), both(isLong(long_log), noiseIs(noise)));
      const std::string what =
          std::string(", ") + (long_log ? "10 min, " : "200 s, ") + noise + " noise";
      scorer.share("an effect is named" + what, among, flag(&Judgement::alarm));
      scorer.share("only the adequacy test speaks" + what, among, verdictIs("NOT_IN_CATALOGUE"));
      scorer.share("CANNOT_TELL or an error" + what, among, flag(&Judgement::refused));
    }
}

void addPairsAndUnknown(Scorer& scorer) {
  const Test pair = isKind("pair");
  scorer.in("pairs");
  scorer.share("both named", pair, allFound);
  scorer.share("both named, excited", both(pair, isExcited), allFound);
  scorer.share("one named", pair, [](const JudgedCase& one) { return one.judgement.found == 1; });
  scorer.share("exactly right", pair, flag(&Judgement::exact));
  scorer.share("only wrong names", pair, flag(&Judgement::only_wrong));
  const Test unknown = isKind("out_of_catalogue");
  scorer.in("out of catalogue");
  scorer.share("PARTIAL or NOT_IN_CATALOGUE", unknown, flag(&Judgement::flagged));
  scorer.share("  with the right variable", unknown, flag(&Judgement::right_variable));
  scorer.share("a substitute is named", unknown,
               [](const JudgedCase& one) { return !one.record.answer.effects.empty(); });
  scorer.share("NO_DISCREPANCY", unknown, verdictIs("NO_DISCREPANCY"));
}

/// Whether the motor currents classify a named effect as load, or not.
bool isCalled(const JudgedCase& one, bool load) {
  const std::vector<NamedEffect>& named = one.record.answer.effects;
  return std::any_of(named.begin(), named.end(),
                     [load](const NamedEffect& effect) { return effect.load == load; });
}

/// Results of the motor currents for single effects of the drive or the ground with a named effect.
void addCurrents(Scorer& scorer) {
  scorer.in("motor currents");
  for (const bool load : {false, true}) {
    const std::string place = load ? "ground" : "drive";
    const Test among = [place](const JudgedCase& one) {
      return one.record.truth.kind == "single" && !one.record.answer.effects.empty() &&
             one.record.truth.effects.front().place == place;
    };
    const Test right = [load](const JudgedCase& one) {
      return isCalled(one, load) && !isCalled(one, !load);
    };
    const Test wrong = [load](const JudgedCase& one) { return isCalled(one, !load); };
    const Test silent = [right, wrong](const JudgedCase& one) {
      return !right(one) && !wrong(one);
    };
    scorer.share(place + ": right", among, right);
    scorer.share(place + ": wrong", among, wrong);
    scorer.share(place + ": nothing said", among, silent);
  }
}

void addDegenerate(Scorer& scorer) {
  const Test all = isKind("degenerate");
  const Test exact = both(all, fullProgramme);
  const Test poor = both(all, [](const JudgedCase& one) { return !fullProgramme(one); });
  scorer.in("degenerate");
  scorer.share("exact groups: AMBIGUOUS", exact, verdictIs("AMBIGUOUS"));
  scorer.share("exact groups: named as a group", exact, flag(&Judgement::grouped));
  scorer.share("poor drives: AMBIGUOUS", poor, verdictIs("AMBIGUOUS"));
  scorer.share("poor drives: named as a group", poor, flag(&Judgement::grouped));
  scorer.share("poor drives: named", poor, allFound);
}

void addSemi(Scorer& scorer) {
  const Test semi = isKind("semi");
  scorer.in("in recordings");
  scorer.share("first name right", semi, flag(&Judgement::first_right));
  scorer.share("named", semi, allFound);
  scorer.share("  of these on in the nominal model, and moved", semi, flag(&Judgement::moved));
  scorer.share("named or beside a name", semi, flag(&Judgement::listed));
  scorer.share("nothing named", semi, flag(&Judgement::nothing));
  scorer.share("only wrong names", semi, flag(&Judgement::only_wrong));
  scorer.figure("parameter error, median", semi, parameterErrorsOf, 0.5);
  scorer.coverage("95 % intervals that hold the truth", semi);
  std::set<std::string> names;
  for (const JudgedCase& one : scorer.cases())
    if (semi(one)) names.insert(one.record.truth.effects.front().name);
  for (const std::string& name : names)
    scorer.share(
        "first name right: " + name,
        [&](const JudgedCase& one) {
          return semi(one) && one.record.truth.effects.front().name == name;
        },
        flag(&Judgement::first_right));
}

void addBadLogs(Scorer& scorer) {
  std::set<std::string> defects;
  for (const JudgedCase& one : scorer.cases())
    if (!one.record.truth.defect.empty()) defects.insert(one.record.truth.defect);
  scorer.in("bad logs");
  for (const std::string& defect : defects)
    scorer.share(
        defect + ": refused with a reason",
        [&](const JudgedCase& one) { return one.record.truth.defect == defect; },
        flag(&Judgement::refused));
}

void addVerdicts(Scorer& scorer) {
  scorer.in("right verdict");
  for (const char* kind :
       {"null", "single", "pair", "out_of_catalogue", "degenerate", "bad", "semi"})
    scorer.share(kind, isKind(kind), flag(&Judgement::right_verdict));
}

}  // namespace

void addMusts(Scorer& scorer) {
  scorer.in("must");
  addNullMusts(scorer);
  addNameMusts(scorer);
  addNumberMusts(scorer);
  scorer.share("out of catalogue: PARTIAL or NOT_IN_CATALOGUE with the right variable",
               isKind("out_of_catalogue"), flag(&Judgement::right_variable), Must{0.80});
  scorer.share("exact degenerate groups named as such", both(isKind("degenerate"), fullProgramme),
               flag(&Judgement::grouped), Must{1.0});
  scorer.share("in recordings: first name right", isKind("semi"), flag(&Judgement::first_right),
               Must{0.85});
  scorer.figure("CPU time of the answer to a 10 min log, with report, median", isLong(true),
                secondsOf, 0.5, Must{30.0, false}, "s");
  scorer.share("bad logs refused with a reason", isKind("bad"), flag(&Judgement::refused),
               Must{1.0});
}

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

std::vector<ScoreLine> scoresOf(const std::vector<JudgedCase>& cases) {
  Scorer scorer(cases);
  addMusts(scorer);
  addNulls(scorer);
  addSingles(scorer);
  addPairsAndUnknown(scorer);
  addCurrents(scorer);
  addDegenerate(scorer);
  addSemi(scorer);
  addBadLogs(scorer);
  addVerdicts(scorer);
  return scorer.take();
}

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/scores.hpp"

#include <set>

#include "tests/study/score/scorer.hpp"

namespace tread::blindtest {
namespace {

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

std::vector<ScoreLine> scoresOf(const std::vector<JudgedCase>& cases) {
  Scorer scorer(cases);
  addMusts(scorer);
  addNulls(scorer);
  addSingles(scorer);
  addPairsAndUnknown(scorer);
  addDegenerate(scorer);
  addSemi(scorer);
  addBadLogs(scorer);
  addVerdicts(scorer);
  return scorer.take();
}

}  // namespace tread::blindtest

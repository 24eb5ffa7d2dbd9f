// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "tests/study/score/scorer.hpp"

namespace tread::blindtest {
namespace {

void addNulls(Scorer& scorer) {
  const Test null = isKind("null");
  scorer.share("false positives: an effect named in a null log", null, flag(&Judgement::alarm),
               Must{0.05, false, {}, 0.08, 400});
  scorer.share("  any verdict but NO_DISCREPANCY in a null log", null,
               [](const JudgedCase& one) { return one.record.answer.verdict != "NO_DISCREPANCY"; });
}

void addNames(Scorer& scorer) {
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

void addNumbers(Scorer& scorer) {
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

}  // namespace

void addMusts(Scorer& scorer) {
  scorer.in("must");
  addNulls(scorer);
  addNames(scorer);
  addNumbers(scorer);
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

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/blind/scores.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace tread::blindtest {
namespace {

using Test = std::function<bool(const JudgedCase&)>;
using Numbers = std::function<std::vector<double>(const JudgedCase&)>;

Test isKind(const std::string& kind) {
  return [kind](const JudgedCase& one) { return one.record.truth.kind == kind; };
}

Test both(Test a, Test b) {
  return [a = std::move(a), b = std::move(b)](const JudgedCase& one) { return a(one) && b(one); };
}

Test noiseIs(const std::string& noise) {
  return [noise](const JudgedCase& one) { return one.record.truth.noise == noise; };
}

Test sizeIs(double size) {
  return [size](const JudgedCase& one) { return one.record.truth.size == size; };
}

bool isExcited(const JudgedCase& one) {
  return one.judgement.excited;
}

bool allFound(const JudgedCase& one) {
  return !one.record.truth.effects.empty() &&
         one.judgement.found == one.record.truth.effects.size();
}

Test shapeIs(const std::string& shape) {
  return [shape](const JudgedCase& one) {
    const auto& effects = one.record.truth.effects;
    return !effects.empty() && effects.front().shape == shape;
  };
}

Test verdictIs(const std::string& verdict) {
  return [verdict](const JudgedCase& one) { return one.record.answer.verdict == verdict; };
}

template <typename Value>
Test flag(Value Judgement::*member) {
  return [member](const JudgedCase& one) { return static_cast<bool>(one.judgement.*member); };
}

/// A log of ten minutes, or the short one of 200 s.
Test minutesAre(bool long_log) {
  constexpr double kShort = 5.0;
  return
      [long_log](const JudgedCase& one) { return (one.record.truth.minutes > kShort) == long_log; };
}

std::vector<double> closedOf(const JudgedCase& one) {
  if (!std::isfinite(one.judgement.closed) || !allFound(one)) return {};
  return {one.judgement.closed};
}

std::vector<double> closedMediansOf(const JudgedCase& one) {
  if (!std::isfinite(one.judgement.closed_median) || !allFound(one)) return {};
  return {one.judgement.closed_median};
}

std::vector<double> errorsOf(const JudgedCase& one) {
  std::vector<double> errors;
  for (const ParameterError& error : one.judgement.parameters) errors.push_back(error.relative);
  return errors;
}

/// Collects lines out of the cases.
class Scorer {
 public:
  explicit Scorer(const std::vector<JudgedCase>& cases) : cases_(cases) {}

  std::vector<ScoreLine> all() {
    musts();
    nulls();
    singles();
    byEffect();
    pairsAndUnknown();
    degenerate();
    badLogs();
    numbers();
    verdicts();
    return std::move(lines_);
  }

 private:
  void share(const std::string& section, const std::string& what, const Test& among,
             const Test& hit, std::optional<Must> must = {}) {
    ScoreLine line{section, what};
    line.must = must;
    for (const JudgedCase& one : cases_) {
      if (!among(one)) continue;
      ++line.cases;
      line.hits += hit(one);
    }
    setShare(line);
    if (line.cases > 0 || must) lines_.push_back(line);
  }

  void figure(const std::string& section, const std::string& what, const Test& among,
              const Numbers& numbers, double q, std::optional<Must> must = {}) {
    std::vector<double> values;
    for (const JudgedCase& one : cases_) {
      if (!among(one)) continue;
      const std::vector<double> more = numbers(one);
      values.insert(values.end(), more.begin(), more.end());
    }
    ScoreLine line{section, what, false};
    line.must = must;
    line.cases = values.size();
    line.value = quantile(values, q);
    if (line.cases > 0 || must) lines_.push_back(line);
  }

  /// Shares of parameters, not of cases.
  void coverage(const std::string& section, const std::string& what, const std::string& shape,
                std::optional<Must> must = {}) {
    ScoreLine line{section, what};
    line.must = must;
    for (const JudgedCase& one : cases_)
      for (const ParameterError& error : one.judgement.parameters) {
        if (!shape.empty() && error.shape != shape) continue;
        ++line.cases;
        line.hits += error.inside;
      }
    setShare(line);
    if (line.cases > 0 || must) lines_.push_back(line);
  }

  void musts() {
    const std::string at = "must";
    const Test single = isKind("single"), excited = both(single, isExcited);
    const Test mid = both(minutesAre(true), noiseIs("mid"));
    const Test high = both(minutesAre(true), noiseIs("high"));
    const Test alarm = [](const JudgedCase& one) {
      return one.record.answer.verdict != "NO_DISCREPANCY";
    };
    share(at, "false positives on null logs", isKind("null"), alarm, Must{0.05, false, {}, 0.08});
    share(at, "truth named, single, mid noise, excited", both(excited, mid), allFound, Must{0.95});
    share(at, "truth named, single, high noise, excited", both(excited, high), allFound,
          Must{0.90});
    share(at, "truth named, 200 s log, mid noise",
          both(single, both(minutesAre(false), noiseIs("mid"))), allFound, Must{0.88});
    share(at, "truth named, 200 s log, high noise",
          both(single, both(minutesAre(false), noiseIs("high"))), allFound, Must{0.70});
    share(at, "exactly the truth, single, mid noise", both(excited, mid), flag(&Judgement::exact),
          Must{0.90});
    share(at, "only wrong names, single", single, flag(&Judgement::only_wrong), Must{0.03, false});
    share(at, "both of two named, mid noise", both(isKind("pair"), mid), allFound, Must{0.80});
    const Test named = [](const JudgedCase& one) {
      return one.record.truth.kind == "single" || one.record.truth.kind == "pair";
    };
    figure(at, "gap closed against the oracle, median", named, closedOf, 0.5, Must{0.97});
    figure(at, "gap closed against the oracle, 10th percentile", named, closedOf, 0.1, Must{0.90});
    figure(at, "parameter error, median", named, errorsOf, 0.5, Must{0.05, false});
    figure(at, "parameter error, 90th percentile", named, errorsOf, 0.9, Must{0.20, false});
    coverage(at, "95 % intervals that hold the truth", "", Must{0.90, true, 0.98});
    share(at, "out of catalogue: PARTIAL or NOT_IN_CATALOGUE with the right variable",
          isKind("out_of_catalogue"), flag(&Judgement::right_variable), Must{0.80});
    share(at, "exact degenerate groups named as such", both(isKind("degenerate"), fullProgramme),
          flag(&Judgement::grouped), Must{1.0});
    share(at, "bad logs refused with a reason", isKind("bad"), flag(&Judgement::refused),
          Must{1.0});
  }

  static bool fullProgramme(const JudgedCase& one) { return one.record.truth.programme == "full"; }

  void nulls() {
    for (const char* noise : {"low", "mid", "high"}) {
      const Test among = both(isKind("null"), noiseIs(noise));
      const std::string what = std::string(", ") + noise + " noise";
      share("null", "an effect is named" + what, among,
            [](const JudgedCase& one) { return !one.record.answer.effects.empty(); });
      share("null", "only the adequacy test speaks" + what, among, [](const JudgedCase& one) {
        return one.record.answer.effects.empty() && !one.record.answer.unexplained.empty();
      });
      share("null", "CANNOT_TELL or an error" + what, among, flag(&Judgement::refused));
    }
  }

  void singleLines(const std::string& what, const Test& among) {
    const std::string at = "single";
    share(at, "named, " + what, among, allFound);
    share(at, "  of these on in the nominal model, moved by 3 sigma, " + what, among,
          flag(&Judgement::moved));
    share(at, "first name right, " + what, among, flag(&Judgement::first_right));
    share(at, "named or runner-up, " + what, among, flag(&Judgement::listed));
    share(at, "exactly right, " + what, among, flag(&Judgement::exact));
    share(at, "only wrong names, " + what, among, flag(&Judgement::only_wrong));
    share(at, "nothing named, " + what, among, flag(&Judgement::nothing));
  }

  void singles() {
    const Test single = isKind("single");
    share("single", "not excited (below 5 % of the noise)", single,
          [](const JudgedCase& one) { return !one.judgement.excited; });
    singleLines("all", single);
    for (const char* noise : {"low", "mid", "high"})
      singleLines(std::string(noise) + " noise", both(single, noiseIs(noise)));
    for (const char* shape : {"same", "other"})
      singleLines(std::string("form ") +
                      (shape[0] == 's' ? "as in the catalogue" : "only like the catalogue's"),
                  both(single, shapeIs(shape)));
    for (const double size : {1.0, 2.0, 4.0})
      singleLines("size " + std::to_string(static_cast<int>(size)), both(single, sizeIs(size)));
    for (const double size : {1.0, 2.0, 4.0}) {
      const std::string what = "size " + std::to_string(static_cast<int>(size));
      for (const char* noise : {"low", "mid", "high"})
        share("single by size and noise", "named, " + what + ", " + noise + " noise",
              both(both(single, sizeIs(size)), noiseIs(noise)), allFound);
    }
  }

  void byEffect() {
    std::set<std::string> names;
    for (const JudgedCase& one : cases_)
      if (one.record.truth.kind == "single") names.insert(one.record.truth.effects.front().name);
    for (const std::string& name : names)
      share(
          "single by effect", name,
          [&](const JudgedCase& one) {
            return one.record.truth.kind == "single" &&
                   one.record.truth.effects.front().name == name;
          },
          allFound);
  }

  void pairsAndUnknown() {
    const Test pair = isKind("pair");
    share("pairs", "both named", pair, allFound);
    share("pairs", "one named", pair,
          [](const JudgedCase& one) { return one.judgement.found == 1; });
    share("pairs", "exactly right", pair, flag(&Judgement::exact));
    share("pairs", "only wrong names", pair, flag(&Judgement::only_wrong));
    const Test unknown = isKind("out_of_catalogue");
    share("out of catalogue", "PARTIAL or NOT_IN_CATALOGUE", unknown, flag(&Judgement::flagged));
    share("out of catalogue", "  with the right variable", unknown,
          flag(&Judgement::right_variable));
    share("out of catalogue", "a substitute is named", unknown,
          [](const JudgedCase& one) { return !one.record.answer.effects.empty(); });
    share("out of catalogue", "NO_DISCREPANCY", unknown, verdictIs("NO_DISCREPANCY"));
  }

  void degenerate() {
    const Test all = isKind("degenerate");
    const Test poor = both(all, [](const JudgedCase& one) { return !fullProgramme(one); });
    const std::string at = "degenerate";
    share(at, "exact groups: AMBIGUOUS", both(all, fullProgramme), verdictIs("AMBIGUOUS"));
    share(at, "exact groups: named as a group", both(all, fullProgramme),
          flag(&Judgement::grouped));
    share(at, "poor drives: AMBIGUOUS", poor, verdictIs("AMBIGUOUS"));
    share(at, "poor drives: named as a group", poor, flag(&Judgement::grouped));
    share(at, "poor drives: named", poor, allFound);
  }

  void badLogs() {
    std::set<std::string> defects;
    for (const JudgedCase& one : cases_)
      if (!one.record.truth.defect.empty()) defects.insert(one.record.truth.defect);
    for (const std::string& defect : defects)
      share(
          "bad logs", defect + ": refused with a reason",
          [&](const JudgedCase& one) { return one.record.truth.defect == defect; },
          flag(&Judgement::refused));
  }

  void numbers() {
    const Test single = isKind("single");
    figure("gap closed", "by medians of the end errors instead of rms, median", single,
           closedMediansOf, 0.5);
    for (const char* noise : {"low", "mid", "high"})
      for (const double q : {0.5, 0.1})
        figure("gap closed",
               std::string(q > 0.3 ? "median, " : "10th percentile, ") + noise + " noise",
               both(single, noiseIs(noise)), closedOf, q);
    for (const char* shape : {"same", "other"}) {
      const std::string form =
          shape[0] == 's' ? "form as in the catalogue" : "form only like the catalogue's";
      const Numbers errors = [shape](const JudgedCase& one) {
        std::vector<double> values;
        for (const ParameterError& error : one.judgement.parameters)
          if (error.shape == shape) values.push_back(error.relative);
        return values;
      };
      const Test any = [](const JudgedCase&) { return true; };
      figure("parameters", "error, median, " + form, any, errors, 0.5);
      figure("parameters", "error, 90th percentile, " + form, any, errors, 0.9);
      coverage("parameters", "95 % intervals that hold the truth, " + form, shape);
    }
  }

  void verdicts() {
    for (const char* kind :
         {"null", "single", "pair", "out_of_catalogue", "degenerate", "bad", "semi"})
      share("right verdict", kind, isKind(kind), flag(&Judgement::right_verdict));
  }

  const std::vector<JudgedCase>& cases_;
  std::vector<ScoreLine> lines_;
};

}  // namespace

std::vector<ScoreLine> scoresOf(const std::vector<JudgedCase>& cases) {
  return Scorer(cases).all();
}

}  // namespace tread::blindtest

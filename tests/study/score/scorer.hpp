// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/scores.hpp"

namespace tread::blindtest {

/// A selection of cases, or a property that is counted.
using Test = std::function<bool(const JudgedCase&)>;
/// The values of a case for a quantile.
using Numbers = std::function<std::vector<double>(const JudgedCase&)>;

Test isKind(const std::string& kind);
Test both(Test a, Test b);
Test noiseIs(const std::string& noise);
Test sizeIs(double size);
Test verdictIs(const std::string& verdict);
/// A log of ten minutes, or a short one of 200 s.
Test isLong(bool long_log);
/// Kind of the first hidden effect: vehicle, measurement.
Test effectKindIs(const std::string& kind);
/// Its shape: "same" as the catalogue's equation, or "other".
Test shapeIs(const std::string& shape);
/// Its form: changed in the 1 kHz dynamics ("physical") or in the resulting motion.
Test formIs(const std::string& form);

bool anyCase(const JudgedCase& one);
bool isExcited(const JudgedCase& one);
bool allFound(const JudgedCase& one);
bool fullProgramme(const JudgedCase& one);

template <typename Value>
Test flag(Value Judgement::*member) {
  return [member](const JudgedCase& one) { return static_cast<bool>(one.judgement.*member); };
}

std::vector<double> closedOf(const JudgedCase& one);         ///< if everything was found
std::vector<double> closedMediansOf(const JudgedCase& one);  ///< the same by medians
std::vector<double> parameterErrorsOf(const JudgedCase& one);

/// Makes lines from the cases. A line without a target and without cases is omitted.
class Scorer {
 public:
  explicit Scorer(const std::vector<JudgedCase>& cases) : cases_(cases) {}

  /// Begins a section.
  Scorer& in(const std::string& section) { return section_ = section, *this; }
  /// Share of the cases among some for which a test holds.
  void share(const std::string& what, const Test& among, const Test& hit,
             std::optional<Must> must = {});
  /// A quantile of the cases' values.
  void figure(const std::string& what, const Test& among, const Numbers& numbers, double q,
              std::optional<Must> must = {}, const char* unit = "%");
  /// Share of the parameters' intervals that contain the truth.
  void coverage(const std::string& what, const Test& among, std::optional<Must> must = {});
  void add(const ScoreLine& line);

  const std::vector<JudgedCase>& cases() const { return cases_; }
  std::vector<ScoreLine> take() { return std::move(lines_); }

 private:
  const std::vector<JudgedCase>& cases_;
  std::string section_;
  std::vector<ScoreLine> lines_;
};

/// The figures with a target.
void addMusts(Scorer& scorer);
/// All figures of single effects, for both kinds and by agreement with the catalogue's form.
void addSingles(Scorer& scorer);

}  // namespace tread::blindtest

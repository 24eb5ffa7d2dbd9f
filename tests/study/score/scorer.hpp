// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/scores.hpp"

namespace tread::blindtest {

/// Which cases are meant, or what is counted of them.
using Test = std::function<bool(const JudgedCase&)>;
/// What a case adds to a quantile's values.
using Numbers = std::function<std::vector<double>(const JudgedCase&)>;

Test isKind(const std::string& kind);
Test both(Test a, Test b);
Test noiseIs(const std::string& noise);
Test sizeIs(double size);
Test verdictIs(const std::string& verdict);
/// A log of ten minutes, or the short one of 200 s.
Test isLong(bool long_log);
/// Of the first hidden effect: vehicle, measurement.
Test effectKindIs(const std::string& kind);
/// The same: as the catalogue's equation ("same") or only like it ("other").
Test shapeIs(const std::string& shape);
/// The same: changed in the 1 kHz dynamics ("physical") or in the motion that comes out of them.
Test formIs(const std::string& form);

bool anyCase(const JudgedCase& one);
bool isExcited(const JudgedCase& one);
bool allFound(const JudgedCase& one);
bool fullProgramme(const JudgedCase& one);

template <typename Value>
Test flag(Value Judgement::*member) {
  return [member](const JudgedCase& one) { return static_cast<bool>(one.judgement.*member); };
}

std::vector<double> closedOf(const JudgedCase& one);         ///< if all was found
std::vector<double> closedMediansOf(const JudgedCase& one);  ///< the same by medians
std::vector<double> parameterErrorsOf(const JudgedCase& one);

/// Makes lines out of the cases. A line without a must is left out where it has no case.
class Scorer {
 public:
  explicit Scorer(const std::vector<JudgedCase>& cases) : cases_(cases) {}

  /// Begins a section.
  Scorer& in(const std::string& section) { return section_ = section, *this; }
  /// The share of the cases among some of which something holds.
  void share(const std::string& what, const Test& among, const Test& hit,
             std::optional<Must> must = {});
  /// A quantile of numbers of cases.
  void figure(const std::string& what, const Test& among, const Numbers& numbers, double q,
              std::optional<Must> must = {}, const char* unit = "%");
  /// The share of the intervals of parameters that hold the truth.
  void coverage(const std::string& what, const Test& among, std::optional<Must> must = {});
  void add(const ScoreLine& line);

  const std::vector<JudgedCase>& cases() const { return cases_; }
  std::vector<ScoreLine> take() { return std::move(lines_); }

 private:
  const std::vector<JudgedCase>& cases_;
  std::string section_;
  std::vector<ScoreLine> lines_;
};

/// The figures that have a target.
void addMusts(Scorer& scorer);
/// All figures of single effects, for both kinds and by how the forms fit the catalogue's.
void addSingles(Scorer& scorer);

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/scorer.hpp"

#include <algorithm>
#include <cmath>

namespace tread::blindtest {
namespace {

/// Whether something holds of the first hidden effect.
Test ofFirst(std::function<bool(const HiddenEffect&)> test) {
  return [test = std::move(test)](const JudgedCase& one) {
    const auto& effects = one.record.truth.effects;
    return !effects.empty() && test(effects.front());
  };
}

}  // namespace

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

Test verdictIs(const std::string& verdict) {
  return [verdict](const JudgedCase& one) { return one.record.answer.verdict == verdict; };
}

Test isLong(bool long_log) {
  constexpr double kShort = 5.0;  // [min]
  return
      [long_log](const JudgedCase& one) { return (one.record.truth.minutes > kShort) == long_log; };
}

Test effectKindIs(const std::string& kind) {
  return ofFirst([kind](const HiddenEffect& effect) { return effect.kind == kind; });
}

Test shapeIs(const std::string& shape) {
  return ofFirst([shape](const HiddenEffect& effect) { return effect.shape == shape; });
}

Test formIs(const std::string& form) {
  return ofFirst([form](const HiddenEffect& effect) { return effect.form == form; });
}

bool anyCase(const JudgedCase&) {
  return true;
}

bool isExcited(const JudgedCase& one) {
  return one.judgement.excited;
}

bool allFound(const JudgedCase& one) {
  return !one.record.truth.effects.empty() &&
         one.judgement.found == one.record.truth.effects.size();
}

bool fullProgramme(const JudgedCase& one) {
  return one.record.truth.programme == "full";
}

std::vector<double> closedOf(const JudgedCase& one) {
  if (!std::isfinite(one.judgement.closed) || !allFound(one)) return {};
  return {one.judgement.closed};
}

std::vector<double> closedMediansOf(const JudgedCase& one) {
  if (!std::isfinite(one.judgement.closed_median) || !allFound(one)) return {};
  return {one.judgement.closed_median};
}

std::vector<double> parameterErrorsOf(const JudgedCase& one) {
  std::vector<double> errors;
  for (const ParameterError& error : one.judgement.parameters) errors.push_back(error.relative);
  return errors;
}

void Scorer::share(const std::string& what, const Test& among, const Test& hit,
                   std::optional<Must> must) {
  ScoreLine line{section_, what};
  line.must = must;
  for (const JudgedCase& one : cases_) {
    if (!among(one)) continue;
    ++line.cases;
    line.hits += hit(one);
  }
  setShare(line);
  add(line);
}

void Scorer::figure(const std::string& what, const Test& among, const Numbers& numbers, double q,
                    std::optional<Must> must, const char* unit) {
  std::vector<double> values;
  for (const JudgedCase& one : cases_) {
    if (!among(one)) continue;
    const std::vector<double> more = numbers(one);
    values.insert(values.end(), more.begin(), more.end());
  }
  ScoreLine line{section_, what};
  line.must = must;
  line.unit = unit;
  setQuantile(line, std::move(values), q);
  add(line);
}

void Scorer::coverage(const std::string& what, const Test& among, std::optional<Must> must) {
  ScoreLine line{section_, what};
  line.must = must;
  for (const JudgedCase& one : cases_) {
    if (!among(one)) continue;
    for (const ParameterError& error : one.judgement.parameters) {
      ++line.cases;
      line.hits += error.inside;
    }
  }
  setShare(line);
  add(line);
}

void Scorer::add(const ScoreLine& line) {
  if (line.cases == 0 && !line.must) return;
  lines_.push_back(line);
  lines_.back().section = section_;
}

}  // namespace tread::blindtest

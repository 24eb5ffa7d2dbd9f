// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/scorer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::blindtest {
namespace {

/// Probability of at most `count` hits in n trials of probability p.
double binomialUpTo(size_t count, size_t n, double p) {
  double sum = 0.0;
  for (size_t k = 0; k <= count; ++k)
    sum += std::exp(
        std::lgamma(static_cast<double>(n) + 1.0) - std::lgamma(static_cast<double>(k) + 1.0) -
        std::lgamma(static_cast<double>(n - k) + 1.0) + static_cast<double>(k) * std::log(p) +
        static_cast<double>(n - k) * std::log1p(-p));
  return sum;
}

/// Tests the first hidden effect.
Test ofFirst(std::function<bool(const HiddenEffect&)> test) {
  return [test = std::move(test)](const JudgedCase& one) {
    const auto& effects = one.record.truth.effects;
    return !effects.empty() && test(effects.front());
  };
}

}  // namespace

bool ScoreLine::valueIsGood() const {
  if (!must || cases == 0) return false;
  const bool good = must->least ? value >= must->at : value <= must->at;
  return good && (!must->below || value <= *must->below);
}

std::optional<Met> ScoreLine::met() const {
  if (!must || cases == 0) return std::nullopt;
  // No number of cases proves that something never happens.
  const bool absolute = must->least ? must->at >= 1.0 && is_share : must->at <= 0.0;
  if (absolute || !(low <= high)) return valueIsGood() ? Met::kYes : Met::kNo;
  if (must->upper_end) {
    if (value <= must->at && high <= *must->upper_end && cases >= must->cases) return Met::kYes;
    return low > must->at ? Met::kNo : Met::kOpen;
  }
  const double best = must->least ? low : high;
  const double worst = must->least ? high : low;
  const auto good = [&](double share) {
    return must->least ? share >= must->at : share <= must->at;
  };
  if (must->below && low > *must->below) return Met::kNo;
  if (!good(worst)) return Met::kNo;
  return good(best) && (!must->below || high <= *must->below) ? Met::kYes : Met::kOpen;
}

void setShare(ScoreLine& line) {
  if (line.cases == 0) return;
  constexpr double z = 1.959963985;
  const auto n = static_cast<double>(line.cases);
  const double p = static_cast<double>(line.hits) / n;
  const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / (1.0 + z * z / n);
  line.value = p;
  line.low = std::max(0.0, centre - half);
  line.high = std::min(1.0, centre + half);
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return kUnknown;
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

void setQuantile(ScoreLine& line, std::vector<double> values, double q) {
  line.is_share = false;
  line.cases = values.size();
  line.value = quantile(values, q);
  if (values.empty()) return;
  constexpr double kTail = 0.025;
  std::sort(values.begin(), values.end());
  // The probability that the quantile is below the k-th smallest value is that of fewer than k
  // values below it.
  const size_t n = values.size();
  size_t low = 0;
  while (low < n && binomialUpTo(low, n, q) <= kTail) ++low;
  size_t high = 0;
  while (high < n && binomialUpTo(high, n, q) < 1.0 - kTail) ++high;
  // Too few values leave an end open.
  line.low = low > 0 ? values[low - 1] : -std::numeric_limits<double>::infinity();
  line.high = high < n ? values[high] : std::numeric_limits<double>::infinity();
}

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

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/formula.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <stdexcept>
#include <utility>

#include <muParser.h>

#include "common/vehicle/model.hpp"

namespace tread {

struct Formula::Compiled {
  mu::Parser parser;
  std::vector<double> values;
};

namespace {

constexpr size_t kLongestFormula = 1000;  // characters

double smoothSign(double value) {
  return std::tanh(value / kSignWidth);
}

/// curve(x, a, f(a), b, f(b), ..): linear in between, constant outside; a, b, .. ascending.
double curve(const double* arguments, int count) {
  if (count < 5 || count % 2 == 0)
    throw mu::ParserError("curve() takes a value and pairs of numbers, two or more");
  for (int i = 3; i < count; i += 2)
    if (!(arguments[i - 2] < arguments[i]))
      throw mu::ParserError("the places of curve() must be ascending");
  int upper = 3;
  while (upper + 2 < count && arguments[0] >= arguments[upper]) upper += 2;
  const double* at = arguments + upper - 2;
  const double share = std::clamp((arguments[0] - at[0]) / (at[2] - at[0]), 0.0, 1.0);
  return at[1] + share * (at[3] - at[1]);
}

/// Whether it contains an assignment, which muParser would apply to the inputs.
bool assigns(const std::string& text) {
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) return true;
  }
  return false;
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string problemWords(const mu::ParserError& problem, const std::vector<std::string>& names) {
  const bool unknown = problem.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
  const std::string& token = problem.GetToken();
  const bool name = !token.empty() && (std::isalpha(token[0]) != 0 || token[0] == '_');
  if (unknown && name) return "'" + token + "' is unknown; it may name " + list(names);
  std::string what = problem.GetMsg();
  while (!what.empty() && what.back() == '.') what.pop_back();
  return what;
}

}  // namespace

Formula::Formula(std::string text, std::vector<std::string> names)
    : text_(std::move(text)), names_(std::move(names)) {
  if (text_.size() > kLongestFormula)
    throw std::runtime_error("is longer than " + std::to_string(kLongestFormula) + " characters");
  if (assigns(text_))
    throw std::runtime_error("'" + text_ + "' is no formula: it assigns; compare with ==");
  idle_.push_back(compile());
}

Formula::~Formula() = default;

std::unique_ptr<Formula::Compiled> Formula::compile() const {
  auto compiled = std::make_unique<Compiled>();
  compiled->values.assign(names_.size(), 0.0);
  mu::Parser& parser = compiled->parser;
  try {
    parser.DefineFun("limited", steps::limited);
    parser.DefineFun("dead_zone", steps::deadZone);
    parser.DefineFun("lessened", steps::lessened);
    parser.DefineFun("smooth_sign", smoothSign);
    parser.DefineFun("curve", curve);
    for (size_t i = 0; i < names_.size(); ++i) parser.DefineVar(names_[i], &compiled->values[i]);
    parser.SetExpr(text_);
    parser.Eval();
    if (parser.GetNumResults() != 1)
      throw std::runtime_error("'" + text_ + "' is no formula: it has several values");
  } catch (const mu::ParserError& problem) {
    throw std::runtime_error("'" + text_ + "' is no formula: " + problemWords(problem, names_));
  }
  return compiled;
}

FormulaUse::FormulaUse(std::shared_ptr<const Formula> formula) : formula_(std::move(formula)) {
  {
    const std::lock_guard lock(formula_->mutex_);
    if (!formula_->idle_.empty()) {
      compiled_ = std::move(formula_->idle_.back());
      formula_->idle_.pop_back();
    }
  }
  if (compiled_ == nullptr) compiled_ = formula_->compile();
}

FormulaUse::FormulaUse(const FormulaUse& other) : FormulaUse(other.formula_) {
  std::copy(other.compiled_->values.begin(), other.compiled_->values.end(),
            compiled_->values.begin());
}

FormulaUse::FormulaUse(FormulaUse&&) noexcept = default;

FormulaUse& FormulaUse::operator=(FormulaUse other) noexcept {
  std::swap(formula_, other.formula_);
  std::swap(compiled_, other.compiled_);
  return *this;
}

FormulaUse::~FormulaUse() {
  if (compiled_ == nullptr) return;
  const std::lock_guard lock(formula_->mutex_);
  formula_->idle_.push_back(std::move(compiled_));
}

double& FormulaUse::input(size_t place) const {
  return compiled_->values[place];
}

double FormulaUse::value() const {
  try {
    return compiled_->parser.Eval();
  } catch (const mu::ParserError&) {  // no number; it compiled
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tread {

/// A formula over named numbers, as users write it: "v + offset * yaw_rate".
/** Operators, functions and conditions are those of muParser, plus limited(value, inverse_limit,
 * beyond), dead_zone(value, width) and lessened(value, loss) as in the effects of the catalogue,
 * smooth_sign(value), and curve(value, a, f(a), b, f(b), ..), linear in between. There are no
 * loops and no assignments: the length of a formula bounds its run time. */
class Formula {
 public:
  /// Compiles it; throws std::runtime_error with one line if it is no formula of these names.
  Formula(std::string text, std::vector<std::string> names);
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;
  ~Formula();

  const std::string& text() const { return text_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  friend class FormulaUse;
  struct Compiled;

  std::unique_ptr<Compiled> compile() const;

  const std::string text_;
  const std::vector<std::string> names_;
  // muParser's compiled formula also holds the inputs: each use borrows one of its own and returns
  // it.
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Compiled>> idle_;
};

/// Evaluates a formula, in one thread at a time. Copies are independent.
class FormulaUse {
 public:
  explicit FormulaUse(std::shared_ptr<const Formula> formula);
  FormulaUse(const FormulaUse& other);
  FormulaUse(FormulaUse&&) noexcept;
  FormulaUse& operator=(FormulaUse other) noexcept;
  ~FormulaUse();

  /// An input by its place in names(); set it before value().
  double& input(size_t place) const;
  /// The value; NaN or infinite if the formula is undefined there.
  double value() const;

 private:
  std::shared_ptr<const Formula> formula_;
  std::unique_ptr<Formula::Compiled> compiled_;
};

}  // namespace tread

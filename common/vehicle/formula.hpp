// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tread {

/// A formula over named numbers, as people write it: "v + offset * yaw_rate".
/** Operators, functions and conditions are those of muParser, beside limited(value, inverse_limit,
 * beyond), dead_zone(value, width) and lessened(value, loss) as the effects of the catalogue use
 * them, smooth_sign(value), and curve(value, a, f(a), b, f(b), ..), straight between. There are no
 * loops and no assignments: the time that it takes is bounded by its length. */
class Formula {
 public:
  /// Compiles it; throws std::runtime_error with one line for what is no formula of these names.
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
  // What muParser compiles holds the numbers, too: each use has one of its own, and gives it back.
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Compiled>> idle_;
};

/// Evaluates a formula: for one thread at a time. Copies are independent.
class FormulaUse {
 public:
  explicit FormulaUse(std::shared_ptr<const Formula> formula);
  FormulaUse(const FormulaUse& other);
  FormulaUse(FormulaUse&&) noexcept;
  FormulaUse& operator=(FormulaUse other) noexcept;
  ~FormulaUse();

  /// A number by its place in names(); to be set before value().
  double& input(size_t place) const;
  /// The value; NaN or infinite where the formula has none.
  double value() const;

 private:
  std::shared_ptr<const Formula> formula_;
  std::unique_ptr<Formula::Compiled> compiled_;
};

}  // namespace tread

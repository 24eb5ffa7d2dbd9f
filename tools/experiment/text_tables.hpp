// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/tables.hpp"

namespace tread::experiment {

/// What a text about an experiment must know beside its numbers.
struct Setting {
  std::vector<std::string> surfaces;
  std::vector<std::string> rules;
  bool paper_reference = false;
  size_t books = 1;
};

/// Rules side by side in one table that is narrow enough to read: the paper's columns a, b, c, d
/// first, then what else was compared.
std::vector<std::vector<std::string>> columnGroups(const Setting& setting);

/// Table I in the paper's layout: rows from, groups of columns to; a, b, c, d as in the paper,
/// further rules in tables after them; the paper's numbers below.
std::string textOfErrors(const Tables& tables, const Setting& setting);
/// Table II: collective against single as in the paper, then each other rule.
std::string textOfReductions(const Tables& tables, const Setting& setting);
/// RMS deviations and signs, and those of single books; empty where nothing can be compared.
std::string textOfAgreement(const Tables& tables, const Setting& setting,
                            const std::vector<Tables>& books);
/// Medians and worst cases by rule: reductions, all patterns, unchanged ground; with several books
/// means and deviations over them.
std::string textOfKeyFigures(const Tables& tables, const Setting& setting,
                             const std::vector<Tables>& books);

/// The median; NaN of nothing.
double median(std::vector<double> values);

}  // namespace tread::experiment

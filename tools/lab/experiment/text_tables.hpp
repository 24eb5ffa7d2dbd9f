// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {

/// Groups of rules that fit into one table: the paper's columns a, b, c, d first, then the others.
std::vector<std::vector<std::string>> columnGroups(const Setting& setting);

/// Table I in the paper's layout: rows from, groups of columns to; a, b, c, d as in the paper,
/// further rules in additional tables; the paper's numbers below.
std::string textOfErrors(const Tables& tables, const Setting& setting);
/// Table II: collective compared with single as in the paper, then every other rule.
std::string textOfReductions(const Tables& tables, const Setting& setting);
/// RMS deviations and signs, also of single sets of recordings; empty if there is nothing to
/// compare.
std::string textOfAgreement(const Tables& tables, const Setting& setting,
                            const std::vector<Tables>& sets);

}  // namespace tread::experiment

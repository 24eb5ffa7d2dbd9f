// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/plan/plan_answer.hpp"
#include "tools/plan/query_file.hpp"

namespace tread::plan {

/// Counts what all queries on a map share for this one.
void addPreparation(PlanAnswer& answer, double preparation_ms);

/// The answer to one query: what could not be found out is null.
nlohmann::ordered_json answerJson(const PlanAnswer& answer);

/// What the answers to many queries have in common, and a short line about each.
/** Quantiles are of nearest rank; first_ms and length_m are of the solved ones only, and null if
 * there is none. expansions_per_s counts the time without that for the way to go. preparation_ms
 * was spent once, before the first query, and is not in the others. */
nlohmann::ordered_json answersJson(const std::vector<PlanQuery>& queries,
                                   const std::vector<PlanAnswer>& answers, double preparation_ms);

/// Writes JSON whole or not at all; throws std::runtime_error with one clear line.
void writeJson(const std::string& path, const nlohmann::ordered_json& json);

/// What people read of one answer, lines with their ends.
std::string answerText(const PlanAnswer& answer);

/// What people read of many answers.
std::string answersText(const std::vector<PlanAnswer>& answers, double preparation_ms);

/// How a query ended, in a line without its end.
std::string headline(const PlanAnswer& answer);

/// The smallest value that at least a share 0..1 of the values does not exceed; NaN of nothing.
double nearestRank(std::vector<double> values, double share);

}  // namespace tread::plan

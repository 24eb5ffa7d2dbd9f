// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/experiment/experiment.hpp"

namespace tread::experiment {

inline constexpr const char* kPosition = "position";
inline constexpr const char* kOrientation = "orientation";
inline constexpr const char* kQuantities[] = {kPosition, kOrientation};

/// One number of a table.
struct Row {
  std::string from;  ///< for unchanged ground: the surface
  std::string to;
  std::string quantity;  ///< position: per driven metre; orientation: per radian turned
  std::string rule;
  std::string against;  ///< reductions: the rule that is improved on
  int k = 0;            ///< executions before, where that counts
  Estimate estimate;
  double spread = std::numeric_limits<double>::quiet_NaN();  ///< deviation over books
};

/// The numbers of an experiment.
struct Tables {
  std::vector<Row> errors;               ///< Table I
  std::vector<Row> reductions;           ///< [%] Table II
  std::vector<Row> all_patterns;         ///< errors over all patterns after k executions
  std::vector<Row> unchanged;            ///< [1] error in the long run over the omniscient one
  std::vector<Row> unchanged_sequences;  ///< the same over the test sequences
};

Tables tablesOf(const ExperimentErrors& errors, const ExperimentSettings& settings,
                const std::vector<Ground>& grounds);

/// Means over the books, number by number, with the spread and the 99 % interval of the mean (by
/// Student); of one book that book.
Tables combined(const std::vector<Tables>& books);

/// The row of these words; nullptr if there is none.
const Row* find(const std::vector<Row>& rows, const std::string& from, const std::string& to,
                const std::string& quantity, const std::string& rule,
                const std::string& against = "", int k = 0);

/// Rules for which a reduction is told: all that learn.
std::vector<std::string> learningRules(const std::vector<std::string>& rules);

/// How one table is written to NAME.csv.
struct TableFile {
  const char* name;
  std::vector<Row> Tables::*rows;
  const char* header;
  std::string (*line)(const Row& row);
};
/// All tables, in the order of books.csv.
const std::array<TableFile, 5>& tableFiles();
std::string csvOf(const Tables& tables, const TableFile& file);

/// drift.csv: rule,executions,width of the watched pattern over its shipped one [1].
std::string csvOfDrift(const ExperimentErrors& errors, const ExperimentSettings& settings);
/// books.csv: table,seed,from,to,quantity,rule,against,k,value of each book.
std::string csvOfBooks(const std::vector<Tables>& books, uint64_t first_seed);

}  // namespace tread::experiment

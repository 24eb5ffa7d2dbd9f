// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
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
  double spread = std::numeric_limits<double>::quiet_NaN();  ///< deviation over sets of recordings
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

/// Means over the sets of recordings, number by number, with the spread and the 99 % interval of
/// the mean (by Student); of one set of recordings that set of recordings.
Tables combined(const std::vector<Tables>& sets);

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
/// All tables, in the order of sets of recordings.csv.
const std::array<TableFile, 5>& tableFiles();
std::string csvOf(const Tables& tables, const TableFile& file);

/// drift.csv: rule,executions,width of the watched pattern over its shipped one [1].
std::string csvOfDrift(const ExperimentErrors& errors, const ExperimentSettings& settings);
/// sets of recordings.csv: table,seed,from,to,quantity,rule,against,k,value of each set of
/// recordings.
std::string csvOfSets(const std::vector<Tables>& sets, uint64_t first_seed);

/// A cell of the paper's Tables I and II for one transition and quantity, as printed.
struct PaperCell {
  const char* from;
  const char* to;
  const char* quantity;
  std::array<double, 4> errors;  ///< columns a, b, c, d per driven metre or radian
  double reduction;              ///< [%] of c against b
};

/// All 24 cells.
const std::vector<PaperCell>& paperCells();
/// The cell, if the paper has these surfaces.
const PaperCell* paperCell(const std::string& from, const std::string& to,
                           const std::string& quantity);
/// The rules of columns a, b, c, d.
const std::array<std::string, 4>& paperRules();

/// Why a printed number is probably a misprint; empty if nothing speaks against it.
std::string doubtOfError(const PaperCell& cell, size_t column);
std::string doubtOfReduction(const PaperCell& cell);

/// How near a table comes to the paper's.
struct Agreement {
  /// Root of the mean squared difference in columns a, b, c, d; the transition cinder -> tarmac is
  /// left out of the orientation. NaN where nothing can be compared.
  std::array<double, 4> position_rms;
  std::array<double, 4> orientation_rms;
  int cells = 0;  ///< compared reductions of each quantity
  int position_signs = 0;
  int orientation_signs = 0;
};

/// Nothing if no transition of the tables is the paper's.
std::optional<Agreement> agreementWithPaper(const Tables& tables);

/// What a text about an experiment must know beside its numbers.
struct Setting {
  std::vector<std::string> surfaces;
  std::vector<std::string> rules;
  bool paper_reference = false;
  size_t sets = 1;
};

/// Rules side by side in one table that is narrow enough to read: the paper's columns a, b, c, d
/// first, then what else was compared.
std::vector<std::vector<std::string>> columnGroups(const Setting& setting);

/// Table I in the paper's layout: rows from, groups of columns to; a, b, c, d as in the paper,
/// further rules in tables after them; the paper's numbers below.
std::string textOfErrors(const Tables& tables, const Setting& setting);
/// Table II: collective against single as in the paper, then each other rule.
std::string textOfReductions(const Tables& tables, const Setting& setting);
/// RMS deviations and signs, and those of single sets of recordings; empty where nothing can be
/// compared.
std::string textOfAgreement(const Tables& tables, const Setting& setting,
                            const std::vector<Tables>& sets);
/// Medians and worst cases by rule: reductions, all patterns, unchanged ground; with several sets
/// of recordings means and deviations over them.
std::string textOfKeyFigures(const Tables& tables, const Setting& setting,
                             const std::vector<Tables>& sets);

/// The median; NaN of nothing.
double median(std::vector<double> values);

}  // namespace tread::experiment

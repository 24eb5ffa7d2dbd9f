// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/lab/experiment/experiment.hpp"

namespace tread::experiment {

inline constexpr const char* kPosition = "position";
inline constexpr const char* kOrientation = "orientation";
inline constexpr const char* kQuantities[] = {kPosition, kOrientation};

/// Quantity name for the share of ends inside 90 % regions.
inline constexpr const char* kRegion = "region";

/// One number of a table.
struct Row {
  std::string from;  ///< for unchanged ground: the surface
  std::string to;
  std::string quantity;  ///< position: per driven metre; orientation: per radian turned
  std::string rule;
  std::string against;  ///< for reductions: the rule compared with
  int k = 0;            ///< number of executions before, if relevant
  Estimate estimate;
  /// standard deviation over sets of recordings
  double spread = std::numeric_limits<double>::quiet_NaN();
};

/// All results of an experiment.
struct Tables {
  std::vector<Row> errors;        ///< Table I
  std::vector<Row> reductions;    ///< [%] Table II
  std::vector<Row> all_patterns;  ///< errors over all patterns after k executions
  /// Errors over all patterns after k executions of random ones, also on unchanged ground.
  std::vector<Row> first_executions;
  std::vector<Row> regions;    ///< [1] share of ends inside, before execution k = 1, 2, ...
  std::vector<Row> unchanged;  ///< [1] error in the long run relative to the omniscient one's
  std::vector<Row> unchanged_sequences;  ///< the same over the test sequences
};

Tables tablesOf(const ExperimentErrors& errors, const ExperimentSettings& settings,
                const std::vector<TrialGround>& grounds);

/// Element-wise means over the sets of recordings, with standard deviation and 99 % interval
/// (Student); a single set is returned unchanged.
Tables combined(const std::vector<Tables>& sets);

/// The matching row; nullptr if there is none.
const Row* find(const std::vector<Row>& rows, const std::string& from, const std::string& to,
                const std::string& quantity, const std::string& rule,
                const std::string& against = "", int k = 0);

/// Rules with a reduction: all that learn.
std::vector<std::string> learningRules(const std::vector<std::string>& rules);

/// A table and its file NAME.csv.
struct TableFile {
  const char* name;
  std::vector<Row> Tables::*rows;
  const char* header;
  std::string (*line)(const Row& row);
};
/// All tables, in the order of sets.csv.
const std::array<TableFile, 7>& tableFiles();
std::string csvOf(const Tables& tables, const TableFile& file);

/// drift.csv: rule, executions, width of the watched pattern relative to its shipped one [1].
std::string csvOfDrift(const ExperimentErrors& errors, const ExperimentSettings& settings);
/// sets.csv: table,seed,from,to,quantity,rule,against,k,value, a row for each number of each set of
/// recordings.
std::string csvOfSets(const std::vector<Tables>& sets, uint64_t first_seed);

/// A cell of the paper's Tables I and II for one transition and quantity, as printed.
struct PaperCell {
  const char* from;
  const char* to;
  const char* quantity;
  std::array<double, 4> errors;  ///< columns a, b, c, d per driven metre or radian
  double reduction;              ///< [%] of c relative to b
};

/// All 24 cells.
const std::vector<PaperCell>& paperCells();
/// The cell, if the paper has these surfaces.
const PaperCell* paperCell(const std::string& from, const std::string& to,
                           const std::string& quantity);
/// The rules of columns a, b, c, d.
const std::array<std::string, 4>& paperRules();

/// Why a printed number is probably a misprint; empty if it is plausible.
std::string doubtOfError(const PaperCell& cell, size_t column);
std::string doubtOfReduction(const PaperCell& cell);

/// Agreement of a table with the paper's.
struct Agreement {
  /// Root of the mean squared difference in columns a, b, c, d; the transition cinder -> tarmac is
  /// left out of the orientation. NaN if there is nothing to compare.
  std::array<double, 4> position_rms;
  std::array<double, 4> orientation_rms;
  int cells = 0;  ///< compared reductions per quantity
  int position_signs = 0;
  int orientation_signs = 0;
};

/// nullopt if the tables share no transition with the paper.
std::optional<Agreement> agreementWithPaper(const Tables& tables);

/// Description of an experiment, for texts.
struct Setting {
  std::vector<std::string> surfaces;
  std::vector<std::string> rules;
  bool paper_reference = false;
  size_t sets = 1;
};

/// Options of the command line.
struct Request {
  std::string world;                   ///< file; empty: `recordings` is used
  std::string recordings;              ///< folder
  std::string robot;                   ///< name of the robot in a folder of drives
  std::vector<std::string> sessions;   ///< selected ones; empty = all comparable ones
  std::vector<std::string> sequences;  ///< "left,left,right"; empty = those of the world
  std::vector<std::string> rules;
  int64_t repetitions = 2000;
  int64_t excitations = 40;            ///< excitation runs of each transition
  int64_t excitation = 200;            ///< executions on each surface of one
  double memory = 0.5;                 ///< [1] weight w of equation (2)
  std::vector<std::string> overrides;  ///< of learner.yaml: "ground.fresh=0.3"
  uint64_t seed = 1;
  int threads = 1;
  int sets = 1;    ///< for a world: number of sets of recordings, with increasing seeds
  int length = 1;  ///< for a world: factor on the duration of each command
  bool change_inside = false;
  bool extras = false;  ///< also patterns of twice the length and changes within a pattern
};

/// The experiment under other conditions, with fewer repetitions.
struct Variant {
  std::string words;
  Tables tables;
  std::vector<Tables> sets;
};

/// A request and its results.
struct Batch {
  Request request;
  Setting setting;
  ExperimentSettings settings;
  std::string source;              ///< the world or folder, in words
  std::vector<std::string> notes;  ///< about the recordings
  std::vector<Tables> sets;
  Tables tables;                     ///< combined over all sets of recordings
  std::vector<TrialGround> grounds;  ///< of the first set of recordings
  ExperimentErrors first;            ///< its errors, for the pictures
  std::vector<Variant> variants;     ///< if the request has `extras`
  double seconds = 0.0;              ///< of the trials, without recording
};

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/tables.hpp"

#include <cmath>

#include "common/report/text.hpp"

namespace tread::experiment {
namespace {

Estimate reduction(const Estimate& ratio) {
  return {100.0 * (1.0 - ratio.value), 100.0 * (1.0 - ratio.high), 100.0 * (1.0 - ratio.low)};
}

/// Rows of both quantities; make(row, moments of the quantity).
template <class Make>
void forBoth(const MethodErrors& errors, Row row, const Make& make) {
  row.quantity = kPosition;
  make(row, errors.position);
  row.quantity = kOrientation;
  make(row, errors.orientation);
}

void addErrors(const MethodErrors& errors, const ExperimentSettings& settings, const Row& about,
               std::vector<Row>& rows) {
  forBoth(errors, about, [&](Row row, const RatioMoments& moments) {
    for (size_t i = 0; i < settings.rules.size(); ++i) {
      row.rule = settings.rules[i];
      row.estimate = moments.error(i);
      rows.push_back(row);
    }
  });
}

void addReductions(const MethodErrors& errors, const ExperimentSettings& settings, const Row& about,
                   std::vector<Row>& rows) {
  const auto add = [&](Row row, const RatioMoments& moments) {
    for (const char* against : {"single", "off"}) {
      const size_t other = settings.ruleIndex(against);
      if (other == settings.rules.size()) continue;
      for (const std::string& rule : learningRules(settings.rules)) {
        if (rule == against) continue;
        row.rule = rule;
        row.against = against;
        row.estimate = reduction(moments.ratio(settings.ruleIndex(rule), other));
        rows.push_back(row);
      }
    }
  };
  forBoth(errors, about, add);
}

void addUnchanged(const MethodErrors& errors, const ExperimentSettings& settings, const Row& about,
                  std::vector<Row>& rows) {
  const size_t omniscient = settings.ruleIndex(kOmniscient);
  if (omniscient == settings.rules.size()) return;
  forBoth(errors, about, [&](Row row, const RatioMoments& moments) {
    for (size_t i = 0; i < settings.rules.size(); ++i) {
      row.rule = settings.rules[i];
      row.estimate = moments.ratio(i, omniscient);
      rows.push_back(row);
    }
  });
}

void addFirstExecutions(const FirstExecutions& first, const ExperimentSettings& settings, Row about,
                        Tables& tables) {
  for (size_t k = 0; k < first.all_patterns.size(); ++k) {
    about.k = static_cast<int>(FirstExecutions::kTested[k]);
    addErrors(first.all_patterns[k], settings, about, tables.first_executions);
  }
  about.quantity = kRegion;
  for (size_t j = 0; j < first.regions.size(); ++j)
    for (size_t i = 0; i < settings.rules.size(); ++i) {
      const RegionCount& count = first.regions[j][i];
      if (count.ends == 0.0) continue;
      about.k = static_cast<int>(j) + 1;
      about.rule = settings.rules[i];
      about.estimate = {count.inside / count.ends};
      tables.regions.push_back(about);
    }
}

/// The i-th row of one table, combined over all sets of recordings.
Row combinedRow(const std::vector<const Row*>& sets) {
  Row row = *sets.front();
  if (sets.size() < 2) return row;
  const auto n = static_cast<double>(sets.size());
  double mean = 0.0, squares = 0.0;
  for (const Row* set : sets) mean += set->estimate.value / n;
  for (const Row* set : sets) squares += std::pow(set->estimate.value - mean, 2);
  row.spread = std::sqrt(squares / (n - 1.0));
  const double half = student99(sets.size()) * row.spread / std::sqrt(n);
  row.estimate = {mean, mean - half, mean + half};
  return row;
}

std::vector<Row> combinedRows(const std::vector<Tables>& sets, std::vector<Row> Tables::*table) {
  std::vector<Row> rows;
  for (size_t i = 0; i < (sets.front().*table).size(); ++i) {
    std::vector<const Row*> same;
    for (const Tables& set : sets) same.push_back(&(set.*table)[i]);
    rows.push_back(combinedRow(same));
  }
  return rows;
}

std::string number(double value) {
  return fixed(value, 6);
}

std::string interval(const Estimate& estimate) {
  return number(estimate.value) + "," + number(estimate.low) + "," + number(estimate.high);
}

std::string what(const Row& row) {
  return row.from + "," + row.to + "," + row.quantity + "," + row.rule;
}

std::string ratioLine(const Row& row) {
  return row.from + "," + row.quantity + "," + row.rule + "," + number(row.estimate.value);
}

const std::array<TableFile, 7> kTableFiles{{
    {"table1", &Tables::errors, "from,to,quantity,rule,error,low,high",
     [](const Row& row) { return what(row) + "," + interval(row.estimate); }},
    {"table2", &Tables::reductions, "from,to,quantity,rule,against,reduction_percent,low,high",
     [](const Row& row) { return what(row) + "," + row.against + "," + interval(row.estimate); }},
    {"all_patterns", &Tables::all_patterns, "from,to,quantity,rule,k,error",
     [](const Row& row) {
       return what(row) + "," + std::to_string(row.k) + "," + number(row.estimate.value);
     }},
    {"first_executions", &Tables::first_executions, "from,to,quantity,rule,k,error",
     [](const Row& row) {
       return what(row) + "," + std::to_string(row.k) + "," + number(row.estimate.value);
     }},
    {"regions", &Tables::regions, "from,to,quantity,rule,execution,share",
     [](const Row& row) {
       return what(row) + "," + std::to_string(row.k) + "," + number(row.estimate.value);
     }},
    {"unchanged", &Tables::unchanged, "surface,quantity,rule,ratio", &ratioLine},
    {"unchanged_sequences", &Tables::unchanged_sequences, "surface,quantity,rule,ratio",
     &ratioLine},
}};

}  // namespace

std::vector<std::string> learningRules(const std::vector<std::string>& rules) {
  std::vector<std::string> learning;
  for (const std::string& rule : rules)
    if (rule != "off" && rule != kOmniscient) learning.push_back(rule);
  return learning;
}

Tables tablesOf(const ExperimentErrors& errors, const ExperimentSettings& settings,
                const std::vector<TrialGround>& grounds) {
  Tables tables;
  for (const TransitionErrors& transition : errors.transitions) {
    Row about;
    about.from = grounds[transition.from].surface;
    about.to = grounds[transition.to].surface;
    addErrors(transition.sequences.errors, settings, about, tables.errors);
    addReductions(transition.sequences.errors, settings, about, tables.reductions);
    addFirstExecutions(transition.first, settings, about, tables);
    for (size_t k = 0; k < transition.all_patterns.size(); ++k) {
      about.k = settings.all_patterns_after[k];
      addErrors(transition.all_patterns[k], settings, about, tables.all_patterns);
    }
  }
  for (size_t s = 0; s < errors.unchanged.size(); ++s) {
    Row about;
    about.from = about.to = grounds[s].surface;
    addUnchanged(errors.unchanged[s], settings, about, tables.unchanged);
    addFirstExecutions(errors.unchanged_first[s], settings, about, tables);
    addUnchanged(errors.unchanged_sequences[s], settings, about, tables.unchanged_sequences);
  }
  return tables;
}

Tables combined(const std::vector<Tables>& sets) {
  Tables all;
  for (const TableFile& file : kTableFiles) all.*file.rows = combinedRows(sets, file.rows);
  return all;
}

const Row* find(const std::vector<Row>& rows, const std::string& from, const std::string& to,
                const std::string& quantity, const std::string& rule, const std::string& against,
                int k) {
  for (const Row& row : rows)
    if (row.from == from && row.to == to && row.quantity == quantity && row.rule == rule &&
        row.against == against && row.k == k)
      return &row;
  return nullptr;
}

const std::array<TableFile, 7>& tableFiles() {
  return kTableFiles;
}

std::string csvOf(const Tables& tables, const TableFile& file) {
  std::string text = std::string(file.header) + "\n";
  for (const Row& row : tables.*file.rows) text += file.line(row) + "\n";
  return text;
}

std::string csvOfDrift(const ExperimentErrors& errors, const ExperimentSettings& settings) {
  std::string text = "rule,executions,width\n";
  for (size_t i = 0; i < errors.drift.size(); ++i)
    for (size_t j = 0; j < errors.drift[i].size(); ++j)
      text += settings.rules[i] + "," + std::to_string(j) + "," + number(errors.drift[i][j]) + "\n";
  return text;
}

std::string csvOfSets(const std::vector<Tables>& sets, uint64_t first_seed) {
  std::string text = "table,seed,from,to,quantity,rule,against,k,value\n";
  for (size_t set = 0; set < sets.size(); ++set)
    for (const TableFile& file : kTableFiles)
      for (const Row& row : sets[set].*file.rows)
        text += std::string(file.name) + "," + std::to_string(first_seed + set) + "," + what(row) +
                "," + row.against + "," + std::to_string(row.k) + "," + number(row.estimate.value) +
                "\n";
  return text;
}

namespace {

bool is(const PaperCell& cell, const char* from, const char* to, const char* quantity) {
  return std::string(cell.from) == from && std::string(cell.to) == to &&
         std::string(cell.quantity) == quantity;
}

bool isLeftOut(const PaperCell& cell) {
  return is(cell, "cinder", "tarmac", kOrientation);
}

/// Sum of squared differences in one column.
struct Squares {
  double sum = 0.0;
  int count = 0;
  double rms() const { return count > 0 ? std::sqrt(sum / count) : Estimate{}.value; }
};

}  // namespace

const std::vector<PaperCell>& paperCells() {
  static const std::vector<PaperCell> cells{
      {"cinder", "tarmac", kPosition, {0.043, 0.043, 0.042, 0.035}, 1.5},
      {"cinder", "tarmac", kOrientation, {0.041, 0.043, 0.042, 0.037}, 18.5},
      {"cinder", "grass", kPosition, {0.087, 0.077, 0.063, 0.039}, 17.8},
      {"cinder", "grass", kOrientation, {0.271, 0.226, 0.162, 0.067}, 27.9},
      {"cinder", "gravel", kPosition, {0.063, 0.061, 0.058, 0.046}, 3.4},
      {"cinder", "gravel", kOrientation, {0.164, 0.147, 0.126, 0.099}, 13.5},
      {"tarmac", "cinder", kPosition, {0.059, 0.055, 0.056, 0.041}, -0.5},
      {"tarmac", "cinder", kOrientation, {0.107, 0.100, 0.091, 0.030}, 8.5},
      {"tarmac", "grass", kPosition, {0.060, 0.057, 0.051, 0.039}, 10.3},
      {"tarmac", "grass", kOrientation, {0.204, 0.172, 0.129, 0.067}, 24.9},
      {"tarmac", "gravel", kPosition, {0.054, 0.054, 0.057, 0.046}, -4.9},
      {"tarmac", "gravel", kOrientation, {0.113, 0.111, 0.109, 0.099}, 1.2},
      {"grass", "cinder", kPosition, {0.108, 0.093, 0.085, 0.041}, 9.1},
      {"grass", "cinder", kOrientation, {0.372, 0.313, 0.231, 0.030}, 26.0},
      {"grass", "tarmac", kPosition, {0.071, 0.064, 0.060, 0.035}, 5.0},
      {"grass", "tarmac", kOrientation, {0.256, 0.214, 0.154, 0.037}, 27.8},
      {"grass", "gravel", kPosition, {0.063, 0.060, 0.059, 0.046}, -1.1},
      {"grass", "gravel", kOrientation, {0.165, 0.151, 0.133, 0.099}, 7.3},
      {"gravel", "cinder", kPosition, {0.060, 0.056, 0.055, 0.041}, 0.3},
      {"gravel", "cinder", kOrientation, {0.191, 0.166, 0.134, 0.030}, 18.4},
      {"gravel", "tarmac", kPosition, {0.045, 0.044, 0.046, 0.035}, -5.4},
      {"gravel", "tarmac", kOrientation, {0.090, 0.079, 0.066, 0.037}, 15.6},
      {"gravel", "grass", kPosition, {0.064, 0.060, 0.057, 0.039}, 4.5},
      {"gravel", "grass", kOrientation, {0.136, 0.119, 0.098, 0.067}, 17.2},
  };
  return cells;
}

const PaperCell* paperCell(const std::string& from, const std::string& to,
                           const std::string& quantity) {
  for (const PaperCell& cell : paperCells())
    if (cell.from == from && cell.to == to && cell.quantity == quantity) return &cell;
  return nullptr;
}

const std::array<std::string, 4>& paperRules() {
  static const std::array<std::string, 4> rules{"off", "single", "collective", kOmniscient};
  return rules;
}

std::string doubtOfError(const PaperCell& cell, size_t column) {
  if (isLeftOut(cell))
    return "probably a misprint: all other cells suggest about .092 .081 .066 .038, which gives "
           "the 18.5 % of Table II";
  if (is(cell, "tarmac", "cinder", kOrientation) && column == 1)
    return "column b probably a misprint: it does not fit its neighbours a and c, nor Table II";
  return "";
}

std::string doubtOfReduction(const PaperCell& cell) {
  if (is(cell, "grass", "gravel", kOrientation)) return "Table I gives 11.9";
  if (is(cell, "grass", "gravel", kPosition)) return "Table I gives +1.7: the sign is doubtful";
  return "";
}

std::optional<Agreement> agreementWithPaper(const Tables& tables) {
  Agreement agreement;
  std::array<Squares, 4> position, orientation;
  for (const PaperCell& cell : paperCells()) {
    const bool is_position = std::string(cell.quantity) == kPosition;
    for (size_t column = 0; column < 4; ++column) {
      const Row* row = find(tables.errors, cell.from, cell.to, cell.quantity, paperRules()[column]);
      if (row == nullptr || isLeftOut(cell)) continue;
      Squares& squares = (is_position ? position : orientation)[column];
      squares.sum += std::pow(row->estimate.value - cell.errors[column], 2);
      ++squares.count;
    }
    const Row* row =
        find(tables.reductions, cell.from, cell.to, cell.quantity, "collective", "single");
    if (row == nullptr) continue;
    if (is_position) ++agreement.cells;
    if ((row->estimate.value > 0.0) == (cell.reduction > 0.0))
      ++(is_position ? agreement.position_signs : agreement.orientation_signs);
  }
  int compared = 0;
  for (size_t column = 0; column < 4; ++column) {
    agreement.position_rms[column] = position[column].rms();
    agreement.orientation_rms[column] = orientation[column].rms();
    compared += position[column].count;
  }
  if (compared == 0) return std::nullopt;
  return agreement;
}

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/tables.hpp"

#include <cmath>

#include "common/report/text.hpp"

namespace tread::experiment {
namespace {

Estimate reduction(const Estimate& ratio) {
  return {100.0 * (1.0 - ratio.value), 100.0 * (1.0 - ratio.high), 100.0 * (1.0 - ratio.low)};
}

/// Rows of both quantities of some errors; make(row, moments of the quantity).
template <class Make>
void forBoth(const Errors& errors, Row row, const Make& make) {
  row.quantity = kPosition;
  make(row, errors.position);
  row.quantity = kOrientation;
  make(row, errors.orientation);
}

void addErrors(const Errors& errors, const ExperimentSettings& settings, const Row& about,
               std::vector<Row>& rows) {
  forBoth(errors, about, [&](Row row, const RatioMoments& moments) {
    for (size_t i = 0; i < settings.rules.size(); ++i) {
      row.rule = settings.rules[i];
      row.estimate = moments.error(i);
      rows.push_back(row);
    }
  });
}

void addReductions(const Errors& errors, const ExperimentSettings& settings, const Row& about,
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

void addUnchanged(const Errors& errors, const ExperimentSettings& settings, const Row& about,
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

/// The i-th row of one table, over all books.
Row combinedRow(const std::vector<const Row*>& books) {
  Row row = *books.front();
  if (books.size() < 2) return row;
  const auto n = static_cast<double>(books.size());
  double mean = 0.0, squares = 0.0;
  for (const Row* book : books) mean += book->estimate.value / n;
  for (const Row* book : books) squares += std::pow(book->estimate.value - mean, 2);
  row.spread = std::sqrt(squares / (n - 1.0));
  const double half = student99(books.size()) * row.spread / std::sqrt(n);
  row.estimate = {mean, mean - half, mean + half};
  return row;
}

std::vector<Row> combinedRows(const std::vector<Tables>& books, std::vector<Row> Tables::*table) {
  std::vector<Row> rows;
  for (size_t i = 0; i < (books.front().*table).size(); ++i) {
    std::vector<const Row*> same;
    for (const Tables& book : books) same.push_back(&(book.*table)[i]);
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

const std::array<TableFile, 5> kTableFiles{{
    {"table1", &Tables::errors, "from,to,quantity,rule,error,low,high",
     [](const Row& row) { return what(row) + "," + interval(row.estimate); }},
    {"table2", &Tables::reductions, "from,to,quantity,rule,against,reduction_percent,low,high",
     [](const Row& row) { return what(row) + "," + row.against + "," + interval(row.estimate); }},
    {"all_patterns", &Tables::all_patterns, "from,to,quantity,rule,k,error",
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
                const std::vector<Ground>& grounds) {
  Tables tables;
  for (const TransitionErrors& transition : errors.transitions) {
    Row about;
    about.from = grounds[transition.from].surface;
    about.to = grounds[transition.to].surface;
    addErrors(transition.sequences.errors, settings, about, tables.errors);
    addReductions(transition.sequences.errors, settings, about, tables.reductions);
    for (size_t k = 0; k < transition.all_patterns.size(); ++k) {
      about.k = settings.all_patterns_after[k];
      addErrors(transition.all_patterns[k], settings, about, tables.all_patterns);
    }
  }
  for (size_t s = 0; s < errors.unchanged.size(); ++s) {
    Row about;
    about.from = about.to = grounds[s].surface;
    addUnchanged(errors.unchanged[s], settings, about, tables.unchanged);
    addUnchanged(errors.unchanged_sequences[s], settings, about, tables.unchanged_sequences);
  }
  return tables;
}

Tables combined(const std::vector<Tables>& books) {
  Tables all;
  for (const TableFile& file : kTableFiles) all.*file.rows = combinedRows(books, file.rows);
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

const std::array<TableFile, 5>& tableFiles() {
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

std::string csvOfBooks(const std::vector<Tables>& books, uint64_t first_seed) {
  std::string text = "table,seed,from,to,quantity,rule,against,k,value\n";
  for (size_t book = 0; book < books.size(); ++book)
    for (const TableFile& file : kTableFiles)
      for (const Row& row : books[book].*file.rows)
        text += std::string(file.name) + "," + std::to_string(first_seed + book) + "," + what(row) +
                "," + row.against + "," + std::to_string(row.k) + "," + number(row.estimate.value) +
                "\n";
  return text;
}

}  // namespace tread::experiment

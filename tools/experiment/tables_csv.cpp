// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>

#include "tools/experiment/tables.hpp"

namespace tread::experiment {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", value);
  return text;
}

std::string interval(const Estimate& estimate) {
  return number(estimate.value) + "," + number(estimate.low) + "," + number(estimate.high);
}

std::string what(const Row& row) {
  return row.from + "," + row.to + "," + row.quantity + "," + row.rule;
}

void addBook(const char* table, uint64_t seed, const std::vector<Row>& rows, std::string& text) {
  for (const Row& row : rows)
    text += std::string(table) + "," + std::to_string(seed) + "," + what(row) + "," + row.against +
            "," + std::to_string(row.k) + "," + number(row.estimate.value) + "\n";
}

std::string csvOfRatios(const std::vector<Row>& rows) {
  std::string text = "surface,quantity,rule,ratio\n";
  for (const Row& row : rows)
    text +=
        row.from + "," + row.quantity + "," + row.rule + "," + number(row.estimate.value) + "\n";
  return text;
}

}  // namespace

std::string csvOfErrors(const Tables& tables) {
  std::string text = "from,to,quantity,rule,error,low,high\n";
  for (const Row& row : tables.errors) text += what(row) + "," + interval(row.estimate) + "\n";
  return text;
}

std::string csvOfReductions(const Tables& tables) {
  std::string text = "from,to,quantity,rule,against,reduction_percent,low,high\n";
  for (const Row& row : tables.reductions)
    text += what(row) + "," + row.against + "," + interval(row.estimate) + "\n";
  return text;
}

std::string csvOfAllPatterns(const Tables& tables) {
  std::string text = "from,to,quantity,rule,k,error\n";
  for (const Row& row : tables.all_patterns)
    text += what(row) + "," + std::to_string(row.k) + "," + number(row.estimate.value) + "\n";
  return text;
}

std::string csvOfUnchanged(const Tables& tables) {
  return csvOfRatios(tables.unchanged);
}

std::string csvOfUnchangedSequences(const Tables& tables) {
  return csvOfRatios(tables.unchanged_sequences);
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
  for (size_t book = 0; book < books.size(); ++book) {
    const uint64_t seed = first_seed + book;
    addBook("table1", seed, books[book].errors, text);
    addBook("table2", seed, books[book].reductions, text);
    addBook("all_patterns", seed, books[book].all_patterns, text);
    addBook("unchanged", seed, books[book].unchanged, text);
    addBook("unchanged_sequences", seed, books[book].unchanged_sequences, text);
  }
  return text;
}

}  // namespace tread::experiment

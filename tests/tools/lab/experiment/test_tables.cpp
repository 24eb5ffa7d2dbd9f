// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Tables, CSV and texts of an experiment with known numbers.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/tools/lab/experiment/small_world.hpp"
#include "tools/lab/experiment/figures.hpp"
#include "tools/lab/experiment/first_executions_text.hpp"
#include "tools/lab/experiment/key_figures.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

/// Ten runs of 2 m in which each rule's error is alternately slightly above and below these shares.
RatioMoments moments(const std::vector<double>& shares) {
  RatioMoments sums(shares.size());
  for (int i = 0; i < 10; ++i) {
    std::vector<double> errors;
    for (const double share : shares) errors.push_back(2.0 * share * (i % 2 == 0 ? 1.1 : 0.9));
    RatioMoments run(shares.size());
    run.add(2.0, errors.data());
    sums.addRun(run);
  }
  return sums;
}

MethodErrors errorsOf(const std::vector<double>& shares) {
  MethodErrors errors(shares.size());
  errors.position = moments(shares);
  std::vector<double> turned;
  for (const double share : shares) turned.push_back(2.0 * share);
  errors.orientation = moments(turned);
  return errors;
}

const std::vector<TrialGround>& grounds() {
  static const std::vector<TrialGround> both = groundsOfText(kSmallWorld);
  return both;
}

ExperimentSettings settings() {
  ExperimentSettings made = smallSettings();
  made.rules = {"off", "single", "collective", kOmniscient};
  made.all_patterns_after = {1, 3};
  return made;
}

/// The same errors after any number of executions; the last method states regions.
FirstExecutions knownFirst() {
  FirstExecutions first(4);
  for (MethodErrors& errors : first.all_patterns) errors = errorsOf({0.4, 0.2, 0.1, 0.05});
  for (auto& methods : first.regions) methods[3] = {10.0, 9.0};
  return first;
}

/// From ice to road: without learning 0.4, single 0.2, collective 0.1, the best 0.05.
ExperimentErrors knownErrors() {
  const MethodErrors known = errorsOf({0.4, 0.2, 0.1, 0.05});
  TransitionErrors transition;
  transition.from = 0;
  transition.to = 1;
  transition.sequences.errors = known;
  transition.all_patterns = {errorsOf({0.4, 0.3, 0.2, 0.05}), errorsOf({0.4, 0.2, 0.08, 0.05})};
  ExperimentErrors errors;
  errors.transitions = {transition};
  errors.unchanged = {known, known};
  errors.unchanged_sequences = {known, known};
  errors.transitions[0].first = knownFirst();
  errors.unchanged_first = {knownFirst(), knownFirst()};
  return errors;
}

Tables knownTables() {
  return tablesOf(knownErrors(), settings(), grounds());
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("a table has the error of each rule per metre and per radian") {
  const Tables tables = knownTables();
  CHECK(tables.errors.size() == 2 * 4);
  const Row* off = find(tables.errors, "ice", "road", kPosition, "off");
  REQUIRE(off != nullptr);
  CHECK(off->estimate.value == Approx(0.4));
  CHECK(off->estimate.low < 0.4);
  CHECK(off->estimate.high > 0.4);
  CHECK(find(tables.errors, "ice", "road", kOrientation, "off")->estimate.value == Approx(0.8));
  CHECK(find(tables.errors, "road", "ice", kPosition, "off") == nullptr);
  CHECK(find(tables.errors, "ice", "road", kPosition, "magic") == nullptr);
}

TEST_CASE("a reduction is what a rule takes off another one's error, in per cent") {
  const Tables tables = knownTables();
  // Collective relative to single; both relative to off; two quantities.
  CHECK(tables.reductions.size() == 2 * 3);
  const Row* row = find(tables.reductions, "ice", "road", kPosition, "collective", "single");
  REQUIRE(row != nullptr);
  CHECK(row->estimate.value == Approx(50.0));
  CHECK(row->estimate.low <= row->estimate.value);
  CHECK(row->estimate.high >= row->estimate.value);
  // Both errors rise and fall together: paired, no uncertainty remains.
  CHECK(row->estimate.high - row->estimate.low < 1e-3);
  CHECK(find(tables.reductions, "ice", "road", kPosition, "collective", "off")->estimate.value ==
        Approx(75.0));
  CHECK(find(tables.reductions, "ice", "road", kPosition, "off", "off") == nullptr);
}

TEST_CASE("errors over all patterns are told by the executions before, unchanged ground by ratio") {
  const Tables tables = knownTables();
  CHECK(tables.all_patterns.size() == 2 * 2 * 4);
  CHECK(find(tables.all_patterns, "ice", "road", kPosition, "collective", "", 1)->estimate.value ==
        Approx(0.2));
  CHECK(find(tables.all_patterns, "ice", "road", kPosition, "collective", "", 3)->estimate.value ==
        Approx(0.08));
  CHECK(find(tables.all_patterns, "ice", "road", kPosition, "collective", "", 2) == nullptr);
  CHECK(find(tables.unchanged, "ice", "ice", kPosition, "off")->estimate.value == Approx(8.0));
  CHECK(find(tables.unchanged, "road", "road", kPosition, kOmniscient)->estimate.value ==
        Approx(1.0));
}

TEST_CASE("without single or the omniscient rule the tables that need them are empty") {
  ExperimentSettings alone = settings();
  alone.rules = {"collective", "multi_model"};
  ExperimentErrors errors = knownErrors();
  const MethodErrors two = errorsOf({0.2, 0.1});
  errors.transitions[0].sequences.errors = two;
  errors.transitions[0].all_patterns = {two, two};
  errors.unchanged = errors.unchanged_sequences = {two, two};
  const Tables tables = tablesOf(errors, alone, grounds());
  CHECK(tables.errors.size() == 2 * 2);
  CHECK(tables.reductions.empty());
  CHECK(tables.unchanged.empty());
  const std::string text = textOfKeyFigures(tables, {{"ice", "road"}, alone.rules}, {tables});
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find("inf") == std::string::npos);
}

TEST_CASE("each CSV has a head and one line a row, all with as many fields") {
  const Tables tables = knownTables();
  for (const TableFile& file : tableFiles()) {
    INFO(file.name);
    const std::vector<std::string> lines = linesOf(csvOf(tables, file));
    REQUIRE(lines.size() == 1 + (tables.*file.rows).size());
    CHECK(lines[0] == file.header);
    const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
    for (const std::string& line : lines)
      CHECK(std::count(line.begin(), line.end(), ',') == commas);
  }
  CHECK(csvOf(tables, tableFiles()[0]).find("ice,road,position,single,0.200000,") !=
        std::string::npos);
}

TEST_CASE("the file of sets has every row of every set under its seed") {
  const Tables tables = knownTables();
  size_t rows = 0;
  for (const TableFile& file : tableFiles()) rows += (tables.*file.rows).size();
  const std::vector<std::string> lines = linesOf(csvOfSets({tables, tables}, 40));
  REQUIRE(lines.size() == 1 + 2 * rows);
  CHECK(lines[1] == "table1,40,ice,road,position,off,,0,0.400000");
  CHECK(lines[1 + rows] == "table1,41,ice,road,position,off,,0,0.400000");
}

TEST_CASE("drift.csv counts executions from zero, rule by rule") {
  ExperimentErrors errors;
  errors.drift = {{1.0, 1.1}, {1.0, 0.9}};
  ExperimentSettings two;
  two.rules = {"off", "single"};
  CHECK(csvOfDrift(errors, two) ==
        "rule,executions,width\noff,0,1.000000\noff,1,1.100000\nsingle,0,1.000000\n"
        "single,1,0.900000\n");
}

TEST_CASE("key figures are the numbers of the tables, a dash where there is none") {
  const Tables tables = knownTables();
  const std::string text = textOfKeyFigures(tables, {{"ice", "road"}, settings().rules}, {tables});
  INFO(text);
  std::string collective;
  for (const std::string& line : linesOf(text))
    if (line.find("collective") == 0 && collective.empty()) collective = line;
  std::istringstream words(collective);
  std::string rule, sequences, worst, all_after_10, all_3, unchanged;
  words >> rule >> sequences >> worst >> all_after_10 >> all_3 >> unchanged;
  CHECK(sequences == "50.0");
  CHECK(worst == "-75.0");
  CHECK(all_after_10 == "-");  // the tables end after 3 executions
  CHECK(all_3 == "-80.0");
  CHECK(unchanged == "2.000");
}

TEST_CASE("surfaces that the paper does not have are not compared with it") {
  CHECK_FALSE(agreementWithPaper(knownTables()));
  CHECK(paperCells().size() == 24);
  CHECK(paperCell("ice", "road", kPosition) == nullptr);
  // A table with the paper's own numbers agrees with it.
  Tables printed;
  for (const PaperCell& cell : paperCells()) {
    for (size_t column = 0; column < 4; ++column) {
      Row row;
      row.from = cell.from;
      row.to = cell.to;
      row.quantity = cell.quantity;
      row.rule = paperRules()[column];
      row.estimate.value = cell.errors[column];
      printed.errors.push_back(row);
    }
    Row row;
    row.from = cell.from;
    row.to = cell.to;
    row.quantity = cell.quantity;
    row.rule = "collective";
    row.against = "single";
    row.estimate.value = cell.reduction;
    printed.reductions.push_back(row);
  }
  const std::optional<Agreement> agreement = agreementWithPaper(printed);
  REQUIRE(agreement);
  CHECK(agreement->cells == 12);
  CHECK(agreement->position_signs == 12);
  CHECK(agreement->orientation_signs == 12);
  for (size_t column = 0; column < 4; ++column) {
    CHECK(agreement->position_rms[column] == 0.0);
    CHECK(agreement->orientation_rms[column] == 0.0);
  }
}

TEST_CASE("the transition of the figures is the one that costs most without learning") {
  ExperimentErrors errors = knownErrors();
  TransitionErrors back = errors.transitions[0];
  std::swap(back.from, back.to);
  back.sequences.errors = errorsOf({0.9, 0.2, 0.1, 0.05});
  errors.transitions.push_back(back);
  CHECK(transitionOfFigures(errors, settings(), grounds()) == 1);
  CHECK(wordsOf(back, grounds()) == "road to ice");
}

TEST_CASE("first executions: errors over those of off and of the right set, regions, price") {
  Setting setting;
  setting.surfaces = {"ice", "road"};
  setting.rules = settings().rules;
  const std::string text = textOfFirstExecutions(knownTables(), setting);
  INFO(text);
  const auto lines = linesOf(text);
  const auto after = [&](const std::string& title, size_t row) {
    const auto at = std::find_if(lines.begin(), lines.end(),
                                 [&](const std::string& line) { return line.find(title) == 0; });
    REQUIRE(at != lines.end());
    return *(at + static_cast<std::ptrdiff_t>(row));
  };
  CHECK(after("error ", 3).find("0.100") != std::string::npos);
  CHECK(after("over off ", 3).find("0.250") != std::string::npos);
  CHECK(after("over omniscient ", 3).find("2.000") != std::string::npos);
  CHECK(after("worst over off ", 2).find("0.500") != std::string::npos);
  CHECK(after("position  ", 3).find("2.000") != std::string::npos);
  CHECK(after("new ground", 1).find("omniscient") == 0);
  CHECK(after("new ground", 1).find("90") != std::string::npos);
  CHECK(after("unchanged ground", 1).find("90") != std::string::npos);
}

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/ladder_output.hpp"

#include <cmath>

#include "common/recordings/text_file.hpp"
#include "tools/gap/find_output.hpp"
#include "tools/gap/report/effect_words.hpp"

namespace tread::gap {

using namespace report;

namespace {

constexpr Rung kRivals[] = {Rung::kSlipRegression, Rung::kBlackBox};
constexpr auto kFound = static_cast<size_t>(Rung::kDiscovered);

/// What a table tells of end errors and their differences.
struct Quantity {
  const char* title;
  double unit;  ///< in SI
  int digits;
  ErrorFigure EndErrors::*figure;
  MeanDifference RungDifference::*difference;
};
const Quantity kYaw{"Yaw error after 2 s, open loop [deg]", kPi / 180.0, 1, &EndErrors::yaw,
                    &RungDifference::yaw};
const Quantity kPosition{"Position error after 2 s, open loop [m]", 1.0, 2, &EndErrors::position,
                         &RungDifference::position};

std::string cell(const std::optional<EndErrors>& errors, const Quantity& quantity) {
  if (!errors || errors->executions == 0) return "-";
  const ErrorFigure& figure = (*errors).*quantity.figure;
  return formatted("%.*f / %.*f", quantity.digits, figure.median / quantity.unit, quantity.digits,
                   figure.rms / quantity.unit);
}

std::string cell(const std::optional<RungDifference>& behind, const Quantity& quantity) {
  if (!behind) return "-";
  const MeanDifference& difference = (*behind).*quantity.difference;
  if (!std::isfinite(difference.error)) return "-";
  return formatted("%+.*f +- %.*f", quantity.digits, difference.mean / quantity.unit,
                   quantity.digits, difference.error / quantity.unit);
}

size_t executionsOf(const LadderRow& row) {
  for (const auto& errors : row.errors)
    if (errors) return errors->executions;
  return 0;
}

std::string nameOf(const LadderRow& row) {
  return row.log + (row.structure_nested || !row.errors[kFound] ? "" : " *");
}

Table errorTable(const std::vector<LadderRow>& rows, const Quantity& quantity) {
  Table table;
  table.header = {"log", "n"};
  for (size_t r = 0; r < kRungs; ++r) table.header.push_back(rungName(static_cast<Rung>(r)));
  for (Rung rung : kRivals) table.header.push_back(std::string("D - ") + rungName(rung));
  table.header.emplace_back("encoders + gyro");
  for (const LadderRow& row : rows) {
    if (executionsOf(row) == 0) continue;  // a remark says why
    std::vector<std::string> cells{nameOf(row), std::to_string(executionsOf(row))};
    for (const auto& errors : row.errors) cells.push_back(cell(errors, quantity));
    for (Rung rung : kRivals)
      cells.push_back(cell(row.behind[static_cast<size_t>(rung)], quantity));
    cells.push_back(cell(row.floor, quantity));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string namesOf(const LadderFold& fold) {
  if (!fold.models[kFound]) return "-";
  std::string names;
  for (const std::string& name : fold.models[kFound]->effects)
    names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "nothing" : names;
}

Table nameTable(const std::vector<LadderRow>& rows) {
  Table table{{"log", "learned from", "effects named"}, {}, 3};
  for (const LadderRow& row : rows)
    for (const LadderFold& fold : row.folds)
      table.rows.push_back({row.log, fold.trained_on, namesOf(fold)});
  return table;
}

/// Effects that all folds name, and those that only some do.
std::string agreement(const std::vector<LadderRow>& rows) {
  std::map<std::string, size_t> counts;
  size_t folds = 0;
  for (const LadderRow& row : rows)
    for (const LadderFold& fold : row.folds) {
      if (!fold.models[kFound]) continue;
      ++folds;
      for (const std::string& name : fold.models[kFound]->effects) ++counts[name];
    }
  std::string always;
  std::string sometimes;
  for (const auto& [name, count] : counts) {
    std::string& list = count == folds ? always : sometimes;
    list += (list.empty() ? "" : ", ") + name;
    if (count < folds) list += " (" + std::to_string(count) + ")";
  }
  return "Named in all " + std::to_string(folds) + " folds: " + (always.empty() ? "none" : always) +
         "; in some: " + (sometimes.empty() ? "none" : sometimes) + ".";
}

std::vector<std::string> remarksOf(const std::vector<LadderRow>& rows) {
  std::vector<std::string> remarks;
  bool whole = false;
  for (const LadderRow& row : rows) {
    if (!row.remark.empty()) remarks.push_back(row.log + ": " + row.remark);
    whole = whole || (!row.structure_nested && row.errors[kFound]);
  }
  if (whole)
    remarks.emplace_back(
        "*: too short to choose effects on one half: they were chosen on the whole log, their "
        "sizes on the other half");
  return remarks;
}

Section sectionOf(const std::string& title, const std::vector<LadderRow>& rows) {
  Section section{title, {}};
  for (const Quantity* quantity : {&kYaw, &kPosition}) {
    section.blocks.emplace_back(
        Paragraph{std::string(quantity->title) +
                  ", median / rms; D - another, discovered less another: mean +- standard error "
                  "over blocks, negative = discovered is better"});
    section.blocks.emplace_back(errorTable(rows, *quantity));
  }
  section.blocks.emplace_back(Paragraph{"Effects named"});
  section.blocks.emplace_back(nameTable(rows));
  if (const auto remarks = remarksOf(rows); !remarks.empty())
    section.blocks.emplace_back(Points{remarks});
  return section;
}

}  // namespace

Page ladderPage(const LadderReport& report) {
  Page page;
  page.title = "tread-compare-models";
  page.verdict = "Errors of models that did not see the driving that judges them";
  page.mood = "change";
  page.first = {Points{
      {"ideal: " + (report.model.empty() ? "an ideal differential drive with the track that each "
                                           "recording names"
                                         : report.model + " as it is"),
       "gain + track: command gain, effective track width and latency of the poses fitted",
       "powertrain + ICR: and lag, delay, top speed, left-right asymmetry, centre of rotation",
       "slip regression: powertrain, and slip velocities regressed on the twist: forward ~ v, "
       "sideways ~ v omega, turning ~ v omega, v, omega (DRIVE, arXiv 2309.10718)",
       "black box: powertrain + ICR, and ridge regression of the twist on 37 terms for each part",
       "discovered: what tread-gap find --calibrate finds",
       "encoders + gyro: dead reckoning that has seen the motion"}}};
  page.sections.push_back(
      sectionOf("Each log: one half of its blocks judged by what the other half taught",
                report.ladder.nested));
  if (report.ladder.pooled.empty()) return page;
  page.sections.push_back(
      sectionOf("Each log judged by what all others taught", report.ladder.pooled));
  page.sections.back().blocks.emplace_back(Paragraph{agreement(report.ladder.pooled)});
  return page;
}

void writeLadder(const std::string& folder, const LadderReport& report) {
  makeFolder(folder);
  recordings::writeText(folder + "/ladder.md", markdownOf(ladderPage(report)));
  recordings::writeText(folder + "/ladder.json", ladderJson(report).dump(2) + "\n");
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/comparison_output.hpp"

#include <algorithm>
#include <cmath>

#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "tools/lab/gap/report/sections.hpp"

namespace tread::gap {

using namespace report;

namespace {

constexpr Rung kRivals[] = {Rung::kSlipRegression, Rung::kBlackBox, Rung::kAllParameters,
                            Rung::kSparse};
/// Rungs that name effects.
constexpr Rung kNaming[] = {Rung::kAllParameters, Rung::kSparse, Rung::kDiscovered};

/// A quantity in a table of end errors and their differences.
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

size_t executionsOf(const ComparisonRow& row) {
  for (const auto& errors : row.errors)
    if (errors) return errors->executions;
  return 0;
}

std::string nameOf(const ComparisonRow& row) {
  return row.log + (row.structure_nested || !row.errors[kFound] ? "" : " *");
}

Table errorTable(const std::vector<ComparisonRow>& rows, const Quantity& quantity) {
  Table table;
  table.header = {"log", "n"};
  for (size_t r = 0; r < kRungs; ++r) table.header.push_back(rungName(static_cast<Rung>(r)));
  table.header.emplace_back("encoders + gyro");
  for (const ComparisonRow& row : rows) {
    if (executionsOf(row) == 0) continue;  // a remark gives the reason
    std::vector<std::string> cells{nameOf(row), std::to_string(executionsOf(row))};
    for (const auto& errors : row.errors) cells.push_back(cell(errors, quantity));
    cells.push_back(cell(row.floor, quantity));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// Difference of errors between "discovered" and each rival.
Table differenceTable(const std::vector<ComparisonRow>& rows, const Quantity& quantity) {
  Table table{{"log"}, {}};
  for (Rung rung : kRivals) table.header.push_back(std::string("less ") + rungName(rung));
  for (const ComparisonRow& row : rows) {
    if (executionsOf(row) == 0) continue;
    std::vector<std::string> cells{nameOf(row)};
    for (Rung rung : kRivals)
      cells.push_back(cell(row.behind[static_cast<size_t>(rung)], quantity));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string joined(const std::vector<std::string>& names, const char* none) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? none : all;
}

Table nameTable(const std::vector<ComparisonRow>& rows) {
  Table table{{"log", "learned from", "model", "effects named"}, {}, 4};
  for (const ComparisonRow& row : rows)
    for (const ComparisonFold& fold : row.folds)
      for (Rung rung : kNaming)
        if (const auto& model = fold.models[static_cast<size_t>(rung)])
          table.rows.push_back(
              {row.log, fold.trained_on, rungName(rung), joined(model->effects, "nothing")});
  return table;
}

/// Sizes at the ends of their plausible ranges.
Table runawayTable(const std::vector<ComparisonRow>& rows) {
  Table table{{"log", "learned from", "model", "ran to the ends of their plausible ranges"}, {}, 4};
  for (const ComparisonRow& row : rows)
    for (const ComparisonFold& fold : row.folds)
      for (Rung rung : kNaming) {
        const auto& model = fold.models[static_cast<size_t>(rung)];
        if (model && !model->at_end.empty())
          table.rows.push_back(
              {row.log, fold.trained_on, rungName(rung), joined(model->at_end, "")});
      }
  return table;
}

/// Effects named in all folds, and those named in some.
std::string agreement(const std::vector<ComparisonRow>& rows) {
  std::map<std::string, size_t> counts;
  size_t folds = 0;
  for (const ComparisonRow& row : rows)
    for (const ComparisonFold& fold : row.folds) {
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

std::vector<std::string> remarksOf(const std::vector<ComparisonRow>& rows) {
  std::vector<std::string> remarks;
  bool whole = false;
  for (const ComparisonRow& row : rows) {
    if (!row.remark.empty()) remarks.push_back(row.log + ": " + row.remark);
    whole = whole || (!row.structure_nested && row.errors[kFound]);
  }
  if (whole)
    remarks.emplace_back(
        "*: too short to choose effects on one half: they were chosen on the whole log, their "
        "sizes on the other half");
  return remarks;
}

Section sectionOf(const std::string& title, const std::vector<ComparisonRow>& rows) {
  Section section{title, {}};
  for (const Quantity* quantity : {&kYaw, &kPosition}) {
    section.blocks.emplace_back(Paragraph{std::string(quantity->title) + ", median / rms"});
    section.blocks.emplace_back(errorTable(rows, *quantity));
    section.blocks.emplace_back(
        Paragraph{"Discovered less another, mean +- standard error over blocks; negative = "
                  "discovered is better"});
    section.blocks.emplace_back(differenceTable(rows, *quantity));
  }
  section.blocks.emplace_back(Paragraph{"Effects named"});
  section.blocks.emplace_back(nameTable(rows));
  if (Table runaway = runawayTable(rows); !runaway.rows.empty()) {
    section.blocks.emplace_back(
        Paragraph{"Implausible sizes: no vehicle has them, and another effect may "
                  "compensate them"});
    section.blocks.emplace_back(std::move(runaway));
  }
  if (const auto remarks = remarksOf(rows); !remarks.empty())
    section.blocks.emplace_back(Points{remarks});
  return section;
}

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json errorsJson(const EndErrors& errors) {
  const auto figure = [](const ErrorFigure& of) {
    return Json{{"median", number(of.median)}, {"rms", number(of.rms)}};
  };
  return {{"executions", errors.executions},
          {"yaw_rad", figure(errors.yaw)},
          {"position_m", figure(errors.position)}};
}

Json differenceJson(const RungDifference& behind) {
  const auto difference = [](const MeanDifference& of) {
    return Json{{"mean", number(of.mean)}, {"error", number(of.error)}};
  };
  return {{"yaw_rad", difference(behind.yaw)}, {"position_m", difference(behind.position)}};
}

Json foldJson(const ComparisonFold& fold) {
  Json fitted = Json::object();
  Json named = Json::object();
  Json at_end = Json::object();
  for (size_t r = 0; r < kRungs; ++r) {
    if (!fold.models[r]) continue;
    const auto rung = static_cast<Rung>(r);
    Json numbers = Json::object();
    for (const auto& [path, value] : fold.models[r]->numbers) numbers[path] = number(value);
    fitted[rungKey(rung)] = numbers;
    if (std::find(std::begin(kNaming), std::end(kNaming), rung) == std::end(kNaming)) continue;
    named[rungKey(rung)] = fold.models[r]->effects;
    at_end[rungKey(rung)] = fold.models[r]->at_end;
  }
  return {{"trained_on", fold.trained_on},
          {"named", named},
          {"at_end_of_range", at_end},
          {"fitted", fitted}};
}

Json rowJson(const ComparisonRow& row, const std::string& sha256) {
  Json rungs = Json::object();
  Json less = Json::object();
  for (size_t r = 0; r < kRungs; ++r) {
    const char* key = rungKey(static_cast<Rung>(r));
    if (row.errors[r]) rungs[key] = errorsJson(*row.errors[r]);
    if (row.behind[r]) less[key] = differenceJson(*row.behind[r]);
  }
  Json folds = Json::array();
  for (const ComparisonFold& fold : row.folds) folds.push_back(foldJson(fold));
  return {{"log", row.log},          {"sha256", sha256},
          {"blocks", row.blocks},    {"driven_s", number(row.driven)},
          {"remark", row.remark},    {"structure_nested", row.structure_nested},
          {"rungs", rungs},          {"floor", row.floor ? errorsJson(*row.floor) : Json(nullptr)},
          {"discovered_less", less}, {"folds", folds}};
}

/// Columns padded with spaces, except for the last.
std::string plain(const Table& table) {
  std::vector<std::vector<std::string>> lines{table.header};
  lines.insert(lines.end(), table.rows.begin(), table.rows.end());
  std::vector<size_t> widths(table.header.size(), 0);
  for (const auto& line : lines)
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    for (size_t i = 0; i < line.size(); ++i) {
      const std::string fill(widths[i] - line[i].size(), ' ');
      const bool left = i < table.left;
      text += (i > 0 ? "  " : "") + (left ? line[i] : fill + line[i]);
      if (left && i + 1 < line.size()) text += fill;
    }
    text += "\n";
  }
  return text;
}

struct TextWriter {
  std::string text;

  void operator()(const Paragraph& paragraph) { text += paragraph.text + "\n"; }
  void operator()(const Table& table) { text += plain(table) + "\n"; }
  void operator()(const Points& points) {
    for (const std::string& item : points.items) text += item + "\n";
  }
  void operator()(const Commands&) {}
  void operator()(const Pictures&) {}
};

}  // namespace

Page comparisonPage(const ComparisonReport& report) {
  Page page;
  page.title = "tread-compare-models";
  page.verdict = "Errors of models on held-out driving";
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
       "all parameters: every effect of the catalogue and gains, lag and delay, fitted at once by "
       "least squares within plausible ranges, as the tools of common simulators do",
       "sparse: a sequentially thresholded regression on the directions of the same effects "
       "(SINDy, "
       "Brunton et al. 2016); what it leaves is fitted in the same way",
       "discovered: what tread-gap find --calibrate finds",
       "encoders + gyro: dead reckoning with the measured motion"}}};
  page.sections.push_back(
      sectionOf("Each log: one half of its blocks, predicted by models fitted to the other half",
                report.comparison.nested));
  if (report.comparison.pooled.empty()) return page;
  page.sections.push_back(
      sectionOf("Each log, predicted by models fitted to all others", report.comparison.pooled));
  page.sections.back().blocks.emplace_back(Paragraph{agreement(report.comparison.pooled)});
  return page;
}

void writeComparison(const std::string& folder, const ComparisonReport& report) {
  OutputFolder files(folder);
  writeText(files.path() + "/comparison.md", markdownOf(comparisonPage(report)));
  writeText(files.path() + "/comparison.json", comparisonJson(report).dump(2) + "\n");
  files.commit();
}

nlohmann::ordered_json comparisonJson(const ComparisonReport& report) {
  const auto rows = [&report](const std::vector<ComparisonRow>& of) {
    Json all = Json::array();
    for (size_t i = 0; i < of.size(); ++i) all.push_back(rowJson(of[i], report.sha256[i]));
    return all;
  };
  return {{"tool", toolVersion()},
          {"seed", report.comparison.seed},
          {"model", report.model},
          {"nested", rows(report.comparison.nested)},
          {"pooled", rows(report.comparison.pooled)}};
}

std::string comparisonText(const ComparisonReport& report) {
  TextWriter writer;
  for (const Section& section : comparisonPage(report).sections) {
    writer.text += "\n" + section.title + "\n\n";
    for (const Block& block : section.blocks) std::visit(writer, block);
  }
  return writer.text;
}

}  // namespace tread::gap

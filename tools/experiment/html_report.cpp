// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "common/report/text.hpp"
#include "tools/experiment/batch.hpp"
#include "tools/experiment/figures.hpp"
#include "tools/experiment/paper_numbers.hpp"

namespace tread::experiment {
namespace {

const char* const kHtmlHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Transitions between surfaces</title><style>
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1240px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
table { border-collapse: collapse; margin: .6em 0; font-variant-numeric: tabular-nums; }
th, td { padding: .15em .55em; text-align: right; white-space: nowrap; }
th { font-weight: 600; } thead tr:last-child th { border-bottom: 1.5px solid #555; }
td.name, th.name { text-align: left; } tr.first td, tr.first th { border-top: 1px solid #ccc; }
td.group, th.group { border-left: 1px solid #ccc; } .worse { color: #b03a00; }
.paper { display: block; color: #777; font-size: .8em; } .doubt { border-bottom: 1px dotted #b03a00; }
.wide { overflow-x: auto; } img { max-width: 100%; } pre { overflow-x: auto; font-size: .85em; }
p.small { color: #555; font-size: .9em; }
</style></head><body>
)";

std::string picture(const std::string& png, const std::string& words) {
  return "<p><img alt=\"" + escaped(words) + "\" src=\"data:image/png;base64," + base64(png) +
         "\"></p>\n";
}

std::string cell(const std::string& inside, const std::string& tip = "", bool group = false) {
  return "<td" + std::string(group ? " class=\"group\"" : "") +
         (tip.empty() ? "" : " title=\"" + escaped(tip) + "\"") + ">" + inside + "</td>";
}

std::string paperWords(double value, const char* format, const std::string& doubt) {
  const std::string text = formatted(format, value);
  if (doubt.empty()) return "<span class=\"paper\">" + text + "</span>";
  return "<span class=\"paper\"><span class=\"doubt\" title=\"" + escaped(doubt) + "\">" + text +
         "?</span></span>";
}

std::string intervalWords(const Row& row, const char* format) {
  std::string words = "99 %: " + formatted(format, row.estimate.low) + " to " +
                      formatted(format, row.estimate.high);
  if (std::isfinite(row.spread)) words += "; deviation over books " + formatted(format, row.spread);
  return words;
}

std::string rowBegin(bool first) {
  return first ? "<tr class=\"first\">" : "<tr>";
}

std::string nameCell(const std::string& name) {
  return "<td class=\"name\">" + escaped(name) + "</td>";
}

/// A table with one heading for each of some names, after the first cells of the head.
std::string table(const std::string& head, const std::vector<std::string>& names,
                  const std::string& rows) {
  std::string text = "<table><thead><tr><th class=\"name\">" + head;
  for (const std::string& name : names) text += "<th>" + escaped(name) + "</th>";
  return text + "</tr></thead><tbody>\n" + rows + "</tbody></table>";
}

std::string section(const std::string& title, const std::string& text) {
  return text.empty() ? "" : "<h2>" + title + "</h2>\n<pre>" + escaped(text) + "</pre>\n";
}

/// Writes the tables of one batch.
class Writer {
 public:
  explicit Writer(const Batch& batch)
      : batch_(batch), tables_(batch.tables), setting_(batch.setting) {}

  std::string html(const Pictures& pictures) const;

 private:
  std::string about() const;
  std::string errors() const;
  std::string errorTable(const std::vector<std::string>& rules) const;
  std::string errorRow(const std::vector<std::string>& rules, const std::string& from,
                       const char* quantity) const;
  std::string reductions() const;
  std::string reductionTable(const std::string& rule, const std::string& against) const;
  std::string reductionCell(const Row* row, bool with_paper) const;
  std::string allPatterns() const;
  std::string unchanged() const;
  std::string unchangedTable(const std::vector<Row>& of) const;
  std::string bothCell(const std::vector<Row>& rows, const std::string& from, const std::string& to,
                       const std::string& rule, int k = 0) const;
  std::string drift(const std::string& png) const;
  std::string notes() const;
  const Batch& batch_;
  const Tables& tables_;
  const Setting& setting_;
};

std::string Writer::about() const {
  const Request& request = batch_.request;
  std::string text = "<h1>Transitions between surfaces: " + escaped(batch_.source) + "</h1>\n<p>";
  text += std::to_string(request.repetitions) + " repetitions of each transition";
  text += ", memory w = " + formatted("%g", request.memory);
  text += ", seed " + std::to_string(request.seed);
  if (request.books > 1)
    text += ", means over " + std::to_string(request.books) + " books of recordings";
  if (request.length > 1)
    text += ", each command held " + std::to_string(request.length) + " times as long";
  if (request.change_inside) text += "; the ground changes in the middle of the first execution";
  text += ". Test sequences:";
  const auto& patterns = batch_.grounds.front().averaged.patterns();
  for (const Sequence& sequence : batch_.settings.sequences) {
    text += sequence == batch_.settings.sequences.front() ? " " : "; ";
    for (size_t j = 0; j < sequence.size(); ++j)
      text += (j > 0 ? ", " : "") + escaped(patterns[sequence[j]].name);
  }
  return text + ".</p>\n";
}

std::string Writer::errorRow(const std::vector<std::string>& rules, const std::string& from,
                             const char* quantity) const {
  const bool first = std::string(quantity) == kPosition;
  std::string text = rowBegin(first) + nameCell(first ? from : "") + nameCell(quantity);
  for (const std::string& to : setting_.surfaces)
    for (const std::string& rule : rules) {
      const bool group = rule == rules.front();
      const Row* row = find(tables_.errors, from, to, quantity, rule);
      if (row == nullptr) {
        text += cell("-", "", group);
        continue;
      }
      std::string inside = formatted("%.3f", row->estimate.value);
      const PaperCell* paper = paperCell(from, to, quantity);
      for (size_t c = 0; c < 4 && setting_.paper_reference && paper != nullptr; ++c)
        if (paperRules()[c] == rule)
          inside += paperWords(paper->errors[c], "%.3f", doubtOfError(*paper, c));
      text += cell(inside, intervalWords(*row, "%.4f"), group);
    }
  return text + "</tr>\n";
}

std::string Writer::errorTable(const std::vector<std::string>& rules) const {
  std::string text = "<div class=\"wide\"><table><thead><tr><th></th><th></th>";
  for (const std::string& to : setting_.surfaces)
    text += "<th class=\"group\" style=\"text-align:center\" colspan=\"" +
            std::to_string(rules.size()) + "\">" + escaped(to) + "</th>";
  text += "</tr><tr><th class=\"name\">from</th><th></th>";
  for (size_t s = 0; s < setting_.surfaces.size(); ++s)
    for (const std::string& rule : rules)
      text += "<th" + std::string(rule == rules.front() ? " class=\"group\"" : "") + ">" +
              escaped(rule) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& from : setting_.surfaces)
    for (const char* quantity : kQuantities) text += errorRow(rules, from, quantity);
  return text + "</tbody></table></div>\n";
}

std::string Writer::errors() const {
  std::string text =
      "<h2>Table I: errors</h2>\n<p class=\"small\">Position per driven metre, orientation per "
      "radian turned; rows from, groups of columns to. " +
      std::string(setting_.paper_reference ? "Grey: the paper's numbers, ? = probably misprinted. "
                                           : "") +
      "The 99 % interval of a number appears under the pointer.</p>\n";
  for (const std::vector<std::string>& rules : columnGroups(setting_)) text += errorTable(rules);
  return text + "<pre>" + escaped(textOfAgreement(tables_, setting_, batch_.books)) + "</pre>\n";
}

std::string Writer::reductionCell(const Row* row, bool with_paper) const {
  if (row == nullptr) return cell("-");
  std::string inside = formatted("%.1f", row->estimate.value);
  inside += setting_.books > 1
                ? formatted(" &plusmn; %.1f", row->spread)
                : formatted(" [%.1f", row->estimate.low) + formatted(", %.1f]", row->estimate.high);
  if (row->estimate.value < 0.0) inside = "<span class=\"worse\">" + inside + "</span>";
  const PaperCell* paper = with_paper ? paperCell(row->from, row->to, row->quantity) : nullptr;
  if (paper != nullptr) inside += paperWords(paper->reduction, "%.1f", doubtOfReduction(*paper));
  return cell(inside, intervalWords(*row, "%.2f"));
}

std::string Writer::reductionTable(const std::string& rule, const std::string& against) const {
  const bool papers = setting_.paper_reference && rule == "collective" && against == "single";
  std::string rows;
  for (const std::string& from : setting_.surfaces)
    for (const char* quantity : kQuantities) {
      const bool first = std::string(quantity) == kPosition;
      rows += rowBegin(first) + nameCell(first ? from : "") + nameCell(quantity);
      for (const std::string& to : setting_.surfaces)
        rows += reductionCell(find(tables_.reductions, from, to, quantity, rule, against), papers);
      rows += "</tr>\n";
    }
  return "<h3>" + escaped(rule) + " against " + escaped(against) + "</h3>" +
         table("from</th><th></th>", setting_.surfaces, rows) + "\n";
}

std::string Writer::reductions() const {
  std::string text = "<h2>Table II: error reductions in per cent</h2>\n<p class=\"small\">";
  text += setting_.books > 1 ? "Mean and deviation over the books of recordings."
                             : "With paired 99 % intervals.";
  text += "</p>\n";
  for (const char* against : {"single", "off"})
    for (const std::string& rule : learningRules(setting_.rules))
      if (find(tables_.reductions, setting_.surfaces[0], setting_.surfaces[1], kPosition, rule,
               against) != nullptr)
        text += reductionTable(rule, against);
  return text;
}

/// Position and orientation in one cell.
std::string Writer::bothCell(const std::vector<Row>& rows, const std::string& from,
                             const std::string& to, const std::string& rule, int k) const {
  const auto value = [&](const char* quantity) {
    return formatted("%.3f", find(rows, from, to, quantity, rule, "", k)->estimate.value);
  };
  return cell(value(kPosition) + " / " + value(kOrientation));
}

std::string Writer::allPatterns() const {
  std::string rows;
  for (const std::string& from : setting_.surfaces)
    for (const std::string& to : setting_.surfaces)
      for (const int k : batch_.settings.all_patterns_after) {
        if (from == to) continue;
        const bool first = k == batch_.settings.all_patterns_after.front();
        rows +=
            rowBegin(first) + nameCell(first ? from + " to " + to : "") + cell(std::to_string(k));
        for (const std::string& rule : setting_.rules)
          rows += bothCell(tables_.all_patterns, from, to, rule, k);
        rows += "</tr>\n";
      }
  return "<h2>Errors over all patterns after k executions</h2>\n<p class=\"small\">Fresh "
         "recordings of each pattern; position / orientation.</p>\n<div class=\"wide\">" +
         table("transition</th><th>k</th>", setting_.rules, rows) + "</div>\n";
}

std::string Writer::unchangedTable(const std::vector<Row>& of) const {
  std::string rows;
  for (const std::string& surface : setting_.surfaces) {
    rows += rowBegin(false) + nameCell(surface);
    for (const std::string& rule : setting_.rules) rows += bothCell(of, surface, surface, rule);
    rows += "</tr>\n";
  }
  return table("surface</th>", setting_.rules, rows) + "\n";
}

std::string Writer::unchanged() const {
  if (tables_.unchanged.empty()) return "";
  return "<h2>Cost on an unchanged surface</h2>\n<p class=\"small\">Error in the long run over "
         "that of the right set; position / orientation. Patterns in random order:</p>\n" +
         unchangedTable(tables_.unchanged) +
         "<p class=\"small\">The test sequences again and again:</p>\n" +
         unchangedTable(tables_.unchanged_sequences);
}

std::string Writer::drift(const std::string& png) const {
  if (png.empty()) return "";
  return "<h2>Drift on an unchanged surface</h2>\n" + picture(png, "drift") + "<pre>" +
         escaped(textOfDrift(batch_)) + "</pre>\n";
}

std::string Writer::notes() const {
  if (batch_.notes.empty()) return "";
  std::string text = "<h2>About the recordings</h2>\n<ul>\n";
  for (const std::string& note : batch_.notes) text += "<li>" + escaped(note) + "</li>\n";
  return text + "</ul>\n";
}

std::string Writer::html(const Pictures& pictures) const {
  const size_t shown = transitionOfFigures(batch_.first, batch_.settings, batch_.grounds);
  const std::string words = wordsOf(batch_.first.transitions[shown], batch_.grounds);
  std::string text = kHtmlHead + about() + "<pre>" +
                     escaped(textOfKeyFigures(tables_, setting_, batch_.books)) + "</pre>\n" +
                     errors() + reductions();
  text += "<h2>Figure 4: from " + escaped(words) + ", error over executions</h2>\n" +
          picture(pictures.figure4, "error over executions");
  text += "<h2>Figure 5: from " + escaped(words) + ", error distributions</h2>\n" +
          picture(pictures.figure5, "error distributions");
  return text + allPatterns() + unchanged() + drift(pictures.drift) +
         section("What the bank met before", textOfBank(batch_)) +
         section("On other terms", textOfVariants(batch_)) + notes() + "</body></html>\n";
}

}  // namespace

std::string htmlOf(const Batch& batch, const Pictures& pictures) {
  return Writer(batch).html(pictures);
}

}  // namespace tread::experiment

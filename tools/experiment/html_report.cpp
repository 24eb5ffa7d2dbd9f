// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/experiment/campaign.hpp"
#include "tools/experiment/figures.hpp"
#include "tools/experiment/paper_numbers.hpp"

namespace tread::experiment {
namespace {

const char* const kQuantities[] = {kPosition, kOrientation};

const char* const kHead = R"(<!DOCTYPE html>
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

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else if (letter == '&')
      safe += "&amp;";
    else if (letter == '"')
      safe += "&quot;";
    else
      safe += letter;
  }
  return safe;
}

std::string base64(const std::string& bytes) {
  static const char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kLetters[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string picture(const std::string& png, const std::string& words) {
  return "<p><img alt=\"" + escaped(words) + "\" src=\"data:image/png;base64," + base64(png) +
         "\"></p>\n";
}

std::string cell(const std::string& inside, const std::string& tip = "", bool group = false) {
  return "<td" + std::string(group ? " class=\"group\"" : "") +
         (tip.empty() ? "" : " title=\"" + escaped(tip) + "\"") + ">" + inside + "</td>";
}

std::string paperWords(double value, const char* format, const std::string& doubt) {
  const std::string text = number(format, value);
  if (doubt.empty()) return "<span class=\"paper\">" + text + "</span>";
  return "<span class=\"paper\"><span class=\"doubt\" title=\"" + escaped(doubt) + "\">" + text +
         "?</span></span>";
}

std::string intervalWords(const Row& row, const char* format) {
  std::string words =
      "99 %: " + number(format, row.estimate.low) + " to " + number(format, row.estimate.high);
  if (std::isfinite(row.spread)) words += "; deviation over books " + number(format, row.spread);
  return words;
}

/// Writes the tables of one campaign.
class Writer {
 public:
  explicit Writer(const Campaign& campaign)
      : campaign_(campaign), tables_(campaign.tables), setting_(campaign.setting) {}

  std::string html(const std::string& figure4, const std::string& figure5) const;

 private:
  std::string about() const;
  std::string errors() const;
  std::string errorRow(const std::string& from, const char* quantity) const;
  std::string reductions() const;
  std::string reductionTable(const std::string& rule, const std::string& against) const;
  std::string reductionCell(const Row* row, bool with_paper) const;
  std::string allPatterns() const;
  std::string unchanged() const;
  std::string notes() const;
  bool isPapers(const std::string& rule, const std::string& against) const {
    return setting_.paper_reference && rule == "collective" && against == "single";
  }

  const Campaign& campaign_;
  const Tables& tables_;
  const Setting& setting_;
};

std::string Writer::about() const {
  const Request& request = campaign_.request;
  std::string text =
      "<h1>Transitions between surfaces: " + escaped(campaign_.source) + "</h1>\n<p>";
  text += std::to_string(request.repetitions) + " repetitions of each transition";
  text += ", memory w = " + number("%g", request.memory);
  text += ", seed " + std::to_string(request.seed);
  if (request.books > 1)
    text += ", means over " + std::to_string(request.books) + " books of recordings";
  if (request.length > 1)
    text += ", each command held " + std::to_string(request.length) + " times as long";
  if (request.change_inside) text += "; the ground changes in the middle of the first execution";
  text += ". Test sequences:";
  const auto& patterns = campaign_.grounds.front().averaged.patterns();
  for (const Sequence& sequence : campaign_.settings.sequences) {
    text += sequence == campaign_.settings.sequences.front() ? " " : "; ";
    for (size_t j = 0; j < sequence.size(); ++j)
      text += (j > 0 ? ", " : "") + escaped(patterns[sequence[j]].name);
  }
  return text + ".</p>\n";
}

std::string Writer::errorRow(const std::string& from, const char* quantity) const {
  const bool first = std::string(quantity) == kPosition;
  std::string text = first ? "<tr class=\"first\">" : "<tr>";
  text += "<td class=\"name\">" + (first ? escaped(from) : "") + "</td><td class=\"name\">" +
          quantity + "</td>";
  for (const std::string& to : setting_.surfaces)
    for (const std::string& rule : setting_.rules) {
      const bool group = rule == setting_.rules.front();
      const Row* row = find(tables_.errors, from, to, quantity, rule);
      if (row == nullptr) {
        text += cell("-", "", group);
        continue;
      }
      std::string inside = number("%.3f", row->estimate.value);
      const PaperCell* paper = paperCell(from, to, quantity);
      for (size_t c = 0; c < 4 && setting_.paper_reference && paper != nullptr; ++c)
        if (paperRules()[c] == rule)
          inside += paperWords(paper->errors[c], "%.3f", doubtOfError(*paper, c));
      text += cell(inside, intervalWords(*row, "%.4f"), group);
    }
  return text + "</tr>\n";
}

std::string Writer::errors() const {
  std::string text =
      "<h2>Table I: errors</h2>\n<p class=\"small\">Position per driven metre, orientation per "
      "radian turned; rows from, groups of columns to. " +
      std::string(setting_.paper_reference ? "Grey: the paper's numbers, ? = probably misprinted. "
                                           : "") +
      "The 99 % interval of a number appears under the pointer.</p>\n<div class=\"wide\"><table>"
      "<thead><tr><th></th><th></th>";
  for (const std::string& to : setting_.surfaces)
    text += "<th class=\"group\" style=\"text-align:center\" colspan=\"" +
            std::to_string(setting_.rules.size()) + "\">" + escaped(to) + "</th>";
  text += "</tr><tr><th class=\"name\">from</th><th></th>";
  for (size_t s = 0; s < setting_.surfaces.size(); ++s)
    for (const std::string& rule : setting_.rules)
      text += "<th" + std::string(rule == setting_.rules.front() ? " class=\"group\"" : "") + ">" +
              escaped(rule) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& from : setting_.surfaces)
    for (const char* quantity : kQuantities) text += errorRow(from, quantity);
  return text + "</tbody></table></div>\n<pre>" +
         escaped(textOfAgreement(tables_, setting_, campaign_.books)) + "</pre>\n";
}

std::string Writer::reductionCell(const Row* row, bool with_paper) const {
  if (row == nullptr) return cell("-");
  std::string inside = number("%.1f", row->estimate.value);
  inside += setting_.books > 1
                ? number(" &plusmn; %.1f", row->spread)
                : number(" [%.1f", row->estimate.low) + number(", %.1f]", row->estimate.high);
  if (row->estimate.value < 0.0) inside = "<span class=\"worse\">" + inside + "</span>";
  const PaperCell* paper = with_paper ? paperCell(row->from, row->to, row->quantity) : nullptr;
  if (paper != nullptr) inside += paperWords(paper->reduction, "%.1f", doubtOfReduction(*paper));
  return cell(inside, intervalWords(*row, "%.2f"));
}

std::string Writer::reductionTable(const std::string& rule, const std::string& against) const {
  std::string text = "<h3>" + escaped(rule) + " against " + escaped(against) +
                     "</h3><table><thead><tr><th class=\"name\">from</th><th></th>";
  for (const std::string& to : setting_.surfaces) text += "<th>" + escaped(to) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& from : setting_.surfaces)
    for (const char* quantity : kQuantities) {
      const bool first = std::string(quantity) == kPosition;
      text += std::string(first ? "<tr class=\"first\">" : "<tr>") + "<td class=\"name\">" +
              (first ? escaped(from) : "") + "</td><td class=\"name\">" + quantity + "</td>";
      for (const std::string& to : setting_.surfaces)
        text += reductionCell(find(tables_.reductions, from, to, quantity, rule, against),
                              isPapers(rule, against));
      text += "</tr>\n";
    }
  return text + "</tbody></table>\n";
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

std::string Writer::allPatterns() const {
  std::string text =
      "<h2>Errors over all patterns after k executions</h2>\n<p class=\"small\">Fresh recordings "
      "of each pattern; position / orientation.</p>\n<div class=\"wide\"><table><thead><tr><th "
      "class=\"name\">transition</th><th>k</th>";
  for (const std::string& rule : setting_.rules) text += "<th>" + escaped(rule) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& from : setting_.surfaces)
    for (const std::string& to : setting_.surfaces)
      for (const int k : campaign_.settings.all_patterns_after) {
        if (from == to) continue;
        const bool first = k == campaign_.settings.all_patterns_after.front();
        text += std::string(first ? "<tr class=\"first\">" : "<tr>") + "<td class=\"name\">" +
                (first ? escaped(from + " to " + to) : "") + "</td>" + cell(std::to_string(k));
        for (const std::string& rule : setting_.rules) {
          const Row* position = find(tables_.all_patterns, from, to, kPosition, rule, "", k);
          const Row* turn = find(tables_.all_patterns, from, to, kOrientation, rule, "", k);
          text += cell(number("%.3f", position->estimate.value) + " / " +
                       number("%.3f", turn->estimate.value));
        }
        text += "</tr>\n";
      }
  return text + "</tbody></table></div>\n";
}

std::string Writer::unchanged() const {
  if (tables_.unchanged.empty()) return "";
  std::string text =
      "<h2>Cost on an unchanged surface</h2>\n<p class=\"small\">Error in the long run, patterns "
      "in random order, over that of the right set; position / "
      "orientation.</p>\n<table><thead><tr><th class=\"name\">surface</th>";
  for (const std::string& rule : setting_.rules) text += "<th>" + escaped(rule) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& surface : setting_.surfaces) {
    text += "<tr><td class=\"name\">" + escaped(surface) + "</td>";
    for (const std::string& rule : setting_.rules) {
      const Row* position = find(tables_.unchanged, surface, surface, kPosition, rule);
      const Row* turn = find(tables_.unchanged, surface, surface, kOrientation, rule);
      text += cell(number("%.3f", position->estimate.value) + " / " +
                   number("%.3f", turn->estimate.value));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table>\n";
}

std::string Writer::notes() const {
  if (campaign_.notes.empty()) return "";
  std::string text = "<h2>About the recordings</h2>\n<ul>\n";
  for (const std::string& note : campaign_.notes) text += "<li>" + escaped(note) + "</li>\n";
  return text + "</ul>\n";
}

std::string Writer::html(const std::string& figure4, const std::string& figure5) const {
  const size_t shown = transitionOfFigures(campaign_.first, campaign_.settings, campaign_.grounds);
  const std::string words = wordsOf(campaign_.first.transitions[shown], campaign_.grounds);
  std::string text = kHead + about() + "<pre>" +
                     escaped(textOfKeyFigures(tables_, setting_, campaign_.books) + "\n" +
                             textOfTours(campaign_)) +
                     "</pre>\n" + errors() + reductions();
  text += "<h2>Figure 4: from " + escaped(words) + ", error over executions</h2>\n" +
          picture(figure4, "error over executions");
  text += "<h2>Figure 5: from " + escaped(words) + ", error distributions</h2>\n" +
          picture(figure5, "error distributions");
  return text + allPatterns() + unchanged() + notes() + "</body></html>\n";
}

}  // namespace

std::string htmlOf(const Campaign& campaign, const std::string& figure4_png,
                   const std::string& figure5_png) {
  return Writer(campaign).html(figure4_png, figure5_png);
}

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/campaign.hpp"
#include "tools/experiment/figures.hpp"
#include "tools/experiment/html_words.hpp"
#include "tools/experiment/paper_numbers.hpp"

namespace tread::experiment {
namespace {

const char* const kQuantities[] = {kPosition, kOrientation};

/// Writes the tables of one campaign.
class Writer {
 public:
  explicit Writer(const Campaign& campaign)
      : campaign_(campaign), tables_(campaign.tables), setting_(campaign.setting) {}

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
  std::string unchangedTable(const std::vector<Row>& rows) const;
  std::string drift(const std::string& png) const;
  std::string bank() const;
  std::string variants() const;
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

std::string Writer::errorRow(const std::vector<std::string>& rules, const std::string& from,
                             const char* quantity) const {
  const bool first = std::string(quantity) == kPosition;
  std::string text = first ? "<tr class=\"first\">" : "<tr>";
  text += "<td class=\"name\">" + (first ? escaped(from) : "") + "</td><td class=\"name\">" +
          quantity + "</td>";
  for (const std::string& to : setting_.surfaces)
    for (const std::string& rule : rules) {
      const bool group = rule == rules.front();
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
  return text + "<pre>" + escaped(textOfAgreement(tables_, setting_, campaign_.books)) + "</pre>\n";
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

std::string Writer::unchangedTable(const std::vector<Row>& rows) const {
  std::string text = "<table><thead><tr><th class=\"name\">surface</th>";
  for (const std::string& rule : setting_.rules) text += "<th>" + escaped(rule) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::string& surface : setting_.surfaces) {
    text += "<tr><td class=\"name\">" + escaped(surface) + "</td>";
    for (const std::string& rule : setting_.rules) {
      const Row* position = find(rows, surface, surface, kPosition, rule);
      const Row* turn = find(rows, surface, surface, kOrientation, rule);
      text += cell(number("%.3f", position->estimate.value) + " / " +
                   number("%.3f", turn->estimate.value));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table>\n";
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
         escaped(textOfDrift(campaign_)) + "</pre>\n";
}

std::string Writer::bank() const {
  if (campaign_.tours.empty()) return "";
  return "<h2>What the bank met before</h2>\n<pre>" + escaped(textOfBank(campaign_)) + "</pre>\n";
}

std::string Writer::variants() const {
  if (campaign_.variants.empty()) return "";
  return "<h2>On other terms</h2>\n<pre>" + escaped(textOfVariants(campaign_)) + "</pre>\n";
}

std::string Writer::notes() const {
  if (campaign_.notes.empty()) return "";
  std::string text = "<h2>About the recordings</h2>\n<ul>\n";
  for (const std::string& note : campaign_.notes) text += "<li>" + escaped(note) + "</li>\n";
  return text + "</ul>\n";
}

std::string Writer::html(const Pictures& pictures) const {
  const size_t shown = transitionOfFigures(campaign_.first, campaign_.settings, campaign_.grounds);
  const std::string words = wordsOf(campaign_.first.transitions[shown], campaign_.grounds);
  std::string text = kHtmlHead + about() + "<pre>" +
                     escaped(textOfKeyFigures(tables_, setting_, campaign_.books)) + "</pre>\n" +
                     errors() + reductions();
  text += "<h2>Figure 4: from " + escaped(words) + ", error over executions</h2>\n" +
          picture(pictures.figure4, "error over executions");
  text += "<h2>Figure 5: from " + escaped(words) + ", error distributions</h2>\n" +
          picture(pictures.figure5, "error distributions");
  return text + allPatterns() + unchanged() + drift(pictures.drift) + bank() + variants() +
         notes() + "</body></html>\n";
}

}  // namespace

std::string htmlOf(const Campaign& campaign, const Pictures& pictures) {
  return Writer(campaign).html(pictures);
}

}  // namespace tread::experiment

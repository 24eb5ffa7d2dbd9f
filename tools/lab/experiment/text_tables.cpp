// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/experiment/text_tables.hpp"

#include <algorithm>

#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::experiment {
namespace {

std::string padded(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string centred(const std::string& text, size_t width) {
  if (text.size() >= width) return text;
  const size_t left = (width - text.size()) / 2;
  return padded(std::string(left, ' ') + text, width);
}

constexpr size_t kRowHead = 22;

/// Head and body of a Table I; cell(from, to, quantity, column) returns six characters. The
/// columns' letters begin with `first`.
template <class Cell>
std::string grid(const Setting& setting, size_t columns, char first, const Cell& cell) {
  const size_t group = 7 * columns + 2;
  std::string text = padded("from \\ to", kRowHead);
  for (const std::string& to : setting.surfaces) text += "| " + centred(to, group - 2);
  text += "\n" + std::string(kRowHead, ' ');
  for (size_t s = 0; s < setting.surfaces.size(); ++s) {
    text += "|";
    for (size_t c = 0; c < columns; ++c)
      text += "    " + std::string(1, static_cast<char>(first + static_cast<char>(c))) + "  ";
    text += " ";
  }
  text += "\n";
  for (const std::string& from : setting.surfaces)
    for (const char* quantity : kQuantities) {
      const std::string name = std::string(quantity) == kPosition ? from : "";
      text += padded(padded(name, 10) + quantity, kRowHead);
      for (const std::string& to : setting.surfaces) {
        text += "|";
        for (size_t c = 0; c < columns; ++c) text += " " + cell(from, to, quantity, c);
        text += " ";
      }
      text += "\n";
    }
  return text;
}

std::string paperGrid(const Setting& setting) {
  std::string notes;
  std::string text =
      grid(setting, 4, 'a',
           [&](const std::string& from, const std::string& to, const std::string& quantity,
               size_t column) {
             const PaperCell* cell = paperCell(from, to, quantity);
             if (cell == nullptr) return std::string("  -   ");
             const std::string doubt = doubtOfError(*cell, column);
             const bool told = notes.find(doubt) != std::string::npos;
             if (!doubt.empty() && !told)
               notes += "  ? " + from + " -> " + to + ", " + quantity + ": " + doubt + "\n";
             return formatted("%5.3f", cell->errors[column]) + (doubt.empty() ? " " : "?");
           });
  return text + notes;
}

std::string reductionCell(const Row* row, const Setting& setting, const std::string& paper) {
  if (row == nullptr) return "-";
  const Estimate& e = row->estimate;
  std::string text = formatted("%.1f", e.value);
  if (setting.sets > 1)
    text += " +-" + formatted("%.1f", row->spread);
  else
    text += " [" + formatted("%.1f", e.low) + ", " + formatted("%.1f", e.high) + "]";
  return paper.empty() ? text : text + " (" + paper + ")";
}

std::string reductionGrid(const Tables& tables, const Setting& setting, const std::string& rule,
                          const std::string& against, bool with_paper) {
  constexpr size_t kWidth = 27;
  std::string text = padded("from \\ to", kRowHead);
  for (const std::string& to : setting.surfaces) text += centred(to, kWidth);
  text += "\n";
  for (const std::string& from : setting.surfaces)
    for (const char* quantity : kQuantities) {
      const std::string name = std::string(quantity) == kPosition ? from : "";
      text += padded(padded(name, 10) + quantity, kRowHead);
      for (const std::string& to : setting.surfaces) {
        const PaperCell* cell = with_paper ? paperCell(from, to, quantity) : nullptr;
        std::string paper;
        if (cell != nullptr)
          paper = formatted("%.1f", cell->reduction) + (doubtOfReduction(*cell).empty() ? "" : "?");
        const Row* row = find(tables.reductions, from, to, quantity, rule, against);
        text += centred(reductionCell(row, setting, paper), kWidth);
      }
      text += "\n";
    }
  return text;
}

std::string rmsLine(const std::string& name, const std::array<double, 4>& rms) {
  std::string line = "  " + padded(name, 12);
  for (size_t c = 0; c < 4; ++c)
    line += std::string("  ") + static_cast<char>('a' + c) + formatted(" %.4f", rms[c]);
  return line + "\n";
}

/// The largest deviations and the extreme numbers of signs over single sets of recordings.
std::string extremesLines(const std::vector<Tables>& sets) {
  Agreement most = *agreementWithPaper(sets.front()), fewest = most;
  for (const Tables& set : sets) {
    const Agreement one = *agreementWithPaper(set);
    for (size_t c = 0; c < 4; ++c) {
      most.position_rms[c] = std::max(most.position_rms[c], one.position_rms[c]);
      most.orientation_rms[c] = std::max(most.orientation_rms[c], one.orientation_rms[c]);
    }
    most.position_signs = std::max(most.position_signs, one.position_signs);
    most.orientation_signs = std::max(most.orientation_signs, one.orientation_signs);
    fewest.position_signs = std::min(fewest.position_signs, one.position_signs);
    fewest.orientation_signs = std::min(fewest.orientation_signs, one.orientation_signs);
  }
  std::string text = "Of single sets at most:\n" + rmsLine(kPosition, most.position_rms) +
                     rmsLine(kOrientation, most.orientation_rms);
  if (most.cells > 0)
    text += "  signs: orientation " + std::to_string(fewest.orientation_signs) + " to " +
            std::to_string(most.orientation_signs) + ", position " +
            std::to_string(fewest.position_signs) + " to " + std::to_string(most.position_signs) +
            "\n";
  return text;
}

std::string spreadNote(const Tables& tables, const Setting& setting) {
  if (setting.sets < 2) return "";
  double largest[2] = {0.0, 0.0};
  for (const Row& row : tables.errors)
    if (row.from != row.to) {
      double& most = largest[row.quantity == kPosition ? 0 : 1];
      most = std::max(most, row.spread);
    }
  return "Means over " + std::to_string(setting.sets) +
         " sets of recordings; largest deviation of a cell from set to set: position " +
         formatted("%.4f", largest[0]) + ", orientation " + formatted("%.4f", largest[1]) + ".\n";
}

}  // namespace

std::vector<std::vector<std::string>> columnGroups(const Setting& setting) {
  constexpr size_t kWidest = 158;
  const auto has = [](const std::vector<std::string>& list, const std::string& rule) {
    return std::find(list.begin(), list.end(), rule) != list.end();
  };
  std::vector<std::string> papers, others;
  for (const std::string& rule : paperRules())
    if (has(setting.rules, rule)) papers.push_back(rule);
  for (const std::string& rule : setting.rules)
    if (!has(papers, rule)) others.push_back(rule);
  const size_t surface = (kWidest - kRowHead) / std::max<size_t>(1, setting.surfaces.size());
  const size_t most = surface < 9 + 7 ? 1 : (surface - 2) / 7;
  std::vector<std::vector<std::string>> groups;
  if (papers.size() + others.size() <= most) {
    papers.insert(papers.end(), others.begin(), others.end());
    return {papers};
  }
  for (const auto& rules : {papers, others}) {
    const size_t parts = (rules.size() + most - 1) / most;
    for (size_t part = 0; part < parts; ++part)
      groups.emplace_back(rules.begin() + static_cast<long>(rules.size() * part / parts),
                          rules.begin() + static_cast<long>(rules.size() * (part + 1) / parts));
  }
  return groups;
}

std::string textOfErrors(const Tables& tables, const Setting& setting) {
  std::string text =
      "TABLE I: errors of all transitions; position per driven metre, orientation per radian "
      "turned.\n";
  char letter = 'a';
  for (const std::vector<std::string>& columns : columnGroups(setting)) {
    text += letter == 'a' ? "" : "\n";
    for (size_t c = 0; c < columns.size(); ++c)
      text += std::string(c == 0 ? "" : "  ") + static_cast<char>(letter + static_cast<char>(c)) +
              ") " + columns[c];
    text += "\n\n";
    text += grid(setting, columns.size(), letter,
                 [&](const std::string& from, const std::string& to, const std::string& quantity,
                     size_t column) {
                   const Row* row = find(tables.errors, from, to, quantity, columns[column]);
                   return row == nullptr ? std::string("  -   ")
                                         : formatted("%5.3f", row->estimate.value) + " ";
                 });
    letter = static_cast<char>(letter + static_cast<char>(columns.size()));
  }
  text += spreadNote(tables, setting);
  if (setting.paper_reference)
    text +=
        "\nThe paper's Table I, ? = doubtful:  a) off  b) single  c) collective  d) "
        "omniscient\n\n" +
        paperGrid(setting);
  return text;
}

std::string textOfReductions(const Tables& tables, const Setting& setting) {
  std::string text = "TABLE II: error reductions in per cent";
  text += setting.sets > 1 ? " (mean +- deviation from set to set"
                           : " [paired 99 % interval over excitation runs";
  text += setting.sets > 1 ? ")" : "]";
  if (setting.paper_reference) text += " (the paper's; ? = doubtful)";
  text += "\n";
  for (const char* against : {"single", "off"})
    for (const std::string& rule : learningRules(setting.rules)) {
      if (find(tables.reductions, setting.surfaces[0], setting.surfaces[1], kPosition, rule,
               against) == nullptr)
        continue;
      const bool papers =
          setting.paper_reference && rule == "collective" && std::string(against) == "single";
      text += "\n" + rule + " against " + against + "\n" +
              reductionGrid(tables, setting, rule, against, papers);
      for (const PaperCell& cell : paperCells())
        if (papers && !doubtOfReduction(cell).empty())
          text += "  ? " + std::string(cell.from) + " -> " + cell.to + ", " + cell.quantity + ": " +
                  doubtOfReduction(cell) + "\n";
    }
  return text;
}

std::string textOfAgreement(const Tables& tables, const Setting& setting,
                            const std::vector<Tables>& sets) {
  const std::optional<Agreement> agreement = agreementWithPaper(tables);
  if (!setting.paper_reference || !agreement) return "";
  std::string text =
      "RMS deviation from the paper's Table I (cinder -> tarmac orientation left out):\n" +
      rmsLine(kPosition, agreement->position_rms) +
      rmsLine(kOrientation, agreement->orientation_rms);
  if (agreement->cells > 0)
    text += "Signs of Table II, all printed cells counted: orientation " +
            std::to_string(agreement->orientation_signs) + "/" + std::to_string(agreement->cells) +
            ", position " + std::to_string(agreement->position_signs) + "/" +
            std::to_string(agreement->cells) + "\n";
  return sets.size() < 2 ? text : text + extremesLines(sets);
}

}  // namespace tread::experiment

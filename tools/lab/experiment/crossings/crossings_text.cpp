// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/crossings/crossings_text.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::experiment {
namespace {

constexpr size_t kRuleWidth = 16;

std::string rightOf(const std::string& text, size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string heading(const char* title) {
  std::string line = std::string(title) +
                     std::string(kRuleWidth - std::min(kRuleWidth, std::string(title).size()), ' ');
  for (const char* phase : kPhaseNames) line += rightOf(phase, 10);
  return line + "\n";
}

/// A row per rule, a cell per phase.
template <class Cell>
std::string rowsOf(const std::vector<CrossingErrors>& errors, const Cell& cell) {
  std::string text;
  for (const CrossingErrors& one : errors) {
    text += one.rule + std::string(kRuleWidth - std::min(kRuleWidth, one.rule.size()), ' ');
    for (const PhaseErrors& phase : one.phases) text += rightOf(cell(phase), 10);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string textOf(const std::vector<CrossingDrives>& drives) {
  size_t runs = 0, changes = 0, real = 0;
  for (const CrossingDrives& drive : drives)
    for (const CrossingRun& run : drive.runs) {
      ++runs;
      changes += run.changes.size();
      real += static_cast<size_t>(std::count_if(run.changes.begin(), run.changes.end(),
                                                [](const auto& change) { return change.real; }));
    }
  return formatted("%zu runs, %zu changes of ground; after %zu of them the motion differs\n\n",
                   runs, changes, real);
}

std::string textOf(const std::vector<CrossingErrors>& errors) {
  std::string text = heading("error per metre");
  text += rowsOf(errors, [](const PhaseErrors& phase) {
    return phase.pieces > 0 ? formatted("%.3f", phase.perMetre()) : "-";
  });
  text += "\n" + heading("mm");
  text += rowsOf(errors, [](const PhaseErrors& phase) {
    return phase.pieces > 0
               ? formatted("%.1f", 1000.0 * phase.position / static_cast<double>(phase.pieces))
               : "-";
  });
  text += "\n" + heading("% in regions");
  text += rowsOf(errors, [](const PhaseErrors& phase) {
    return phase.regions > 0 ? formatted("%.0f", 100.0 * static_cast<double>(phase.inside) /
                                                     static_cast<double>(phase.regions))
                             : "-";
  });
  text +=
      "\ndetected while a piece runs: runs with a false alarm, and real changes within so many "
      "seconds\n"
      "                   false of runs, driven          .5 s     .8    1.6    of  median\n";
  for (const CrossingErrors& one : errors) {
    const Notices& notices = one.notices;
    if (notices.runs == 0) continue;
    text += one.rule + std::string(kRuleWidth - std::min(kRuleWidth, one.rule.size()), ' ') +
            formatted("   %3zu of %3zu, %5.0f s %22zu %6zu %6zu %5zu  %.2f s\n", notices.false_runs,
                      notices.runs, notices.undisturbed, notices.within(0.5), notices.within(0.8),
                      notices.delays.size(), notices.real, upperMedian(notices.delays, kNoFigure));
  }
  return text;
}

std::string csvOf(const std::vector<CrossingErrors>& errors) {
  std::string text = "rule,phase,pieces,metres,error_per_metre,regions,inside\n";
  for (const CrossingErrors& one : errors)
    for (size_t p = 0; p < kPhases; ++p) {
      const PhaseErrors& phase = one.phases[p];
      text += formatted("%s,%s,%zu,%.4f,%.6f,%zu,%zu\n", one.rule.c_str(), kPhaseNames[p],
                        phase.pieces, phase.metres, phase.pieces > 0 ? phase.perMetre() : 0.0,
                        phase.regions, phase.inside);
    }
  return text;
}

std::string noticedCsvOf(const std::vector<CrossingErrors>& errors) {
  std::string text =
      "rule,runs,false_runs,undisturbed_s,changes,within_0.5,within_0.8,within_1.6\n";
  for (const CrossingErrors& one : errors) {
    const Notices& notices = one.notices;
    text += formatted("%s,%zu,%zu,%.1f,%zu,%zu,%zu,%zu\n", one.rule.c_str(), notices.runs,
                      notices.false_runs, notices.undisturbed, notices.real, notices.within(0.5),
                      notices.within(0.8), notices.delays.size());
  }
  return text;
}

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"
#include "tools/robot/why/debrief.hpp"

namespace tread::why {
namespace {

using Pattern = Said<learning_t>;

constexpr double kMuchWorse = 2.5;  // [1] times the previous errors
constexpr size_t kManyRefused = 3;
constexpr size_t kRun = 4;  // patterns in a run that is compared with those before

/// Patterns far from their predictions from the start on, until corrected.
void addBeginning(const std::vector<const Pattern*>& measured, std::vector<Finding>& findings) {
  if (measured.size() < 4 * kRun) return;
  std::vector<double> first, later;
  for (size_t i = 0; i < measured.size(); ++i)
    if (i < kRun || i >= 2 * kRun)
      (i < kRun ? first : later).push_back(std::abs(measured[i]->message.error_position));
  const double begun = upperMedian(first, kNoFigure);
  const double usual = std::max(0.03, upperMedian(later, kNoFigure));
  if (begun < kMuchWorse * usual) return;
  Finding finding{
      FindingKind::kPrediction,
      measured.front()->time,
      measured[kRun - 1]->time,
      "prediction",
      formatted("the first patterns ended %.2f m from their predictions, later ones %.2f m: the "
                "set that it began with was another vehicle's or ground's",
                begun, usual),
      {}};
  for (size_t i = 0; i < kRun; ++i)
    finding.evidence.push_back({measured[i]->time, "LEARNING",
                                measured[i]->message.learned_pattern_name +
                                    formatted(": %.2f m", measured[i]->message.error_position)});
  findings.push_back(std::move(finding));
}

/// Stretches with patterns that ended much further from their predictions than before.
void addPredictions(const DriveTimeline& drive, std::vector<Finding>& findings) {
  std::vector<const Pattern*> measured;
  for (const Pattern& note : drive.patterns)
    if (note.message.accepted && std::isfinite(note.message.error_position))
      measured.push_back(&note);
  const auto typical = [&](size_t from, size_t to, double learning_t::*error) {
    std::vector<double> errors;
    for (size_t i = from; i < to; ++i) errors.push_back(std::abs(measured[i]->message.*error));
    return upperMedian(errors, kNoFigure);
  };
  addBeginning(measured, findings);
  for (size_t i = kRun; i + kRun <= measured.size();) {
    const size_t before = i > 2 * kRun ? i - 2 * kRun : 0;
    const double usual = std::max(0.03, typical(before, i, &learning_t::error_position));
    const double usual_yaw = std::max(0.02, typical(before, i, &learning_t::error_yaw));
    const double now = typical(i, i + kRun, &learning_t::error_position);
    const double now_yaw = typical(i, i + kRun, &learning_t::error_yaw);
    if (now < kMuchWorse * usual && now_yaw < kMuchWorse * usual_yaw) {
      ++i;
      continue;
    }
    Finding finding{
        FindingKind::kPrediction,
        measured[i]->time,
        measured[i + kRun - 1]->time,
        "prediction",
        formatted("patterns ended %.2f m and %.1f deg from their predictions, %.2f m and %.1f deg "
                  "before",
                  now, now_yaw * 180.0 / kPi, usual, usual_yaw * 180.0 / kPi),
        {}};
    for (size_t k = i; k < i + kRun; ++k) {
      const learning_t& pattern = measured[k]->message;
      std::string words =
          pattern.learned_pattern_name +
          formatted(": %.2f m, %.1f deg", pattern.error_position, pattern.error_yaw * 180.0 / kPi);
      if (pattern.ground_changed > 0.5) words += ", the learner assumes another ground";
      if (!wordsOf(pattern).empty()) words += "; " + wordsOf(pattern);
      finding.evidence.push_back({measured[k]->time, "LEARNING", words});
    }
    const auto sameSide = [&](double sign) {
      return std::all_of(
          measured.begin() + static_cast<long>(i), measured.begin() + static_cast<long>(i + kRun),
          [&](const Pattern* note) { return sign * note->message.error_yaw > 0.01; });
    };
    if (sameSide(1.0) || sameSide(-1.0))
      finding.sentence +=
          std::string(", each time too far to the ") + (sameSide(1.0) ? "left" : "right");
    const auto changed = std::find_if(
        measured.begin() + static_cast<long>(i), measured.begin() + static_cast<long>(i + kRun),
        [](const Pattern* note) { return note->message.ground_changed > 0.5; });
    if (changed != measured.begin() + static_cast<long>(i + kRun))
      finding.sentence += (*changed)->message.surface > 0
                              ? formatted(": the ground changed to the known surface %d",
                                          (*changed)->message.surface)
                              : ": the ground changed to an unknown one";
    findings.push_back(std::move(finding));
    i += kRun;
  }
}

/// Patterns without a measurement of the learner, by reason.
void addRefusals(const DriveTimeline& drive, std::vector<Finding>& findings) {
  std::map<std::string, std::vector<const Pattern*>> by_reason;
  size_t refused = 0;
  for (const Pattern& note : drive.patterns)
    if (!note.message.accepted) {
      by_reason[wordsOf(note.message)].push_back(&note);
      ++refused;
    }
  if (refused < kManyRefused || refused * 5 < drive.patterns.size()) return;
  Finding finding;
  finding.kind = FindingKind::kRefusal;
  finding.cause = "refused_measurements";
  finding.time = finding.until = by_reason.begin()->second.front()->time;
  std::vector<std::string> words;
  for (const auto& [reason, notes] : by_reason) {
    words.push_back(formatted("%zu for ", notes.size()) + reason);
    finding.time = std::min(finding.time, notes.front()->time);
    finding.until = std::max(finding.until, notes.back()->time);
    finding.evidence.push_back({notes.front()->time, "LEARNING",
                                notes.front()->message.learned_pattern_name + ": " + reason});
  }
  finding.sentence =
      formatted("the learner rejected %zu of %zu patterns: ", refused, drive.patterns.size()) +
      joined(words);
  findings.push_back(std::move(finding));
}

}  // namespace

std::vector<Finding> patternFindingsOf(const DriveTimeline& drive) {
  std::vector<Finding> findings;
  addPredictions(drive, findings);
  addRefusals(drive, findings);
  return findings;
}

}  // namespace tread::why

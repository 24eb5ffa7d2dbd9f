// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/repeat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/observations.hpp"
#include "modules/identification/core/search.hpp"
#include "tools/lab/gap/compare.hpp"
#include "tools/lab/gap/report/report.hpp"
#include "tools/lab/gap/what_if.hpp"

namespace tread::gap {
namespace {

std::vector<std::string> namesOf(const GapFinding& finding) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : finding.identified.effects)
    if (isShown(effect)) names.push_back(effect.name);
  return names;
}

/// Whether a log determines a parameter: its error is below the typical size, or below its value.
bool isSeen(const LogFit& fit, size_t parameter) {
  const double error = fit.errors[parameter];
  const EffectParameter* known = findEffectParameter(fit.parameters[parameter]);
  const double typical = known != nullptr ? std::abs(known->typical) : 0.0;
  return error > 0.0 && error < std::max(typical, std::abs(fit.values[parameter]));
}

RepeatedParameter repeatedParameter(const std::vector<LogFit>& fits, size_t parameter,
                                    double needed) {
  RepeatedParameter repeated;
  repeated.parameter = fits.front().parameters[parameter];
  repeated.unit = unitOf(repeated.parameter);
  double sum = 0.0, weights = 0.0;
  for (const LogFit& fit : fits) {
    const double error = fit.errors[parameter];
    repeated.values.push_back(fit.values[parameter]);
    repeated.errors.push_back(error);
    repeated.seen.push_back(isSeen(fit, parameter));
    if (!repeated.seen.back()) continue;
    sum += fit.values[parameter] / (error * error);
    weights += 1.0 / (error * error);
  }
  if (weights > 0.0) repeated.common = sum / weights;
  for (size_t i = 0; i < fits.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      if (!repeated.seen[i] || !repeated.seen[j]) continue;
      const Movement movement{repeated.parameter, repeated.unit,      repeated.values[j],
                              repeated.errors[j], repeated.values[i], repeated.errors[i]};
      repeated.farthest = std::max(repeated.farthest, std::abs(movement.sigmas()));
    }
  repeated.differs = repeated.farthest > needed;
  return repeated;
}

std::string saidValue(const RepeatedParameter& parameter, size_t log) {
  if (!parameter.seen[log]) return "not visible";
  return threeDigits(parameter.values[log]) + " \u00b1 " + threeDigits(parameter.errors[log]);
}

std::string saidOwner(const RepeatedParameter& parameter) {
  const auto seen = std::count(parameter.seen.begin(), parameter.seen.end(), true);
  if (parameter.differs) return "the day's, " + threeDigits(parameter.farthest) + " sigma";
  if (seen > 1) return "the vehicle's";
  return seen == 1 ? "visible in one log only" : "visible in none";
}

/// Formats columns, each as wide as its widest cell; "±" has two bytes and one column.
std::string tableText(const std::vector<std::vector<std::string>>& rows) {
  const auto widthOf = [](const std::string& cell) {
    return static_cast<size_t>(
        std::count_if(cell.begin(), cell.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  };
  std::vector<size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  std::string text;
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i)
      text +=
          row[i] + (i + 1 < row.size() ? std::string(widths[i] - widthOf(row[i]) + 2, ' ') : "");
    text += "\n";
  }
  return text;
}

}  // namespace

bool Repetition::differs() const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const RepeatedParameter& parameter) { return parameter.differs; });
}

size_t Repetition::logsThatName(const std::string& effect) const {
  return static_cast<size_t>(std::count_if(
      alone.begin(), alone.end(),
      [&effect](const GapFinding& finding) { return contains(namesOf(finding), effect); }));
}

std::vector<std::string> Repetition::names() const {
  std::set<std::string> all;
  for (const GapFinding& finding : alone)
    for (const std::string& name : namesOf(finding)) all.insert(name);
  for (const std::string& name : namesOf(together)) all.insert(name);
  return {all.begin(), all.end()};
}

ModelDocument Repetition::modelOf(size_t log) const {
  ModelDocument model = together.identified.model;
  for (const RepeatedParameter& parameter : parameters)
    if (parameter.differs && parameter.seen[log])
      *findParameter(model, parameter.parameter) = parameter.values[log];
  return model;
}

Repetition repeatLogs(const GapTask& task, const Progress& say) {
  if (task.train.size() < 2)
    throw std::invalid_argument("repeat: one log is not enough; give two or more");
  for (const Drive& drive : task.train) {
    // Check now rather than after an hour of computing.
    const std::vector<Drive> alone{drive};
    const std::string problem = tooLittleDriving(Observations(alone, ObservationSettings{}));
    if (!problem.empty()) throw std::invalid_argument(drive.name + ": " + problem);
  }
  Repetition repetition;
  const Progress silent = [](const std::string&) {};
  GapTask one = task;
  for (const Drive& drive : task.train) {
    one.train = {drive};
    one.log_notes = drive.notes;
    repetition.logs.push_back(drive.name);
    repetition.alone.push_back(findGap(one, silent));
    const GapFinding& finding = repetition.alone.back();
    say(drive.name + ": " + verdictName(finding.verdict) +
        (finding.reason.empty() ? "" : ", " + finding.reason) +
        (namesOf(finding).empty() ? "" : ": " + joined(namesOf(finding))));
  }
  repetition.together = findGap(task, silent);
  say("all together: " + std::string(verdictName(repetition.together.verdict)));
  if (repetition.together.verdict == GapVerdict::kCannotTell) return repetition;
  std::vector<LogFit> fits;
  int blocks = std::numeric_limits<int>::max();
  for (const Drive& drive : task.train) {
    fits.push_back(fitLog(repetition.together.identified.model, drive, task.parallel));
    blocks = std::min(blocks, fits.back().blocks);
  }
  const size_t parameters = fits.front().parameters.size();
  const size_t pairs = fits.size() * (fits.size() - 1) / 2;
  repetition.needed = neededSigmas(blocks, parameters * pairs);
  for (size_t i = 0; i < parameters; ++i)
    repetition.parameters.push_back(repeatedParameter(fits, i, repetition.needed));
  return repetition;
}

std::string textOf(const Repetition& repetition) {
  const size_t logs = repetition.logs.size();
  std::string text;
  for (const std::string& name : repetition.names()) {
    const size_t count = repetition.logsThatName(name);
    text += formatted("%-24s named in %zu of %zu logs%s\n", name.c_str(), count, logs,
                      contains(namesOf(repetition.together), name) ? ", and in all together" : "");
  }
  if (repetition.names().empty()) text += "No effect is named in any log.\n";
  if (repetition.together.verdict == GapVerdict::kCannotTell)
    return text + "All together: CANNOT_TELL: " + repetition.together.reason + ".\n";
  if (repetition.parameters.empty()) return text;
  std::vector<std::vector<std::string>> rows{{"parameter", "unit", "all"}};
  for (const std::string& log : repetition.logs) rows[0].push_back(log);
  rows[0].push_back("whose");
  for (const RepeatedParameter& parameter : repetition.parameters) {
    rows.push_back({parameter.parameter, parameter.unit,
                    std::isfinite(parameter.common) ? threeDigits(parameter.common) : "-"});
    for (size_t i = 0; i < logs; ++i) rows.back().push_back(saidValue(parameter, i));
    rows.back().push_back(saidOwner(parameter));
  }
  return text + "\n" + tableText(rows) + "\nFrom " + threeDigits(repetition.needed) +
         " sigma between two logs on it is significant, with " +
         std::to_string(repetition.parameters.size()) + " parameters and " +
         std::to_string(logs * (logs - 1) / 2) + (logs == 2 ? " pair" : " pairs") + " of logs.\n";
}

}  // namespace tread::gap

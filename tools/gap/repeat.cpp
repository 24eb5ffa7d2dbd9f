// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/search.hpp"
#include "tools/gap/questions.hpp"
#include "tools/gap/report/report.hpp"

namespace tread::gap {
namespace {

std::vector<std::string> namesOf(const Finding& finding) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : finding.identified.effects)
    if (isShown(effect)) names.push_back(effect.name);
  return names;
}

/// Mean with the weights of the errors.
double commonValue(const std::vector<LogFit>& fits, size_t parameter) {
  double sum = 0.0, weights = 0.0;
  for (const LogFit& fit : fits) {
    const double error = fit.errors[parameter];
    if (!(std::isfinite(error) && error > 0.0)) continue;
    sum += fit.values[parameter] / (error * error);
    weights += 1.0 / (error * error);
  }
  return weights > 0.0 ? sum / weights : fits.front().values[parameter];
}

RepeatedParameter repeatedParameter(const std::vector<LogFit>& fits, size_t parameter,
                                    double needed) {
  RepeatedParameter repeated;
  repeated.parameter = fits.front().parameters[parameter];
  repeated.unit = unitOf(repeated.parameter);
  repeated.common = commonValue(fits, parameter);
  for (const LogFit& fit : fits) {
    repeated.values.push_back(fit.values[parameter]);
    repeated.errors.push_back(fit.errors[parameter]);
  }
  for (size_t i = 0; i < fits.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Movement movement{repeated.parameter, repeated.unit,      repeated.values[j],
                              repeated.errors[j], repeated.values[i], repeated.errors[i]};
      repeated.farthest = std::max(repeated.farthest, std::abs(movement.sigmas()));
    }
  repeated.agrees = repeated.farthest <= needed;
  return repeated;
}

/// "1.18 +- 0.02 rad/s", or that the log does not say.
std::string saidValue(const RepeatedParameter& parameter, size_t log) {
  const double value = parameter.values[log];
  const double error = parameter.errors[log];
  if (!std::isfinite(error) || error > std::max(1.0, 10.0 * std::abs(value))) return "not seen";
  return threeDigits(value) + " \u00b1 " + threeDigits(error);
}

/// Columns of text, each as wide as its widest cell; plus and minus is one place in two bytes.
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

bool Repetition::agrees() const {
  return std::all_of(parameters.begin(), parameters.end(),
                     [](const RepeatedParameter& parameter) { return parameter.agrees; });
}

size_t Repetition::logsThatName(const std::string& effect) const {
  return static_cast<size_t>(std::count_if(
      alone.begin(), alone.end(),
      [&effect](const Finding& finding) { return contains(namesOf(finding), effect); }));
}

std::vector<std::string> Repetition::names() const {
  std::set<std::string> all;
  for (const Finding& finding : alone)
    for (const std::string& name : namesOf(finding)) all.insert(name);
  for (const std::string& name : namesOf(together)) all.insert(name);
  return {all.begin(), all.end()};
}

ModelDocument Repetition::modelOf(size_t log) const {
  ModelDocument model = together.identified.model;
  for (const RepeatedParameter& parameter : parameters)
    if (!parameter.agrees) *findParameter(model, parameter.parameter) = parameter.values[log];
  return model;
}

Repetition repeatLogs(const GapTask& task, const Progress& say) {
  if (task.train.size() < 2)
    throw std::invalid_argument("repeat: one log repeats nothing; give two or more");
  Repetition repetition;
  const Progress silent = [](const std::string&) {};
  const auto notesOf = [&task](const Drive& drive) {
    std::vector<LogNote> notes;
    std::copy_if(task.log_notes.begin(), task.log_notes.end(), std::back_inserter(notes),
                 [&drive](const LogNote& note) { return note.log == drive.name; });
    return notes;
  };
  GapTask one = task;
  for (const Drive& drive : task.train) {
    one.train = {drive};
    one.log_notes = notesOf(drive);
    repetition.logs.push_back(drive.name);
    repetition.alone.push_back(findGap(one, silent));
    const Finding& finding = repetition.alone.back();
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
  if (repetition.parameters.empty()) return text;
  std::vector<std::vector<std::string>> rows{{"parameter", "unit", "all"}};
  for (const std::string& log : repetition.logs) rows[0].push_back(log);
  rows[0].push_back("whose");
  for (const RepeatedParameter& parameter : repetition.parameters) {
    rows.push_back({parameter.parameter, parameter.unit, threeDigits(parameter.common)});
    for (size_t i = 0; i < logs; ++i) rows.back().push_back(saidValue(parameter, i));
    rows.back().push_back(parameter.agrees
                              ? "the vehicle's"
                              : "the day's, " + threeDigits(parameter.farthest) + " sigma");
  }
  return text + "\n" + tableText(rows) + "\nFrom " + threeDigits(repetition.needed) +
         " sigma between two logs on it is no chance, with " +
         std::to_string(repetition.parameters.size()) + " parameters and " +
         std::to_string(logs * (logs - 1) / 2) + (logs == 2 ? " pair" : " pairs") + " of logs.\n";
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <sstream>

#include "common/report/text.hpp"

#include "tests/study/score/score_files.hpp"

namespace tread::blindtest {
namespace {

std::string percent(double share, int digits) {
  return fixed(100.0 * share, digits);
}

/// A figure without its unit; no number for an interval's open end.
std::string number(const ScoreLine& line, double value, int digits) {
  if (!std::isfinite(value)) return "?";
  if (line.unit == std::string("%")) return percent(value, digits);
  return fixed(value, digits);
}

/// Joined by a bar, words stay one CSV field.
std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : "|") + word;
  return all;
}

/// Quoted if a CSV field needs it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text)
    quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

void addHidden(const Truth& truth, std::ostringstream& row) {
  std::vector<std::string> names, shapes;
  for (const HiddenEffect& hidden : truth.effects) {
    names.push_back(hidden.name);
    shapes.push_back(hidden.shape);
  }
  row << joined(names) << "," << joined(shapes) << "," << truth.defect << ",";
}

void addAnswer(const Answer& answer, std::ostringstream& row) {
  std::vector<std::string> names, groups, runner_ups, rest;
  for (const NamedEffect& named : answer.effects) {
    names.push_back(named.name);
    groups.insert(groups.end(), named.group.begin(), named.group.end());
    runner_ups.insert(runner_ups.end(), named.runner_ups.begin(), named.runner_ups.end());
  }
  for (const auto& [channel, variable] : answer.unexplained)
    rest.push_back(channel + ": " + variable);
  row << answer.verdict << "," << joined(names) << "," << joined(groups) << ","
      << joined(runner_ups) << "," << field(joined(rest)) << ",";
}

/// Unknown numbers stay empty.
void addNumber(double value, std::ostringstream& row) {
  if (std::isfinite(value)) row << value;
  row << ",";
}

void addJudgement(const Judgement& judgement, std::ostringstream& row) {
  row << judgement.right_verdict << "," << judgement.found << "," << judgement.moved << ","
      << judgement.first_right << "," << judgement.exact << "," << judgement.only_wrong << ","
      << judgement.grouped << "," << judgement.right_variable << "," << judgement.excited << ",";
}

}  // namespace

std::string figureWords(const ScoreLine& line) {
  if (line.cases == 0) return "no case";
  const std::string words = number(line, line.value, 1) + " " + line.unit + " (" +
                            number(line, line.low, 0) + " to " + number(line, line.high, 0) + "), ";
  if (!line.is_share) return words + "n = " + std::to_string(line.cases);
  return words + std::to_string(line.hits) + " of " + std::to_string(line.cases);
}

std::string mustWords(const ScoreLine& line) {
  if (!line.must) return "";
  const auto digits = [&](double value) { return number(line, value, 0); };
  const std::string unit = std::string(" ") + line.unit;
  std::string words = (line.must->least ? ">= " : "<= ") + digits(line.must->at) + unit;
  if (line.must->below) words = digits(line.must->at) + " to " + digits(*line.must->below) + unit;
  if (line.must->upper_end) words += ", upper end <= " + digits(*line.must->upper_end) + unit;
  if (line.must->cases > 0) words += ", n >= " + std::to_string(line.must->cases);
  return words;
}

std::string metWords(const ScoreLine& line) {
  if (!line.must) return "";
  const auto met = line.met();
  if (!met) return "no case";
  if (*met == Met::kYes) return "met";
  if (*met == Met::kNo) return "not met";
  return "cannot be decided with " + std::to_string(line.cases) +
         (line.valueIsGood() ? " (value met)" : " (value not met)");
}

std::string tableText(const ScoredStudy& study) {
  std::ostringstream text;
  text << "suite " << study.header.value("suite", "?") << ", seed " << study.header.value("seed", 0)
       << ", " << study.header.value("minutes", 0.0) << " min logs: " << study.cases.size()
       << " of " << study.header.value("cases", 0) << " cases\n";
  text << "(value with 95 % interval: Wilson's of a share, of order statistics of a quantile; what "
          "must be is met\n or not met where the whole interval says so)\n";
  std::string section;
  for (const ScoreLine& line : study.scores) {
    if (line.section != section) text << "\n" << (section = line.section) << "\n";
    std::string words =
        formatted("  %-72s %-36s %-28s %s", line.what.c_str(), figureWords(line).c_str(),
                  mustWords(line).c_str(), metWords(line).c_str());
    words.erase(words.find_last_not_of(' ') + 1);
    text << words << "\n";
  }
  return text.str();
}

std::string casesCsv(const std::vector<JudgedCase>& cases) {
  std::ostringstream text;
  text << "case,kind,noise,size,programme,minutes,hidden,form,defect,verdict,named,group,runner_up,"
          "unexplained,right_verdict,found,moved,first_right,exact,only_wrong,grouped,"
          "right_variable,excited,gap_closed,parameter_errors,reason\n";
  for (const JudgedCase& one : cases) {
    const Truth& truth = one.record.truth;
    text << truth.name << "," << truth.kind << "," << truth.noise << "," << truth.size << ","
         << truth.programme << "," << truth.minutes << ",";
    addHidden(truth, text);
    addAnswer(one.record.answer, text);
    addJudgement(one.judgement, text);
    addNumber(one.judgement.closed, text);
    std::vector<std::string> errors;
    for (const ParameterError& error : one.judgement.parameters) {
      errors.push_back(
          formatted("%s %.3f %s", error.path.c_str(), error.relative, error.inside ? "in" : "out"));
    }
    text << field(joined(errors)) << "," << field(one.record.answer.reason) << "\n";
  }
  return text.str();
}

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/study/score/scores.hpp"

namespace tread::blindtest {

/// Header and cases of cases.jsonl, with their scores.
struct ScoredStudy {
  nlohmann::ordered_json header;
  std::vector<std::string> lines;  ///< records, sorted by case
  std::vector<JudgedCase> cases;
  std::vector<ScoreLine> scores;
  Confusion confusion;
};

/// CPU seconds of answers by case.
using CaseSeconds = std::map<std::string, double>;

/// Scores and counts. Throws std::runtime_error for an invalid line.
ScoredStudy scored(const std::vector<std::string>& lines, const CaseSeconds& seconds = {});

/// The times.csv of batches below folders, as far as they exist.
CaseSeconds secondsBelow(const std::vector<std::string>& folders);

/// Joins the cases.jsonl of shards below the folders (or in them). Throws std::runtime_error if
/// they are from different studies or a case has different answers.
std::vector<std::string> merged(const std::vector<std::string>& folders);

/// Writes cases.jsonl, cases.csv, scores.json, table.txt, confusion.png and scores.html.
void writeScores(const ScoredStudy& study, const std::string& folder);

std::string tableText(const ScoredStudy& study);             ///< table.txt
std::string casesCsv(const std::vector<JudgedCase>& cases);  ///< cases.csv
std::string scoresJson(const ScoredStudy& study);            ///< scores.json
std::string pageHtml(const ScoredStudy& study, const std::string& png);
void drawConfusion(const Confusion& confusion, const std::string& path);

/// The figure with its interval and number of cases: "93.3 % (70 to 99), 14 of 15".
std::string figureWords(const ScoreLine& line);
/// ">= 95 %", or "" without a target.
std::string mustWords(const ScoreLine& line);
/// "met", "not met", "cannot be decided with 38 (value met)", "no case"; "" without a target.
std::string metWords(const ScoreLine& line);

}  // namespace tread::blindtest

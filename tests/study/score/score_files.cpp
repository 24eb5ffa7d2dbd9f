// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/score_files.hpp"
#include "common/config/problem_words.hpp"
#include "tests/helpers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

namespace fs = std::filesystem;

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTimesFile = "times.csv";

void write(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

using tread::testing::contentOf;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Record files in a folder: its own, else those of its shards.
std::vector<fs::path> recordFiles(const std::string& folder) {
  if (fs::exists(fs::path(folder) / "cases.jsonl")) return {fs::path(folder) / "cases.jsonl"};
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (fs::exists(entry.path() / "cases.jsonl")) files.push_back(entry.path() / "cases.jsonl");
  if (files.empty())
    throw std::runtime_error(folder + ": neither cases.jsonl nor folders of shards with one");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

ScoredStudy scored(const std::vector<std::string>& lines, const CaseSeconds& seconds) {
  ScoredStudy study;
  if (lines.empty()) throw std::runtime_error("no cases");
  try {
    study.header = Json::parse(lines.front());
    study.lines.assign(lines.begin() + 1, lines.end());
    for (const std::string& line : study.lines) {
      JudgedCase one{recordOf(Json::parse(line)), {}};
      one.judgement = judge(one.record);
      const auto time = seconds.find(one.record.truth.name);
      if (time != seconds.end()) one.seconds = time->second;
      study.cases.push_back(std::move(one));
    }
  } catch (const nlohmann::json::exception& problem) {
    throw std::runtime_error(std::string("cases.jsonl: ") + wordsOf(problem));
  }
  study.scores = scoresOf(study.cases);
  study.confusion = confusionOf(study.cases);
  return study;
}

CaseSeconds secondsBelow(const std::vector<std::string>& folders) {
  CaseSeconds seconds;
  for (const std::string& folder : folders) {
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry :
         fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied)) {
      if (entry.path().filename() != kTimesFile) continue;
      std::ifstream file(entry.path());
      std::string line;
      for (std::getline(file, line); std::getline(file, line);) {
        const size_t comma = line.find(',');
        if (comma != std::string::npos)
          seconds[line.substr(0, comma)] = std::strtod(line.c_str() + comma + 1, nullptr);
      }
    }
  }
  return seconds;
}

std::vector<std::string> merged(const std::vector<std::string>& folders) {
  std::string header;
  std::map<std::string, std::string> records;
  for (const std::string& folder : folders)
    for (const fs::path& path : recordFiles(folder)) {
      std::istringstream lines(contentOf(path));
      std::string line;
      std::getline(lines, line);
      if (header.empty()) header = line;
      if (line != header)
        throw std::runtime_error(path.string() +
                                 ": is of another study (suite, seed, minutes or nominal models)");
      while (std::getline(lines, line)) {
        const std::string name = Json::parse(line).at("case");
        if (!records.emplace(name, line).second && records[name] != line)
          throw std::runtime_error(path.string() + ": case " + name +
                                   " is there twice, with different answers");
      }
    }
  std::vector<std::string> all{header};
  for (const auto& record : records) all.push_back(record.second);
  return all;
}

std::string scoresJson(const ScoredStudy& study) {
  Json json = {{"study", study.header}, {"cases", study.cases.size()}, {"scores", Json::array()}};
  for (const ScoreLine& line : study.scores) {
    Json one = {{"section", line.section}, {"what", line.what}, {"cases", line.cases}};
    if (line.is_share) one["hits"] = line.hits;
    one["value"] = number(line.value);
    one["low"] = number(line.low), one["high"] = number(line.high);
    if (!line.is_share) one["unit"] = line.unit;
    if (line.must) one["must"] = mustWords(line), one["met"] = metWords(line);
    json["scores"].push_back(one);
  }
  const Confusion& confusion = study.confusion;
  json["confusion"] = {{"hidden", confusion.hidden},
                       {"cases", confusion.cases},
                       {"named", confusion.named},
                       {"share", confusion.share}};
  return json.dump(1) + "\n";
}

void writeScores(const ScoredStudy& study, const std::string& folder) {
  fs::create_directories(folder);
  const fs::path out(folder);
  std::string records = study.header.dump() + "\n";
  for (const std::string& line : study.lines) records += line + "\n";
  write(out / "cases.jsonl", records);
  write(out / "cases.csv", casesCsv(study.cases));
  write(out / "scores.json", scoresJson(study));
  write(out / "table.txt", tableText(study));
  drawConfusion(study.confusion, (out / "confusion.png").string());
  write(out / "scores.html", pageHtml(study, contentOf(out / "confusion.png")));
}

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/study.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "common/report/page.hpp"
#include "common/store/store.hpp"
#include "tests/helpers.hpp"
#include "tests/study/score/batch.hpp"
#include "tests/study/score/child.hpp"
#include "tests/study/score/suites.hpp"

namespace fs = std::filesystem;

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kBatch = 40;

using tread::testing::contentOf;

/// Description of the study; shards with a different line belong to another one.
Json headerOf(const Study& study, const std::vector<HiddenCase>& cases) {
  return {{"format", "tread-blind cases 1"},
          {"suite", study.suite},
          {"answered_by", study.rival.empty() ? "tread-gap" : "tread-rival " + study.rival},
          {"seed", study.seed},
          {"minutes", study.minutes},
          {"cases", cases.size()},
          {"nominal", nominalStory(study, cases)}};
}

/// Only tread-hide knows the cases of a suite, and lists them.
std::vector<HiddenCase> hiddenSuite(const Study& study) {
  const fs::path folder(shardFolder(study));
  runOrThrow({{study.programs + "/tread-hide", "conditions", "--suite", study.suite, "--seed",
               std::to_string(study.seed)},
              folder.string(),
              "conditions.txt"});
  std::vector<HiddenCase> cases;
  std::ifstream lines(folder / "conditions.txt");
  for (HiddenCase one; lines >> one.name >> one.nominal;) cases.push_back(one);
  return cases;
}

/// Requires the same options and programs as an existing study in the folder.
void claim(const Study& study, const Json& header) {
  const fs::path note = fs::path(shardFolder(study)) / "study.json";
  Json all = header;
  for (const char* program : {"tread-hide", study.rival.empty() ? "tread-gap" : "tread-rival"})
    all[program] = sha256(readText(study.programs + "/" + program));
  const std::string text = all.dump(2) + "\n";
  if (fs::exists(note) && contentOf(note) != text)
    throw std::runtime_error(note.string() +
                             ": another study, or other programs or models; give another --out");
  std::ofstream(note, std::ios::binary) << text;
}

}  // namespace

std::string shardFolder(const Study& study) {
  const std::string name =
      "shard-" + std::to_string(study.shard) + "of" + std::to_string(study.shards);
  return (fs::absolute(study.out) / name).string();
}

std::vector<HiddenCase> casesOf(const Study& study) {
  if (study.suite == "quick") return quickSuite(study.minutes, study.seed);
  if (study.suite == "wrong_start") return wrongStartSuite(study.minutes, study.seed);
  std::vector<HiddenCase> cases = hiddenSuite(study);
  // After the suite's own cases, which tread-hide numbers from the first on.
  for (const HiddenCase& one : recordingSuite(study)) cases.push_back(one);
  return cases;
}

std::vector<std::string> runShard(const Study& study) {
  const fs::path folder(shardFolder(study));
  fs::create_directories(folder);
  const std::vector<HiddenCase> cases = casesOf(study);
  const Json header = headerOf(study, cases);
  claim(study, header);
  std::map<std::string, std::string> models;
  for (const HiddenCase& one : cases)
    if (models.count(one.nominal) == 0) models[one.nominal] = nominalModel(study, one.nominal);
  const size_t per_shard = (cases.size() + study.shards - 1) / study.shards;
  const size_t batches = std::max<size_t>(1, (per_shard + kBatch - 1) / kBatch);
  std::vector<std::string> records;
  for (size_t i = 0; i < batches; ++i) {
    Batch batch{(folder / ("batch-" + std::to_string(i + 1))).string(),
                study.shard - 1 + i * study.shards,
                batches * study.shards,
                {}};
    for (size_t k = batch.first; k < cases.size(); k += batch.stride)
      batch.cases.push_back(cases[k]);
    if (batch.cases.empty()) continue;
    if (!fs::exists(fs::path(batch.folder) / kBatchRecords)) runBatch(study, batch, models);
    std::istringstream lines(contentOf(fs::path(batch.folder) / kBatchRecords));
    for (std::string line; std::getline(lines, line);) records.push_back(line);
    std::cout << "batch " << i + 1 << " of " << batches << ": " << batch.cases.size()
              << " cases done" << std::endl;
  }
  std::sort(records.begin(), records.end());
  records.insert(records.begin(), header.dump());
  return records;
}

}  // namespace tread::blindtest

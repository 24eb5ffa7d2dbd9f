// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Twelve logs from the generator to the scores, with the command-line programs.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/study/score/score_files.hpp"

using namespace tread::blindtest;
namespace fs = std::filesystem;

namespace {

/// A temporary folder.
class Folder {
 public:
  ~Folder() { fs::remove_all(path); }
  const std::string path =
      (fs::temp_directory_path() / ("tread-quick-" + std::to_string(getpid()))).string();
};

int runQuick(const std::string& out, const std::string& options = "") {
  const std::string command = std::string(TREAD_BIN_DIR) +
                              "/tread-blind --suite quick --minutes 6 --nominal " +
                              TREAD_SOURCE_DIR + "/tests/data/blind/nominal_mid.yaml --out " + out +
                              " " + options + " > /dev/null";
  return std::system(command.c_str());
}

std::string namesOf(const JudgedCase& one) {
  std::string names = one.record.truth.name + " " + one.record.answer.verdict + ":";
  for (const NamedEffect& named : one.record.answer.effects) names += " " + named.name;
  return names;
}

}  // namespace

TEST_CASE("a blind test of twelve logs: what is easy is named, what is bad refused") {
  const Folder folder;
  REQUIRE(runQuick(folder.path) == 0);
  const ScoredStudy study = scored(merged({folder.path}));
  REQUIRE(study.cases.size() == 12);
  for (const JudgedCase& one : study.cases) {
    INFO(namesOf(one) << " " << one.record.answer.reason);
    const std::string& kind = one.record.truth.kind;
    if (kind == "null") CHECK(one.record.answer.effects.empty());
    if (kind == "single") CHECK(one.judgement.found == 1);
    if (kind == "pair") CHECK(one.judgement.found >= 1);
    if (kind == "degenerate") CHECK(one.judgement.grouped);
    if (kind == "out_of_catalogue") CHECK(one.record.answer.verdict != "NO_DISCREPANCY");
    if (kind == "bad") CHECK(one.judgement.refused);
  }
  for (const char* file : {"scores.json", "table.txt", "cases.csv", "confusion.png", "scores.html"})
    CHECK(fs::file_size(fs::path(folder.path) / file) > 0);
  // A shard gives the same bytes elsewhere, with any number of jobs.
  const std::string elsewhere = folder.path + "/elsewhere";
  REQUIRE(runQuick(elsewhere, "--shard 5/6 --jobs 2") == 0);
  const std::vector<std::string> whole = merged({folder.path});
  const std::vector<std::string> part = merged({elsewhere});
  REQUIRE(part.size() == 3);
  for (const std::string& line : part)
    CHECK(std::find(whole.begin(), whole.end(), line) != whole.end());
}

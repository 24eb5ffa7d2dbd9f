// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "tests/study/score/score_files.hpp"
#include "tests/study/score/study.hpp"

using namespace tread::blindtest;

namespace {

constexpr const char* kFooter =
    "Writes into --out: nominal/ (models, made once), shard-IofN/ (cases.jsonl),\n"
    "and for a complete or merged study scores.json, table.txt, cases.csv,\n"
    "confusion.png, scores.html. A restarted study continues where it stopped.\n"
    "Exit status: 0, or 2 with one line that explains the error.";

struct Arguments {
  Study study;
  std::string shard;
  std::vector<std::string> merge;
};

void addOptions(CLI::App& app, Arguments& arguments) {
  Study& study = arguments.study;
  app.footer(kFooter);
  app.add_option("--suite", study.suite, "which cases")
      ->check(CLI::IsMember({"quick", "small", "medium", "full", "wrong_start"}))
      ->capture_default_str();
  app.add_option("--out", study.out, "folder")->required();
  app.add_option(
         "--rival", study.rival,
         "another method to test instead: all (least squares over all parameters) or sparse "
         "(sequentially thresholded regression on the catalogue's directions, as SINDy)")
      ->check(CLI::IsMember({"all", "sparse"}));
  app.add_option("--seed", study.seed)->capture_default_str();
  app.add_option("--shard", arguments.shard, "I/N: every N-th case from the I-th");
  app.add_option("--jobs", study.jobs, "logs processed in parallel; no influence on any byte")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--minutes", study.minutes, "of each log")
      ->check(CLI::Range(0.5, 120.0))
      ->capture_default_str();
  app.add_option("--calibration-minutes", study.hour, "of the log for the nominal model")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  app.add_option("--nominal", study.nominal, "model file for all cases instead of a calibration")
      ->check(CLI::ExistingFile);
  app.add_option("--recordings", study.recordings,
                 "folder of real logs NAME.lcmlog with NAME.yaml, the model to begin with: effects "
                 "are hidden in them, too (medium, full)");
  app.add_flag("--keep", study.keep, "keep logs and reports");
  app.add_option("--merge", arguments.merge,
                 "folders of shards (or their --out): only joins and scores them");
}

void readShard(const std::string& text, Study& study) {
  if (text.empty()) return;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%zu/%zu%c", &study.shard, &study.shards, &rest) != 2 ||
      study.shard < 1 || study.shard > study.shards)
    throw std::runtime_error("--shard: '" + text + "' is not I/N with 1 <= I <= N");
}

void score(const std::vector<std::string>& lines, const std::string& folder,
           const std::vector<std::string>& timed) {
  const ScoredStudy study = scored(lines, secondsBelow(timed));
  writeScores(study, folder);
  std::cout << tableText(study) << "\n" << folder << "/scores.html" << std::endl;
}

int parseAndRun(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Blind test of tread-gap: hides effects, lets tread-gap find them, scores the answers.",
      "tread-blind"};
  addOptions(app, arguments);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  Study& study = arguments.study;
  if (!arguments.merge.empty())
    return score(merged(arguments.merge), study.out, arguments.merge), 0;
  readShard(arguments.shard, study);
  study.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  const std::vector<std::string> lines = runShard(study);
  score(lines, study.shards == 1 ? study.out : shardFolder(study), {shardFolder(study)});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parseAndRun(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "tread-blind: %s\n", tread::wordsOf(problem).c_str());
    return 2;
  }
}

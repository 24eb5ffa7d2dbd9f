// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/corpus.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <unistd.h>

#include "common/config/problem_words.hpp"
#include "common/mcap/mcap_log.hpp"
#include "common/parallel/parallel_for.hpp"
#include "tools/lab/replay/robot_learner.hpp"
#include "tools/lab/replay/robot_planner.hpp"
#include "tools/lab/replay/robot_replay.hpp"
#include "tools/robot/report/logged_learner.hpp"

namespace tread::replay {
namespace {

namespace fs = std::filesystem;

/// The original log of an MCAP file, deleted by the destructor.
class UnpackedLog {
 public:
  explicit UnpackedLog(const std::string& path) : path_(path) {
    if (fs::path(path).extension() != ".mcap") return;
    path_ = (fs::temp_directory_path() /
             ("tread_corpus_" + std::to_string(getpid()) + "_" + fs::path(path).stem().string()))
                .string();
    made_ = true;
    LogWriter log(path_);
    mcap::writeLog(path, log);
    log.close();
  }
  ~UnpackedLog() {
    std::error_code error;
    if (made_) fs::remove(path_, error);
  }
  UnpackedLog(const UnpackedLog&) = delete;
  UnpackedLog& operator=(const UnpackedLog&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool made_ = false;
};

/// The overrides of one process, without its name.
std::vector<std::string> overridesOf(const std::vector<std::string>& overrides,
                                     const std::string& process) {
  std::vector<std::string> own;
  for (const std::string& override : overrides)
    if (override.rfind(process + ".", 0) == 0) own.push_back(override.substr(process.size() + 1));
  return own;
}

std::string counted(const std::string& what, const MessageCounts& counts) {
  return what + ": " + countsText(counts, "");
}

CorpusEntry replayOne(const std::string& path, const std::vector<std::string>& overrides,
                      const std::string& patterns_folder) {
  CorpusEntry entry;
  entry.name = fs::path(path).filename().string();
  entry.equal = true;
  const auto note = [&](const std::string& line) { entry.lines.push_back(line); };
  try {
    const UnpackedLog unpacked(path);
    const RobotLog log = readRobotLog({unpacked.path()});
    if (!log.problem.empty()) note(log.problem);
    try {
      const PlannerCheck check =
          checkPlanner(log, plannerConfigOf(log, overridesOf(overrides, "planner")));
      entry.compared = true;
      if (!check.equal()) {
        entry.equal = false;
        note("planner: " + check.first_difference);
        note("  " + counted("PROGRAM", check.programs) + "; " + counted("PLAN", check.plans));
      }
    } catch (const std::runtime_error& error) {
      entry.equal = false;
      note(std::string("planner not compared: ") + wordsOf(error));
    }
    try {
      const LearnerCheck check = checkLearner(
          log, report::learnerConfigOf(log, patterns_folder, overridesOf(overrides, "learner")));
      entry.compared = true;
      if (!check.equal()) {
        entry.equal = false;
        note("learner: " + check.first_difference);
        note("  " + counted("PATTERN_SET", check.versions) + "; " +
             counted("LEARNING", check.learning));
      }
    } catch (const std::runtime_error& error) {
      entry.equal = false;
      note(std::string("learner not compared: ") + wordsOf(error));
    }
  } catch (const std::runtime_error& error) {
    note(wordsOf(error));
  }
  entry.equal = entry.equal && entry.compared;
  return entry;
}

}  // namespace

std::vector<std::string> corpusOf(const std::string& folder) {
  std::vector<std::string> logs;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error))
    if (file.path().extension() == ".lcmlog" || file.path().extension() == ".mcap")
      logs.push_back(file.path().string());
  if (error) throw std::runtime_error(folder + ": cannot be read: " + error.message());
  if (logs.empty()) throw std::runtime_error(folder + ": holds no log (*.lcmlog, *.mcap)");
  std::sort(logs.begin(), logs.end());
  return logs;
}

std::vector<CorpusEntry> replayCorpus(const std::vector<std::string>& logs,
                                      const std::vector<std::string>& overrides,
                                      const std::string& patterns_folder, int threads) {
  for (const std::string& override : overrides)
    if (override.rfind("planner.", 0) != 0 && override.rfind("learner.", 0) != 0)
      throw std::runtime_error("--set " + override + ": begins with neither planner. nor learner.");
  std::vector<CorpusEntry> corpus(logs.size());
  onThreads(threads)(logs.size(),
                     [&](size_t i) { corpus[i] = replayOne(logs[i], overrides, patterns_folder); });
  return corpus;
}

std::string reportOf(const std::vector<CorpusEntry>& corpus) {
  std::string text;
  int equal = 0, different = 0, silent = 0;
  for (const CorpusEntry& entry : corpus) {
    ++(entry.equal ? equal : entry.compared ? different : silent);
    text += entry.name + ": " +
            (entry.equal      ? "equal"
             : entry.compared ? "DIFFERENT"
                              : "NOT COMPARED") +
            "\n";
    for (const std::string& line : entry.lines) text += "  " + line + "\n";
  }
  return text + std::to_string(corpus.size()) + " logs: " + std::to_string(equal) + " equal, " +
         std::to_string(different) + " different, " + std::to_string(silent) + " not compared\n";
}

}  // namespace tread::replay

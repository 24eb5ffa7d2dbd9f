// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/experiment/batch.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/recordings/drive_recordings.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {
namespace {

namespace fs = std::filesystem;
using recordings::PatternRecordings;

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> parts(1);
  for (const char letter : words) {
    if (letter == ',')
      parts.emplace_back();
    else
      parts.back() += letter;
  }
  return parts;
}

void checkRules(const std::vector<std::string>& rules) {
  for (const std::string& rule : rules) {
    if (!methodOf(rule))
      throw std::invalid_argument("--rules: unknown rule '" + rule + "'; known are " +
                                  joinWords(methodNames()));
    if (std::count(rules.begin(), rules.end(), rule) > 1)
      throw std::invalid_argument("--rules: '" + rule + "' is given twice");
  }
}

learner::RuleConfig ruleConfig(const Request& request) {
  learner::RuleConfig config;
  config.memory = request.memory;
  ConfigReader reader = ConfigReader::fromText("{}", "learner", request.overrides);
  learner::readRules(reader, config);
  reader.finish();
  return config;
}

PatternRecordings recordingsOfFolder(const Request& request, Batch& batch) {
  const fs::path folder(request.recordings);
  if (fs::exists(folder / "sessions.csv")) {
    recordings::DriveRequest drives;
    drives.folder = request.recordings;
    drives.robot = request.robot;
    drives.sessions = request.sessions;
    recordings::DriveRecordings made = recordings::recordingsFromDrives(drives);
    batch.notes = made.notes;
    batch.source += ", " + made.robot;
    return std::move(made.recordings);
  }
  if (!request.robot.empty() || !request.sessions.empty())
    throw std::invalid_argument(request.recordings +
                                ": --robot and --sessions select drives; there is no "
                                "sessions.csv here");
  if (!fs::exists(folder / "patterns.yaml"))
    throw std::invalid_argument(request.recordings +
                                ": neither sessions.csv (drives) nor patterns.yaml (pattern "
                                "recordings) is there");
  return recordings::readRecordings(request.recordings);
}

/// Pattern names as indices into the set.
Sequence sequenceOf(const std::vector<std::string>& names, const PatternSet& set) {
  Sequence sequence;
  std::vector<std::string> known;
  for (const MotionPattern& pattern : set.patterns()) known.push_back(pattern.name);
  for (const std::string& name : names) {
    const auto place = std::find(known.begin(), known.end(), name);
    if (place == known.end())
      throw std::invalid_argument("sequence " + joinWords(names) + ": unknown pattern '" + name +
                                  "'; the patterns are " + joinWords(known));
    sequence.push_back(static_cast<size_t>(place - known.begin()));
  }
  return sequence;
}

/// Runs the sets of recordings in turn.
class Runner {
 public:
  Runner(const Request& request, const std::function<void(double)>& progress)
      : progress_(progress) {
    batch_.request = request;
    checkRules(request.rules);
    batch_.settings.rules = batch_.setting.rules = request.rules;
    batch_.settings.config = ruleConfig(request);
    batch_.settings.repetitions = request.repetitions;
    batch_.settings.excitations = request.excitations;
    batch_.settings.excitation = request.excitation;
    batch_.settings.threads = request.threads;
    batch_.settings.change_inside = request.change_inside;
    batch_.setting.sets = static_cast<size_t>(request.sets);
  }

  Batch run() {
    if (batch_.request.world.empty())
      runFolder();
    else
      runWorld();
    batch_.tables = combined(batch_.sets);
    return std::move(batch_);
  }

 private:
  void runFolder() {
    const Request& request = batch_.request;
    if (request.sets != 1 || request.length != 1)
      throw std::invalid_argument(
          "--sets and --length need a --world, which can be recorded again");
    batch_.source = "recordings " + fs::path(request.recordings).filename().string();
    const PatternRecordings recorded = recordingsOfFolder(request, batch_);
    chooseSequences(recorded.patterns, {});
    runRecordings(recorded, 0);
  }

  void runWorld() {
    const Request& request = batch_.request;
    if (!request.robot.empty() || !request.sessions.empty())
      throw std::invalid_argument("--robot and --sessions need --recordings");
    const TransitionWorld world = readTransitionWorld(request.world);
    batch_.source = "world " + world.name;
    // The paper's numbers are for patterns of one second and for changes between patterns.
    batch_.setting.paper_reference =
        world.paper_reference && request.length == 1 && !request.change_inside;
    for (uint64_t number = 0; number < static_cast<uint64_t>(request.sets); ++number) {
      const PatternRecordings recorded = record(world, request.seed + number, request.length);
      if (number == 0) chooseSequences(recorded.patterns, world.sequences);
      runRecordings(recorded, number);
    }
  }

  void chooseSequences(const PatternSet& set, std::vector<std::vector<std::string>> usual) {
    if (!batch_.request.sequences.empty()) {
      usual.clear();
      for (const std::string& words : batch_.request.sequences) usual.push_back(split(words));
    }
    for (const std::vector<std::string>& names : usual)
      batch_.settings.sequences.push_back(sequenceOf(names, set));
    if (batch_.settings.sequences.empty()) chooseByEnds(set);
  }

  /// The usual names if the set has them, else the patterns that are farthest apart.
  void chooseByEnds(const PatternSet& set) {
    const auto has = [&](const char* name) {
      const auto& patterns = set.patterns();
      return std::any_of(patterns.begin(), patterns.end(),
                         [&](const MotionPattern& pattern) { return pattern.name == name; });
    };
    if (has("left") && has("right"))
      return chooseSequences(set, {{"left", "left", "right"}, {"right", "right", "left"}});
    batch_.settings.sequences = sequencesFor(set);
    if (batch_.settings.sequences.empty())
      throw std::invalid_argument(batch_.source +
                                  ": there is only one pattern; transitions need two");
    std::vector<std::string> names;
    for (const size_t pattern : batch_.settings.sequences.front())
      names.push_back(set.patterns()[pattern].name);
    batch_.notes.push_back("test sequences are " + joinWords(names) +
                           " and the reverse, for the patterns with the most distant ends; "
                           "choose others by --sequence");
  }

  void runRecordings(const PatternRecordings& recorded, uint64_t number) {
    std::vector<std::string> notes;
    std::vector<TrialGround> grounds = groundsOf(recorded, notes);
    batch_.notes.insert(batch_.notes.end(), notes.begin(), notes.end());
    batch_.settings.seed = batch_.request.seed + number;
    const auto begun = std::chrono::steady_clock::now();
    const auto sets = static_cast<double>(batch_.request.sets);
    ExperimentErrors errors = runExperiment(grounds, batch_.settings, [&](size_t done, size_t all) {
      const double part = static_cast<double>(done) / static_cast<double>(all);
      if (progress_) progress_((static_cast<double>(number) + part) / sets);
    });
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun;
    batch_.seconds += passed.count();
    batch_.sets.push_back(tablesOf(errors, batch_.settings, grounds));
    if (number > 0) return;
    for (const TrialGround& ground : grounds) batch_.setting.surfaces.push_back(ground.surface);
    batch_.grounds = std::move(grounds);
    batch_.first = std::move(errors);
  }

  Batch batch_;
  std::function<void(double)> progress_;
};

/// The variants of --extras, in words and as requests: a tenth of the repetitions, few sets of
/// recordings.
std::vector<std::pair<std::string, Request>> variantsOf(const Request& request) {
  constexpr int64_t kFewest = 100;
  constexpr int kSets = 3;
  Request base = request;
  base.repetitions = std::max(kFewest, request.repetitions / 10);
  base.sets = std::min(request.sets, kSets);
  std::vector<std::pair<std::string, Request>> variants;
  if (!request.world.empty()) {
    Request longer = base;
    longer.length = 2 * request.length;
    variants.emplace_back("each command held twice as long", longer);
  }
  if (!request.change_inside) {
    Request inside = base;
    inside.change_inside = true;
    variants.emplace_back("the ground changes in the middle of the first execution", inside);
  }
  return variants;
}

}  // namespace

Batch runBatch(const Request& request, const std::function<void(double)>& progress) {
  if (!request.extras) return Runner(request, progress).run();
  const std::vector<std::pair<std::string, Request>> variants = variantsOf(request);
  // A variant takes time in proportion to its repetitions.
  const double main_share = 1.0 / (1.0 + 0.15 * static_cast<double>(variants.size()));
  double done = 0.0, part = main_share;
  const auto shared = [&](double share) {
    if (progress) progress(done + share * part);
  };
  Batch batch = Runner(request, shared).run();
  part = (1.0 - main_share) / static_cast<double>(variants.size());
  done = main_share;
  for (const auto& [words, of_variant] : variants) {
    Batch other = Runner(of_variant, shared).run();
    batch.variants.push_back({words, std::move(other.tables), std::move(other.sets)});
    done += part;
  }
  return batch;
}

}  // namespace tread::experiment

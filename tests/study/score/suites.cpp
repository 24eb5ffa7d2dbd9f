// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/suites.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "common/config/problem_words.hpp"

namespace fs = std::filesystem;

namespace tread::blindtest {
namespace {

constexpr const char* kPrefix = "recording-";

/// Effects that can be hidden by an exact transformation of poses or commands.
const char* const kEffects[] = {"heading_misalignment", "ins_latency",   "position_scale",
                                "command_delay",        "battery_sag",   "track_asymmetry",
                                "motor_deadband",       "gyro_bias",     "lever_arm_x",
                                "lever_arm_y",          "payload_change"};

HiddenCase hiddenIn(const Recording& recording, const std::string& effect, int size, size_t number,
                    uint64_t seed) {
  char name[24];
  std::snprintf(name, sizeof name, "r%04zu", number);
  return {name,
          recording.nominal,
          {"semi", "--log", recording.log, "--effect", effect, "--size", std::to_string(size),
           "--seed", std::to_string(seed * 1000 + number), "--name", name}};
}

/// Whether its nominal model can be made; prints why not.
bool isUsable(const Study& study, const Recording& recording) {
  try {
    nominalModel(study, recording.nominal);
    return true;
  } catch (const std::exception& problem) {
    std::cout << recording.log << " is left out: " << wordsOf(problem) << std::endl;
    return false;
  }
}

constexpr size_t kWrongStarts = 400;

/// Names a case by its position, and adds the common arguments of separate cases.
void addCase(HiddenCase one, double minutes, uint64_t seed, std::vector<HiddenCase>& cases) {
  const size_t number = cases.size() + 1;
  char name[24];
  std::snprintf(name, sizeof name, "%04zu", number);
  one.name = name;
  for (const std::string& word :
       {std::string("--noise"), one.nominal.substr(0, one.nominal.find('~')),
        std::string("--minutes"), std::to_string(minutes), std::string("--name"), one.name,
        std::string("--seed"), std::to_string(seed * 1000 + number)})
    one.arguments.push_back(word);
  cases.push_back(one);
}

}  // namespace

const char* const kBaseModel =
    R"(# The generator's vehicle as its data sheet has it; calibration makes the nominal model out of it.
name: blind_base
kind: power
full_speed: 1.2  # m/s
gauge: 0.43      # m
lag: 0.15        # s
effects:
  yaw_inertia: {lag: 0.03}   # s, a guess: a heavy body is slower than its tracks
  body_inertia: {lag: 0.03}  # s
)";

std::vector<HiddenCase> quickSuite(double minutes, uint64_t seed) {
  const std::vector<std::vector<std::string>> kinds = {
      {"--null"},
      {"--effect", "motor_deadband", "--size", "4"},
      {"--effect", "slope_pitch", "--size", "4"},
      {"--bad", "clock_jump"},
      {"--effect", "heading_misalignment", "--size", "4"},
      {"--effect", "command_delay", "--size", "4"},
      {"--null"},
      {"--effect", "track_width,lever_arm_y", "--size", "4"},
      {"--effect", "lever_arm_x", "--case", "degenerate", "--size", "4"},
      {"--effect", "steering_hysteresis", "--size", "4"},
      {"--bad", "frozen_ins"},
      {"--effect", "track_asymmetry", "--size", "4"},
  };
  std::vector<HiddenCase> cases;
  for (const std::vector<std::string>& kind : kinds)
    addCase({"", "mid", kind}, minutes, seed, cases);
  return cases;
}

std::vector<HiddenCase> wrongStartSuite(double minutes, uint64_t seed) {
  std::vector<HiddenCase> cases;
  for (size_t i = 0; i < kWrongStarts; ++i)
    addCase({"", std::string(i % 2 == 0 ? "mid" : "high") + "~" + std::to_string(i), {"--null"}},
            minutes, seed, cases);
  return cases;
}

std::vector<Recording> recordingsIn(const std::string& folder) {
  std::vector<Recording> recordings;
  if (!fs::is_directory(folder)) return recordings;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path log = fs::absolute(entry.path());
    const fs::path model = fs::path(log).replace_extension(".yaml");
    if (log.extension() == ".lcmlog" && fs::exists(model))
      recordings.push_back({kPrefix + log.stem().string(), log.string(), model.string()});
  }
  std::sort(recordings.begin(), recordings.end(),
            [](const Recording& a, const Recording& b) { return a.nominal < b.nominal; });
  return recordings;
}

std::optional<Recording> recordingNamed(const Study& study, const std::string& nominal) {
  for (const Recording& one : recordingsIn(study.recordings))
    if (one.nominal == nominal) return one;
  return std::nullopt;
}

std::vector<HiddenCase> recordingSuite(const Study& study) {
  std::vector<HiddenCase> cases;
  if (study.suite != "medium" && study.suite != "full") return cases;
  const std::vector<Recording> recordings = recordingsIn(study.recordings);
  if (recordings.empty())
    std::cout << "no cases in recordings: "
              << (study.recordings.empty()
                      ? "no --recordings"
                      : study.recordings + " has no NAME.lcmlog with NAME.yaml")
              << std::endl;
  size_t number = 0;
  for (const Recording& recording : recordings) {
    if (!isUsable(study, recording)) continue;
    for (const char* effect : kEffects) {
      ++number;
      if (study.suite == "medium") {
        cases.push_back(
            hiddenIn(recording, effect, 1 + static_cast<int>(number % 2), number, study.seed));
        continue;
      }
      for (const int size : {1, 2})
        cases.push_back(hiddenIn(recording, effect, size, 2 * number + size - 2, study.seed));
    }
  }
  return cases;
}

}  // namespace tread::blindtest

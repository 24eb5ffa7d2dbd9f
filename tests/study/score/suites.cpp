// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/suites.hpp"

#include <cstdio>

namespace tread::blindtest {

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
  for (size_t i = 0; i < kinds.size(); ++i) {
    char name[24];
    std::snprintf(name, sizeof name, "%04zu", i + 1);
    HiddenCase one{name, "mid", kinds[i]};
    for (const std::string& word : {std::string("--noise"), one.nominal, std::string("--minutes"),
                                    std::to_string(minutes), std::string("--name"), one.name,
                                    std::string("--seed"), std::to_string(seed * 1000 + i + 1)})
      one.arguments.push_back(word);
    cases.push_back(one);
  }
  return cases;
}

}  // namespace tread::blindtest

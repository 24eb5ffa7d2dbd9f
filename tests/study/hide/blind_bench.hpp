// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/study/hide/blind_case.hpp"
#include "tests/study/hide/hidden_drive.hpp"
#include "tests/study/hide/instruments.hpp"

namespace tread::blind::bench {

/// A temporary folder.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("tread-blind-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& name = "") const { return (path_ / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::filesystem::path path_;
};

/// A case of two minutes.
inline CasePlan shortPlan(const std::vector<std::string>& effects, double size = 2.0) {
  CasePlan plan;
  plan.effects = effects;
  plan.kind = effects.empty() ? CaseKind::kNull : CaseKind::kSingle;
  plan.size = size;
  plan.minutes = 2.0;
  plan.seed = 17;
  return plan;
}

/// The same drive with and without an effect.
struct Twins {
  HiddenDrive with;
  HiddenDrive without;
  InstrumentFault fault;
  std::vector<Quantity> equivalent;
  EndPoseError gap;
};

/// The plain vehicle's drive, simulated once.
inline const HiddenDrive& plainDrive(double minutes, uint64_t seed) {
  static std::map<std::pair<double, uint64_t>, HiddenDrive> drives;
  const auto key = std::make_pair(minutes, seed);
  const auto found = drives.find(key);
  if (found != drives.end()) return found->second;
  const Programme programme = makeProgramme(Choice::kFull, minutes, seed);
  return drives.emplace(key, drive(programme, {}, *noiseLevel("mid"), seed)).first->second;
}

inline Twins twins(const std::string& effect, double size, double minutes = 2.5,
                   uint64_t seed = 5) {
  const Programme programme = makeProgramme(Choice::kFull, minutes, seed);
  const double duration = static_cast<double>(programme.duration) * 1e-6;
  const NoiseLevel noise = *noiseLevel("mid");
  const auto hidden = makeHidden({effect}, size, duration, seed);
  Twins both{drive(programme, hidden, noise, seed),
             plainDrive(minutes, seed),
             faultOf(hidden),
             hidden.front().hider.equivalent,
             {}};
  if (hidden.front().hider.measure)
    both.equivalent = hidden.front().hider.measure(compare(both.with, both.without));
  both.gap = hiddenGap(both.with, both.fault, both.without);
  return both;
}

/// A programme with one command for some patterns, after 2 s at rest.
inline Programme oneCommand(const sim::MotorPower& power, int patterns) {
  Programme programme;
  for (int i = 0; i < patterns; ++i)
    programme.patterns.push_back({(i + 1) * kPatternUs, 1, 1, power});
  programme.duration = (patterns + 2) * kPatternUs;
  return programme;
}

/// The body's velocity at the end of one command, after 6 s.
inline Twist2 steadyTwist(const std::vector<std::string>& effects, double size,
                          const sim::MotorPower& power) {
  const auto hidden = makeHidden(effects, size, 10.0, 1);
  const HiddenDrive driven = drive(oneCommand(power, 3), hidden, NoiseLevel{}, 1);
  return driven.track.v_clean[790];
}

}  // namespace tread::blind::bench

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tread::blindtest {

/// What may be known of a case in advance, and how it is hidden.
struct HiddenCase {
  std::string name;
  /// Nominal model of the robot: low, mid, high, recording-NAME; NAME~N: with wrong numbers, which
  /// tread-gap then has to calibrate.
  std::string nominal;
  /// of tread-hide, for a separate case; empty: part of a suite
  std::vector<std::string> arguments;
};

/// Options of a blind study.
struct Study {
  std::string suite = "small";  ///< quick, small, medium, full, wrong_start
  std::string out;
  std::string programs;         ///< folder of tread-hide, tread-gap and tread-rival
  std::string rival = {};       ///< method of tread-rival that replaces tread-gap
  std::string nominal;          ///< model file instead of calibrating; empty = calibrate
  std::string recordings = {};  ///< folder of logs for hiding effects; see suites.hpp
  double minutes = 10.0;
  double hour = 60.0;  ///< minutes of the log for calibrating the nominal model
  uint64_t seed = 1;
  size_t shard = 1;
  size_t shards = 1;
  size_t jobs = 1;
  bool keep = false;  ///< keep logs and reports; else they are deleted when their batch is scored
};

/// Name of the shard's folder in `out`.
std::string shardFolder(const Study& study);

/// Whether a nominal model has wrong numbers.
inline bool startsWrong(const std::string& nominal) {
  return nominal.find('~') != std::string::npos;
}

/// All cases of the suite in order, with what may be known of them.
std::vector<HiddenCase> casesOf(const Study& study);

/// Absolute path of the nominal model of a noise level or recording; created if missing.
/** An hour of the plain vehicle with a separate seed goes through `tread-gap find --calibrate`,
 * repeatedly from the previous result while residuals remain unexplained and terms are added; a
 * recording is used unchanged. A second process waits. */
std::string nominalModel(const Study& study, const std::string& name);

/// Provenance of each nominal model: {noise: {model sha256, rounds, verdict, effects}}.
nlohmann::ordered_json nominalStory(const Study& study, const std::vector<HiddenCase>& cases);

/// Hides and runs batch after batch, so that only one is on disk. Returns the lines of cases.jsonl:
/// the header, then one record each.
std::vector<std::string> runShard(const Study& study);

}  // namespace tread::blindtest

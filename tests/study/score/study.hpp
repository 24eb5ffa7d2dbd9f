// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tread::blindtest {

/// What may be known of a case before it is opened, and how it is hidden.
struct HiddenCase {
  std::string name;
  /// Which nominal model is the robot's: low, mid, high, recording-NAME; NAME~N: that one with
  /// wrong numbers, which tread-gap is then asked to calibrate.
  std::string nominal;
  std::vector<std::string> arguments;  ///< of tread-hide, for a case of its own; empty: of a suite
};

/// What a run of the blind test is asked.
struct Study {
  std::string suite = "small";  ///< quick, small, medium, full, wrong_start
  std::string out;
  std::string programs;         ///< folder of tread-hide, tread-gap and tread-rival
  std::string rival = {};       ///< method of tread-rival that answers in tread-gap's place
  std::string nominal;          ///< model file to be used instead of calibrating; empty = calibrate
  std::string recordings = {};  ///< folder of logs to hide effects in; see suites.hpp
  double minutes = 10.0;
  double hour = 60.0;  ///< minutes of the log that the nominal model is fitted to
  uint64_t seed = 1;
  size_t shard = 1;
  size_t shards = 1;
  size_t jobs = 1;
  bool keep = false;  ///< logs and reports stay, else they go when their batch is scored
};

/// Name of the shard's folder in `out`.
std::string shardFolder(const Study& study);

/// Whether a nominal model has wrong numbers.
inline bool startsWrong(const std::string& nominal) {
  return nominal.find('~') != std::string::npos;
}

/// All cases of the suite in order, with what may be known of them.
std::vector<HiddenCase> casesOf(const Study& study);

/// Where the nominal model of a noise level or recording is, absolute; made if it is not there.
/** An hour of the plain vehicle of a seed of its own, hidden like all logs, goes through
 * `tread-gap find --calibrate`, again from where it came to while that leaves something unexplained
 * and adds; a recording goes through it as it is. Whoever comes second waits. */
std::string nominalModel(const Study& study, const std::string& name);

/// How each nominal model was made: {noise: {model sha256, rounds, verdict, effects}}.
nlohmann::ordered_json nominalStory(const Study& study, const std::vector<HiddenCase>& cases);

/// Hides and runs batch after batch, so that only one lies on the disk. Returns the lines of
/// cases.jsonl: what the study is, then a record each.
std::vector<std::string> runShard(const Study& study);

}  // namespace tread::blindtest

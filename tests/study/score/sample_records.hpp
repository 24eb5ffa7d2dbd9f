// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/study/score/scores.hpp"

namespace tread::blindtest::samples {

/// A case with these hidden effects; the error of the truth is 0.1 m and 0.1 rad.
inline CaseRecord hidden(const std::vector<std::string>& names, const std::string& kind) {
  CaseRecord record;
  record.truth.name = "0001";
  record.truth.kind = kind;
  record.truth.noise = "mid";
  record.truth.programme = "full";
  record.truth.size = 2.0;
  record.truth.minutes = 10.0;
  record.truth.duration = 600.0;
  record.truth.floor = {{0.1, 0.1}, {}, 0.01};
  record.truth.gap = {{0.3, 0.3}, {}, 0.03};
  for (const std::string& name : names) {
    HiddenEffect effect;
    effect.name = name;
    effect.kind = "vehicle";
    effect.form = "physical";
    effect.shape = "same";
    record.truth.effects.push_back(effect);
  }
  record.truth.right_names = names;
  record.answer.verdict = "NO_DISCREPANCY";
  record.answer.before = {{0.5, 0.1}, {}};
  record.answer.after = {{0.5, 0.1}, {}};
  return record;
}

/// The answer names these.
inline CaseRecord answered(CaseRecord record, const std::vector<std::string>& names) {
  record.answer.verdict = "FOUND";
  for (const std::string& name : names) record.answer.effects.push_back({name, {}, {}, {}});
  return record;
}

inline JudgedCase judged(const CaseRecord& record) {
  return {record, judge(record)};
}

}  // namespace tread::blindtest::samples

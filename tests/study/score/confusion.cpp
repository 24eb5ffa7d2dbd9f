// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <map>
#include <set>

#include "tests/study/score/scores.hpp"

namespace tread::blindtest {
namespace {

const char* const kNothing = "nothing";
const char* const kUnexplained = "unexplained";
const char* const kRefused = "refused";

bool counts(const JudgedCase& one) {
  return one.record.truth.kind == "single" || one.record.truth.kind == "null";
}

std::string hiddenOf(const JudgedCase& one) {
  return one.record.truth.effects.empty() ? kNothing : one.record.truth.effects.front().name;
}

/// The given names; a group that contains the truth counts as the truth.
std::set<std::string> saidOf(const JudgedCase& one) {
  const std::string hidden = hiddenOf(one);
  std::set<std::string> said;
  const auto& effects = one.record.truth.effects;
  for (const NamedEffect& named : one.record.answer.effects) {
    const bool right =
        !effects.empty() && blindtest::belongs(named.name, effects.front(), one.record.answer);
    said.insert(right ? hidden : named.name);
  }
  if (one.judgement.moved > 0) said.insert(hidden);
  if (one.judgement.refused) said.insert(kRefused);
  if (one.judgement.flagged) said.insert(kUnexplained);
  if (said.empty()) said.insert(kNothing);
  return said;
}

}  // namespace

Confusion confusionOf(const std::vector<JudgedCase>& cases) {
  std::map<std::string, size_t> count;
  std::map<std::string, std::map<std::string, size_t>> said;
  std::set<std::string> names;
  const std::set<std::string> words{kNothing, kUnexplained, kRefused};
  for (const JudgedCase& one : cases) {
    if (!counts(one)) continue;
    const std::string hidden = hiddenOf(one);
    ++count[hidden];
    if (hidden != kNothing) names.insert(hidden);
    for (const std::string& word : saidOf(one)) {
      ++said[hidden][word];
      if (words.count(word) == 0) names.insert(word);
    }
  }
  Confusion confusion;
  confusion.named.assign(names.begin(), names.end());
  for (const char* word : {kNothing, kUnexplained, kRefused}) confusion.named.emplace_back(word);
  for (const std::string& name : names)
    if (count.count(name) > 0) confusion.hidden.push_back(name);
  if (count.count(kNothing) > 0) confusion.hidden.emplace_back(kNothing);
  for (const std::string& hidden : confusion.hidden) {
    std::vector<double> row;
    for (const std::string& name : confusion.named)
      row.push_back(static_cast<double>(said[hidden][name]) / static_cast<double>(count[hidden]));
    confusion.share.push_back(row);
    confusion.cases.push_back(count[hidden]);
  }
  return confusion;
}

}  // namespace tread::blindtest

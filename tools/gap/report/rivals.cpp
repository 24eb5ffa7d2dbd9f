// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/rivals.hpp"

#include <algorithm>

#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

bool isKnown(const std::vector<RivalPair>& pairs, const std::string& one,
             const std::string& other) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const RivalPair& pair) {
    return (pair.found == one && pair.other == other) || (pair.found == other && pair.other == one);
  });
}

}  // namespace

std::vector<std::string> rivalsOf(const FoundEffect& effect) {
  std::vector<std::string> names;
  for (const std::string& member : effect.group)
    if (!contains(names, member)) names.push_back(member);
  for (const RunnerUp& runner_up : effect.runner_ups)
    if (isAsGood(runner_up) && !contains(names, runner_up.effect))
      names.push_back(runner_up.effect);
  return names;
}

std::string rivalTitle(const std::string& found, const std::string& other) {
  const std::string title = inSentence(shortTitleOf(other));
  // A model may have a latency of the poses alone, which is another one.
  if (effectNamed(other).kind == EffectKind::kMeasurement)
    for (const ConfoundedGroup* group : confoundedGroupsOf(found))
      if (group->share != nullptr && contains(group->members, other))
        return title + group->share_words;
  return title;
}

std::vector<std::string> waysToTell(const FoundEffect& effect) {
  const std::vector<std::string> rivals = rivalsOf(effect);
  std::vector<std::string> ways;
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect.name))
    if (std::any_of(group->members.begin(), group->members.end(),
                    [&](const std::string& member) { return contains(rivals, member); }))
      ways.push_back(group->separates);
  if (ways.empty()) ways.push_back(effectNamed(effect.name).separates);
  return ways;
}

bool driveMayTell(const RivalPair& pair) {
  const std::vector<const ConfoundedGroup*> groups = confoundedGroupsOf(pair.found);
  return !pair.twin ||
         std::none_of(groups.begin(), groups.end(), [&pair](const ConfoundedGroup* group) {
           return contains(group->members, pair.other);
         });
}

std::vector<RivalPair> rivalPairs(const Finding& finding) {
  std::vector<RivalPair> pairs;
  for (const FoundEffect& effect : finding.effects) {
    for (const std::string& member : effect.group)
      if (!isKnown(pairs, effect.name, member)) pairs.push_back({effect.name, member, true});
    for (const RunnerUp& runner_up : effect.runner_ups)
      if (!isKnown(pairs, effect.name, runner_up.effect))
        pairs.push_back({effect.name, runner_up.effect, false, runner_up.behind, runner_up.error});
  }
  return pairs;
}

}  // namespace tread::gap

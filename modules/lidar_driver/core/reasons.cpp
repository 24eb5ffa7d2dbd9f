// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/core/reasons.hpp"

#include <tuple>

namespace tread::lidar {
namespace {

constexpr int64_t kKept = 5'000'000;  // [us]
constexpr size_t kMostReasons = 64;   // whatever a line says

}  // namespace

void Reasons::note(Rank rank, const std::string& what, int64_t now, int64_t times,
                   const std::string& remedy) {
  if (noted_.size() >= kMostReasons && noted_.count(what) == 0) return;
  Noted& noted = noted_[what];
  noted.rank = rank;
  noted.times += times;
  noted.last = now;
  noted.remedy = remedy;
}

NotedReason Reasons::best(int64_t now) const {
  const std::pair<const std::string, Noted>* found = nullptr;
  for (const auto& candidate : noted_) {
    const Noted& noted = candidate.second;
    if (noted.rank > Rank::kStarting && now - noted.last > kKept) continue;
    if (found == nullptr ||
        std::tie(noted.rank, noted.times) > std::tie(found->second.rank, found->second.times))
      found = &candidate;
  }
  if (found == nullptr) return {};
  const auto& [what, noted] = *found;
  std::string words = what;
  if (noted.rank >= Rank::kUnreadable) words += " (" + std::to_string(noted.times) + ")";
  if (!noted.remedy.empty()) words += "; " + noted.remedy;
  return {noted.rank, words};
}

}  // namespace tread::lidar

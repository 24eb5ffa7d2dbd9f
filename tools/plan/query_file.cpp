// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/query_file.hpp"

#include <array>

#include "common/config/scalars.hpp"
#include "tools/plan/words.hpp"

namespace tread::plan {
namespace {

constexpr size_t kMostQueries = 1'000'000;
constexpr std::array<const char*, 6> kNames{"the start's x", "the start's y", "the start's yaw",
                                            "the goal's x",  "the goal's y",  "the goal's yaw"};

PlanQuery readQuery(Words& words) {
  std::array<double, 6> values{};
  int line = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const bool is_yaw = i % 3 == 2;
    values[i] = words.number(kNames[i], is_yaw ? Range{-100.0, 100.0} : Range{-1e6, 1e6},
                             is_yaw ? "rad" : "m");
    if (i == 0) line = words.line();
    if (words.line() != line)
      throw words.error("line " + std::to_string(line) + " has " + std::to_string(i) +
                        " numbers; a query is six: x y yaw x y yaw");
  }
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
}

std::string formatPose(const Pose2& pose) {
  return formatNumber(pose.x) + " " + formatNumber(pose.y) + " " + formatNumber(pose.yaw);
}

}  // namespace

std::vector<PlanQuery> parseQueries(std::string text, const std::string& name) {
  Words words(std::move(text), name, '#');
  std::vector<PlanQuery> queries;
  int line = 0;
  while (!words.atEnd()) {
    queries.push_back(readQuery(words));
    if (words.line() == line)
      throw words.error("more than six numbers; a query is x y yaw x y yaw");
    line = words.line();
    if (queries.size() > kMostQueries)
      throw words.error("more than " + std::to_string(kMostQueries) + " queries");
  }
  if (queries.empty()) throw words.error("no query; one is x y yaw x y yaw on a line");
  return queries;
}

std::vector<PlanQuery> readQueries(const std::string& path) {
  return parseQueries(readWhole(path), path);
}

std::string formatQueries(const std::vector<PlanQuery>& queries) {
  std::string text = "# x y yaw x y yaw: start and goal [m, rad] in the map's frame\n";
  for (const PlanQuery& query : queries)
    text += formatPose(query.T_map_start) + " " + formatPose(query.T_map_goal) + "\n";
  return text;
}

}  // namespace tread::plan

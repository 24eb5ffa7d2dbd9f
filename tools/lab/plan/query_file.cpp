// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/query_file.hpp"

#include "tools/lab/plan/plan_files.hpp"

#include <array>
#include <random>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "tools/lab/plan/tokenizer.hpp"

namespace tread::plan {
namespace {

constexpr size_t kMostQueries = 1'000'000;
constexpr std::array<const char*, 6> kNames{"the start's x", "the start's y", "the start's yaw",
                                            "the goal's x",  "the goal's y",  "the goal's yaw"};

PlanQuery readQuery(Tokenizer& tokens) {
  std::array<double, 6> values{};
  int line = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const bool is_yaw = i % 3 == 2;
    values[i] = tokens.number(kNames[i], is_yaw ? Range{-100.0, 100.0} : Range{-1e6, 1e6},
                              is_yaw ? "rad" : "m");
    if (i == 0) line = tokens.line();
    if (tokens.line() != line)
      throw tokens.error("line " + std::to_string(line) + " has " + std::to_string(i) +
                         " numbers; a query is six: x y yaw x y yaw");
  }
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
}

std::string formatPose(const Pose2& pose) {
  return formatNumber(pose.x) + " " + formatNumber(pose.y) + " " + formatNumber(pose.yaw);
}

constexpr size_t kDrawsEach = 1000;

/// Draws poses over a grid's window, the same on every platform (the standard's distributions
/// differ).
class Draw {
 public:
  Draw(const Grid& grid, uint64_t seed) : grid_(grid), random_(seed) {}

  Pose2 pose() {
    const double x = share() * grid_.width() * grid_.cellSize();
    const double y = share() * grid_.height() * grid_.cellSize();
    return {grid_.lower().x * grid_.cellSize() + x, grid_.lower().y * grid_.cellSize() + y,
            (2.0 * share() - 1.0) * kPi};
  }

 private:
  double share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }  // [0, 1)

  const Grid& grid_;
  std::mt19937_64 random_;
};

}  // namespace

std::vector<PlanQuery> parseQueries(std::string text, const std::string& name) {
  Tokenizer tokens(std::move(text), name, '#');
  std::vector<PlanQuery> queries;
  int line = 0;
  while (!tokens.atEnd()) {
    queries.push_back(readQuery(tokens));
    if (tokens.line() == line)
      throw tokens.error("more than six numbers; a query is x y yaw x y yaw");
    line = tokens.line();
    if (queries.size() > kMostQueries)
      throw tokens.error("more than " + std::to_string(kMostQueries) + " queries");
  }
  if (queries.empty()) throw tokens.error("no query; one is x y yaw x y yaw on a line");
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

std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free) {
  Draw draw(grid, wanted.seed);
  std::vector<PlanQuery> queries;
  Pose2 start;
  bool has_start = false;
  for (size_t draws = kDrawsEach * wanted.count; queries.size() < wanted.count; --draws) {
    if (draws == 0)
      throw std::runtime_error("only " + std::to_string(queries.size()) + " of " +
                               std::to_string(wanted.count) +
                               " random queries found; the map has too little free space for the "
                               "footprint, or --apart is too large");
    const Pose2 pose = draw.pose();
    if (!is_free(pose)) continue;
    // Too close pairs are dropped as a whole: the start may have nothing far enough away.
    if (has_start && (pose.position() - start.position()).norm() > wanted.apart)
      queries.push_back({T_map_grid * start, T_map_grid * pose});
    has_start = !has_start;
    start = pose;
  }
  return queries;
}

}  // namespace tread::plan

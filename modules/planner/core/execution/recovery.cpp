// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tread::planner {
namespace {

struct Move {
  std::vector<const TablePattern*> patterns;
  Pose2 end;  // relative to the start
};

/// Moves of one or two patterns that lead from rest to rest.
std::vector<Move> movesFromRest(const PatternTable& table) {
  std::vector<Move> moves;
  for (const TablePattern* first : table.from(table.restClass())) {
    if (first->exit == table.restClass()) {
      moves.push_back({{first}, first->end().pose});
      continue;
    }
    for (const TablePattern* second : table.stopsFrom(first->exit))
      moves.push_back({{first, second}, first->end().pose * second->end().pose});
  }
  return moves;
}

/// How welcome a move is in the try of that number; the greatest is taken.
double worth(const Move& move, int number) {
  switch (number % 3) {
    case 0:
      return -move.end.x - 0.1 * std::abs(move.end.yaw);
    case 1:
      return move.end.yaw - std::hypot(move.end.x, move.end.y);
    default:
      return -move.end.yaw - std::hypot(move.end.x, move.end.y);
  }
}

/// Whether a move is free; if `regains`, only with more and more margin on its way.
bool isFree(const Move& move, const CollisionChecker& around, const Pose2& start, bool regains) {
  int level = around.freeLevel(start, CollisionChecker::kPlan);
  Overlap overlap = around.overlap(start);
  Pose2 pose = start;
  for (const TablePattern* pattern : move.patterns) {
    if (level >= 0) {
      const int wanted = regains ? CollisionChecker::kPlan : level;
      if (!around.sweepRegains(turned(pose), level, *pattern, wanted)) return false;
      level = around.freeLevel(pose * pattern->end().pose, wanted);
    } else {
      const std::optional<Overlap> after = around.escape(pose, overlap, *pattern);
      if (!after) return false;
      overlap = *after;
    }
    pose = pose * pattern->end().pose;
  }
  return true;
}

}  // namespace

std::vector<int> Recovery::propose(const PatternTable& table,
                                   const CollisionChecker& collision_checker,
                                   const Pose2& T_map_body) {
  std::vector<Move> moves = movesFromRest(table);
  const int number = tries_++;
  std::stable_sort(moves.begin(), moves.end(), [number](const Move& a, const Move& b) {
    return worth(a, number) > worth(b, number);
  });
  for (const bool regains : {true, false}) {
    for (const Move& move : moves) {
      if (!isFree(move, collision_checker, T_map_body, regains)) continue;
      std::vector<int> ids;
      for (const TablePattern* pattern : move.patterns) ids.push_back(pattern->id());
      return ids;
    }
  }
  return {};
}

}  // namespace tread::planner

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/helpers.hpp"
#include "tests/planner/kit/path_bench.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// An answer and the solutions reported before it.
struct Told {
  PathAnswer answer;
  std::vector<double> costs;
  std::vector<int> expansions;
  int begun = 0;
};

Told ask(PathBench& bench, const PathQuery& query, const StopPredicate& stop) {
  Told told;
  PathEvents events;
  events.search_begins = [&told] { ++told.begun; };
  events.better_plan = [&told](double cost, int expansions) {
    told.costs.push_back(cost);
    told.expansions.push_back(expansions);
  };
  told.answer = bench.planner->answer(query, stop, events);
  return told;
}

template <class Visit>
void onQueries(uint64_t seed, int grounds, const Visit& visit) {
  for (int i = 0; i < grounds; ++i) {
    PathBench bench(seed + static_cast<uint64_t>(i), i % 3 != 0);
    for (int k = 0; k < 3; ++k) {
      INFO("seed " << seed + static_cast<uint64_t>(i) << " query " << k);
      visit(bench, bench.query());
    }
  }
}

}  // namespace

TEST_CASE("each plan that is told is cheaper than the one before, and the last one is returned") {
  int improved = 0;
  onQueries(1, testing::effort(40), [&](PathBench& bench, const PathQuery& query) {
    const Told told = ask(bench, query, after(3000));
    for (size_t i = 1; i < told.costs.size(); ++i) {
      REQUIRE(told.costs[i] < told.costs[i - 1]);
      REQUIRE(told.expansions[i] > told.expansions[i - 1]);
      ++improved;
    }
    REQUIRE(told.costs.empty() == (told.answer.end != PathEnd::kSolved));
    if (told.costs.empty()) return;
    CHECK(told.begun == 1);
    CHECK(told.answer.search.cost == Approx(told.costs.back()).epsilon(1e-6));
    CHECK(told.expansions.back() <= told.answer.search.expansions);
  });
  CHECK(improved > testing::effort(30));
}

TEST_CASE("more expansions never give a worse plan, and what is exhausted stays as it is") {
  int exhausted = 0;
  onQueries(500, testing::effort(15), [&](PathBench& bench, const PathQuery& query) {
    double cost = 0.0;
    bool solved = false;
    bool finished = false;
    for (int expansions = 16; expansions <= 8192; expansions *= 2) {
      const Told told = ask(bench, query, after(expansions));
      const SearchResult& search = told.answer.search;
      const bool now = told.answer.end == PathEnd::kSolved;
      if (solved) {
        REQUIRE(now);
        REQUIRE(search.cost <= cost);
      }
      if (finished) {
        REQUIRE(search.exhausted);
        REQUIRE(search.cost == cost);
      }
      solved = now;
      cost = search.cost;
      finished = search.exhausted;
    }
    exhausted += finished ? 1 : 0;
  });
  CHECK(exhausted >= testing::effort(10) - 1);
}

TEST_CASE("a search that is told to stop does so within the 16 expansions between two questions") {
  int stopped = 0;
  onQueries(900, testing::effort(20), [&](PathBench& bench, const PathQuery& query) {
    for (int limit = 1; limit <= 300; limit += 23) {
      int last_asked = -1;
      const Told told = ask(bench, query, [&](int expansions) {
        CHECK(expansions >= last_asked);
        last_asked = expansions;
        return expansions >= limit;
      });
      const SearchResult& search = told.answer.search;
      if (search.exhausted || search.expansions == 0) continue;
      CHECK(search.expansions < limit + 16);
      ++stopped;
    }
  });
  CHECK(stopped > testing::effort(150));
}

TEST_CASE("a stop while the way is worked out is heard as soon as one while searching") {
  int heard = 0;
  onQueries(1100, testing::effort(10), [&](PathBench& bench, const PathQuery& query) {
    for (int limit = 1; limit <= 64; limit *= 2) {
      int asked = 0;
      const Told told = ask(bench, query, [&](int expansions) {
        ++asked;
        return expansions > 0 || asked >= limit;
      });
      if (asked == 0 || told.answer.search.exhausted) continue;
      // Heuristic, search and a finer search may each check once more.
      CHECK(asked <= limit + 3);
      CHECK(told.answer.search.expansions <= 16);
      heard += told.begun == 1 && asked >= limit ? 1 : 0;
    }
  });
  CHECK(heard > testing::effort(60));
}

TEST_CASE("a stop before anything was found says so and promises nothing") {
  int none = 0;
  onQueries(1300, testing::effort(20), [&](PathBench& bench, const PathQuery& query) {
    const Told told = ask(bench, query, [](int) { return true; });
    if (told.answer.end == PathEnd::kNoneInTime && !told.answer.search.exhausted) {
      ++none;
      CHECK(told.answer.reason == "none was found before the search was stopped");
      CHECK(told.costs.empty());
    }
  });
  CHECK(none > 0);
}

TEST_CASE("an exhausted search is at least as cheap as one that begins with greater care") {
  // For any initial weights the last search has no better result at the resolution, except for
  // plans hidden by a shared cell.
  onQueries(1700, testing::effort(12), [&](PathBench& bench, const PathQuery& query) {
    const Told greedy = ask(bench, query, after(40'000));
    if (!greedy.answer.search.exhausted || greedy.answer.end != PathEnd::kSolved) return;
    PathConfig careful = bench.config;
    careful.search.heuristic_weight = 1.0;
    careful.search.turn_weight = 0.0;
    careful.search.improvements = 0;
    PathPlanner planner(bench.grid, *bench.table, careful);
    const PathAnswer answer = planner.answer(query, after(40'000));
    REQUIRE(answer.end == PathEnd::kSolved);
    CHECK(greedy.answer.search.cost <= answer.search.cost * 1.05 + 0.1);
  });
}

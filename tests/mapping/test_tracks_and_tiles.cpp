// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>

#include "common/geometry/se3.hpp"
#include "modules/mapping/core/occupancy_map.hpp"
#include "modules/mapping/core/spatial_track.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

std::vector<CellIndex> tiles(int count) {
  std::vector<CellIndex> list;
  for (int i = 0; i < count; ++i) list.push_back({i % 8, i / 8});
  return list;
}

}  // namespace

TEST_CASE("a pose in space is interpolated between its neighbours and never extrapolated") {
  SpatialTrack track(1'000'000, 10.0);
  REQUIRE(track.push(100'000, isometryFrom({0, 0, 0}, {0.0, 0.0, 0.0})) ==
          SpatialTrack::PoseCheck::kTaken);
  REQUIRE(track.push(120'000, isometryFrom({0.02, 0.01, 0.004}, {0.1, 0.05, 0.0})) ==
          SpatialTrack::PoseCheck::kTaken);
  const auto middle = track.at(110'000, 50'000);
  REQUIRE(middle);
  REQUIRE(middle->translation().isApprox(Eigen::Vector3d(0.01, 0.005, 0.002), 1e-9));
  const auto angles = yawPitchRoll(Eigen::Quaterniond(middle->linear()));
  REQUIRE(angles.yaw == Approx(0.05).margin(1e-4));
  REQUIRE(angles.pitch == Approx(0.025).margin(1e-3));
  REQUIRE(track.at(100'000, 50'000));
  REQUIRE(track.at(120'000, 0));
  REQUIRE_FALSE(track.at(99'999, 50'000));
  REQUIRE_FALSE(track.at(120'001, 50'000));
  REQUIRE_FALSE(track.at(110'000, 10'000));
}

TEST_CASE("a track refuses what is not newer and forgets what is old") {
  SpatialTrack track(1'000'000, 10.0);
  const auto pose = isometryFrom({1, 2, 3}, {});
  track.push(100'000, pose);
  REQUIRE(track.push(100'000, pose) == SpatialTrack::PoseCheck::kNotNewer);
  // A time before all clocks, for which no difference may be computed.
  SpatialTrack empty(1'000'000, 10.0);
  for (const int64_t utime : {INT64_MIN, int64_t{-1}})
    REQUIRE(empty.push(utime, pose) == SpatialTrack::PoseCheck::kNotNewer);
  REQUIRE(empty.empty());
  for (int64_t utime = 200'000; utime < 1'400'000; utime += 100'000) track.push(utime, pose);
  REQUIRE_FALSE(track.at(250'000, 1'000'000));
  REQUIRE(track.at(350'000, 1'000'000));
}

TEST_CASE("a single pose far off is forgotten, three that agree are a jump") {
  SpatialTrack track(1'000'000, 10.0);
  const auto at = [](double x) { return isometryFrom({x, 0, 0}, {}); };
  using PoseCheck = SpatialTrack::PoseCheck;
  track.push(100'000, at(0.0));
  REQUIRE(track.push(120'000, at(0.69)) == PoseCheck::kTaken);
  REQUIRE(track.push(140'000, at(50.0)) == PoseCheck::kDoubted);
  REQUIRE(track.push(160'000, at(0.7)) == PoseCheck::kTaken);
  REQUIRE(track.at(140'000, 50'000)->translation().x() == Approx(0.695));
  REQUIRE(track.push(180'000, at(50.0)) == PoseCheck::kDoubted);
  REQUIRE(track.push(200'000, at(90.0)) == PoseCheck::kDoubted);
  REQUIRE(track.push(220'000, at(90.1)) == PoseCheck::kDoubted);
  REQUIRE(track.newest() == 160'000);
  REQUIRE(track.push(240'000, at(90.2)) == PoseCheck::kJump);
  REQUIRE(track.at(230'000, 50'000)->translation().x() == Approx(90.15));
  REQUIRE_FALSE(track.at(160'000, 50'000));
}

TEST_CASE("changed tiles are sent first, all others in turn") {
  TileSchedule turns(7);
  const auto seen = tiles(64);
  std::set<std::pair<int, int>> sent;
  for (int cycle = 0; cycle < 10; ++cycle) {
    const std::vector<CellIndex> changed{{3, 3}, {4, 3}};
    turns.begin(seen, changed);
    REQUIRE(turns.take() == CellIndex{3, 3});
    REQUIRE(turns.take() == CellIndex{4, 3});
    for (int i = 0; i < 7; ++i) {
      const CellIndex tile = turns.take();
      sent.insert({tile.x, tile.y});
    }
    REQUIRE(turns.empty());
  }
  REQUIRE(sent.size() == 62);
}

TEST_CASE("what a cycle could not send stays first, once, as long as it may be sent") {
  TileSchedule turns(0);
  const auto seen = tiles(16);
  turns.begin(seen, {{1, 0}, {2, 0}, {3, 0}});
  REQUIRE(turns.take() == CellIndex{1, 0});
  turns.begin(seen, {{0, 1}, {3, 0}});
  REQUIRE(turns.take() == CellIndex{2, 0});
  REQUIRE(turns.take() == CellIndex{3, 0});
  REQUIRE(turns.take() == CellIndex{0, 1});
  REQUIRE(turns.empty());
  turns.begin(seen, {{5, 1}, {6, 1}});
  turns.begin({{6, 1}}, {});
  REQUIRE(turns.take() == CellIndex{6, 1});
  REQUIRE(turns.empty());
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <memory>

#include "common/bus/health.hpp"
#include "modules/mapping/core/spatial_track.hpp"
#include "modules/mapping/core/tile_schedule.hpp"
#include "modules/mapping/mapping_config.hpp"
#include "modules/mapping/scan_reader.hpp"

namespace tread::mapping {

/// Makes MAP from SCAN and INS, and says in HEALTH what it refused and why.
class MappingNode : public Node {
 public:
  MappingNode(const MappingConfig& config, Bus& bus);

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override;

  /// The present map, for tests and replay.
  const LocalMap& map() const { return *map_; }

 private:
  /// What becomes of the first scan in the queue.
  enum class Fate { kWaits, kDone };

  void startClock();
  void hear(const ins_t& message);
  void hear(const scan_t& message);
  void beginNewMap();
  Fate tryFirst(int64_t now);
  void insert(const WaitingScan& scan);
  void refuse(const std::string& reason);
  void publishTiles(int64_t utime);
  void send(CellIndex tile);
  void reportHealth(int64_t now);

  MappingConfig config_;
  Bus& bus_;
  HealthReporter health_;
  std::unique_ptr<LocalMap> map_;
  SpatialTrack track_;
  std::deque<WaitingScan> waiting_;
  TileSchedule turns_;
  int64_t next_cycle_ = 0;
  int64_t seq_ = 0;
  bool heard_ = false;  // anything yet: only then the robot's time is known
  int64_t last_scan_;   // [us] when the last SCAN came in
  int64_t last_ins_;    // [us] when the last INS with a pose came in
  int64_t last_taken_;  // [us] when the last scan went into the map
  std::string last_refusal_;
};

}  // namespace tread::mapping

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tread/scan_t.hpp>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/messages/scan_messages.hpp"
#include "modules/mapping/core/occupancy_map.hpp"
#include "modules/mapping/core/scan_monitor.hpp"
#include "modules/mapping/core/spatial_track.hpp"

namespace tread::mapping {

/// Configuration of mapping, with its defaults.
struct MappingConfig {
  OccupancyMapConfig map;
  /// [s] between cycles of MAP; changed tiles wait no longer than this
  double publish_period = 0.2;
  double refresh_period = 2.0;  ///< [s] in which every tile is sent at least once
  double max_ins_gap = 0.1;  ///< [s] largest gap between INS poses for interpolating a beam's pose
  double max_wait = 0.5;     ///< [s] for which a scan waits for INS
  double top_speed = 10.0;   ///< [m/s] of the robot; more is a jump of the INS: a new map begins
  double silence = 1.0;      ///< [s] without an accepted scan after which mapping reports a fault
  std::string effective;     ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
MappingConfig readMappingConfig(ConfigReader& reader);

/// Makes MAP from SCAN and INS, and reports refusals with their reasons in HEALTH.
class MappingNode : public Node {
 public:
  MappingNode(const MappingConfig& config, Bus& bus);

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override;

  /// The current map, for tests and replay.
  const OccupancyMap& map() const { return *map_; }

 private:
  /// Result of handling the first scan in the queue.
  enum class Fate { kWaits, kDone };

  void startClock();
  void hear(const ins_t& message);
  void hear(const scan_t& message);
  void beginNewMap();
  Fate tryFirst(int64_t now);
  void insert(const ReceivedScan& scan);
  ScanMonitor& monitorOf(const Eigen::Isometry3d& T_body_sensor);
  std::string lyingFinder() const;
  void refuse(const std::string& reason);
  void publishTiles(int64_t utime);
  void send(CellIndex tile);
  void reportHealth(int64_t now);

  MappingConfig config_;
  Bus& bus_;
  HealthReporter health_;
  std::unique_ptr<OccupancyMap> map_;
  SpatialTrack track_;
  std::deque<ReceivedScan> waiting_;
  std::vector<std::pair<Eigen::Isometry3d, ScanMonitor>> monitors_;  ///< by range finder
  TileSchedule turns_;
  int64_t next_cycle_ = 0;
  int64_t seq_ = 0;
  bool heard_ = false;  // any message: the robot's time is unknown before
  int64_t last_scan_;   // [us] when the last SCAN arrived
  int64_t last_ins_;    // [us] when the last INS with a pose arrived
  int64_t last_taken_;  // [us] when the last scan was inserted into the map
  std::string last_refusal_;
};

}  // namespace tread::mapping

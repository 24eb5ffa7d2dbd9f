// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/drive/event_teller.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread {

/// A message for viewers, in one of Foxglove's own schemas, which are drawn without a plugin.
struct SceneMessage {
  std::string topic;
  std::string schema;  ///< its name
  std::string json;
  uint64_t part = 0;  ///< identifies the entity of its topic that it replaces
};

/// Draws the robot, the map, the scan and the plan with its tree, and reports events, from Tread's
/// messages.
/** Frames: map, body. All times are times of recording: a viewer uses the recorder's clock. */
class SceneMaker {
 public:
  std::vector<SceneMessage> take(const LogEvent& event);

 private:
  void hear(const ins_t& ins);
  void hear(const map_tile_t& tile);
  void hear(const scan_t& scan);
  void hear(const plan_t& plan);
  void hear(const plan_tree_t& tree);
  void hear(const goal_t& goal);
  void hear(const config_t& config);
  void drawMap();

  int64_t now_ = 0;  ///< [us] of recording
  std::vector<SceneMessage> made_;
  EventTeller teller_;
  Pose2 T_map_body_;
  bool placed_ = false;
  std::unique_ptr<TileMap> map_;
  bool map_changed_ = false;
  int64_t map_drawn_ = INT64_MIN;  ///< [us]
};

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tools/missions/mission_runner.hpp"
#include "tools/missions/report.hpp"

namespace tread::missions {

/// Missions to be driven one way.
struct CampaignOrder {
  int missions = 1;
  uint64_t seed = 1;                   ///< of the first; the others count up from it
  int threads = 1;                     ///< missions at the same time
  std::string name;                    ///< of the campaign: its rule, or that it is omniscient
  std::vector<std::string> overrides;  ///< of the configuration, for the report
  MissionOptions options;              ///< of each mission; its log is set here
  std::optional<uint64_t> show;        ///< seed of the mission to draw
  std::string picture;                 ///< the file of that
  std::string log;                     ///< of the first mission; empty = none
};

/// Drives the missions; results are in the order of the seeds, lines go to stdout as they come.
Campaign runCampaign(const RobotConfig& robot, const CampaignOrder& order);

}  // namespace tread::missions

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/lab/missions/mission.hpp"

namespace tread::missions {

/// Ground of all given worlds, overriding their own.
struct GivenGround {
  std::string surface;  ///< name, built in or of a kind of world; empty = that of the world
  std::optional<double> friction;  ///< [1] of that surface, or of ice if none is named

  bool empty() const { return surface.empty() && !friction; }
};

/// Timed worlds from a file; throws one clear line with file:line.
/** There are two formats. (1) Lines "world x y radius" [m], optionally gzipped, # begins a comment:
 * upright discs in the order of the file. Start, goal, tolerance and limit are those of the BARN
 * benchmark, the ground is tarmac, and the lengths of reference paths come from index.csv in the
 * same folder (columns world, path_m), else from the straight line. (2) YAML: start [m m rad],
 * goal [m], tolerance and limit for all worlds; `discs`, a file of the first format; `worlds`, a
 * list of name, world (a world file of the simulator or its keys), path [m] and overrides of the
 * common keys. Seeds count from 0 in the order of the file. `only`: names of the selected worlds;
 * empty = all. */
std::vector<MissionWorld> readGivenWorlds(const std::string& file,
                                          const std::vector<std::string>& only = {},
                                          const GivenGround& ground = {});

/// The surface of the given ground; throws ConfigError with one line for an unknown name.
sim::SurfaceParameters surfaceOf(const GivenGround& ground);

/// Metric of the BARN challenge for a timed run: success x t / clip(clock, 2 t, 8 t), with t the
/// time for the reference path at 2 m/s; 0.5 at most.
double navigationMetric(const MissionResult& result);

}  // namespace tread::missions

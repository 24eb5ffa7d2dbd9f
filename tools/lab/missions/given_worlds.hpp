// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/lab/missions/mission.hpp"

namespace tread::missions {

/// The ground of all given worlds, in the place of what they say.
struct GivenGround {
  std::string surface;             ///< by name, built in or of a kind of world; empty = as they say
  std::optional<double> friction;  ///< [1] of that surface, or of ice

  bool empty() const { return surface.empty() && !friction; }
};

/// Worlds to be driven against the clock, from a file; throws one clear line with file:line.
/** Two forms. Lines "world x y radius" [m], packed by gzip or not, # begins a comment: upright
 * discs, in the order of the file; start, goal, tolerance and limit are those of the BARN
 * benchmark, the ground is tarmac, and lengths of reference paths come from a table index.csv
 * beside it (columns world, path_m), else the straight line counts. Or YAML: start [m m rad], goal
 * [m], tolerance, limit for all worlds, `discs`, a file of the first form, and `worlds`, a list of
 * name, world (keys of a world file of the simulator, or the file), path [m] and what is another
 * one there. Seeds count from 0 in the order of the file. `only`: names of the worlds wanted; empty
 * = all. */
std::vector<MissionWorld> readGivenWorlds(const std::string& file,
                                          const std::vector<std::string>& only = {},
                                          const GivenGround& ground = {});

/// The surface of given ground; throws ConfigError with one line for one that nobody knows.
sim::SurfaceParameters surfaceOf(const GivenGround& ground);

/// The BARN challenge's metric of a timed run: success x t / clip(clock, 2 t, 8 t), t the time that
/// the reference path takes at 2 m/s; 0.5 at most.
double navigationMetric(const MissionResult& result);

}  // namespace tread::missions

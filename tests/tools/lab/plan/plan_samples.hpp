// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/lab/plan/plan_files.hpp"

namespace tread::plan::samples {

using Folder = tread::samples::OwnFolder;

/// A file of the planning scenarios by others; empty if absent.
inline std::string recorded(const std::string& name) {
  return tread::testing::recorded("planning/" + name);
}

/// A text with a few bytes changed, removed or inserted, or truncated.
inline std::string damaged(std::string text, std::mt19937_64& random) {
  const std::string bytes(
      "0123456789-+.:# \n\0\xff"
      "eNax",
      24);
  for (size_t changes = 1 + random() % 4; changes > 0 && !text.empty(); --changes) {
    const size_t at = random() % text.size();
    const char byte = bytes[random() % bytes.size()];
    switch (random() % 5) {
      case 0:
        text[at] = byte;
        break;
      case 1:
        text.erase(at, 1 + random() % 12);
        break;
      case 2:
        text.insert(at, 1, byte);
        break;
      case 3:
        text.insert(at, 1 + random() % 6, '9');
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

/// 4 x 3 cells of 0.5 m.
inline const std::string kEnvironment =
    "discretization(cells): 4 3\n"
    "obsthresh: 254\n"
    "cost_inscribed_thresh: 253\n"
    "cost_possibly_circumscribed_thresh: 128\n"
    "cellsize(meters): 0.5\n"
    "nominalvel(mpersecs): 0.8\n"
    "timetoturn45degsinplace(secs): 3.0\n"
    "start(meters,rads): 0.25 0.25 0\n"
    "end(meters,rads): 1.75 1.25 -1.5\n"
    "environment:\n"
    "0 100 253 254\n"
    "0   0 128 255\n"
    "0   0   0   0\n";

/// Four headings, cells of 0.5 m: from heading 0 one cell ahead and a quarter circle to the left,
/// from heading 3 one cell back.
inline const std::string kPrimitives =
    "resolution_m: 0.500000\n"
    "numberofangles: 4\n"
    "totalnumberofprimitives: 3\n"
    "primID: 0\n"
    "startangle_c: 0\n"
    "endpose_c: 1 0 0\n"
    "additionalactioncostmult: 1\n"
    "intermediateposes: 3\n"
    "0.0000 0.0000 0.0000\n"
    "0.2000 0.0000 0.0000\n"
    "0.5000 0.0000 0.0000\n"
    "primID: 1\n"
    "startangle_c: 0\n"
    "endpose_c: 1 1 1\n"
    "additionalactioncostmult: 3\n"
    "intermediateposes: 4\n"
    "0.0000 0.0000 0.0000\n"
    "0.3000 0.0000 0.5000\n"
    "0.3000 0.4000 1.0000\n"
    "0.5000 0.5000 1.5708\n"
    "primID: 0\n"
    "startangle_c: 3\n"
    "endpose_c: 0 1 -1\n"
    "additionalactioncostmult: 5\n"
    "intermediateposes: 2\n"
    "0.0000 0.0000 -1.5708\n"
    "0.0000 0.5000 4.7124\n";

/// The first two of them in the format of nav2's lattice generator: without their start poses.
inline const std::string kLattice =
    "{\n\t\"version\": 1.0,\n\t\"date_generated\": \"2026-01-01\",\n\t\"lattice_metadata\": {\n"
    "\t\t\"motion_model\": \"diff\",\n\t\t\"turning_radius\": 0.5,\n\t\t\"grid_resolution\": 0.5,\n"
    "\t\t\"num_of_headings\": 4,\n\t\t\"heading_angles\": "
    "[\n\t\t\t0.0,\n\t\t\t1.5707963267948966,\n"
    "\t\t\t3.141592653589793,\n\t\t\t4.71238898038469\n\t\t],\n\t\t\"number_of_trajectories\": 2\n"
    "\t},\n\t\"primitives\": [\n"
    "\t\t{\"trajectory_id\": 0, \"start_angle_index\": 0, \"end_angle_index\": 0,\n"
    "\t\t\"left_turn\": true, \"trajectory_radius\": 0.0, \"trajectory_length\": 0.5,\n"
    "\t\t\"poses\": [\n\t\t\t[0.2, 0.0, 0.0],\n\t\t\t[0.5, 0.0, 0.0]\n\t\t]},\n"
    "\t\t{\"trajectory_id\": 1, \"start_angle_index\": 0, \"end_angle_index\": 1,\n"
    "\t\t\"left_turn\": true, \"trajectory_radius\": 0.5, \"trajectory_length\": 0.8,\n"
    "\t\t\"poses\": [[0.3, 0.0, 0.5], [0.3, 0.4, 1.0], [0.5, 0.5, 1.5707963267948966]]}\n"
    "\t]\n}\n";

}  // namespace tread::plan::samples

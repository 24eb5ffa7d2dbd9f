// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::testing {

/// Level ground of two kinds with a wall between start and goal.
inline constexpr const char* kYard = R"(name: yard
bounds: [-15, -10, 15, 10]
base_surface: grass
regions:
  - surface: tarmac
    corners: [[2, -10], [15, -10], [15, 10], [2, 10]]
obstacles:
  - {box: [0, 1.5, 0], length: 0.4, width: 6, height: 1.2, name: wall}
)";

/// Level empty ground with four posts, so that the laser has returns.
inline constexpr const char* kField = R"(name: field
bounds: [-40, -40, 40, 40]
base_surface: grass
obstacles:
  - {disc: [12, 6], radius: 0.3, height: 1.2, name: post}
  - {disc: [-12, 6], radius: 0.3, height: 1.2, name: post}
  - {disc: [12, -6], radius: 0.3, height: 1.2, name: post}
  - {disc: [-12, -6], radius: 0.3, height: 1.2, name: post}
)";

}  // namespace tread::testing

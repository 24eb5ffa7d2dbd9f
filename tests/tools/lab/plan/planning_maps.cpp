// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/tools/lab/plan/planning_maps.hpp"

#include <algorithm>
#include <random>
#include <vector>

namespace tread::plan::samples {
namespace {

constexpr double kWidth = 30.0;  // [m]
constexpr double kHeight = 20.0;
constexpr double kCell = 0.05;
constexpr double kWall = 0.15;
constexpr double kDoor = 1.0;

/// Reproducible on every platform, unlike the standard's distributions.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool happens(double share) { return between(0.0, 1.0) < share; }

 private:
  std::mt19937_64 engine_;
};

/// A rectangle of the ground [m].
struct Area {
  double x0, y0, x1, y1;

  bool overlaps(const Area& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
};

/// Free ground for obstacles; x to the right, y up, from the lower left corner.
class Drawing {
 public:
  Drawing() : pixels_(static_cast<size_t>(kColumns) * kRows, '\xfe') {}

  void block(const Area& area) { fill(area, '\0'); }
  void clear(const Area& area) { fill(area, '\xfe'); }
  void disc(double x, double y, double radius) {
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double dx = (column + 0.5) * kCell - x;
        const double dy = (row + 0.5) * kCell - y;
        if (dx * dx + dy * dy <= radius * radius) at(column, row) = '\0';
      }
  }
  void surround() {
    block({0.0, 0.0, kWidth, kWall});
    block({0.0, kHeight - kWall, kWidth, kHeight});
    block({0.0, 0.0, kWall, kHeight});
    block({kWidth - kWall, 0.0, kWidth, kHeight});
  }
  std::string picture() const {
    return "P5\n" + std::to_string(kColumns) + " " + std::to_string(kRows) + "\n255\n" + pixels_;
  }

 private:
  static constexpr int kColumns = 600;
  static constexpr int kRows = 400;

  /// Rows of a picture go down.
  char& at(int column, int row) {
    return pixels_[static_cast<size_t>(kRows - 1 - row) * kColumns + static_cast<size_t>(column)];
  }
  /// Cells whose centre is inside.
  void fill(const Area& area, char value) {
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double x = (column + 0.5) * kCell;
        const double y = (row + 0.5) * kCell;
        if (x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1) at(column, row) = value;
      }
  }

  std::string pixels_;
};

std::string yamlOf(const std::string& name, const std::string& origin, const std::string& task,
                   uint64_t seed) {
  return "# SPDX-License-Identifier: BSD-3-Clause\n# Copyright (c) 2026 The Tread authors\n"
         "# Made by make-planning-maps --seed " +
         std::to_string(seed) + "; a task in it: " + task + "\nimage: " + name +
         ".pgm\nmode: trinary\nresolution: 0.05\norigin: [" + origin +
         "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

/// Places furniture without overlap and with clearance to doors.
class Furniture {
 public:
  explicit Furniture(Drawing& drawing) : drawing_(drawing) {}

  void keepClear(const Area& area) { taken_.push_back(area); }
  void put(const Area& piece) {
    const bool is_free = std::none_of(taken_.begin(), taken_.end(),
                                      [&](const Area& other) { return piece.overlaps(other); });
    if (!is_free) return;
    drawing_.block(piece);
    taken_.push_back({piece.x0 - 0.8, piece.y0 - 0.8, piece.x1 + 0.8, piece.y1 + 0.8});
  }

 private:
  Drawing& drawing_;
  std::vector<Area> taken_;
};

/// A row of rooms between two heights, with doors in the wall at `corridor_wall`.
void drawRooms(Drawing& drawing, Random& random, double low, double high, double corridor_wall) {
  Furniture furniture(drawing);
  double left = 0.0;
  while (left < kWidth - 1.0) {
    double right = left + random.between(3.6, 6.2);
    if (kWidth - right < 3.6) right = kWidth;
    const double door = random.between(left + 0.5, right - 0.5 - kDoor);
    drawing.block({left, corridor_wall, right, corridor_wall + kWall});
    drawing.clear({door, corridor_wall, door + kDoor, corridor_wall + kWall});
    furniture.keepClear(
        {door - 0.2, corridor_wall - 1.3, door + kDoor + 0.2, corridor_wall + 1.45});
    if (right < kWidth) {
      drawing.block({right - kWall / 2.0, low, right + kWall / 2.0, high});
      const double between = random.between(low + 0.6, high - 0.6 - kDoor);
      const Area opening{right - kWall, between, right + kWall, between + kDoor};
      if (random.happens(0.4)) {
        drawing.clear(opening);
        furniture.keepClear({right - 1.3, between - 0.2, right + 1.3, between + kDoor + 0.2});
      }
    }
    for (int i = 0; i < 30; ++i) {
      const bool along = random.happens(0.5);
      const bool chair = random.happens(0.4);
      const double length = chair ? 0.5 : along ? 1.6 : 0.8;
      const double depth = chair ? 0.5 : along ? 0.8 : 1.6;
      const double x = random.between(left + 0.1, right - 0.1 - length);
      const double y = random.between(low + 0.1, high - 0.1 - depth);
      furniture.put({x, y, x + length, y + depth});
    }
    left = right;
  }
}

PlanningMap office(uint64_t seed) {
  Random random(seed);
  Drawing drawing;
  drawing.surround();
  drawRooms(drawing, random, kWall, 9.0, 9.0);
  drawRooms(drawing, random, 11.15, kHeight - kWall, 11.0);
  return {"office", yamlOf("office", "-15.0, -10.0, 0.0", "from -13.5,0.1,0 to 13.5,0.1,0", seed),
          drawing.picture()};
}

PlanningMap forest(uint64_t seed) {
  struct Trunk {
    double x, y, radius;
  };
  Random random(seed + 1);
  Drawing drawing;
  // Space at both ends of the task.
  std::vector<Trunk> trunks{{1.5, 1.5, 1.0}, {28.5, 18.5, 1.0}};
  for (int i = 0; i < 3000 && trunks.size() < 262; ++i) {
    const Trunk trunk{random.between(0.0, kWidth), random.between(0.0, kHeight),
                      random.between(0.1, 0.4)};
    const bool is_free = std::none_of(trunks.begin(), trunks.end(), [&](const Trunk& other) {
      const double dx = trunk.x - other.x;
      const double dy = trunk.y - other.y;
      const double apart = trunk.radius + other.radius + 0.4;
      return dx * dx + dy * dy < apart * apart;
    });
    if (!is_free) continue;
    trunks.push_back(trunk);
    drawing.disc(trunk.x, trunk.y, trunk.radius);
  }
  return {"forest", yamlOf("forest", "0.0, 0.0, 0.0", "from 1.5,1.5,0.6 to 28.5,18.5,0.6", seed),
          drawing.picture()};
}

PlanningMap deadEnd(uint64_t seed) {
  Random random(seed + 2);
  Drawing drawing;
  drawing.surround();
  // Three adjacent cul-de-sacs, a fourth above them; all end before the goal.
  for (const double y : {7.0, 9.0, 11.0, 13.0}) drawing.block({6.0, y, 24.0, y + kWall});
  drawing.block({24.0, 7.0, 24.0 + kWall, kHeight});
  // Below them a slalom is the way around.
  for (int i = 0; i < 6; ++i) {
    const double x = 7.5 + 3.0 * i;
    const bool from_below = i % 2 == 0;
    drawing.block({x, from_below ? 0.0 : 1.5, x + kWall, from_below ? 5.5 : 7.0});
  }
  // A few stones leave at least 1 m of space.
  for (int i = 0; i < 8; ++i) {
    const double x = random.between(7.0, 22.0);
    const double y = 7.3 + 2.0 * (i % 4) + (random.happens(0.5) ? 0.0 : 1.4);
    drawing.disc(x, y, random.between(0.1, 0.25));
  }
  return {"dead_end", yamlOf("dead_end", "2.37, -1.12, 0.0", "from 5.0,9.0,0 to 29.5,9.0,0", seed),
          drawing.picture()};
}

}  // namespace

std::array<PlanningMap, 3> planningMaps(uint64_t seed) {
  return {office(seed), forest(seed), deadEnd(seed)};
}

}  // namespace tread::plan::samples

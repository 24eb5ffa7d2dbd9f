// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Counts false alarms about a healthy range finder in hours of driving in virtual time.
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "tests/mapping/scan_drive.hpp"

namespace {

using namespace tread;
using mapping::ScanDrive;

struct Arguments {
  double hours = 1.0;
  uint64_t seed = 1;
  int beams = 91;
};

constexpr double kDrive = 600.0;  // [s]
constexpr double kReach = 60.0;   // [m]

class Draw {
 public:
  explicit Draw(uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }

 private:
  std::mt19937_64 random_;
};

void scatter(Draw& draw, int count, double reach, sim::WorldDescription& world) {
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at(draw.between(-reach, reach), draw.between(-reach, reach));
    const double height = draw.between(0.6, 2.0);
    if (draw.between(0.0, 1.0) < 0.6)
      world.obstacles.push_back(sim::discObstacle(at, draw.between(0.1, 0.7), height));
    else
      world.obstacles.push_back(sim::boxObstacle({at.x(), at.y(), draw.between(0.0, 3.1)},
                                                 draw.between(0.4, 8.0), draw.between(0.2, 1.0),
                                                 height));
  }
}

/// Long walls along x, in pairs; in some corridors with niches.
void wallIn(Draw& draw, bool niches, sim::WorldDescription& world) {
  for (double y = -20.0; y < 20.0; y += draw.between(2.2, 5.0)) {
    if (!niches) {
      world.obstacles.push_back(sim::boxObstacle({0.0, y, 0.0}, 2.0 * kReach, 0.2, 2.0));
      continue;
    }
    for (double x = -kReach; x < kReach;) {
      const double length = draw.between(2.0, 20.0);
      world.obstacles.push_back(sim::boxObstacle({x + length / 2.0, y, 0.0}, length, 0.2, 2.0));
      x += length + draw.between(0.8, 2.0);
    }
  }
}

void raise(Draw& draw, double steepest, sim::WorldDescription& world) {
  for (int i = 0; i < 3; ++i) {
    const double length = draw.between(4.0, 40.0);
    const Eigen::Vector2d along =
        Eigen::Rotation2Dd(draw.between(0.0, 6.3)) * Eigen::Vector2d::UnitX();
    const Eigen::Vector2d k = 2.0 * kPi / length * along;
    world.terrain.waves.push_back(
        {draw.between(0.0, steepest / 3.0) / k.norm(), k, draw.between(0.0, 6.3)});
  }
}

const char* const kKinds[] = {
    "yard", "open field", "empty field", "corridor", "corridor with doors", "hills", "open hills"};

sim::WorldDescription worldOf(size_t kind, uint64_t seed) {
  Draw draw(seed);
  sim::WorldDescription world;
  world.bounds = {{-kReach, -kReach}, {kReach, kReach}};
  switch (kind) {
    case 0:
      scatter(draw, 60, 25.0, world);
      break;
    case 1:
      scatter(draw, 12, kReach, world);
      break;
    case 2:
      scatter(draw, 1, kReach, world);
      break;
    case 3:
    case 4:
      wallIn(draw, kind == 4, world);
      break;
    default:
      raise(draw, 0.18, world);
      scatter(draw, kind == 5 ? 60 : 8, 40.0, world);
  }
  return world;
}

int run(const Arguments& arguments) {
  struct Figures {
    double hours = 0.0, metres = 0.0;
    int64_t scans = 0, suspected = 0;
    int verdicts = 0;
  };
  std::map<std::string, Figures> by_kind;
  Figures all;
  for (uint64_t seed = arguments.seed; all.hours < arguments.hours; ++seed) {
    const size_t kind = seed % std::size(kKinds);
    ScanDrive drive(worldOf(kind, seed), arguments.beams, seed);
    while (drive.seconds() < kDrive) drive.wander(1.0);
    if (drive.verdicts > 0)
      std::printf("seed %llu, %s:\n%s", static_cast<unsigned long long>(seed), kKinds[kind],
                  drive.told.c_str());
    for (Figures* figures : {&all, &by_kind[kKinds[kind]]}) {
      figures->hours += drive.seconds() / 3600.0;
      figures->metres += drive.travelled;
      figures->scans += drive.scans;
      figures->suspected += drive.suspected;
      figures->verdicts += drive.verdicts;
    }
    std::fflush(stdout);
  }
  by_kind["all"] = all;
  for (const auto& [kind, figures] : by_kind)
    std::printf(
        "%-20s %6.1f h, %6.1f km, %9lld scans: %6lld left out of the map in doubt, %d "
        "times called a liar\n",
        kind.c_str(), figures.hours, 1e-3 * figures.metres, static_cast<long long>(figures.scans),
        static_cast<long long>(figures.suspected), figures.verdicts);
  return all.verdicts == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives for hours with a healthy range finder and counts false alarms about it.",
               "bench-eyes"};
  Arguments arguments;
  app.add_option("--hours", arguments.hours, "of driving")->check(CLI::Range(0.01, 10000.0));
  app.add_option("--seed", arguments.seed, "seed of the first drive; the others count up from it");
  app.add_option("--beams", arguments.beams, "of a scan")->check(CLI::Range(31, 1081));
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("bench-eyes", [&] { return run(arguments); });
}

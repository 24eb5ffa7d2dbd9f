// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Makes the maps of tests/data/planning: make-planning-maps tests/data/planning
#include <cstdio>
#include <filesystem>

#include "common/config/command_line.hpp"
#include "common/store/store.hpp"
#include "tests/tools/lab/plan/planning_maps.hpp"

namespace {

using namespace tread;
using namespace tread::plan::samples;

int run(int argc, char** argv) {
  std::string folder;
  uint64_t seed = kPlanningMapsSeed;
  CLI::App app{"Makes our maps for planning: an office, a forest, dead ends.",
               "make-planning-maps"};
  app.add_option("folder", folder, "where they are written")->required();
  app.add_option("--seed", seed, "another one gives other maps")->capture_default_str();
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  std::filesystem::create_directories(folder);
  for (const PlanningMap& map : planningMaps(seed)) {
    writeText(folder + "/" + map.name + ".yaml", map.yaml);
    writeText(folder + "/" + map.name + ".pgm", map.picture);
    std::printf("%s/%s.yaml\n", folder.c_str(), map.name.c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "make-planning-maps: %s\n", problem.what());
    return 2;
  }
}

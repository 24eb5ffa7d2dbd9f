// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/host.hpp"

using namespace tread::launch;
namespace fs = std::filesystem;

TEST_CASE("a file or a link to nothing in the place of a run folder is named, and is not ready") {
  const fs::path place = fs::temp_directory_path() / ("tread_run_" + std::to_string(::getpid()));
  fs::remove_all(place);
  fs::create_directories(place);
  const std::string file = place / "file";
  const std::string dangling = place / "dangling";
  std::ofstream(file) << "text";
  fs::create_symlink("nowhere", dangling);
  const auto check = [](const std::string& run) { return checkFolder(folderFacts(RunPaths(run))); };
  for (const std::string& bad : {file, dangling})
    for (const std::string& run : {bad, bad + "/below"}) {
      const std::vector<HostFinding> findings = check(run);
      REQUIRE(findings.size() == 1);
      CHECK(findingLine("robot", findings[0]).find(bad + " is a file or a link to nothing") !=
            std::string::npos);
      CHECK(anyCritical(findings));
    }
  fs::create_directory(place / "nowhere");
  for (const std::string& good : {dangling, (place / "new/folder").string()})
    CHECK_FALSE(anyCritical(check(good)));
  fs::remove_all(place);
}

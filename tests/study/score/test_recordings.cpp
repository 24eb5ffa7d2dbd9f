// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/study/score/suites.hpp"

using namespace tread::blindtest;
namespace fs = std::filesystem;

TEST_CASE("recordings are logs that have a model beside them, and absent ones leave no case") {
  const fs::path folder =
      fs::temp_directory_path() / ("tread-recordings-" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (const char* name :
       {"sand.lcmlog", "sand.yaml", "gravel.lcmlog", "gravel.yaml", "odd.lcmlog"})
    std::ofstream(folder / name) << "x";
  const auto recordings = recordingsIn(folder.string());
  REQUIRE(recordings.size() == 2);
  CHECK(recordings[0].nominal == "recording-gravel");
  CHECK(recordings[1].log == (folder / "sand.lcmlog").string());
  CHECK(recordings[1].model == (folder / "sand.yaml").string());
  Study study;
  study.suite = "medium";
  study.recordings = folder.string();
  CHECK(recordingNamed(study, "recording-sand").has_value());
  CHECK_FALSE(recordingNamed(study, "mid").has_value());
  fs::remove_all(folder);
  CHECK(recordingsIn(folder.string()).empty());
  CHECK(recordingSuite(study).empty());
}

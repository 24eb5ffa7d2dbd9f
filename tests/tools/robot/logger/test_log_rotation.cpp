// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/logger/log_rotation.hpp"

using namespace tread::testing;
using tread::launch::makeRoomForLog;
namespace fs = std::filesystem;

TEST_CASE("a new log moves the earlier ones up and removes the oldest") {
  const fs::path folder =
      fs::temp_directory_path() / ("tread_log_rotation_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string log = (folder / "x").string();
  makeRoomForLog(log, 3);
  for (const char* content : {"first", "second", "third"}) {
    makeRoomForLog(log, 3);
    std::ofstream(log + ".0") << content;
  }
  CHECK(contentOf(log + ".2") == "first");
  CHECK(contentOf(log + ".0") == "third");
  makeRoomForLog(log, 3);
  CHECK_FALSE(fs::exists(log + ".0"));
  CHECK(contentOf(log + ".1") == "third");
  CHECK(contentOf(log + ".2") == "second");
  CHECK_FALSE(fs::exists(log + ".3"));
  // Beyond a gap nothing has to move.
  makeRoomForLog(log, 3);
  CHECK(contentOf(log + ".2") == "second");
  makeRoomForLog((folder / "none/x").string(), 3);
  fs::remove_all(folder);
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/study/score/child.hpp"

using namespace tread::blindtest;

namespace fs = std::filesystem;

TEST_CASE("a child's status and last words are told") {
  const fs::path folder = fs::temp_directory_path() / ("tread-child-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto shell = [&](const std::string& line, int cpu_limit = 0) {
    return run({{"/bin/sh", "-c", line}, folder.string(), "log.txt", cpu_limit}).status;
  };
  CHECK(shell("exit 13") == 13);
  CHECK(shell("kill -9 $$") == 128 + 9);
  CHECK(shell("while :; do :; done", 1) > 128);
  shell("echo first; echo last; echo");
  CHECK(lastLine((folder / "log.txt").string()) == "last");
  CHECK_THROWS_WITH(run({{"/no/such/program"}, folder.string(), "log.txt"}),
                    Catch::Contains("cannot be started"));
  CHECK_THROWS_WITH(runOrThrow({{"/bin/sh", "-c", "echo why; exit 1"}, folder.string(), "log"}),
                    Catch::Contains("why"));
  fs::remove_all(folder);
}

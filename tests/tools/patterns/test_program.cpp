// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

namespace {

/// Exit status and what a command line prints, errors included.
std::pair<int, std::string> run(const std::string& arguments) {
  const std::string command = std::string(TREAD_BIN_DIR) + "/tread-patterns " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string printed;
  std::array<char, 512> buffer{};
  while (fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr)
    printed += buffer.data();
  const int status = pclose(pipe);
  return {WEXITSTATUS(status), printed};
}

const std::string kConfig = std::string(TREAD_SOURCE_DIR) + "/config/";

}  // namespace

TEST_CASE("tread-patterns makes a file that it can show") {
  const auto file = std::filesystem::temp_directory_path() /
                    ("tread-patterns-" + std::to_string(getpid()) + ".yaml");
  const auto made = run("make " + kConfig + "patterns/recipes/teodor.yaml --model " + kConfig +
                        "models/teodor_grass.yaml -o " + file.string());
  INFO(made.second);
  CHECK(made.first == 0);
  const auto shown = run("show " + file.string());
  CHECK(shown.first == 0);
  CHECK(shown.second == made.second);
  CHECK(shown.second.find("hard_left") != std::string::npos);
  std::filesystem::remove(file);
}

TEST_CASE("tread-patterns says in one line what is wrong") {
  const auto missing = run("show no/such/file.yaml");
  CHECK(missing.first == 1);
  CHECK(missing.second.find("tread-patterns: no/such/file.yaml") == 0);
  CHECK(missing.second.find('\n') == missing.second.size() - 1);
  const auto unwritable = run("make " + kConfig + "patterns/recipes/teodor.yaml --model " +
                              kConfig + "models/teodor_grass.yaml -o /no/such/folder/set.yaml");
  CHECK(unwritable.first == 1);
  CHECK(unwritable.second.find("cannot be written") != std::string::npos);
}

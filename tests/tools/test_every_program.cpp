// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Common properties of all command-line programs, with any parser.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/programs.hpp"

using tread::samples::allCommands;
using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::Command;
using tread::samples::programs;
using tread::testing::contentOf;
using tread::testing::linesOf;

namespace {

void checkRefused(const std::string& arguments, const std::string& name, const std::string& what) {
  const CalledProgram refused = called(arguments + " </dev/null");
  INFO(arguments << ": " << refused.printed);
  CHECK(refused.status == 2);
  CHECK(refused.isOneLine());
  CHECK(refused.printed.rfind(name + ": ", 0) == 0);
  CHECK(refused.says(what));
}

}  // namespace

TEST_CASE("every program and command says in --help what it is for, and how it is called") {
  REQUIRE(allCommands().size() > 30);
  for (const Command& command : allCommands()) {
    INFO(command.words << ": " << command.help);
    const std::vector<std::string> lines = linesOf(command.help);
    REQUIRE(lines.size() > 1);
    CHECK(lines.front().size() > 15);
    CHECK(std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.rfind("Usage: " + command.words, 0) == 0 ||
             line.rfind("usage: " + command.words, 0) == 0;
    }));
  }
}

// The commit is that of this checkout when the program was linked; an archive may have none.
TEST_CASE("every program says its version, the same for all, and the commit it was built from") {
  const std::regex words(R"re(([a-z-]+) (\d+\.\d+\.\d+)( \(commit [0-9a-f]{7,}(-dirty)?\))?\n)re");
  std::set<std::string> versions;
  for (const std::string& program : programs()) {
    const CalledProgram called_version = called(program + " --version </dev/null");
    INFO(program << ": " << called_version.printed);
    std::smatch parts;
    CHECK(called_version.status == 0);
    REQUIRE(std::regex_match(called_version.printed, parts, words));
    CHECK(parts[1] == program);
    versions.insert(parts[2]);
  }
  CHECK(versions.size() == 1);
}

TEST_CASE("every program refuses an unknown option with code 2 and one line of its own name") {
  for (const Command& command : allCommands())
    checkRefused(command.words + " --no-such-option", command.words, "--no-such-option");
}

TEST_CASE("no number on a command line may be nan or infinite") {
  const std::regex real("^  (--[a-z-]+) FLOAT");
  int numbers = 0;
  for (const Command& command : allCommands()) {
    for (const std::string& line : linesOf(command.help)) {
      std::smatch option;
      if (!std::regex_search(line, option, real)) continue;
      ++numbers;
      for (const char* value : {"nan", "inf"})
        checkRefused(command.words + " " + option.str(1) + " " + value, command.words, "--");
    }
  }
  CHECK(numbers > 15);
}

TEST_CASE("the README names every program that is installed") {
  const std::string readme = contentOf(std::string(TREAD_SOURCE_DIR) + "/README.md");
  const std::set<std::string> studies{"tread-hide", "tread-blind", "tread-rival",
                                      "tread-compare-models"};
  for (const std::string& name : programs()) {
    INFO(name);
    const std::string ending = name.substr(name.find('-'));
    if (studies.count(name) == 0)
      CHECK((readme.find(name) != std::string::npos ||
             readme.find("`" + ending) != std::string::npos));
  }
}

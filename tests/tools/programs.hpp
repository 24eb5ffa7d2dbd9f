// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"

namespace tread::samples {

/// "tread-gap", and "tread-gap find", "tread-gap compare" after it.
struct Command {
  std::string words;
  std::string help;
};

inline std::vector<std::string> programs() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(TREAD_BIN_DIR)) {
    const std::string name = entry.path().filename();
    if (name.rfind("tread-", 0) == 0) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

inline std::string helpOf(const std::string& words) {
  const CalledProgram help = called(words + " --help");
  INFO(words);
  CHECK(help.status == 0);
  return help.printed;
}

inline std::vector<Command> commandsOf(const std::string& program) {
  std::vector<Command> commands{{program, helpOf(program)}};
  bool listed = false;
  for (const std::string& line : testing::linesOf(commands.front().help)) {
    std::smatch command;
    if (listed && std::regex_search(line, command, std::regex("^  ([a-z-]+)  ")))
      commands.push_back({program + " " + command.str(1), helpOf(program + " " + command.str(1))});
    if (line.empty()) listed = false;
    if (line == "Subcommands:") listed = true;
  }
  return commands;
}

inline const std::vector<Command>& allCommands() {
  static const std::vector<Command> all = [] {
    std::vector<Command> found;
    for (const std::string& program : programs())
      for (Command& command : commandsOf(program)) found.push_back(std::move(command));
    return found;
  }();
  return all;
}

}  // namespace tread::samples

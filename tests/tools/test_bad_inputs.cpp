// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Wrong inputs in place of a file: each program explains the error in its own message.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"

using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::OwnFolder;
using tread::testing::contentOf;
using tread::testing::linesOf;

namespace {

/// A program or one of its commands, with the places for file names.
struct Command {
  std::string words;
  size_t arguments = 0;              ///< positional ones
  std::vector<std::string> options;  ///< with a text
};

/// Programs that wait for a running robot, or for people; their arguments are words.
bool talks(const std::string& words) {
  for (const char* program :
       {"tread-arm", "tread-stop", "tread-goal", "tread-fence", "tread-drive", "tread-top",
        "tread-spy", "tread-view", "tread-link", "tread-logger", "tread-setup-robot"})
    if (words.rfind(program, 0) == 0) return true;
  return false;
}

/// A process of the robot: only its configuration is read.
bool isProcess(const std::vector<std::string>& help) {
  return std::any_of(help.begin(), help.end(), [](const std::string& line) {
    return line.find("--with-parent") != std::string::npos;
  });
}

Command readHelp(const std::string& words, const std::vector<std::string>& help) {
  static const std::regex argument("^  [a-zA-Z_]+ .*TEXT.*");
  static const std::regex option("^  (?:-[a-z],)?(--[a-z-]+) (?:TEXT|.*FILE).*");
  Command command{words, 0, {}};
  std::string section;
  for (const std::string& line : help) {
    if (!line.empty() && line.front() != ' ') section = line;
    std::smatch found;
    if (section == "Positionals:" && std::regex_match(line, argument)) ++command.arguments;
    if (std::regex_match(line, found, option)) command.options.push_back(found.str(1));
  }
  if (isProcess(help)) command.words += " --check";
  return command;
}

std::vector<Command> commandsOf(const std::string& program) {
  const auto help = linesOf(called(program + " --help").printed);
  std::vector<Command> commands{readHelp(program, help)};
  bool listed = false;
  for (const std::string& line : help) {
    std::smatch name;
    if (listed && std::regex_search(line, name, std::regex("^  ([a-z-]+)  "))) {
      const std::string words = program + " " + name.str(1);
      commands.push_back(readHelp(words, linesOf(called(words + " --help").printed)));
    }
    if (line.empty()) listed = false;
    if (line == "Subcommands:") listed = true;
  }
  return commands;
}

std::vector<std::string> programs() {
  std::vector<std::string> names;
  std::string all = TREAD_PROGRAMS;
  for (size_t at = 0; at < all.size();) {
    const size_t end = std::min(all.find(',', at), all.size());
    names.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  return names;
}

/// Files that no program can read, and some with a plausible beginning.
std::vector<std::string> badInputs(const OwnFolder& folder) {
  std::mt19937 random(3);
  std::string noise(5000, '\0');
  for (char& byte : noise) byte = static_cast<char>(random());
  const std::string robot =
      contentOf(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/robot.yaml");
  std::filesystem::create_directories(folder.path("folder"));
  // The event of an LCM log, and the head of an MCAP file, both truncated.
  const std::string lcm = std::string("\xED\xA1\xDA\x01\0\0\0\0\0\0\0\1", 12) + "cut";
  return {folder.path("missing"),
          folder.path("folder"),
          folder.write("empty", ""),
          folder.write("noise", noise),
          folder.write("cut.yaml", robot.substr(0, robot.size() / 2) + "\n  x: [1,"),
          folder.write("list.yaml", "- 1\n- {a: b}\n"),
          folder.write("x.json", R"({"name": "x", "a": [1, 2)"),
          folder.write("x.csv", "a;b\n1,2,3\n\"\n"),
          folder.write("cut.lcmlog", lcm),
          folder.write("cut.mcap", std::string("\x89MCAP0\r\n\1\xff\xff\xff\xff\0\0\0\0", 17)),
          folder.write("empty", "") + "/below"};
}

/// Where a program's output contains words of a library; empty if nowhere.
std::string foreignWords(const std::string& printed) {
  static const std::regex foreign(
      "std::|\\bbad_[a-z]|basic_[a-z]|_M_|vector::|deque::|\\bmap::|\\b(stoi|stol|stoul|stof|stod)"
      "\\b|"
      "yaml-cpp|filesystem error|json\\.exception|key name is missing|what\\(\\)|terminate called|"
      "Assertion|iostream error|regex_error|bad conversion|bad file|bad optional|CLI::|"
      "Could not convert|lexical_cast|runtime error|core dumped");
  std::smatch found;
  return std::regex_search(printed, found, foreign) ? found.str() : "";
}

constexpr int kTimedOut = 124;  // of timeout(1)

/// `ends`: it can only refuse.
void check(const std::string& command_line, bool ends) {
  const CalledProgram program =
      called(command_line + " </dev/null", ends ? "timeout 30" : "timeout 1");
  INFO(command_line << "\n" << program.printed);
  CHECK(foreignWords(program.printed) == "");
  // Ended by itself, neither by a signal nor by the time limit.
  CHECK((program.status < 126 && (program.status != kTimedOut || !ends)));
}

/// Every third program, from this one on: the parts run in parallel.
void tryPrograms(size_t part) {
  const OwnFolder folder;
  const std::vector<std::string> inputs = badInputs(folder);
  const std::vector<std::string> all = programs();
  REQUIRE(all.size() > 25);
  // For options three of them, one that never ends only for programs that must not wait for the
  // end.
  const std::vector<std::string> few{folder.path("folder"), folder.path("noise"),
                                     folder.path("empty") + "/below"};
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder.path("folder"));  // for output without a path
  size_t calls = 0;
  for (size_t i = part; i < all.size(); i += 3)
    for (const Command& command : commandsOf(all[i])) {
      const bool listens = talks(command.words);
      const auto call = [&](const std::string& option, const std::string& input, bool ends) {
        std::string arguments;
        for (size_t k = 0; k < command.arguments; ++k) arguments += " " + input;
        check(command.words + option + arguments, ends);
        ++calls;
      };
      if (command.arguments > 0 && !listens)
        for (const std::string& input : inputs) call("", input, true);
      for (const std::string& option : command.options) {
        const bool file = option == "--key" || option == "--config" || option == "--set";
        if ((listens && !file) || option == "--lcm-url") continue;
        const bool ends = (command.arguments > 0 || file) && !listens;
        for (const std::string& input : few)
          if (ends || input == few.back()) call(" " + option + " " + input, input, ends);
      }
    }
  std::filesystem::current_path(here);
  CHECK(calls > 100);
}

}  // namespace

TEST_CASE("no program answers a bad input with a library's words, a crash or not at all: a third") {
  tryPrograms(0);
}

TEST_CASE("no program answers a bad input with a library's words, a crash or not at all: another") {
  tryPrograms(1);
}

TEST_CASE(
    "no program answers a bad input with a library's words, a crash or not at all: the rest") {
  tryPrograms(2);
}

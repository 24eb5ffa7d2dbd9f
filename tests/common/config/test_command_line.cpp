// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <vector>

#include <catch2/catch.hpp>

#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"

namespace tread {
namespace {

/// A program's error for these arguments; empty if there is none.
std::string errorOf(const std::string& arguments) {
  CLI::App app{"A program.", "tread-sample"};
  app.require_subcommand(1);
  std::string text;
  int number = 0;
  CLI::App* find = app.add_subcommand("find", "finds");
  find->add_option("--model", text, "file")->required();
  find->add_option("--threads", number, "number")->check(CLI::Range(1, 8));
  CLI::App* explain = app.add_subcommand("explain", "explains");
  explain->add_option("EFFECT", text, "name");
  CLI::App* learn = app.add_subcommand("learn", "learns");
  auto* some = learn->add_option_group("prediction", "at most one of");
  some->add_option("--patterns", text, "file");
  some->add_option("--model", text, "file");
  some->require_option(0, 1);
  auto* one = learn->add_option_group("log", "exactly one of");
  one->add_option("--log", text, "file");
  one->add_option("--folder", text, "folder");
  one->require_option(1);
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    return usageError(app, error);
  }
  return "";
}

/// The exit code of a program with an option of each kind of number.
std::optional<int> codeOf(std::vector<std::string> arguments) {
  CLI::App app{"A program.", "tread-sample"};
  double length = 0.0, ratio = 0.0;
  std::optional<double> limit;
  int count = 0;
  std::string word;
  app.add_option("--length", length, "a number")->check(CLI::Range(1.0, 60.0));
  app.add_option("--count", count, "a whole number");
  app.add_option("--limit", limit, "a number that may be missing");
  app.add_option("--word", word, "no number");
  app.add_subcommand("find", "finds")->add_option("--ratio", ratio, "a number of a command");
  arguments.insert(arguments.begin(), "tread-sample");
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  return parseCommandLine(app, static_cast<int>(words.size()), words.data());
}

}  // namespace

TEST_CASE("options of numbers take finite ones, in every command, and words are left alone") {
  CHECK(codeOf({"--length", "2", "--count", "3", "--limit", "0.5", "--word", "nan"}) ==
        std::nullopt);
  CHECK(codeOf({"find", "--ratio", "1e300"}) == std::nullopt);
  for (const char* number : {"nan", "inf", "-inf", "NaN", "1e999"}) {
    INFO(number);
    CHECK(codeOf({std::string("--length=") + number}) == kBadInput);
    CHECK(codeOf({std::string("--limit=") + number}) == kBadInput);
    CHECK(codeOf({"find", std::string("--ratio=") + number}) == kBadInput);
  }
  CHECK(codeOf({"--count", "nan"}) == kBadInput);
}

TEST_CASE("a program ends with its own code, or with that of bad input where it throws") {
  CHECK(runProgram("tread-sample", [] { return 1; }) == 1);
  CHECK(runProgram("tread-sample", []() -> int { throw std::runtime_error("no such log"); }) ==
        kBadInput);
}

TEST_CASE("a usage error is one line that says where, what, and what would be right") {
  const std::pair<std::string, std::string> kBad[] = {
      {"",
       "tread-sample: a command is missing; one of find, explain, learn; see tread-sample --help"},
      {"fnd --model a",
       "tread-sample: 'fnd' is no command; did you mean find? Known: find, explain, learn; see "
       "tread-sample --help"},
      {"guess",
       "tread-sample: 'guess' is no command; known: find, explain, learn; see tread-sample --help"},
      {"find", "tread-sample find: --model is required; see tread-sample find --help"},
      {"find --model a --thread 2",
       "tread-sample find: '--thread' is not known; did you mean --threads? Known: --help, "
       "--model, "
       "--threads; see tread-sample find --help"},
      {"find --modle a",
       "tread-sample find: '--modle' is not known; did you mean --model? Known: --help, --model, "
       "--threads; see tread-sample find --help"},
      {"find --threads 2 --model",
       "tread-sample find: --model: its value is missing; see tread-sample find --help"},
      {"find --model a b",
       "tread-sample find: 'b' is one argument too many; see tread-sample find --help"},
      {"explain a b",
       "tread-sample explain: 'b' is one argument too many; see tread-sample explain --help"},
      {"learn --log a --patterns b --model c",
       "tread-sample learn: --patterns, --model: only one of them; see tread-sample learn --help"},
      {"learn --log a --folder b",
       "tread-sample learn: --log, --folder: only one of them; see tread-sample learn --help"},
      {"learn --model a",
       "tread-sample learn: one of these is required: --log, --folder; see tread-sample learn "
       "--help"}};
  for (const auto& [arguments, words] : kBad) CHECK(errorOf(arguments) == words);
  for (const char* bad : {"find --model a --threads 0", "find --model a --threads x",
                          "find --model", "find --threads 2 --model"}) {
    const std::string words = errorOf(bad);
    INFO(words);
    CHECK(words.find("tread-sample find: ") == 0);
    CHECK(words.find("--help") != std::string::npos);
    CHECK(words.find('\n') == std::string::npos);
  }
  CHECK(errorOf("find --model a --threads 2") == "");
}

TEST_CASE("a library's exception becomes a sentence, one of ours stays as it is") {
  const auto words = [](const auto& problem) { return wordsOf(problem); };
  const auto stoi = [] {
    try {
      return std::to_string(std::stoi("x"));
    } catch (const std::exception& problem) {
      return wordsOf(problem);
    }
  };
  const auto remove = [] {
    try {
      std::filesystem::create_directories("/proc/version/below");
      return std::string();
    } catch (const std::exception& problem) {
      return wordsOf(problem);
    }
  };
  CHECK(words(std::runtime_error("x.yaml:3: no such key")) == "x.yaml:3: no such key");
  CHECK(words(std::out_of_range("no effect 'x'")) == "no effect 'x'");
  CHECK(remove() == "/proc/version/below: Not a directory");
  CHECK(words(std::bad_alloc()).find("memory") != std::string::npos);
  for (const std::string& text :
       {words(std::bad_cast()), words(std::bad_optional_access()), stoi(),
        words(std::out_of_range("vector::_M_range_check: __n (which is 3) >= this->size()")),
        words(std::runtime_error("yaml-cpp: error at line 1, column 2: bad conversion"))})
    CHECK(text.find("an input is damaged") == 0);
}

}  // namespace tread

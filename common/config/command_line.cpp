// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/command_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <sstream>
#include <thread>
#include <vector>

#include <unistd.h>

#include "common/config/problem_words.hpp"
#include "common/config/scalars.hpp"
#include "common/config/version.hpp"
#include "common/store/output_file.hpp"

namespace tread {
namespace {

/// To CLI11, option groups are commands without a name.
std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_name().empty()) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> optionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
  return names;
}

/// "'fnd' is no command; did you mean find?", else the list of all commands.
std::string unknown(const std::string& word, const std::string& is_not,
                    const std::vector<std::string>& known) {
  const auto meant = nearestSpelling(word, known);
  return "'" + word + "' " + is_not + "; " +
         (meant ? "did you mean " + *meant + "? Known: " : "known: ") + joinWords(known);
}

/// The subcommand whose arguments are wrong.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  return given.empty() ? app : innermost(*given.back());
}

bool isOption(const std::string& word) {
  return word.size() > 1 && word.front() == '-';
}

bool is(const CLI::Error& error, CLI::ExitCodes kind) {
  return error.get_exit_code() == static_cast<int>(kind);
}

/// CLI11 reports the type of the missing value.
std::string missingValue(const std::string& what) {
  const size_t end = what.find(':');
  const bool missing = what.find("missing") != std::string::npos;
  return missing && end != std::string::npos ? what.substr(0, end) + ": its value is missing"
                                             : what;
}

/// "Could not convert: x = north" of CLI11.
std::string wrongValue(const std::string& what) {
  const size_t name = what.find(": ");
  const size_t value = what.find(" = ", name);
  if (name == std::string::npos || value == std::string::npos) return what;
  return what.substr(name + 2, value - name - 2) + ": '" + what.substr(value + 3) +
         "' is no value for it";
}

/// "Exactly 1 option from [--a,--b] is required and 2 were given" of CLI11.
std::optional<std::string> wrongChoice(const std::string& what) {
  const size_t begin = what.find('[');
  const size_t end = what.find(']', begin);
  if (end == std::string::npos) return std::nullopt;
  std::vector<std::string> names;
  std::istringstream list(what.substr(begin + 1, end - begin - 1));
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  const bool none = what.find("given") == std::string::npos;
  return none ? "one of these is required: " + joinWords(names)
              : joinWords(names) + ": only one of them";
}

std::string whatIsWrong(const CLI::App& app, const CLI::App& part, const CLI::Error& error) {
  const std::vector<std::string> left = app.remaining(true);
  const std::vector<std::string> commands = commandsOf(part);
  // A mistyped option is reported first: it may be why another one seems to be missing.
  const auto mistyped = std::find_if(left.begin(), left.end(), isOption);
  const auto choice =
      is(error, CLI::ExitCodes::RequiredError) ? wrongChoice(error.what()) : std::nullopt;
  const bool command_first = !commands.empty() && !left.empty() && mistyped != left.begin();
  if (mistyped != left.end() && !command_first)
    return unknown(*mistyped, "is not known", optionsOf(part));
  if (choice) return *choice;
  if (!commands.empty()) {
    if (!left.empty()) return unknown(left.front(), "is no command", commands);
    if (is(error, CLI::ExitCodes::RequiredError) && error.what()[0] != '-')
      return "a command is missing; one of " + joinWords(commands);
  }
  if (is(error, CLI::ExitCodes::ExtrasError) && !left.empty())
    return "'" + left.front() + "' is one argument too many";
  if (is(error, CLI::ExitCodes::ConversionError)) return wrongValue(error.what());
  return is(error, CLI::ExitCodes::ArgumentMismatch) ? missingValue(error.what()) : error.what();
}

/// CLI::Range accepts NaN, and an option without a range also infinity.
void requireFiniteNumbers(CLI::App& app) {
  const auto problemOf = [](const std::string& text) {
    double number = 0.0;
    const bool finite = !CLI::detail::lexical_cast(text, number) || std::isfinite(number);
    return finite ? std::string() : "'" + text + "' is no finite number";
  };
  for (CLI::Option* option : app.get_options())
    if (option->get_type_name().rfind("FLOAT", 0) == 0) option->check(problemOf);
  for (CLI::App* command : app.get_subcommands({})) requireFiniteNumbers(*command);
}

/// "tread-gap 0.1.0 (commit 59f8ce72a1b2)".
std::string versionLine(const std::string& name) {
  const std::string from = commit();
  return name + " " + version() + (from.empty() ? "" : " (commit " + from + ")");
}

}  // namespace

std::string usageError(const CLI::App& app, const CLI::Error& error) {
  const CLI::App& part = innermost(app);
  const std::string name = app.get_name() + (&part == &app ? "" : " " + part.get_name());
  std::string what = whatIsWrong(app, part, error);
  std::replace(what.begin(), what.end(), '\n', ' ');
  return name + ": " + what + "; see " + name + " --help";
}

std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv) {
  requireFiniteNumbers(app);
  if (app.get_name().empty()) app.name(std::filesystem::path(argv[0]).filename());
  app.set_version_flag("--version", versionLine(app.get_name()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help
    std::fprintf(stderr, "%s\n", usageError(app, error).c_str());
    return kBadInput;
  } catch (const CLI::Error& refused) {  // see Outputs
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), refused.what());
    return refused.get_exit_code();
  }
  return std::nullopt;
}

void addThreads(CLI::App& command, int& threads) {
  threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("--threads", threads, "number of threads; the output does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

int runProgram(const char* name, const std::function<int()>& run) try {
  return run();
} catch (const WriteError& problem) {
  std::fprintf(stderr, "%s: %s\n", name, problem.what());
  return kNotWritten;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "%s: %s\n", name, wordsOf(problem).c_str());
  return kBadInput;
}

std::string operatorName() {
  const char* user = std::getenv("USER");
  char host[65] = "";
  if (::gethostname(host, sizeof host - 1) != 0 || host[0] == '\0') return "operator";
  const std::string name = user != nullptr && *user != '\0' ? user : std::to_string(::getuid());
  return (name + "@" + host).substr(0, 64);
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/pattern/pattern_file.hpp"
#include "tools/patterns/advice.hpp"
#include "tools/patterns/commands.hpp"

namespace tread::patterns {
namespace {

void check(const std::string& file) {
  const PatternSet set = readPatternFile(file);
  for (const std::string& line : adviceFor(set)) std::cout << file << ": warning: " << line << '\n';
  std::cout << file << ": ok, " << set.patterns().size() << " patterns, "
            << set.content().classes.size() << " classes, version " << set.version() << '\n';
}

}  // namespace

CLI::App* addCheck(CLI::App& app) {
  const auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "check", "say what is wrong in a pattern file (code 1), or warn of what may make trouble");
  command->add_option("FILE", *file, "pattern file (YAML)")->required();
  command->callback([file] { check(*file); });
  return command;
}

}  // namespace tread::patterns

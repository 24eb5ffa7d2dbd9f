// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/pattern/pattern_file.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/table.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string file;
};

void show(const Options& options) {
  std::cout << table(readPatternFile(options.file));
}

}  // namespace

CLI::App* addShow(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("show", "print a pattern file as a table");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->callback([options] { show(*options); });
  return command;
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/patterns/advice.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/envelope.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string file;
  std::string model;
};

void check(const Options& options) {
  const std::string& file = options.file;
  const PatternSet set = readPatternFile(file);
  if (!options.model.empty()) warnOutside(readModelDocument(options.model), options.model, set);
  for (const std::string& line : adviceFor(set)) std::cout << file << ": warning: " << line << '\n';
  std::cout << file << ": ok, " << set.patterns().size() << " patterns, "
            << set.content().classes.size() << " classes, version " << set.version() << '\n';
}

}  // namespace

CLI::App* addCheck(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "check", "say what is wrong in a pattern file (code 1), or warn of what may make trouble");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->add_option("--model", options->model,
                      "model file: warn of motions beyond those that it was made from, too");
  command->callback([options] { check(*options); });
  return command;
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern_file.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/mirror.hpp"
#include "tools/patterns/output.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string file;
  std::string output;
  std::optional<std::string> pattern;
};

void mirror(const Options& options) {
  std::vector<std::string> notes;
  const PatternSet set = withMirrors(readPatternFile(options.file), options.pattern, notes);
  writeOutput(options.output, formatPatterns(set), {options.file});
  for (const std::string& note : notes) std::cout << note << '\n';
  if (notes.empty()) std::cout << "every pattern that turns has its mirror image already\n";
  std::cout << options.output << ": " << set.patterns().size() << " patterns\n";
}

}  // namespace

CLI::App* addMirror(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("mirror", "add the mirror image of every pattern that turns and has none");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->add_option("-o,--output", options->output, "pattern file to write")->required();
  command->add_option("--pattern", options->pattern, "only this pattern");
  command->callback([options] { mirror(*options); });
  return command;
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern_file.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/comparison.hpp"
#include "tools/patterns/output.hpp"
#include "tools/patterns/set_picture.hpp"
#include "tools/patterns/table.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string file;
  std::string other;
  std::string picture;
};

/// The file's name, with its folder only where the other file has the same name.
std::string labelOf(const std::string& file, const std::string& other) {
  const auto name = std::filesystem::path(file).filename();
  return name == std::filesystem::path(other).filename() ? file : name.string();
}

void show(const Options& options) {
  const PatternSet set = readPatternFile(options.file);
  std::vector<PicturedSet> pictured{{labelOf(options.file, options.other), set}};
  if (options.other.empty()) {
    std::cout << table(set);
  } else {
    const PatternSet other = readPatternFile(options.other);
    std::cout << comparison(set, options.file, other, options.other);
    pictured.push_back({labelOf(options.other, options.file), other});
  }
  if (options.picture.empty()) return;
  refuseToReplace(options.picture, {options.file, options.other});
  drawSets(pictured, options.picture);
}

}  // namespace

CLI::App* addShow(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("show", "print a pattern file as a table, or compare two");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->add_option("--compare", options->other, "another pattern file: how its ends differ");
  command->add_option("--picture", options->picture,
                      "PNG to write: all trajectories with the spread of their ends");
  command->callback([options] { show(*options); });
  return command;
}

}  // namespace tread::patterns

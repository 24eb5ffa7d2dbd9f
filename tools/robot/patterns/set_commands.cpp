// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// make, show, check and mirror: commands for pattern files.
#include "tools/robot/patterns/set_commands.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/robot/patterns/commands.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/patterns/set_picture.hpp"
#include "tools/robot/patterns/set_text.hpp"

namespace tread::patterns {
namespace {

struct MakeOptions {
  std::string recipe;
  std::string model;
  std::string output;
};

void make(const MakeOptions& options) {
  const ModelDocument model = readModelDocument(options.model);
  const PatternSet set = makeSet(ConfigReader::fromFile(options.recipe), model.vehicle);
  warnOutside(model, options.model, set);
  writeText(options.output, formatPatterns(set));
  std::cout << table(set);
}

struct CheckOptions {
  std::string file;
  std::string model;
};

void check(const CheckOptions& options) {
  const std::string& file = options.file;
  const PatternSet set = readPatternFile(file);
  if (!options.model.empty()) warnOutside(readModelDocument(options.model), options.model, set);
  for (const std::string& line : adviceFor(set)) std::cout << file << ": warning: " << line << '\n';
  std::cout << file << ": ok, " << set.patterns().size() << " patterns, "
            << set.content().classes.size() << " classes, version " << set.version() << '\n';
}

struct MirrorOptions {
  std::string file;
  std::string output;
  std::optional<std::string> pattern;
};

void mirror(const MirrorOptions& options) {
  std::vector<std::string> notes;
  const PatternSet set = withMirrors(readPatternFile(options.file), options.pattern, notes);
  writeText(options.output, formatPatterns(set));
  for (const std::string& note : notes) std::cout << note << '\n';
  if (notes.empty()) std::cout << "every pattern that turns already has its mirror image\n";
  std::cout << options.output << ": " << set.patterns().size() << " patterns\n";
}

struct ShowOptions {
  std::string file;
  std::string other;
  std::string picture;
};

/// The file's name; with its folder only if both files have the same name.
std::string labelOf(const std::string& file, const std::string& other) {
  const auto name = std::filesystem::path(file).filename();
  return name == std::filesystem::path(other).filename() ? file : name.string();
}

void show(const ShowOptions& options) {
  const PatternSet set = readPatternFile(options.file);
  std::vector<PicturedSet> pictured{{labelOf(options.file, options.other), set}};
  if (options.other.empty()) {
    std::cout << table(set);
  } else {
    const PatternSet other = readPatternFile(options.other);
    std::cout << comparison(set, options.file, other, options.other);
    pictured.push_back({labelOf(options.other, options.file), other});
  }
  if (!options.picture.empty()) drawSets(pictured, options.picture);
}

}  // namespace

CLI::App* addMake(CLI::App& app) {
  const auto options = std::make_shared<MakeOptions>();
  CLI::App* command = app.add_subcommand("make", "make a pattern file from a recipe");
  command->add_option("RECIPE", options->recipe, "recipe (YAML)")->required();
  command->add_option("--model", options->model, "model file for the predictions")->required();
  Outputs(*command).file("-o,--output", options->output, "pattern file to write")->required();
  command->callback([options] { make(*options); });
  return command;
}

CLI::App* addCheck(CLI::App& app) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "check a pattern file: errors (exit code 1) and warnings");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->add_option("--model", options->model,
                      "model file: also warn of motions beyond those that it was fitted to");
  command->callback([options] { check(*options); });
  return command;
}

CLI::App* addMirror(CLI::App& app) {
  const auto options = std::make_shared<MirrorOptions>();
  CLI::App* command =
      app.add_subcommand("mirror", "add the mirror image of every pattern that turns and has none");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  Outputs(*command).file("-o,--output", options->output, "pattern file to write")->required();
  command->add_option("--pattern", options->pattern, "add the mirror image of this pattern only");
  command->callback([options] { mirror(*options); });
  return command;
}

CLI::App* addShow(CLI::App& app) {
  const auto options = std::make_shared<ShowOptions>();
  CLI::App* command = app.add_subcommand("show", "print a pattern file as a table, or compare two");
  command->add_option("FILE", options->file, "pattern file (YAML)")->required();
  command->add_option("--compare", options->other,
                      "another pattern file: print the differences of the end poses");
  Outputs(*command).file("--picture", options->picture,
                         "PNG to write: all trajectories with the spread of their ends");
  command->callback([options] { show(*options); });
  return command;
}

}  // namespace tread::patterns

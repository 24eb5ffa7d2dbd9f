// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/envelope.hpp"
#include "tools/patterns/output.hpp"
#include "tools/patterns/recipe.hpp"
#include "tools/patterns/table.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string recipe;
  std::string model;
  std::string output;
};

void make(const Options& options) {
  const ModelDocument model = readModelDocument(options.model);
  const PatternSet set = makeSet(ConfigReader::fromFile(options.recipe), model.vehicle);
  warnOutside(model, options.model, set);
  writeOutput(options.output, formatPatterns(set), {options.recipe, options.model});
  std::cout << table(set);
}

}  // namespace

CLI::App* addMake(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("make", "make a pattern file from a recipe");
  command->add_option("RECIPE", options->recipe, "recipe (YAML)")->required();
  command->add_option("--model", options->model, "model file that predicts")->required();
  command->add_option("-o,--output", options->output, "pattern file to write")->required();
  command->callback([options] { make(*options); });
  return command;
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/patterns/recipe.hpp"
#include "tools/patterns/table.hpp"

namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written; check folder and rights");
}

void make(const std::string& recipe, const std::string& model, const std::string& output) {
  const tread::PatternSet set =
      tread::patterns::makeSet(tread::ConfigReader::fromFile(recipe), tread::readModelFile(model));
  write(output, tread::formatPatterns(set));
  std::cout << tread::patterns::table(set);
}

int run(int argc, char** argv) {
  CLI::App app{"Makes and shows motion patterns."};
  app.require_subcommand(1);
  std::string recipe;
  std::string model;
  std::string output;
  CLI::App* make_command = app.add_subcommand("make", "make a pattern file from a recipe");
  make_command->add_option("RECIPE", recipe, "recipe (YAML)")->required();
  make_command->add_option("--model", model, "model file that predicts")->required();
  make_command->add_option("-o,--output", output, "pattern file to write")->required();
  std::string file;
  CLI::App* show_command = app.add_subcommand("show", "print a pattern file as a table");
  show_command->add_option("FILE", file, "pattern file (YAML)")->required();
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  if (make_command->parsed())
    make(recipe, model, output);
  else
    std::cout << tread::patterns::table(tread::readPatternFile(file));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tread-patterns: %s\n", error.what());
    return 1;
  }
}

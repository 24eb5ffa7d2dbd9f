// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/model_recording.hpp"
#include "tools/recordings/book_update.hpp"

namespace tread::patterns {
namespace {

struct Options {
  std::string patterns;
  std::string book;
  std::string surface;
  std::string model;
  ModelRecording how;
};

void record(const Options& options) {
  const PatternSet set = readPatternFile(options.patterns);
  recordings::requireSamePatterns(options.book, set);
  const recordings::SurfaceRecordings surface =
      recordModel(set, readModelFile(options.model), options.surface, options.how);
  const bool replaced = recordings::addToBook(options.book, set, surface);
  std::cout << options.book << "/" << options.surface << ".csv: " << options.how.executions
            << " executions of each of " << set.patterns().size() << " patterns"
            << (replaced ? ", in the place of what was there" : "") << '\n';
}

}  // namespace

CLI::App* addRecord(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "record", "execute each pattern many times and store what it did as a surface of a book");
  command->add_option("PATTERNS", options->patterns, "pattern file (YAML)")->required();
  command->add_option("--book", options->book, "folder of recordings; made if needed")->required();
  command->add_option("--surface", options->surface, "name of the surface, replaced if recorded")
      ->required();
  command->add_option("--model", options->model, "vehicle model (YAML) that executes")->required();
  ModelRecording& how = options->how;
  command->add_option("-n,--executions", how.executions, "of each pattern")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  command->add_option("--seed", how.seed, "of the model's spread and noise")->capture_default_str();
  command
      ->add_option("--ins-position", how.position, "m, standard deviation of each measured sample")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  command->add_option("--ins-yaw", how.yaw, "rad, the same for yaw")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
  command->callback([options] { record(*options); });
  return command;
}

}  // namespace tread::patterns

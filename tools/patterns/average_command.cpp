// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/pattern/pattern_check.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/recordings/recordings.hpp"
#include "tools/patterns/commands.hpp"
#include "tools/patterns/output.hpp"
#include "tools/patterns/table.hpp"

namespace tread::patterns {
namespace {

using recordings::AverageLimits;
using recordings::AverageNote;
using recordings::PatternRecordings;
using recordings::SurfaceRecordings;

struct Options {
  std::string book;
  std::string surface;
  std::string output;
  std::string name;
  AverageLimits limits;
};

const SurfaceRecordings& surfaceNamed(const PatternRecordings& book, const Options& options) {
  std::string names;
  for (const SurfaceRecordings& surface : book.surfaces) {
    if (surface.surface == options.surface) return surface;
    names += (names.empty() ? "" : ", ") + surface.surface;
  }
  throw recordings::RecordingError(options.book + ": no surface '" + options.surface +
                                   "'; recorded are " + names);
}

std::string noteLine(const AverageNote& note) {
  std::string line = note.pattern + ": " + std::to_string(note.used) + " executions averaged by " +
                     (note.by_twist ? "twist (a strong turn)" : "pose");
  if (!note.rejected.empty()) line += ", " + std::to_string(note.rejected.size()) + " rejected:";
  for (const std::string& why : note.rejected) line += "\n  " + why;
  return line + "\n";
}

PatternSet named(const PatternSet& set, const std::string& name) {
  PatternSetContent content = set.content();
  content.name = name.substr(0, PatternLimits::kMaxNameLength);
  std::string why;
  auto result = PatternSet::make(std::move(content), why);
  if (!result) throw recordings::RecordingError("--name: " + why);
  return *result;
}

void average(const Options& options) {
  const PatternRecordings book = recordings::readRecordings(options.book);
  const SurfaceRecordings& surface = surfaceNamed(book, options);
  std::vector<AverageNote> notes;
  const PatternSet averaged = recordings::averageSet(book.patterns, surface, options.limits, notes);
  const std::string name =
      options.name.empty() ? book.patterns.content().name + "_" + options.surface : options.name;
  const PatternSet set = named(averaged, name);
  writeOutput(options.output, formatPatterns(set),
              {options.book + "/patterns.yaml", options.book + "/" + options.surface + ".csv"});
  for (const AverageNote& note : notes) std::cout << noteLine(note);
  std::cout << table(set);
}

}  // namespace

CLI::App* addAverage(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "average", "average the recordings of one surface: the set that is right there");
  command->add_option("BOOK", options->book, "folder of recordings")->required();
  command->add_option("SURFACE", options->surface, "surface, a SURFACE.csv of the book")
      ->required();
  command->add_option("-o,--output", options->output, "pattern file to write")->required();
  command->add_option("--name", options->name, "name of the set (default: SET_SURFACE)");
  AverageLimits& limits = options->limits;
  command
      ->add_option("--strong-turn", limits.strong_turn,
                   "rad of yaw from which twists are averaged, not poses")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command
      ->add_option("--max-speed", limits.max_speed,
                   "m/s that are possible; 0 = 1.5 times what the median execution reaches")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 30.0));
  command->add_option("--min-executions", limits.min_executions, "fewer fair ones are refused")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->callback([options] { average(*options); });
  return command;
}

}  // namespace tread::patterns

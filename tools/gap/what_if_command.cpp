// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/recordings/text_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/gap/commands.hpp"
#include "tools/gap/drive_log.hpp"
#include "tools/gap/model_change.hpp"
#include "tools/gap/report/effect_words.hpp"
#include "tools/gap/what_if.hpp"

namespace tread::gap {
namespace {

struct Options {
  std::string model;
  ModelChange change;
  std::string log;
  std::string out;
  double minutes = 10.0;
  double pitch = 0.0;         // [deg]
  double roll = 0.0;          // [deg]
  double battery_drop = 0.0;  // [%]
  double worked = 0.5;
};

Circumstances circumstancesOf(const Options& options) {
  Circumstances circumstances;
  circumstances.session_time = 60.0 * options.minutes;
  circumstances.battery_drop = 0.01 * options.battery_drop;
  circumstances.roll = options.roll * kPi / 180.0;
  circumstances.pitch = options.pitch * kPi / 180.0;
  circumstances.worked = options.worked;
  return circumstances;
}

/// "What if without A, with B and limit=1.2".
std::string questionOf(const ModelChange& change) {
  std::vector<std::string> parts;
  for (const std::string& effect : change.remove)
    parts.push_back("without " + inSentence(titleOf(effect)));
  for (const std::string& effect : change.add)
    parts.push_back("with " + inSentence(titleOf(effect)));
  for (const std::string& assignment : change.set) parts.push_back(assignment);
  return "What if: " + joined(parts) + "?";
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void whatIf(const Options& options) {
  if (options.change.remove.empty() && options.change.add.empty() && options.change.set.empty())
    throw std::runtime_error("what-if: nothing to change; give --remove, --add or --set");
  const bool svg = endsWith(options.out, ".svg");
  if (!options.out.empty() && !svg && !endsWith(options.out, ".html"))
    throw std::runtime_error(options.out + ": what kind of file? end it with .html or .svg");
  const ModelDocument model = readModelDocument(options.model);
  const ModelDocument other = changed(model, options.change);
  const std::vector<ManoeuvreComparison> comparisons =
      compareModels(model, other, circumstancesOf(options));
  std::vector<LogComparison> on_log;
  std::string lost;
  if (!options.log.empty()) {
    const Drive drive = readSoundDriveFor(model, options.log);
    lost = drive.lost;
    on_log.push_back(compareOnLog(drive, model, other));
  }
  const std::string question = questionOf(options.change);
  const std::string setting = settingOf(model, other, options.model, options.log);
  std::cout << question << "\n" << setting << "\n\n" << textOf(comparisons);
  for (const LogComparison& comparison : on_log) std::cout << '\n' << textOf(comparison);
  if (!lost.empty()) std::cout << lost << '\n';
  if (!options.out.empty())
    recordings::writeText(
        options.out,
        svg ? svgOf(comparisons, on_log) : htmlOf(pageOf(question, setting, comparisons, on_log)));
  std::cout << std::flush;
}

void addCircumstances(CLI::App& command, Options& options) {
  command.add_option("--minutes", options.minutes, "since the start of the session")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10000.0));
  command.add_option("--pitch", options.pitch, "deg, of the ground, nose down positive")
      ->check(CLI::Range(-45.0, 45.0));
  command.add_option("--roll", options.roll, "deg, of the ground, left side up positive")
      ->check(CLI::Range(-45.0, 45.0));
  command.add_option("--battery-drop", options.battery_drop, "%, fall of the voltage since then")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--worked", options.worked, "mean square of the duty until now, 0..1")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
}

}  // namespace

CLI::App* addWhatIf(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "what-if", "simulate with an effect removed, added or of another size, and show it");
  command->add_option("--model", options->model, "model file (YAML)")->required();
  command->add_option("--remove", options->change.remove, "turn this effect off");
  command->add_option("--add", options->change.add,
                      "turn this effect on, at its typical size; of one that is on, --set another");
  command->add_option(
      "--set", options->change.set,
      "parameter=number: of the effect added, or effect.parameter, or lag, delay..");
  command->add_option("--log", options->log, "a log; its executions are simulated, too");
  command->add_option("--out", options->out, "pictures: FILE.html or FILE.svg");
  addCircumstances(*command, *options);
  command->callback([options] { whatIf(*options); });
  return command;
}

}  // namespace tread::gap

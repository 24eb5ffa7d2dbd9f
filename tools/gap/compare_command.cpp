// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "common/vehicle/model_file.hpp"
#include "tools/gap/commands.hpp"
#include "tools/gap/compare.hpp"
#include "tools/gap/drive_log.hpp"

namespace tread::gap {
namespace {

constexpr int kSomethingMoved = 10;

struct Options {
  std::string first;
  std::string second;
  std::string model;
  int threads = 1;
};

int compare(const Options& options) {
  const ModelDocument model = readModelDocument(options.model);
  const Drive first = readSoundDriveFor(model, options.first);
  const Drive second = readSoundDriveFor(model, options.second);
  if (first.sha256 == second.sha256)
    throw std::runtime_error(options.second + ": the same file as the first; give two logs");
  requireSameRobot(first, second);
  requireSameImport(first, second);
  const LogChange change = compareLogs(model, first, second, onThreads(options.threads));
  for (const Drive* drive : {&first, &second})
    if (!drive->lost.empty()) std::cout << drive->lost << '\n';
  std::cout << textOf(change) << std::flush;
  return change.anyMoved() ? kSomethingMoved : 0;
}

}  // namespace

CLI::App* addCompare(CLI::App& app, int& status) {
  const auto options = std::make_shared<Options>();
  options->threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  CLI::App* command =
      app.add_subcommand("compare", "what changed from one log to another, yesterday and today");
  command->footer(
      "Fits the same terms on both logs and tells which parameters moved beyond chance, at three\n"
      "sigma for all of them together: of a hundred pairs of equal logs at most one is said to\n"
      "have changed. Exit status 0: nothing moved; 10: something did; 2: bad input.");
  command->add_option("FIRST", options->first, "log")->required();
  command->add_option("SECOND", options->second, "log")->required();
  command->add_option("--model", options->model, "model file whose terms are fitted (YAML)")
      ->required();
  command->add_option("--threads", options->threads, "no influence on any byte")
      ->check(CLI::Range(1, 1024));
  command->callback([options, &status] { status = compare(*options); });
  return command;
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/config/command_line.hpp"
#include "common/config/outputs.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/study/models/comparison_output.hpp"
#include "tools/lab/gap/report/report.hpp"

namespace tread::gap {
namespace {

struct Options {
  std::vector<std::string> logs;
  std::string model;
  std::string out;
  bool pool = false;
  int64_t seed = 1;
  int threads = 1;
};

constexpr const char* kFooter =
    "Rungs: the ideal model; gain and track fitted; powertrain and centre of rotation; the\n"
    "literature's slip regression; a black box; least squares over all parameters of the\n"
    "catalogue; a sparse regression on its effects (SINDy); the discovered model. Each is tested\n"
    "on held-out driving: alternate blocks of the log; with --pool also the log that the\n"
    "others were not fitted to. Without --model the ideal one is a differential drive\n"
    "with the track width of the imported recording. Writes into --out: comparison.json and\n"
    "comparison.md. Exit status 0, or 2 for bad input. The same files and the same seed give\n"
    "the same bytes, with any number of threads.";

/// Active terms of a model could not be distinguished from discovered ones.
ModelDocument readIdeal(const std::string& path) {
  ModelDocument model = readModelDocument(path);
  for (const Effect& effect : effectCatalogue())
    if (isOn(effect, model))
      throw std::runtime_error(path + ": the effect " + effect.name +
                               " is on; a comparison begins with a model without effects");
  return model;
}

/// A differential drive that follows its track speeds exactly.
ComparisonLog recordedIdeal(const std::string& path) {
  ComparisonLog log;
  log.drive = readDrive(path);
  if (log.drive.kind != CommandKind::kTrackSpeed)
    throw std::runtime_error(path +
                             ": its commands are powers, so that the ideal model must say how fast "
                             "full power is; give --model");
  const double baseline = log.drive.imported ? log.drive.imported->baseline : 0.0;
  log.ideal.vehicle.name = "ideal differential drive";
  log.ideal.vehicle.kind = CommandKind::kTrackSpeed;
  log.ideal.vehicle.gauge = baseline > 0.0 ? baseline : 1.0;
  log.ideal_known = baseline > 0.0;
  return log;
}

std::vector<ComparisonLog> readLogs(const Options& options) {
  std::optional<ModelDocument> ideal;
  if (!options.model.empty()) ideal = readIdeal(options.model);
  std::vector<ComparisonLog> logs;
  for (const std::string& path : options.logs) {
    ComparisonLog log =
        ideal ? ComparisonLog{readDriveFor(*ideal, path), *ideal} : recordedIdeal(path);
    for (const ComparisonLog& other : logs)
      if (other.drive.sha256 == log.drive.sha256)
        throw std::runtime_error(path + ": the same file as " + other.drive.name +
                                 "; give each log once");
    for (const ComparisonLog& other : logs) {
      requireSameImport(other.drive, log.drive);
      if (options.pool) requireSameRobot(other.drive, log.drive);
    }
    logs.push_back(std::move(log));
  }
  return logs;
}

/// An empty table would look like a result. Pooled, several short logs may be enough.
void requireRows(const ComparisonTask& task) {
  for (const ComparisonLog& log : task.logs)
    if (task.pool || unusable(log.drive).empty()) return;
  const Drive& first = task.logs.front().drive;
  throw std::runtime_error(first.name + ": " + unusable(first));
}

void requireRows(const ModelComparison& comparison) {
  for (const auto* rows : {&comparison.nested, &comparison.pooled})
    for (const ComparisonRow& row : *rows)
      if (row.remark.empty()) return;
  throw std::runtime_error(comparison.nested.front().log + ": " + comparison.nested.front().remark);
}

/// Reports the lost share of logs.
void tellLosses(const ComparisonTask& task) {
  for (const ComparisonLog& log : task.logs)
    if (!log.drive.lost.empty()) std::cout << log.drive.lost << std::endl;
}

void compare(const Options& options) {
  if (options.pool && options.logs.size() < 2)
    throw std::runtime_error("--pool: learning from all logs but one wants at least two --log");
  ComparisonTask task;
  task.logs = readLogs(options);
  task.pool = options.pool;
  task.seed = static_cast<uint64_t>(options.seed);
  task.parallel = onThreads(options.threads);
  requireRows(task);
  tellLosses(task);
  ComparisonReport report;
  report.model = std::filesystem::path(options.model).filename().string();
  for (const ComparisonLog& log : task.logs) report.sha256.push_back(log.drive.sha256);
  report.comparison =
      compareOnLogs(task, [](const std::string& line) { std::cout << line << std::endl; });
  requireRows(report.comparison);
  writeComparison(options.out, report);
  std::cout << comparisonText(report) << options.out << "/comparison.md" << std::endl;
}

}  // namespace

}  // namespace tread::gap

int main(int argc, char** argv) {
  CLI::App app{"Compares tread-gap's discovered model with models from the literature.",
               "tread-compare-models"};
  tread::gap::Options options;
  app.footer(tread::gap::kFooter);
  app.add_option("--log", options.logs, "logs of drives")->required()->expected(-1);
  app.add_option("--model", options.model, "the ideal model (YAML), without effects");
  tread::Outputs(app)
      .folder("--out", options.out,
              "folder for comparison.json and comparison.md; created if needed")
      ->required();
  app.add_flag("--pool", options.pool, "also predict each log by models fitted to all others");
  app.add_option("--seed", options.seed, "seed of the random numbers in the tests")
      ->capture_default_str()
      ->check(CLI::Range(int64_t{0}, int64_t{9'000'000'000'000'000'000}));
  tread::addThreads(app, options.threads);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  return tread::runProgram("tread-compare-models", [&] {
    tread::gap::compare(options);
    return 0;
  });
}

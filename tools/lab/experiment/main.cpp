// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/config/scalars.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "tools/lab/experiment/adaptation/adaptation_report.hpp"
#include "tools/lab/experiment/adaptation/read_recordings.hpp"
#include "tools/lab/experiment/adaptation/summary.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"
#include "tools/lab/experiment/batch.hpp"
#include "tools/lab/experiment/batch_files.hpp"
#include "tools/lab/experiment/crossings/crossings_text.hpp"
#include "tools/lab/experiment/first_executions_text.hpp"
#include "tools/lab/experiment/key_figures.hpp"
#include "tools/lab/experiment/text_tables.hpp"
#include "tools/robot/import/csv_drive.hpp"

namespace {

using tread::OutputFolder;
using tread::Outputs;
using tread::experiment::Batch;
using tread::experiment::Request;

struct Arguments {
  Request request;
  std::string out;
};

/// A progress bar on stderr, on a terminal only.
void showProgress(double share) {
  static const bool looked_at = isatty(STDERR_FILENO) != 0;
  if (!looked_at) return;
  constexpr int kWidth = 50;
  const int done = static_cast<int>(share * kWidth);
  std::fprintf(stderr, "\r[%s%s] %3.0f %%", std::string(static_cast<size_t>(done), '#').c_str(),
               std::string(static_cast<size_t>(kWidth - done), ' ').c_str(), 100.0 * share);
  if (share >= 1.0) std::fputc('\n', stderr);
  std::fflush(stderr);
}

void define(CLI::App& command, Arguments& arguments) {
  Request& request = arguments.request;
  auto* source = command.add_option_group("surfaces", "source of the recordings");
  source->add_option("--world", request.world, "simulated world of transitions (config/worlds)");
  source->add_option("--recordings", request.recordings,
                     "folder of recordings (patterns.yaml) or of drives (sessions.csv)");
  source->require_option(1);
  command.add_option("--robot", request.robot, "drives: part of the robot's name");
  command.add_option("--sessions", request.sessions, "drives: only these sessions")->delimiter(',');
  command
      .add_option(
          "--rules", request.rules,
          "methods: RULE, RULE_home, RULE_unmet, RULE_remembered, where RULE is a rule of the "
          "learner or a rival (" +
              tread::joinWords(tread::adaptation::rivalNames()) + "); omniscient")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option(
      "--sequence", request.sequences,
      "test sequence, patterns separated by commas; repeatable "
      "(default: the world's; left, left, right; the patterns with the most distant ends)");
  command.add_option("--repetitions", request.repetitions, "repetitions of each transition")
      ->check(CLI::Range(2, 100'000'000))
      ->capture_default_str();
  command
      .add_option("--excitations", request.excitations,
                  "excitation runs of each transition, which share its repetitions")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
  command
      .add_option("--excitation", request.excitation, "executions on each surface of such a run")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--memory", request.memory, "w: weight of the old prediction")
      ->check(CLI::Range(0.0, 0.999))
      ->capture_default_str();
  command
      .add_option("--set", request.overrides,
                  "SECTION.KEY=VALUE in the place of what learner.yaml would say: ground.fresh=0.3")
      ->expected(1)
      ->take_all();
  command.add_option("--seed", request.seed, "seed of recordings and trials")
      ->capture_default_str();
  tread::addThreads(command, request.threads);
  command.add_option("--sets", request.sets, "world: number of sets of recordings")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command.add_option("--length", request.length, "world: factor on the duration of each command")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command.add_flag("--change-inside", request.change_inside,
                   "the ground changes in the middle of the first execution");
  command.add_flag(
      "--extras", request.extras,
      "also with patterns of twice the length (world) and with changes inside a pattern");
  Outputs(command).folder("--out", arguments.out, "folder for tables, pictures and report.html");
}

/// The command adaptation.
struct AdaptationArguments {
  tread::adaptation::Settings settings;
  std::string recordings;
  std::vector<std::string> overrides;
  std::string out;
};

void define(CLI::App& command, AdaptationArguments& arguments) {
  command
      .add_option("--recordings", arguments.recordings,
                  "folder of drives (sessions.csv) or of LCM logs of drives (*.lcmlog)")
      ->required();
  command
      .add_option("--rules", arguments.settings.rules,
                  "off, rules of learner.yaml or RULE_home, rivals (" +
                      tread::joinWords(tread::adaptation::rivalNames()) +
                      "), hindsight (slip regression fitted to the whole session)")
      ->delimiter(',')
      ->capture_default_str();
  command
      .add_option("--starts", arguments.settings.starts,
                  "largest number of starts in each session; each has a new learner")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      .add_option("--set", arguments.overrides,
                  "SECTION.KEY=VALUE in the place of what learner.yaml would say: ground.fresh=0.3")
      ->expected(1)
      ->take_all();
  command.add_option("--seed", arguments.settings.seed, "seed of intervals and random features")
      ->capture_default_str();
  tread::addThreads(command, arguments.settings.threads);
  Outputs(command).folder("--out", arguments.out,
                          "folder for adaptation.html, picture and CSV files");
}

/// The command crossings.
struct CrossingArguments {
  tread::experiment::CrossingSettings settings;
  std::vector<std::string> files;
  std::string mapping;
  std::vector<std::string> overrides;
  std::string out;
};

void define(CLI::App& command, CrossingArguments& arguments) {
  tread::experiment::CrossingSettings& settings = arguments.settings;
  command.add_option("csv", arguments.files, "drives in CSV with columns that name the ground")
      ->required();
  command
      .add_option("--mapping", arguments.mapping,
                  "file with the meaning of the columns (config/imports)")
      ->required();
  command
      .add_option(
          "--rules", settings.rules,
          "learning rules or rivals (" + tread::joinWords(tread::adaptation::rivalNames()) + ")")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--cut", settings.cut.length, "pieces of so many seconds under one command")
      ->check(CLI::Range(0.2, 50.0))
      ->capture_default_str();
  command
      .add_option("--offset", settings.cut.settle,
                  "first piece this long after a command began [s]")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command.add_option("--known", settings.known, "number of pieces for the initial set of a run")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command.add_option("--border", settings.border, "uncertainty of the borders in the columns [m]")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command.add_option("--window", settings.test.window, "window of the change test [s]")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  command.add_option("--chance", settings.test.chance, "false-alarm probability of a window [1]")
      ->check(CLI::Range(1e-9, 0.5))
      ->capture_default_str();
  command.add_option("--memory", settings.config.memory, "w: weight of the old prediction")
      ->check(CLI::Range(0.0, 0.999))
      ->capture_default_str();
  command
      .add_option("--set", arguments.overrides,
                  "SECTION.KEY=VALUE in the place of what learner.yaml would say: ground.fresh=0.3")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  Outputs(command).folder("--out", arguments.out, "folder for crossings.csv and noticed.csv");
}

void run(CrossingArguments arguments) {
  namespace experiment = tread::experiment;
  experiment::CrossingSettings& settings = arguments.settings;
  tread::ConfigReader reader = tread::ConfigReader::fromText("{}", "learner", arguments.overrides);
  tread::learner::readRules(reader, settings.config);
  reader.finish();
  std::vector<experiment::CrossingDrives> drives;
  std::string left_out;  // printed only with a result: an error must be one line
  for (const std::string& file : arguments.files) {
    tread::ConfigReader mapping = tread::ConfigReader::fromFile(arguments.mapping);
    tread::import::ForeignDrive read =
        tread::import::readMappedCsv(file, tread::import::readCsvMapping(mapping));
    drives.push_back(crossingRuns(std::move(read.drive), settings));
    for (const std::string& note : drives.back().notes)
      left_out += std::filesystem::path(file).filename().string() + ": " + note + "\n";
  }
  const auto errors = driveCrossings(drives, settings);
  if (!arguments.out.empty()) {
    OutputFolder folder(arguments.out);
    const std::filesystem::path made = folder.path();
    tread::writeText((made / "crossings.csv").string(), csvOf(errors));
    tread::writeText((made / "noticed.csv").string(), noticedCsvOf(errors));
    folder.commit();
  }
  std::cerr << left_out;
  std::cout << textOf(drives) << textOf(errors) << std::flush;
}

void run(const AdaptationArguments& arguments) {
  tread::adaptation::Report report;
  report.settings = arguments.settings;
  tread::ConfigReader reader = tread::ConfigReader::fromText("{}", "learner", arguments.overrides);
  tread::learner::readRules(reader, report.settings.config);
  reader.finish();
  tread::adaptation::Recordings read = tread::adaptation::readRecordings(arguments.recordings);
  report.source = std::filesystem::path(arguments.recordings).filename().string();
  report.errors =
      tread::adaptation::runAdaptation(read.sessions, report.settings, [](size_t done, size_t all) {
        showProgress(static_cast<double>(done) / static_cast<double>(all));
      });
  report.notes = std::move(read.notes);
  report.notes.insert(report.notes.end(), report.errors.notes.begin(), report.errors.notes.end());
  report.lines = summaryOf(report.errors, report.settings.rules, report.settings.seed);
  if (!arguments.out.empty()) {
    OutputFolder folder(arguments.out);
    writeReport(folder.path(), report);
    folder.commit();
  }
  std::cout << textOf(report) << std::flush;
}

void run(const Arguments& arguments) {
  const Batch batch = tread::experiment::runBatch(arguments.request, showProgress);
  for (const std::string& note : batch.notes) std::cerr << note << '\n';
  if (!arguments.out.empty()) {
    OutputFolder folder(arguments.out);
    tread::experiment::writeBatch(folder.path(), batch);
    folder.commit();
  }
  std::cout << textOfErrors(batch.tables, batch.setting) << '\n'
            << textOfReductions(batch.tables, batch.setting) << '\n'
            << textOfAgreement(batch.tables, batch.setting, batch.sets) << '\n'
            << textOfRemembered(batch) << '\n'
            << textOfDrift(batch) << '\n'
            << textOfFirstExecutions(batch.tables, batch.setting) << '\n'
            << textOfVariants(batch) << textOfKeyFigures(batch.tables, batch.setting, batch.sets)
            << std::flush;
  std::fprintf(stderr, "%s: %zu transitions, %.2f s of trials on %d threads\n",
               batch.source.c_str(), batch.first.transitions.size(), batch.seconds,
               arguments.request.threads);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Experiments with learning rules.", "tread-experiment"};
  app.require_subcommand(1);
  Arguments arguments;
  arguments.request.rules = tread::experiment::defaultMethods();
  CLI::App* transitions = app.add_subcommand(
      "transitions", "section V of the paper: errors of rules after a change of surface");
  define(*transitions, arguments);
  AdaptationArguments of_adaptation;
  CLI::App* adaptation = app.add_subcommand("adaptation",
                                            "open-loop errors after 0 to 30 executions on new "
                                            "ground, in a new session, with a new vehicle");
  define(*adaptation, of_adaptation);
  CrossingArguments of_crossings;
  CLI::App* crossings = app.add_subcommand(
      "crossings", "errors and detection delays when the ground changes within a run");
  define(*crossings, of_crossings);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  return tread::runProgram("tread-experiment", [&] {
    if (*adaptation)
      run(of_adaptation);
    else if (*crossings)
      run(of_crossings);
    else
      run(arguments);
    return 0;
  });
}

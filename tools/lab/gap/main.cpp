// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/report/page.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/kept_term.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/identification/core/discovery.hpp"
#include "tools/lab/gap/compare.hpp"
#include "tools/lab/gap/explain.hpp"
#include "tools/lab/gap/question_commands.hpp"
#include "tools/lab/gap/repeat.hpp"
#include "tools/lab/gap/report/find_output.hpp"
#include "tools/lab/gap/report/headline.hpp"
#include "tools/lab/gap/watch_command.hpp"
#include "tools/lab/gap/what_if.hpp"

namespace tread::gap {
namespace {

struct FindOptions {
  std::string model;
  std::vector<std::string> train;
  std::vector<std::string> test;
  std::string out;
  int64_t seed = 1;
  int threads = 1;
  bool calibrate = false;
  bool keep_small = false;
  bool named_only = false;
  double limit = 0.0;  ///< [s]; 0 = none
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

constexpr const char* kFindFooter =
    "Writes into --out: verdict.json, model.yaml (the new model, not applied automatically; none "
    "after\n"
    "CANNOT_TELL), report.md and report.html. Exit status: 0 NO_DISCREPANCY or "
    "NOTHING_NEW,\n"
    "10 FOUND, 11 AMBIGUOUS, 12 PARTIAL, 13 NOT_IN_CATALOGUE, 14 MEASUREMENT, 15 CANNOT_TELL, 2 "
    "bad input (with one line of explanation).\n"
    "The same files and seed give the same bytes with any number of threads, unless "
    "--limit ends the search.";

std::string fileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

void say(const std::string& line) {
  std::cout << line << std::endl;
}

/// Stage 0: prints the contents and defects of a log.
void tell(const Drive& drive) {
  say("0 " + drive.name + ": " + threeDigits(drive.driven()) + " s of driving, " +
      std::to_string(drive.executions.size()) + " executions");
  for (const LogNote& note : drive.notes) say((note.isFatal() ? "  ! " : "  ") + note.what);
}

/// Reads logs of one role; refuses duplicates, which would count their noise twice.
std::vector<Drive> readDrives(const std::vector<std::string>& paths, InputFile::Role role,
                              const ModelDocument& model, std::vector<InputFile>& inputs) {
  std::vector<Drive> drives;
  for (const std::string& path : paths) {
    Drive drive = readDriveFor(model, path);
    for (const InputFile& input : inputs)
      if (input.sha256 == drive.sha256)
        throw std::runtime_error(path + ": the same file as " + input.name +
                                 "; give each log once");
    inputs.push_back({role, fileName(path), drive.sha256});
    tell(drive);
    drives.push_back(std::move(drive));
  }
  return drives;
}

/// Prints where the files are; says so if a model.yaml in the folder is from an earlier run.
void sayWhere(const std::string& folder, const GapFinding& finding) {
  say("Report: " + folder + "/report.html");
  if (hasNewModel(finding)) {
    say("New model, not applied automatically: " + folder + "/model.yaml");
    return;
  }
  const bool old = std::filesystem::exists(folder + "/model.yaml");
  say(std::string("No model was written") +
      (old ? "; " + folder + "/model.yaml is left from an earlier run." : "."));
}

/// The inputs of find and repeat.
GapTask taskOf(const FindOptions& options, std::vector<InputFile>& inputs) {
  GapTask task;
  task.model = readModelDocument(options.model);
  task.decisions = decisionsOf({options.accepted, options.rejected, options.by}, task.model);
  inputs.push_back(
      {InputFile::Role::kModel, fileName(options.model), sha256(readText(options.model))});
  task.train = readDrives(options.train, InputFile::Role::kTrain, task.model, inputs);
  task.test = readDrives(options.test, InputFile::Role::kTest, task.model, inputs);
  for (const std::vector<Drive>* drives : {&task.train, &task.test})
    for (const Drive& drive : *drives) {
      for (const Drive& other : task.train) {
        requireSameRobot(other, drive);
        requireSameImport(other, drive);
      }
      task.log_notes.insert(task.log_notes.end(), drive.notes.begin(), drive.notes.end());
    }
  task.seed = static_cast<uint64_t>(options.seed);
  task.parallel = onThreads(options.threads);
  task.calibrate = options.calibrate;
  task.keep_small = options.keep_small;
  task.named_only = options.named_only;
  if (options.limit > 0.0)
    task.is_over = [end = std::chrono::steady_clock::now() +
                          std::chrono::duration<double>(options.limit)] {
      return std::chrono::steady_clock::now() > end;
    };
  return task;
}

int find(const FindOptions& options) {
  std::vector<InputFile> inputs;
  const GapTask task = taskOf(options, inputs);
  const GapFinding finding = findGap(task, say);
  OutputFolder folder(options.out);
  writeFinding(folder.path(), finding, inputs);
  folder.commit();
  for (const std::string& line : closingLines(finding)) say(line);
  sayWhere(options.out, finding);
  return exitStatus(finding.verdict);
}

constexpr int kSomethingMoved = 10;

/// File names for the models of days; logs of the same name may come from different folders.
std::vector<std::string> dayFiles(const FindOptions& options) {
  std::vector<std::string> files;
  for (size_t i = 0; i < options.train.size(); ++i)
    files.push_back("day" + std::to_string(i + 1) + "_" +
                    std::filesystem::path(options.train[i]).stem().string() + ".yaml");
  return files;
}

int repeat(const FindOptions& options) {
  std::vector<InputFile> inputs;
  const GapTask task = taskOf(options, inputs);
  const Repetition repetition = repeatLogs(task, say);
  OutputFolder folder(options.out);
  writeFinding(folder.path(), repetition.together, inputs);
  const std::string text = textOf(repetition);
  writeText(folder.path() + "/repeat.txt", text);
  const bool cannot_tell = repetition.together.verdict == GapVerdict::kCannotTell;
  const std::vector<std::string> files =
      repetition.differs() && !cannot_tell ? dayFiles(options) : std::vector<std::string>{};
  for (size_t i = 0; i < files.size(); ++i)
    writeText(folder.path() + "/" + files[i], formatModelDocument(repetition.modelOf(i)));
  folder.commit();
  std::cout << '\n' << text;
  sayWhere(options.out, repetition.together);
  if (cannot_tell) return exitStatus(GapVerdict::kCannotTell);
  for (const std::string& file : files)
    say("The same with that day's parameters: " + options.out + "/" + file);
  return repetition.differs() ? kSomethingMoved : 0;
}

struct CompareOptions {
  std::string first;
  std::string second;
  std::string model;
  int threads = 1;
};

int compare(const CompareOptions& options) {
  const ModelDocument model = readModelDocument(options.model);
  const Drive first = readSoundDriveFor(model, options.first);
  const Drive second = readSoundDriveFor(model, options.second);
  if (first.sha256 == second.sha256)
    throw std::runtime_error(options.second + ": both are the same file; give two logs");
  requireSameRobot(first, second);
  requireSameImport(first, second);
  const LogChange change = compareLogs(model, first, second, onThreads(options.threads));
  for (const Drive* drive : {&first, &second})
    if (!drive->lost.empty()) std::cout << drive->lost << '\n';
  std::cout << textOf(change) << std::flush;
  return change.anyMoved() ? kSomethingMoved : 0;
}

/// Options common to all commands that fit.
void addSeedAndThreads(CLI::App& command, FindOptions& options) {
  addEffectsOption(command);
  command.add_option("--seed", options.seed, "seed of the random numbers in the tests")
      ->capture_default_str()
      ->check(CLI::Range(int64_t{0}, int64_t{9'000'000'000'000'000'000}));
  addThreads(command, options.threads);
}

void addFind(CLI::App& app, int& status) {
  const auto options = std::make_shared<FindOptions>();
  CLI::App* command = app.add_subcommand(
      "find", "find where simulation and measurement disagree, and name the effect");
  command->footer(kFindFooter);
  command->add_option("--model", options->model, "model file (YAML)")->required();
  command->add_option("--train", options->train, "logs to learn from")->required()->expected(-1);
  command
      ->add_option("--test", options->test,
                   "logs that are used only for the errors before and after; without them blocks "
                   "of the training "
                   "logs are left out in turn")
      ->expected(-1);
  Outputs(*command)
      .folder("--out", options->out, "folder for the four files; created if needed")
      ->required();
  command->add_flag("--calibrate", options->calibrate,
                    "also fit lag, delay and gains of the nominal model: makes the model of a new "
                    "vehicle from a long log");
  command->add_flag("--keep-small", options->keep_small,
                    "keep significant effects in the model even if they change the end error "
                    "by less than 1 %: for a model that others are to be compared with");
  command->add_flag("--named-only", options->named_only,
                    "add no unnamed term: what no effect explains is reported and stays the "
                    "model's rest");
  command
      ->add_option("--limit", options->limit,
                   "time for the search [s]; then find ends with the best so far, as PARTIAL")
      ->check(CLI::Range(0.001, 1e6));
  command
      ->add_option(
          "--accept", options->accepted,
          "effects that are in the model from the start and stay, whatever the test results")
      ->expected(-1);
  command->add_option("--reject", options->rejected, "effects to leave out")->expected(-1);
  command->add_option("--by", options->by,
                      "name of the person who accepts or rejects, for the new model's provenance");
  addSeedAndThreads(*command, *options);
  command->callback([options, &status] { status = find(*options); });
}

void addRepeat(CLI::App& app, int& status) {
  const auto options = std::make_shared<FindOptions>();
  CLI::App* command = app.add_subcommand(
      "repeat", "compare several days of one vehicle: what agrees, and what differs by day?");
  command->footer(
      "Runs find on each log and on all together, and fits the common result's terms to each log.\n"
      "Parameters without significant differences are the vehicle's, the others are the day's "
      "(ground,\n"
      "battery, INS). Writes into --out: the files of find for all together, repeat.txt, and for "
      "each\n"
      "log a model with that day's parameters. Exit status: 0 nothing differs, 10 something\n"
      "does, 15 all together give CANNOT_TELL, 2 bad input.");
  command->add_option("LOGS", options->train, "two or more logs")->required()->expected(-1);
  command->add_option("--model", options->model, "model file (YAML)")->required();
  Outputs(*command).folder("--out", options->out, "output folder; created if needed")->required();
  command->add_flag("--calibrate", options->calibrate,
                    "also fit lag, delay and gains of the nominal model");
  addSeedAndThreads(*command, *options);
  command->callback([options, &status] { status = repeat(*options); });
}

struct NameOptions {
  std::string model;
  std::string from;
  std::string to;
  std::string effect;  ///< file to write; empty = the term stays unnamed
};

/// Replaces a term by an effect; returns the text of the effect's file.
std::string keepAsEffect(ModelDocument& model, const NameOptions& options) {
  if (std::filesystem::exists(options.effect))
    throw std::runtime_error(options.effect + ": is there already; choose another file");
  ModelDocument named = model;
  renameTerm(named, options.from, options.to);
  const UnnamedTerm& term = *termOfPath(named, options.to + ".0");
  const std::string text = formatEffect(effectOf(term, options.to));
  ConfigReader reader = ConfigReader::fromText(text, options.effect);
  addEntry(readEffectEntry(reader), reader);
  replaceTerm(model, options.from, effectNamed(options.to));
  return text;
}

void name(const NameOptions& options) {
  ModelDocument model = readModelDocument(options.model);
  const bool keep = !options.effect.empty();
  std::string effect;
  if (keep)
    effect = keepAsEffect(model, options);
  else
    renameTerm(model, options.from, options.to);
  const std::string text = formatModelDocument(model);
  parseModelDocument(text, options.model);  // refuse to write an unreadable file
  if (keep) writeText(options.effect, effect);
  writeText(options.model, text);
  say(options.from + " is " + options.to + " in " + options.model + " now");
  if (keep)
    say("Written as an effect: " + options.effect +
        "; edit its texts, and give its folder to find --effects for other logs and models.");
}

void addName(CLI::App& app) {
  const auto options = std::make_shared<NameOptions>();
  CLI::App* command =
      app.add_subcommand("name", "give a name to an unnamed term that find has added to a model");
  command->footer(
      "The model file is rewritten with the name, as find writes it: your own comments in\n"
      "it are lost.");
  command->add_option("MODEL", options->model, "model file (YAML); it is changed")->required();
  command->add_option("TERM", options->from, "its present name, for instance unnamed_1")
      ->required();
  command->add_option("NAME", options->to, "its new name: a-z, 0-9 and _")->required();
  command->add_option("--effect", options->effect,
                      "file to write (YAML): the term becomes an effect of your "
                      "own catalogue, for find --effects FOLDER");
  command->callback([options] { name(*options); });
}

void addExplain(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "explain", "explain an effect: meaning, appearance in data, a check of two minutes");
  command->add_option("EFFECT", *name,
                      "name of an effect, or start, verdicts or words; without it, a list");
  addEffectsOption(*command);
  command->callback([name] {
    const auto about = topic(*name);
    std::cout << (name->empty() ? listOfEffects() + listOfTopics()
                  : about       ? *about
                                : explanation(effectOrGuess(*name)))
              << std::flush;
  });
}

void addCompare(CLI::App& app, int& status) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare", "find what changed between two logs, for instance of yesterday and today");
  command->footer(
      "Fits the same terms to both logs and reports which parameters changed significantly, at "
      "three\n"
      "sigma for all of them together: of a hundred pairs of equal logs at most one is reported "
      "to\n"
      "differ. Exit status 0: nothing changed; 10: something did; 2: bad input.");
  command->add_option("FIRST", options->first, "log")->required();
  command->add_option("SECOND", options->second, "log")->required();
  command->add_option("--model", options->model, "model file whose terms are fitted (YAML)")
      ->required();
  addThreads(*command, options->threads);
  addEffectsOption(*command);
  command->callback([options, &status] { status = compare(*options); });
}

}  // namespace
}  // namespace tread::gap

int main(int argc, char** argv) {
  return tread::runProgram("tread-gap", [&] {
    int status = 0;
    CLI::App app{"Finds, names and closes the gap between simulation and measurement.",
                 "tread-gap"};
    app.require_subcommand(1);
    tread::gap::addFind(app, status);
    tread::gap::addExplain(app);
    tread::gap::addWatch(app, status);
    tread::gap::addWhatIf(app);
    tread::gap::addPlan(app, status);
    tread::gap::addCompare(app, status);
    tread::gap::addRepeat(app, status);
    tread::gap::addName(app);
    return tread::parseCommandLine(app, argc, argv).value_or(status);
  });
}

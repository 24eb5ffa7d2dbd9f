// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/from_recordings_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/config/outputs.hpp"
#include "common/log/event_log.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/drive_recordings.hpp"
#include "common/recordings/execution_log.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "tools/robot/patterns/commands.hpp"

namespace tread::patterns {
namespace {

namespace fs = std::filesystem;
using recordings::DriveRecordings;
using recordings::RecordingError;

struct Options {
  recordings::DriveRequest request;
  bool one_surface = false;
  std::string recipe;
  std::string folder;
  std::string log;
  std::string from;
  std::string to;
  recordings::ExecutionLogRequest executions;
};

/// Refuses other surfaces in the folder: they would be read as part of these recordings.
void refuseOtherSurfaces(const std::string& folder, const DriveRecordings& drives) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() != ".csv") continue;
    const std::string name = entry.path().stem().string();
    const bool ours = std::any_of(drives.surfaces.begin(), drives.surfaces.end(),
                                  [&](const auto& surface) { return surface.surface == name; });
    if (!ours)
      throw RecordingError(entry.path().string() +
                           ": a surface of other recordings; give an empty folder with -o");
  }
}

/// The surface with this name, or with a name that contains it.
size_t surfaceCalled(const DriveRecordings& drives, const std::string& name,
                     const std::string& option) {
  std::string known;
  std::vector<size_t> meant;
  for (size_t i = 0; i < drives.surfaces.size(); ++i) {
    const std::string& surface = drives.surfaces[i].surface;
    if (surface == name) return i;
    if (surface.find(name) != std::string::npos) meant.push_back(i);
    known += (i == 0 ? "" : ", ") + surface;
  }
  if (!name.empty() && meant.size() == 1) return meant.front();
  throw RecordingError(option + " '" + name + "': name one of the surfaces " + known);
}

/// The two surfaces of a log, as indices into the recordings.
struct Transition {
  size_t from = 0;
  size_t to = 0;
};

void writeLog(const Options& options, const DriveRecordings& drives, const Transition& transition) {
  const auto& [from, to] = transition;
  const auto events = recordings::executionLog(recordings::averagedSet(drives, from),
                                               drives.recordings.surfaces[from],
                                               drives.recordings.surfaces[to], options.executions);
  LogWriter writer(options.log);
  for (const LogEvent& event : events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  writer.close();
  const std::string& known = drives.surfaces[from].surface;
  const std::string shipped = (fs::path(options.folder) / (known + ".yaml")).string();
  std::printf(
      "\n%s: %d executions on %s, then %d on %s; its shipped set is %s. Try:\n"
      "  tread-replay learner %s --patterns %s\n",
      options.log.c_str(), options.executions.executions, known.c_str(),
      options.executions.executions, drives.surfaces[to].surface.c_str(), shipped.c_str(),
      options.log.c_str(), shipped.c_str());
}

void writeFolder(const Options& options, const DriveRecordings& drives) {
  refuseOtherSurfaces(options.folder, drives);
  OutputFolder folder(options.folder);
  recordings::writeRecordings(folder.path(), drives.recordings);
  for (size_t i = 0; i < drives.surfaces.size(); ++i)
    writeText((fs::path(folder.path()) / (drives.surfaces[i].surface + ".yaml")).string(),
              formatPatterns(recordings::averagedSet(drives, i)));
  folder.commit();
}

void fromRecordings(const Options& options) {
  recordings::DriveRequest request = options.request;
  if (!options.recipe.empty()) {
    request.recipe = recordings::readRecipe(ConfigReader::fromFile(options.recipe));
    request.fit_recipe = false;
  }
  if (options.one_surface) request.min_surfaces = 1;
  const DriveRecordings drives = recordings::recordingsFromDrives(request);
  Transition transition;
  if (!options.log.empty())
    transition = {surfaceCalled(drives, options.from, "--from"),
                  surfaceCalled(drives, options.to, "--to")};
  writeFolder(options, drives);
  std::fputs(recordings::reportOf(drives).c_str(), stdout);
  std::printf("\n%s: patterns.yaml, recordings (SURFACE.csv) and averaged sets (SURFACE.yaml)\n",
              options.folder.c_str());
  if (!options.log.empty()) writeLog(options, drives, transition);
}

void addLogOptions(CLI::App& command, Outputs& outputs, Options& options) {
  auto* log = outputs.file("--log", options.log,
                           "write an LCM log of executions on one surface, then on another");
  auto* from = command.add_option("--from", options.from, "the known surface");
  auto* to = command.add_option("--to", options.to, "the new surface");
  log->needs(from)->needs(to);
  from->needs(log);
  to->needs(log);
  command
      .add_option("--executions", options.executions.executions,
                  "executions on each of the two surfaces")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->needs(log);
  command
      .add_option("--seed", options.executions.seed,
                  "seed for the choice and order of the recordings")
      ->capture_default_str()
      ->needs(log);
}

}  // namespace

CLI::App* addFromRecordings(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "from-recordings", "build comparable patterns per surface from recorded drives");
  command
      ->add_option("DIR", options->request.folder,
                   "folder with sessions.csv, steps_quality.csv and steps/")
      ->required();
  command->add_option("--robot", options->request.robot, "part of the robot's name");
  command
      ->add_option("--sessions", options->request.sessions,
                   "only these surfaces, separated by commas; default: all comparable ones")
      ->delimiter(',');
  command->add_option("--recipe", options->recipe,
                      "recipe of the patterns (YAML, see config/patterns/recipes/drive.yaml)");
  command->add_flag("--one-surface", options->one_surface, "accept a single surface");
  Outputs outputs(*command);
  outputs.folder("-o,--output", options->folder, "folder of recordings to write")->required();
  addLogOptions(*command, outputs, *options);
  command->callback([options] { fromRecordings(*options); });
  return command;
}

}  // namespace tread::patterns

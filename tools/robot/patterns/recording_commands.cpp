// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// record and average: commands for recordings.
#include "tools/robot/patterns/recording_commands.hpp"

#include <atomic>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/key_option.hpp"
#include "common/bus/shell.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/config/problem_words.hpp"
#include "common/pattern/pattern.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/recordings/average.hpp"
#include "common/seal/key_file.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/pattern_recorder/recorder_node.hpp"
#include "tools/robot/launch/running_robots.hpp"
#include "tools/robot/patterns/commands.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/patterns/set_text.hpp"

namespace tread::patterns {
namespace {

/// A recorder that ends the run when it is done or has failed.
class RunToItsEnd : public Node {
 public:
  RunToItsEnd(pattern_recorder::RecorderNode& recorder, std::atomic<bool>& stop)
      : recorder_(recorder), stop_(stop) {}

  int64_t period() const override { return recorder_.period(); }
  void step(int64_t utime) override {
    recorder_.step(utime);
    const bool runs = recorder_.state() == pattern_recorder::RecorderNode::State::kRunning;
    if (!runs || interrupted_) stop_ = true;
  }
  void shutdown(int64_t utime) override { recorder_.shutdown(utime); }

 private:
  pattern_recorder::RecorderNode& recorder_;
  std::atomic<bool>& stop_;
  const std::atomic<bool>& interrupted_ = stopRequest(0);
};

/// Saves the executions so far; returns where, in words, empty if there are none.
std::string keepPart(const std::string& path, const PatternSet& set,
                     const pattern_recorder::RecorderNode& recorder) {
  size_t executions = 0;
  for (const auto& of_pattern : recorder.recorded()) executions += of_pattern.size();
  if (executions == 0) return "";
  try {
    moveAside(path);
    writeText(path, recordings::formatSurface({"", recorder.recorded()}, set));
  } catch (const std::exception& error) {
    return std::string("; the executions so far are lost: ") + wordsOf(error);
  }
  return "; the " + std::to_string(executions) + " executions so far are in " + path;
}

/// Runs a RecorderNode over LCM until it ends, and prints its progress; returns the executions by
/// pattern.
/** Throws RecordingStopped if it fails or is interrupted (SIGINT, SIGTERM, SIGHUP), after stopping
 * the robot. The executions so far are then saved to `part` if its folder exists. */
std::vector<std::vector<recordings::Execution>> recordLive(
    const PatternSet& set, const pattern_recorder::RecordingConfig& how, BusAccess access,
    const std::string& part) {
  std::atomic<bool> stop{false};
  LcmBus bus(std::move(access), TimeSource::kFollow);
  pattern_recorder::RecorderNode recorder(
      set, how, bus, [](const std::string& line) { std::cout << line << std::endl; });
  RunToItsEnd node(recorder, stop);
  bus.run(node, stop);
  if (recorder.state() == pattern_recorder::RecorderNode::State::kDone) return recorder.recorded();
  const bool failed = recorder.state() == pattern_recorder::RecorderNode::State::kFailed;
  throw RecordingStopped((failed ? recorder.reason() : "interrupted, the robot was stopped") +
                         keepPart(part, set, recorder));
}

struct RecordOptions {
  std::string patterns;
  std::string folder;
  std::string surface;
  std::string model;
  bool live = false;
  bool force = false;
  int executions = 30;
  ModelRecording how;
  pattern_recorder::RecordingConfig live_how;
  std::string lcm_url;
  std::string key;
};

constexpr const char* kFooter =
    "On the robot (--live) this replaces the planner: stop tread-planner and start the other "
    "processes\n"
    "with tread-launch config/launch/recording.yaml (or simulated_recording.yaml). Nothing is\n"
    "driven before tread-arm allows it. It stops if INS, MOTOR or the permission is lost, and "
    "continues\n"
    "once it is armed again. It does not detect obstacles: a circle of --room metres around the "
    "start\n"
    "must be free. It stays inside if the set has patterns that turn, and alternates left\n"
    "and right; outside it stops and asks to be driven back. Executions that are\n"
    "not valid measurements are refused with the reason and repeated. Ctrl-C stops the robot;\n"
    "the executions so far are kept as SURFACE.csv.part next to the surfaces.";

void record(const RecordOptions& options) {
  const PatternSet set = readPatternFile(options.patterns);
  recordings::requireAddable(options.folder, set, options.surface);
  checkOutputs({{options.folder + "/" + options.surface + ".csv"}},
               {options.patterns, options.model}, options.force);
  recordings::SurfaceRecordings surface{options.surface, {}};
  const std::string part = options.folder + "/" + options.surface + ".csv.part";
  if (options.live) {
    pattern_recorder::RecordingConfig how = options.live_how;
    how.executions = options.executions;
    const launch::RunningRobot robot = launch::findRobot(options.lcm_url, options.key);
    surface.executions =
        recordLive(set, how, BusAccess{robot.lcm_url, hostSealer(robot.key)}, part);
  } else {
    ModelRecording how = options.how;
    how.executions = options.executions;
    const ModelDocument model = readModelDocument(options.model);
    warnOutside(model, options.model, set);
    surface = recordModel(set, model, options.surface, how);
  }
  const bool replaced = recordings::addSurface(options.folder, set, surface);
  std::cout << options.folder << "/" << options.surface << ".csv: " << options.executions
            << " executions of each of " << set.patterns().size() << " patterns"
            << (replaced ? ", in the place of what was there" : "") << std::endl;
}

void addModelOptions(CLI::App& command, ModelRecording& how) {
  command.add_option("--seed", how.seed, "with --model: random seed")->capture_default_str();
  command
      .add_option("--ins-position", how.position,
                  "with --model: standard deviation of each measured position [m]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  command.add_option("--ins-yaw", how.yaw, "with --model: the same for yaw [rad]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3.0));
}

void addLiveOptions(CLI::App& command, pattern_recorder::RecordingConfig& how, std::string& lcm_url,
                    std::string& key) {
  command
      .add_option("--room", how.room, "with --live: radius of the free circle around the start [m]")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1000.0));
  command
      .add_option("--give-up-after", how.give_up_after,
                  "with --live: consecutive refusals of one pattern until it ends")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  how.operator_name = operatorName();
  command.add_option("--operator", how.operator_name, "with --live: as with tread-arm")
      ->capture_default_str();
  command.add_option("--lcm-url", lcm_url,
                     "with --live: LCM provider; else LCM_DEFAULT_URL, else the robot that "
                     "tread-launch runs here");
  addKeyOption(command, key);
}

using recordings::AverageLimits;
using recordings::AverageNote;
using recordings::PatternRecordings;
using recordings::SurfaceRecordings;

struct AverageOptions {
  std::string folder;
  std::string surface;
  std::string output;
  std::string name;
  AverageLimits limits;
};

const SurfaceRecordings& surfaceNamed(const PatternRecordings& recorded,
                                      const AverageOptions& options) {
  std::string names;
  for (const SurfaceRecordings& surface : recorded.surfaces) {
    if (surface.surface == options.surface) return surface;
    names += (names.empty() ? "" : ", ") + surface.surface;
  }
  throw recordings::RecordingError(options.folder + ": no surface '" + options.surface +
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

void average(const AverageOptions& options) {
  const PatternRecordings recorded = recordings::readRecordings(options.folder);
  const SurfaceRecordings& surface = surfaceNamed(recorded, options);
  std::vector<AverageNote> notes;
  const PatternSet averaged =
      recordings::averageSet(recorded.patterns, surface, options.limits, notes);
  const std::string name = options.name.empty()
                               ? recorded.patterns.content().name + "_" + options.surface
                               : options.name;
  const PatternSet set = named(averaged, name);
  writeText(options.output, formatPatterns(set));
  for (const AverageNote& note : notes) std::cout << noteLine(note);
  std::cout << table(set);
}

}  // namespace

CLI::App* addRecord(CLI::App& app) {
  const auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand(
      "record",
      "execute each pattern many times and store the measured motions under a surface's name");
  command->footer(kFooter);
  command->add_option("PATTERNS", options->patterns, "pattern file (YAML)")->required();
  command->add_option("--recordings", options->folder, "folder of recordings; created if needed")
      ->required();
  command->add_option("--surface", options->surface, "name of the surface")->required();
  command->add_flag("--force", options->force, "replace the surface if it is recorded already");
  CLI::Option_group* source = command->add_option_group("source", "executed by one of");
  source->add_option("--model", options->model, "a vehicle model (YAML)");
  source->add_flag("--live", options->live, "the robot, or the simulated one, over LCM");
  source->require_option(1);
  command->add_option("-n,--executions", options->executions, "executions of each pattern")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  addModelOptions(*command, options->how);
  addLiveOptions(*command, options->live_how, options->lcm_url, options->key);
  command->callback([options] { record(*options); });
  return command;
}

CLI::App* addAverage(CLI::App& app) {
  const auto options = std::make_shared<AverageOptions>();
  CLI::App* command = app.add_subcommand(
      "average", "average the recordings of one surface into the pattern set for it");
  command->add_option("RECORDINGS", options->folder, "folder of recordings")->required();
  command->add_option("SURFACE", options->surface, "surface, a SURFACE.csv of the folder")
      ->required();
  Outputs(*command).file("-o,--output", options->output, "pattern file to write")->required();
  command->add_option("--name", options->name, "name of the set (default: SET_SURFACE)");
  AverageLimits& limits = options->limits;
  command
      ->add_option("--strong-turn", limits.strong_turn,
                   "turn above which twists are averaged instead of poses [rad]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command
      ->add_option("--max-speed", limits.max_speed,
                   "largest plausible speed [m/s]; 0 = 1.5 times that of the median execution")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 30.0));
  command
      ->add_option("--min-executions", limits.min_executions,
                   "least number of valid executions of a pattern")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->callback([options] { average(*options); });
  return command;
}

}  // namespace tread::patterns

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/question_commands.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/effect_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/lab/gap/compare.hpp"
#include "tools/lab/gap/manoeuvres.hpp"
#include "tools/lab/gap/plan_design.hpp"
#include "tools/lab/gap/repeat.hpp"
#include "tools/lab/gap/report/find_output.hpp"
#include "tools/lab/gap/report/report.hpp"
#include "tools/lab/gap/report/words.hpp"
#include "tools/robot/patterns/recipe.hpp"

namespace tread::gap {
namespace {

struct PlanOptions {
  std::string truth;
  std::string rival;
  std::string model;
  std::string patterns;
  std::string out;
  std::vector<std::string> set;
  double speed = 0.0;  // [m/s], 0 = from the model's envelope
};

constexpr const char* kPlanFooter =
    "Each effect has its size in the model, else its typical one (or that of --set). The "
    "the\n"
    "other one is refitted to imitate it, together with the model's uncertain numbers. The\n"
    "drive separates the two whichever is present, so their order does not matter. It stays\n"
    "within the model's envelope, if its file has one. Written to --out\n"
    "is a pattern set for tread-patterns record. If no drive separates the two, the\n"
    "measurement that does is printed, and the exit status is 1.";

/// The catalogue's text on two confounded effects; empty if they share no group.
std::string fromTable(const std::string& a, const std::string& b) {
  std::string text;
  for (const ConfoundedGroup* group : confoundedGroupsOf(a)) {
    if (!contains(group->members, b)) continue;
    const std::string when = group->when.empty() ? "" : " (" + group->when + ")";
    text += "  " + asSentence(group->because) + when + ".\n  " + group->separates + "\n";
  }
  return text;
}

/// Measurements that separate the two, from that table, else from the catalogue.
std::string otherWays(const std::string& a, const std::string& b) {
  std::string text = fromTable(a, b);
  if (!text.empty()) return text;
  for (const std::string& name : {a, b})
    text += "  " + titleOf(name) + ": " + effectNamed(name).separates + "\n";
  return text;
}

std::string sizeOf(const ModelDocument& model, const std::string& name) {
  std::vector<std::string> sizes;
  for (const EffectParameter& parameter : effectNamed(name).parameters) {
    const std::string path = name + "." + parameter.name;
    const double value = *findParameter(model, path);
    if (parameter.role == ParameterRole::kShape || value == 0.0) continue;
    const bool natural = parameter.reciprocal();
    sizes.push_back(
        (natural ? parameter.natural_name : parameter.name) + " " +
        said(naturalValue(parameter, value), natural ? naturalUnit(parameter) : parameter.unit));
  }
  return sizes.empty() ? "off" : joined(sizes);
}

/// Free space that the patterns of a set need, with a margin [m].
double roomFor(const PatternSet& set) {
  double farthest = 0.0;
  for (const MotionPattern& pattern : set.patterns())
    farthest = std::max(farthest, pattern.end().position().norm());
  return std::max(8.0, std::ceil(2.0 * farthest));
}

std::string sequenceText(const DesignTask& task, const Design& design) {
  std::string text;
  for (size_t i = 0; i < task.manoeuvres.size(); ++i) {
    if (design.counts[i] == 0) continue;
    text += formatted("  %zu x %-24s %.1f s\n", design.counts[i], task.manoeuvres[i].name.c_str(),
                      kManoeuvrePeriod * static_cast<double>(task.manoeuvres[i].commands.size()));
  }
  return text;
}

std::string sizedName(const ModelDocument& model, const std::string& effect) {
  return inSentence(titleOf(effect)) + " (" + sizeOf(model, effect) + ")";
}

std::string sideText(const DesignSide& side) {
  return "  " + threeDigits(side.difference) + " if it is " +
         sizedName(side.true_model, side.truth) + ",\n    although " +
         inSentence(titleOf(side.rival)) + " is refitted to imitate it (" +
         sizeOf(side.rival_model, side.rival) + ")\n";
}

void tellFound(const PlanOptions& options, const DesignTask& task, const Design& design,
               const PatternSet& set) {
  const DesignSide& side = design.sides.front();
  std::cout << "To tell " << inSentence(titleOf(side.truth)) << " from "
            << inSentence(titleOf(side.rival)) << ":\n\n"
            << sequenceText(task, design) << "\n"
            << threeDigits(design.duration)
            << " s of driving; expected difference of the log likelihoods ("
            << threeDigits(task.enough) << " is enough):\n"
            << sideText(design.sides[0]) << sideText(design.sides[1]);
  const std::string known = fromTable(side.truth, side.rival);
  if (!known.empty()) std::cout << "\nThey look similar; another way to decide:\n" << known;
  if (options.out.empty()) return;
  writeText(options.out, formatPatterns(set));
  std::cout
      << "\n"
      << options.out << ": a pattern set. Record a log (tread-logger) while\n"
      << "  tread-patterns record " << options.out
      << " --recordings plan_recordings --surface here --live -n 1 --room "
      << threeDigits(roomFor(set))
      << "\ndrives it, and give that log to tread-gap find with the old one (--train OLD NEW).\n";
}

void tellNone(const Design& design) {
  constexpr double kInvisible = 0.5;  // [nats]
  const DesignSide& side = design.harder();
  if (side.visible < kInvisible)
    std::cout << titleOf(side.truth) << " (" << sizeOf(side.true_model, side.truth)
              << ") is not visible in any of these manoeuvres on level ground. What shows it:\n";
  else
    std::cout << "No drive of these manoeuvres within 120 s distinguishes "
              << sizedName(side.true_model, side.truth) << " from "
              << sizedName(side.rival_model, side.rival) << ": expected difference "
              << threeDigits(side.difference) << " after " << threeDigits(design.duration)
              << " s. What tells:\n";
  std::cout << otherWays(design.sides.front().truth, design.sides.front().rival);
}

/// The built-in manoeuvres: as requested, else within the model's envelope.
std::vector<Manoeuvre> builtInManoeuvres(const PlanOptions& options, const ModelDocument& model) {
  if (options.speed > 0.0) return planManoeuvres(model, options.speed);
  std::vector<Manoeuvre> all = planManoeuvres(model, fullCommand(model));
  if (model.envelope) keepWithin(*model.envelope, model.vehicle, all);
  return all;
}

/// Warns of requested patterns and speeds beyond the model's envelope, and of a model without one.
void warnBeyond(const PlanOptions& options, const ModelDocument& model, const PatternSet& set) {
  patterns::warnOutside(model, options.model, set);
  if (model.envelope) return;
  const Envelope asked = patterns::envelopeOf(model.vehicle, set);
  std::cerr << options.model << ": warning: it has no envelope; the plan commands up to "
            << threeDigits(asked.v) << " m/s and " << threeDigits(asked.omega)
            << " rad/s, whatever the model was made from\n";
}

int plan(const PlanOptions& options) {
  effectOrGuess(options.truth);
  effectOrGuess(options.rival);
  if (options.truth == options.rival)
    throw std::runtime_error("plan: twice " + options.truth + "; name two effects");
  DesignTask task;
  task.model = options.patterns.empty() ? readTwoTracks(options.model, "plan")
                                        : readTrackModelDocument(options.model);
  for (const std::string& effect : {options.truth, options.rival})
    requireOf("plan", effect, task.model.vehicle.layout());
  task.first = options.truth;
  task.second = options.rival;
  if (options.speed > 0.0 && task.model.vehicle.kind == CommandKind::kPower)
    throw std::runtime_error(
        "--speed is for models with track-speed commands; this one has power commands");
  if (!options.set.empty()) {
    ModelChange change{{}, {}, options.set};
    if (!isOn(effectNamed(options.truth), task.model)) change.add = {options.truth};
    task.model = changed(task.model, change);
  }
  std::optional<PatternSet> from;
  if (!options.patterns.empty()) from = readPatternFile(options.patterns);
  task.manoeuvres = from ? manoeuvresOf(*from, task.model) : builtInManoeuvres(options, task.model);
  const Design design = designDrive(task);
  if (!design.separates) {
    tellNone(design);
    return 1;
  }
  const PatternSet set =
      from ? planSet(*from, design.counts) : planSet(task.model, task.manoeuvres, design.counts);
  warnBeyond(options, task.model, set);
  tellFound(options, task, design, set);
  return 0;
}

struct WhatIfOptions {
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

Circumstances circumstancesOf(const WhatIfOptions& options) {
  Circumstances circumstances;
  circumstances.session_time = 60.0 * options.minutes;
  circumstances.battery_drop = 0.01 * options.battery_drop;
  circumstances.roll = options.roll * kPi / 180.0;
  circumstances.pitch = options.pitch * kPi / 180.0;
  circumstances.worked = options.worked;
  return circumstances;
}

/// For instance "What if without A, with B and limit=1.2".
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

void whatIf(const WhatIfOptions& options) {
  if (options.change.remove.empty() && options.change.add.empty() && options.change.set.empty())
    throw std::runtime_error("what-if: nothing to change; give --remove, --add or --set");
  const bool svg = endsWith(options.out, ".svg");
  if (!options.out.empty() && !svg && !endsWith(options.out, ".html"))
    throw std::runtime_error(options.out + ": unknown kind of file; end it with .html or .svg");
  // The manoeuvres are for two tracks; a log may be of any vehicle.
  const ModelDocument model = options.log.empty()
                                  ? readTwoTracks(options.model, "what-if without --log")
                                  : readModelDocument(options.model);
  const ModelDocument other = changed(model, options.change);
  const bool tracks = model.vehicle.layout() == VehicleLayout::kTracks;
  const std::vector<ManoeuvreComparison> comparisons =
      tracks ? compareModels(model, other, circumstancesOf(options))
             : std::vector<ManoeuvreComparison>{};
  std::vector<LogComparison> on_log;
  std::string lost;
  if (!options.log.empty()) {
    const Drive drive = readSoundDriveFor(model, options.log);
    lost = drive.lost;
    on_log.push_back(compareOnLog(drive, model, other));
  }
  const std::string question = questionOf(options.change);
  const std::string setting = settingOf(model, other, options.model, options.log);
  std::cout << question << "\n" << setting << "\n\n";
  if (tracks) std::cout << textOf(comparisons);
  for (const LogComparison& comparison : on_log) std::cout << '\n' << textOf(comparison);
  if (!lost.empty()) std::cout << lost << '\n';
  if (!options.out.empty())
    writeText(options.out, svg ? svgOf(comparisons, on_log)
                               : htmlOf(pageOf(question, setting, comparisons, on_log)));
  std::cout << std::flush;
}

void addCircumstances(CLI::App& command, WhatIfOptions& options) {
  command.add_option("--minutes", options.minutes, "time since the start of the session [min]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10000.0));
  command.add_option("--pitch", options.pitch, "slope of the ground [deg], nose down positive")
      ->check(CLI::Range(-45.0, 45.0));
  command.add_option("--roll", options.roll, "slope of the ground [deg], left side up positive")
      ->check(CLI::Range(-45.0, 45.0));
  command
      .add_option("--battery-drop", options.battery_drop, "fall of the voltage since the start [%]")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--worked", options.worked, "mean square of the duty so far, 0..1")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
}

}  // namespace

void addEffectsOption(CLI::App& command) {
  command
      .add_option_function<std::string>("--effects", addEffectsOf,
                                        "folder of further effects (*.yaml); "
                                        "config/effects has examples")
      ->trigger_on_parse();
}

void addPlan(CLI::App& app, int& status) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand(
      "plan", "find the shortest drive that distinguishes effect A from effect B");
  command->footer(kPlanFooter);
  command->add_option("A", options->truth, "first effect")->required();
  command->add_option("B", options->rival, "second effect")->required();
  command->add_option("--model", options->model, "model file (YAML)")->required();
  command->add_option("--patterns", options->patterns,
                      "choose among the patterns of this set instead of the built-in manoeuvres");
  command->add_option("--set", options->set, "parameter=number: another size of A");
  command
      ->add_option("--speed", options->speed,
                   "largest commanded track speed [m/s]; not for models with power commands")
      ->check(CLI::Range(0.01, 20.0));
  addEffectsOption(*command);
  Outputs(*command).file("--out", options->out, "pattern set to write (YAML)");
  command->callback([options, &status] { status = plan(*options); });
}

void addWhatIf(CLI::App& app) {
  const auto options = std::make_shared<WhatIfOptions>();
  CLI::App* command = app.add_subcommand(
      "what-if",
      "simulate a model with an effect removed, added or resized, and show the difference");
  command->add_option("--model", options->model, "model file (YAML)")->required();
  command->add_option("--remove", options->change.remove, "turn this effect or unnamed term off");
  command->add_option("--add", options->change.add,
                      "turn this effect on, at its typical size (another one by --set)");
  command->add_option(
      "--set", options->change.set,
      "parameter=number: of the effect added, or effect.parameter, or lag, delay..");
  command->add_option("--log", options->log, "also simulate the executions of this log");
  Outputs(*command).file("--out", options->out, "pictures: FILE.html or FILE.svg");
  addCircumstances(*command, *options);
  addEffectsOption(*command);
  command->callback([options] { whatIf(*options); });
}

ModelDocument readTwoTracks(const std::string& path, const std::string& command) {
  ModelDocument model = readModelDocument(path);
  const VehicleLayout layout = model.vehicle.layout();
  if (layout == VehicleLayout::kTracks) return model;
  throw std::runtime_error(path + ": is a model of " + nameOf(layout) + "; tread-gap " + command +
                           " drives two tracks only");
}

}  // namespace tread::gap

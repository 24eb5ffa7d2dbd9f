// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <stdexcept>

#include "common/vehicle/kernel.hpp"

namespace tread::gap {
namespace {

/// Lead before a manoeuvre, and motion behind it: late or early readings need what was there.
constexpr double kLead = 3.0;  // [s]
constexpr double kTail = 1.0;  // [s]

std::vector<TrackCommand> held(const TrackCommand& command, double seconds) {
  return {static_cast<size_t>(std::lround(seconds / kManoeuvrePeriod)), command};
}

std::vector<TrackCommand> followed(std::vector<TrackCommand> first,
                                   const std::vector<TrackCommand>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

EntryState entryOf(const ModelDocument& model, const Manoeuvre& manoeuvre,
                   const Circumstances& circumstances) {
  DriveContext context;
  context.session_time = std::max(0.0, circumstances.session_time - kLead);
  context.battery_drop = circumstances.battery_drop;
  context.roll = circumstances.roll;
  context.pitch = circumstances.pitch;
  EntryState entry = steadyEntry(model.vehicle, manoeuvre.before, context);
  const double share =
      1.0 - std::exp(-circumstances.session_time / model.vehicle.effects.thermal_time);
  entry.heat = {share * circumstances.worked, share * circumstances.worked};
  return entry;
}

void drive(VehicleKernel& kernel, const TrackCommand& command, double& time,
           std::vector<MotionSample>& motion) {
  kernel.step(command, kManoeuvrePeriod);
  time += kManoeuvrePeriod;
  motion.push_back({time, kernel.pose(), kernel.twist().omega});
}

const char* const kRest = "rest";

std::string copyName(const std::string& name, size_t copy) {
  return copy == 0 ? name : name + "_" + std::to_string(copy + 1);
}

PatternSet checked(PatternSetContent content) {
  for (size_t i = 0; i < content.patterns.size(); ++i)
    content.patterns[i].id = static_cast<int>(i) + 1;
  std::string why;
  std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw std::runtime_error("plan: no pattern set: " + why);
  return *set;
}

bool stands(const MotionClass& motion) {
  return motion.steady == Command{};
}

/// Shortest pattern chains between classes: from[class] = first pattern of the chain.
std::map<std::string, const MotionPattern*> waysFrom(const PatternSet& set,
                                                     const std::string& start) {
  std::map<std::string, const MotionPattern*> into{{start, nullptr}};
  std::queue<std::string> open;
  open.push(start);
  while (!open.empty()) {
    for (const MotionPattern* pattern : set.startingIn(open.front()))
      if (into.emplace(pattern->exit_class, pattern).second) open.push(pattern->exit_class);
    open.pop();
  }
  return into;
}

/// Adds the patterns that lead from one class to another.
void addWay(const PatternSet& set, const std::string& from, const std::string& to,
            std::set<std::string>& needed) {
  const auto into = waysFrom(set, from);
  if (into.count(to) == 0)
    throw std::runtime_error("plan: no pattern of the set leads from " + from + " to " + to);
  std::string at = to;
  while (at != from) {
    const auto found = into.find(at);
    needed.insert(found->second->name);
    at = found->second->entry_class;
  }
}

bool isWithin(const Envelope& envelope, const VehicleModel& vehicle, const Manoeuvre& manoeuvre) {
  const EntryState entry = steadyEntry(vehicle, manoeuvre.before);
  const Envelope asked = envelopeOf(vehicle, manoeuvre.commands, kManoeuvrePeriod, entry);
  constexpr double kRounding = 0.99;
  const Envelope known{kRounding * envelope.v, kRounding * envelope.omega,
                       kRounding * envelope.v_omega};
  return warningsOutside(known, asked).empty();
}

Manoeuvre scaled(Manoeuvre manoeuvre, double factor) {
  for (TrackCommand& command : manoeuvre.commands)
    command = {factor * command.left, factor * command.right};
  return manoeuvre;
}

}  // namespace

double fullCommand(const ModelDocument& model) {
  if (model.vehicle.kind == CommandKind::kPower) return 1.0;
  constexpr double kBeyond = 1.25;
  return model.envelope && model.envelope->v > 0.0 ? kBeyond * model.envelope->v : 1.0;
}

std::vector<Manoeuvre> standardManoeuvres(double full) {
  const TrackCommand rest{0.0, 0.0};
  const TrackCommand ahead{full, full};
  const TrackCommand half{0.5 * full, 0.5 * full};
  const TrackCommand back{-0.5 * full, -0.5 * full};
  const auto turn = [&](double left, double right) {
    return TrackCommand{left * full, right * full};
  };
  return {
      {"start to full speed", rest, held(ahead, 2.0)},
      {"straight, full speed", ahead, held(ahead, 2.0)},
      {"straight, half speed", half, held(half, 2.0)},
      {"straight back, half speed", back, held(back, 2.0)},
      {"stop from full speed", ahead, held(rest, 2.0)},
      {"gentle left at full speed", ahead, held(turn(0.8, 1.0), 2.0)},
      {"tight left at full speed", ahead, held(turn(0.3, 1.0), 2.0)},
      {"tight right at full speed", ahead, held(turn(1.0, 0.3), 2.0)},
      {"left at half speed", half, held(turn(0.2, 0.5), 2.0)},
      {"left backwards", back, held(turn(-0.5, -0.2), 2.0)},
      {"slow turn on the spot", rest, held(turn(-0.2, 0.2), 2.0)},
      {"fast turn on the spot", rest, held(turn(-0.7, 0.7), 2.0)},
      {"left, then right", ahead, followed(held(turn(0.5, 1.0), 1.0), held(turn(1.0, 0.5), 1.0))},
      {"forwards, then back", half, followed(held(half, 0.5), held(back, 1.5))},
      {"standing", rest, held(rest, 2.0)},
  };
}

std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances,
                                        const ExecutionNoise& noise) {
  VehicleKernel kernel(model.vehicle, entryOf(model, manoeuvre, circumstances));
  double time = std::max(0.0, circumstances.session_time - kLead);
  std::vector<MotionSample> motion{{time, kernel.pose(), kernel.twist().omega}};
  const auto lead = static_cast<size_t>(std::lround(kLead / kManoeuvrePeriod));
  for (size_t i = 0; i < lead; ++i) drive(kernel, manoeuvre.before, time, motion);
  kernel.setNoise(noise);
  for (const TrackCommand& command : manoeuvre.commands) drive(kernel, command, time, motion);
  const auto tail = static_cast<size_t>(std::lround(kTail / kManoeuvrePeriod));
  for (size_t i = 0; i < tail; ++i) drive(kernel, manoeuvre.commands.back(), time, motion);
  const std::vector<MotionSample> said = measure(motion, model.measurement);
  std::vector<MotionSample> driven;
  for (size_t i = lead; i <= lead + manoeuvre.commands.size(); ++i)
    driven.push_back({static_cast<double>(i - lead) * kManoeuvrePeriod,
                      between(said[lead].T_map_body, said[i].T_map_body), said[i].omega});
  return driven;
}

std::vector<Manoeuvre> planManoeuvres(const ModelDocument& model, double full) {
  // Other models may settle later than this one: half a second of margin.
  const double settled = 3.0 * model.vehicle.settlingLag() + model.vehicle.commandDelay() + 0.5;
  const auto stop = static_cast<size_t>(std::ceil(settled / kManoeuvrePeriod));
  std::vector<Manoeuvre> all;
  const auto add = [&](const char* name, const std::vector<TrackCommand>& parts) {
    const size_t each = 40 / parts.size();
    Manoeuvre manoeuvre{name, {}, {}};
    for (const TrackCommand& part : parts)
      manoeuvre.commands.insert(manoeuvre.commands.end(), each,
                                {full * part.left, full * part.right});
    manoeuvre.commands.insert(manoeuvre.commands.end(), stop, {0.0, 0.0});
    all.push_back(std::move(manoeuvre));
  };
  add("straight_full", {{1.0, 1.0}});
  add("straight_half", {{0.5, 0.5}});
  add("straight_slow", {{0.2, 0.2}});
  add("back_full", {{-1.0, -1.0}});
  add("back_half", {{-0.5, -0.5}});
  add("gentle_left_full", {{0.8, 1.0}});
  add("gentle_right_full", {{1.0, 0.8}});
  add("tight_left_full", {{0.3, 1.0}});
  add("tight_right_full", {{1.0, 0.3}});
  add("tight_left_half", {{0.1, 0.5}});
  add("gentle_left_half", {{0.4, 0.5}});
  add("left_back", {{-1.0, -0.5}});
  add("right_back", {{-0.5, -1.0}});
  add("spin_left_slow", {{-0.15, 0.15}});
  add("spin_left_half", {{-0.5, 0.5}});
  add("spin_left_full", {{-1.0, 1.0}});
  add("spin_right_half", {{0.5, -0.5}});
  add("one_track_left", {{0.0, 0.6}});
  add("left_then_right", {{0.4, 1.0}, {1.0, 0.4}});
  add("forwards_and_back", {{0.6, 0.6}, {-0.6, -0.6}});
  add("three_speeds", {{0.25, 0.25}, {1.0, 1.0}, {0.5, 0.5}, {0.1, 0.1}});
  add("turn_at_speed", {{0.6, 0.6}, {0.3, 0.9}, {0.9, 0.3}, {0.6, 0.6}});
  add("stand", {{0.0, 0.0}});
  return all;
}

void keepWithin(const Envelope& envelope, const VehicleModel& vehicle,
                std::vector<Manoeuvre>& manoeuvres) {
  for (Manoeuvre& manoeuvre : manoeuvres) {
    if (isWithin(envelope, vehicle, manoeuvre)) continue;
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (low + high);
      (isWithin(envelope, vehicle, scaled(manoeuvre, middle)) ? low : high) = middle;
    }
    manoeuvre = scaled(manoeuvre, low);
  }
}

std::vector<Manoeuvre> manoeuvresOf(const PatternSet& set, const ModelDocument& model) {
  if (set.content().channels != model.vehicle.channels())
    throw std::runtime_error(
        "plan: the patterns command another kind than the model; give "
        "patterns and model of one vehicle");
  if (std::abs(set.periodSeconds() - kManoeuvrePeriod) > 1e-9)
    throw std::runtime_error("plan: the patterns' period is not 0.05 s; give such a set");
  std::vector<Manoeuvre> all;
  for (const MotionPattern& pattern : set.patterns())
    all.push_back({pattern.name, set.classNamed(pattern.entry_class).steady.tracks(),
                   tracksOf(pattern.commands)});
  return all;
}

PatternSet planSet(const ModelDocument& model, const std::vector<Manoeuvre>& manoeuvres,
                   const std::vector<size_t>& counts) {
  PatternSetContent content;
  content.name = "plan";
  content.channels = model.vehicle.channels();
  content.classes = {classOf(model.vehicle, kRest, {})};
  for (size_t i = 0; i < manoeuvres.size(); ++i)
    for (size_t copy = 0; copy < counts[i]; ++copy) {
      MotionPattern pattern;
      pattern.name = copyName(manoeuvres[i].name, copy);
      pattern.entry_class = pattern.exit_class = kRest;
      pattern.commands = commandsOf(manoeuvres[i].commands);
      predict(model.vehicle, kManoeuvrePeriod, content.classes.front(), pattern);
      content.patterns.push_back(std::move(pattern));
    }
  return checked(std::move(content));
}

PatternSet planSet(const PatternSet& from, const std::vector<size_t>& counts) {
  PatternSetContent content = from.content();
  const auto rest = std::find_if(content.classes.begin(), content.classes.end(), stands);
  if (rest == content.classes.end())
    throw std::runtime_error("plan: no class of the set stands still");
  std::set<std::string> needed;
  std::vector<MotionPattern> patterns;
  for (size_t i = 0; i < content.patterns.size(); ++i)
    for (size_t copy = 0; copy < counts[i]; ++copy) {
      patterns.push_back(content.patterns[i]);
      patterns.back().name = copyName(content.patterns[i].name, copy);
      addWay(from, rest->name, content.patterns[i].entry_class, needed);
      addWay(from, content.patterns[i].exit_class, rest->name, needed);
    }
  for (size_t i = 0; i < content.patterns.size(); ++i)
    if (counts[i] == 0 && needed.count(content.patterns[i].name) > 0)
      patterns.push_back(content.patterns[i]);
  std::set<std::string> used{rest->name};
  for (const MotionPattern& pattern : patterns) {
    used.insert(pattern.entry_class);
    used.insert(pattern.exit_class);
  }
  const auto unused = [&](const MotionClass& motion) { return used.count(motion.name) == 0; };
  content.classes.erase(std::remove_if(content.classes.begin(), content.classes.end(), unused),
                        content.classes.end());
  content.patterns = std::move(patterns);
  content.name = "plan";
  content.version = 1;
  content.parent_version = 0;
  return checked(std::move(content));
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/ground.hpp"

#include "common/recordings/average.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/lab/experiment/trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "common/config/config_reader.hpp"
#include "common/vehicle/kernel.hpp"

namespace tread::experiment {

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory) {
  const Eigen::Index last = trajectory.rows() - 1;
  ExecutionEnd end;
  end.pose = {trajectory(last, 0), trajectory(last, 1), trajectory(last, 2)};
  end.radians = std::abs(end.pose.yaw);
  end.metres = std::hypot(trajectory(0, 0), trajectory(0, 1));
  for (Eigen::Index i = 1; i <= last; ++i)
    end.metres += std::hypot(trajectory(i, 0) - trajectory(i - 1, 0),
                             trajectory(i, 1) - trajectory(i - 1, 1));
  return end;
}

Executions::Executions(const std::vector<recordings::Execution>& executions, size_t samples)
    : samples_(samples) {
  numbers_.reserve(executions.size() * samples * 3);
  for (const recordings::Execution& execution : executions) {
    for (const Pose2& pose : execution) numbers_.push_back(pose.x);
    for (const Pose2& pose : execution) numbers_.push_back(pose.y);
    for (const Pose2& pose : execution) numbers_.push_back(pose.yaw);
  }
  for (size_t i = 0; i < executions.size(); ++i) ends_.push_back(executionEnd(of(i)));
}

namespace {

using recordings::AverageLimits;
using recordings::AverageNote;
using recordings::Execution;

constexpr int kFewest = 8;  // least valid executions of a pattern
constexpr size_t kFew = 40;

TrialGround groundOf(const recordings::PatternRecordings& recorded,
                     const recordings::SurfaceRecordings& surface,
                     std::vector<std::string>& notes) {
  AverageLimits limits;
  limits.min_executions = kFewest;
  std::vector<AverageNote> fairness, of_half;
  recordings::averageSet(recorded.patterns, surface, limits, fairness);
  recordings::SurfaceRecordings known{surface.surface, {}};
  std::vector<std::vector<Execution>> tests;
  size_t fewest = kFew;
  for (size_t p = 0; p < surface.executions.size(); ++p) {
    const AverageNote& note = fairness[p];
    for (const std::string& line : note.rejected)
      notes.push_back(surface.surface + ", " + note.pattern + ": " + line);
    std::vector<Execution> halves[2];
    size_t fair = 0;
    for (size_t i = 0; i < surface.executions[p].size(); ++i)
      if (!std::binary_search(note.left_out.begin(), note.left_out.end(), i))
        halves[fair++ / 2 % 2].push_back(surface.executions[p][i]);
    fewest = std::min(fewest, fair);
    known.executions.push_back(std::move(halves[0]));
    tests.push_back(std::move(halves[1]));
  }
  if (fewest < kFew)
    notes.push_back(
        surface.surface + ": few recordings, " + std::to_string(fewest) +
        " of a pattern, half of them for tests; other recordings may give other numbers, which "
        "the intervals do not cover");
  limits.max_speed = std::numeric_limits<double>::max();  // accept all
  limits.min_executions = 1;
  TrialGround ground{surface.surface,
                     recordings::averageSet(recorded.patterns, known, limits, of_half),
                     {},
                     {},
                     {}};
  for (size_t p = 0; p < tests.size(); ++p) {
    const MotionPattern& pattern = ground.averaged.patterns()[p];
    ground.averaged_ends.push_back(pattern.end());
    ground.known.emplace_back(known.executions[p], pattern.commands.size());
    ground.tests.emplace_back(tests[p], pattern.commands.size());
  }
  return ground;
}

}  // namespace

std::vector<TrialGround> groundsOf(const recordings::PatternRecordings& recorded,
                                   std::vector<std::string>& notes) {
  if (recorded.surfaces.size() < 2)
    throw recordings::RecordingError(
        "a transition needs recordings of at least two surfaces; there " +
        (recorded.surfaces.empty() ? std::string("is none")
                                   : "is one: '" + recorded.surfaces.front().surface + "'"));
  std::vector<TrialGround> grounds;
  for (const recordings::SurfaceRecordings& surface : recorded.surfaces)
    grounds.push_back(groundOf(recorded, surface, notes));
  return grounds;
}

std::vector<Sequence> sequencesFor(const PatternSet& set) {
  const std::vector<MotionPattern>& patterns = set.patterns();
  std::vector<size_t> candidates, all;
  double reach = 0.0;
  for (size_t p = 0; p < patterns.size(); ++p) {
    all.push_back(p);
    if (learner::roleOf(patterns[p], {}).gives_scaling) candidates.push_back(p);
    reach += patterns[p].end().position().norm() / static_cast<double>(patterns.size());
  }
  if (candidates.size() < 2) candidates = all;
  Sequence best;
  double farthest = -1.0;
  for (const size_t a : candidates)
    for (const size_t b : candidates) {
      const Pose2 end_a = patterns[a].end(), end_b = patterns[b].end();
      const double apart =
          std::hypot((end_a.position() - end_b.position()).norm(), reach * (end_a.yaw - end_b.yaw));
      if (a >= b || apart <= farthest) continue;
      farthest = apart;
      best = {a, b};
    }
  if (best.empty()) return {};
  return {{best[0], best[0], best[1]}, {best[1], best[1], best[0]}};
}

namespace {

constexpr Range kGain{0.05, 5.0};
constexpr Range kSpread{0.0, 1.0};
constexpr int kMaxSamples = 1000;

void readVehicle(ConfigReader reader, VehicleModel& model) {
  reader.number("full_speed", model.full_speed, {0.01, 20.0}, "m/s", true);
  reader.number("gauge", model.gauge, {0.05, 10.0}, "m", true);
  reader.number("lag", model.lag, {0.0, 5.0}, "s");
  reader.number("delay", model.delay, {0.0, 2.0}, "s");
}

WorldSurface readSurface(ConfigReader& reader, const VehicleModel& vehicle) {
  WorldSurface surface{"", vehicle};
  reader.text("name", surface.name, true);
  surface.model.name = surface.name;
  reader.number("forward_gain", surface.model.forward_gain, kGain, "");
  reader.number("yaw_gain", surface.model.yaw_gain, kGain, "");
  ConfigReader effects = reader.section("effects");
  readEffects(effects, surface.model.effects);
  ConfigReader spread = reader.section("spread");
  spread.number("forward", surface.model.spread.forward, kSpread, "");
  spread.number("yaw", surface.model.spread.yaw, kSpread, "");
  spread.number("crab", surface.model.spread.crab, kSpread, "rad");
  return surface;
}

WorldPattern readPattern(ConfigReader& reader) {
  WorldPattern pattern;
  reader.text("name", pattern.name, true);
  std::vector<std::vector<double>> rows;
  reader.table("commands", rows, 3, {-1.0, kMaxSamples}, "", true);
  for (const std::vector<double>& row : rows) {
    if (std::abs(row[0]) > 1.0 || std::abs(row[1]) > 1.0)
      throw reader.error("commands", "power out of range -1..1");
    if (row[2] < 1.0 || row[2] != std::floor(row[2]))
      throw reader.error("commands", "samples are counted; allowed are 1, 2, 3, ...");
    pattern.commands.insert(pattern.commands.end(), static_cast<size_t>(row[2]), {row[0], row[1]});
  }
  if (pattern.commands.empty() || pattern.commands.size() > kMaxSamples)
    throw reader.error("commands", "a pattern has 1 to 1000 samples");
  return pattern;
}

/// Names appear in tables, CSV and file names.
void checkName(const ConfigReader& reader, std::set<std::string>& known, const std::string& name) {
  const auto plain = [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9') || letter == '_' || letter == '-';
  };
  if (name.empty() || name.size() > 64 || !std::all_of(name.begin(), name.end(), plain))
    throw reader.error(
        "name", "'" + name + "' is not a valid name; allowed are 1 to 64 letters, digits, - and _");
  if (!known.insert(name).second) throw reader.error("name", "'" + name + "' is given twice");
}

std::vector<std::string> readSequence(ConfigReader& reader, const std::set<std::string>& patterns) {
  std::vector<std::string> names;
  reader.texts("patterns", names, true);
  if (names.empty()) throw reader.error("patterns", "a sequence needs at least one pattern");
  for (const std::string& name : names)
    if (patterns.count(name) == 0)
      throw reader.error("patterns", "unknown pattern '" + name + "'; see patterns:");
  return names;
}

void readSettings(ConfigReader& reader, TransitionWorld& world) {
  reader.text("name", world.name, true);
  std::string reference = "none";
  reader.choice("reference", reference, {"none", "paper"});
  world.paper_reference = reference == "paper";
  std::vector<double> entry{world.entry.left, world.entry.right};
  reader.numbers("entry", entry, 2, {-1.0, 1.0}, "");
  world.entry = {entry[0], entry[1]};
  reader.number("period", world.period, {0.005, 1.0}, "s");
  reader.integer("recordings", world.recordings, {3, 100000}, "");
  ConfigReader noise = reader.section("noise");
  noise.number("position", world.position_noise, {0.0, 1.0}, "m");
  noise.number("yaw", world.yaw_noise, {0.0, 1.0}, "rad");
}

void requireKind(ConfigReader& reader, const std::string& name) {
  std::string kind;
  if (reader.has("kind")) reader.choice("kind", kind, {"transitions"});
  if (kind.empty())
    throw ConfigError(
        name +
        ":1: not a world of transitions (it has no 'kind: transitions'); the worlds of "
        "the simulator are a different kind of file, see "
        "config/worlds/transitions_symmetric.yaml");
}

TransitionWorld readWorld(ConfigReader reader, const std::string& file) {
  requireKind(reader, file);
  TransitionWorld world;
  readSettings(reader, world);
  VehicleModel vehicle;
  readVehicle(reader.section("vehicle", true), vehicle);
  std::set<std::string> patterns, surfaces;
  for (ConfigReader& entry : reader.sections("patterns", true)) {
    world.patterns.push_back(readPattern(entry));
    checkName(entry, patterns, world.patterns.back().name);
  }
  for (ConfigReader& entry : reader.sections("sequences", true))
    world.sequences.push_back(readSequence(entry, patterns));
  for (ConfigReader& entry : reader.sections("surfaces", true)) {
    world.surfaces.push_back(readSurface(entry, vehicle));
    checkName(entry, surfaces, world.surfaces.back().name);
  }
  if (world.surfaces.size() < 2)
    throw reader.error("surfaces", "a transition needs at least two surfaces");
  if (world.sequences.empty()) throw reader.error("sequences", "at least one is needed");
  reader.finish();
  return world;
}

/// The commands of a pattern, each held `length` times as long.
std::vector<TrackCommand> heldLonger(const std::vector<TrackCommand>& commands, int length) {
  std::vector<TrackCommand> longer;
  for (const TrackCommand& command : commands)
    longer.insert(longer.end(), static_cast<size_t>(length), command);
  return longer;
}

/// The patterns as a set; its predictions are the first surface's mean motion.
PatternSet setOf(const TransitionWorld& world, int length) {
  const VehicleModel& model = world.surfaces.front().model;
  PatternSetContent content;
  content.name = world.name;
  content.period_us = std::llround(world.period * 1e6);
  content.classes = {{"entry", steadyTwist(model, world.entry), world.entry}};
  for (const WorldPattern& executed : world.patterns) {
    MotionPattern pattern;
    pattern.id = static_cast<int>(content.patterns.size()) + 1;
    pattern.name = executed.name;
    pattern.entry_class = pattern.exit_class = "entry";
    const std::vector<TrackCommand> commands = heldLonger(executed.commands, length);
    pattern.commands = commandsOf(commands);
    pattern.trajectory = simulate(model, commands, world.period, steadyEntry(model, world.entry));
    content.patterns.push_back(std::move(pattern));
  }
  std::string why;
  std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw recordings::RecordingError(world.name + ": " + why);
  return *set;
}

Execution execute(const TransitionWorld& world, const VehicleModel& model,
                  const std::vector<TrackCommand>& commands, std::mt19937_64& random) {
  const ExecutionNoise noise = drawNoise(model.spread, random);
  Execution measured =
      simulate(model, commands, world.period, steadyEntry(model, world.entry), noise);
  std::normal_distribution<double> standard;
  for (Pose2& pose : measured) {
    pose.x += world.position_noise * standard(random);
    pose.y += world.position_noise * standard(random);
    pose.yaw += world.yaw_noise * standard(random);
  }
  return measured;
}

}  // namespace

TransitionWorld readTransitionWorld(const std::string& path) {
  return readWorld(ConfigReader::fromFile(path), path);
}

TransitionWorld parseTransitionWorld(const std::string& text, const std::string& name) {
  return readWorld(ConfigReader::fromText(text, name), name);
}

recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length) {
  recordings::PatternRecordings recorded{setOf(world, length), {}};
  for (size_t s = 0; s < world.surfaces.size(); ++s) {
    recordings::SurfaceRecordings surface{world.surfaces[s].name, {}};
    for (size_t p = 0; p < world.patterns.size(); ++p) {
      std::mt19937_64 random(seedOf({seed, s, p}));
      std::vector<Execution> executions;
      for (int64_t i = 0; i < world.recordings; ++i)
        executions.push_back(execute(world, world.surfaces[s].model,
                                     tracksOf(recorded.patterns.patterns()[p].commands), random));
      surface.executions.push_back(std::move(executions));
    }
    recorded.surfaces.push_back(std::move(surface));
  }
  return recorded;
}

}  // namespace tread::experiment

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/pattern_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/pattern/pattern_check.hpp"

namespace tread {
namespace {

using Rows = std::vector<std::vector<double>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kAnyNumber{-kInfinity, kInfinity};
constexpr Range kCount{0.0, kInfinity};
constexpr Range kInt32{0.0, 2147483647.0};

constexpr const char* kHeading =
    "# A set of motion patterns. Edit it with any editor; programs check it when they read it.\n"
    "# kind: power (commands -1..1) or track_speed (commands in m/s). period_us: how long one "
    "sample is held.\n"
    "# classes: steady motions in which patterns begin and end: twist = v_x, v_y [m/s], omega "
    "[rad/s];\n"
    "#   steady = left, right command that keeps it.\n"
    "# commands: [left, right, samples] in their order. trajectory: [x, y, yaw] in m and rad, the "
    "pose after\n"
    "#   each sample in the frame of the start; as many rows as samples. end_covariance: xx xy "
    "xyaw yy yyaw\n"
    "#   yawyaw of the last pose [m2, m rad, rad2]; leave it out if it is unknown.\n";
// For a vehicle without two tracks.
constexpr const char* kChannelsHeading =
    "# A set of motion patterns. Edit it with any editor; programs check it when they read it.\n"
    "# channels: what a command consists of: power (1), track_speed (m/s) or steering_angle (rad, "
    "+ left).\n"
    "# period_us: how long one sample is held. classes: steady motions in which patterns begin and "
    "end:\n"
    "#   twist = v_x, v_y [m/s], omega [rad/s]; steady = the command that keeps it.\n"
    "# commands: [a value for each channel, samples] in their order. trajectory: [x, y, yaw] in m "
    "and rad,\n"
    "#   the pose after each sample in the frame of the start; as many rows as samples. "
    "end_covariance: xx\n"
    "#   xy xyaw yy yyaw yawyaw of the last pose [m2, m rad, rad2]; leave it out if it is "
    "unknown.\n";

Command commandOf(const std::vector<double>& values, size_t channels) {
  Command command;
  for (size_t i = 0; i < channels; ++i) command[i] = values[i];
  return command;
}

std::vector<Command> expand(const Rows& rows, size_t channels, const ConfigReader& reader) {
  std::vector<Command> commands;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double samples = rows[i][channels];
    const auto limit = static_cast<double>(PatternLimits::kMaxSamples - commands.size());
    if (samples < 1.0 || samples > limit || samples != std::floor(samples))
      throw reader.error("commands", "row " + std::to_string(i + 1) + " is held for " +
                                         formatNumber(samples) +
                                         " samples; allowed are whole numbers from 1, together up "
                                         "to " +
                                         std::to_string(PatternLimits::kMaxSamples));
    commands.insert(commands.end(), static_cast<size_t>(samples), commandOf(rows[i], channels));
  }
  return commands;
}

MotionClass readClass(ConfigReader& reader, size_t channels) {
  MotionClass motion;
  reader.text("name", motion.name, true);
  std::vector<double> twist;
  reader.numbers("twist", twist, 3, kAnyNumber, "", true);
  motion.twist = {twist[0], twist[1], twist[2]};
  std::vector<double> steady;
  reader.numbers("steady", steady, channels, kAnyNumber, "", true);
  motion.steady = commandOf(steady, channels);
  return motion;
}

MotionPattern readPattern(ConfigReader& reader, size_t channels) {
  MotionPattern pattern;
  int64_t id = 0;
  reader.integer("id", id, kInt32, "", true);
  pattern.id = static_cast<int>(id);
  reader.text("name", pattern.name, true);
  reader.text("entry", pattern.entry_class, true);
  reader.text("exit", pattern.exit_class, true);
  int64_t times_learned = 0;
  reader.integer("times_learned", times_learned, kInt32, "");
  pattern.times_learned = static_cast<int>(times_learned);
  if (reader.has("end_covariance")) {
    std::vector<double> covariance;
    reader.numbers("end_covariance", covariance, 6, kAnyNumber, "");
    std::copy(covariance.begin(), covariance.end(), pattern.end_covariance.begin());
  }
  Rows commands;
  reader.table("commands", commands, channels + 1, kAnyNumber, "", true);
  pattern.commands = expand(commands, channels, reader);
  Rows trajectory;
  reader.table("trajectory", trajectory, 3, kAnyNumber, "", true);
  for (const auto& row : trajectory) pattern.trajectory.push_back({row[0], row[1], row[2]});
  return pattern;
}

CommandChannels readChannels(ConfigReader& reader) {
  CommandChannels channels;
  for (ConfigReader& section : reader.sections("channels", true)) {
    CommandChannel& channel = channels.emplace_back();
    std::string kind;
    section.text("name", channel.name, true);
    section.choice("kind", kind, {"power", "track_speed", "steering_angle"}, true);
    channel.kind = *kindNamed(kind);
    channel.lowest = -commandLimit(channel.kind);
    channel.highest = commandLimit(channel.kind);
    section.number("lowest", channel.lowest, kAnyNumber, "");
    section.number("highest", channel.highest, kAnyNumber, "");
  }
  if (channels.size() > Command::kMaxChannels)
    throw reader.error("channels", std::to_string(channels.size()) +
                                       " channels; allowed are up to " +
                                       std::to_string(Command::kMaxChannels));
  return channels;
}

void readHead(ConfigReader& reader, PatternSetContent& content) {
  reader.text("name", content.name, true);
  reader.integer("version", content.version, kCount, "");
  reader.integer("parent_version", content.parent_version, kCount, "");
  reader.integer("utime", content.utime, kCount, "us");
  if (reader.has("channels")) {
    content.channels = readChannels(reader);
  } else {
    std::string kind;
    reader.choice("kind", kind, {"power", "track_speed"}, true);
    content.channels = trackChannels(*kindNamed(kind));
  }
  reader.integer("period_us", content.period_us, kCount, "us", true);
}

PatternSet readSet(ConfigReader& reader) {
  if (reader.has("lattice_metadata"))
    throw reader.error("lattice_metadata",
                       "these are nav2's lattice primitives, no pattern set with commands; "
                       "tread-plan reads them in a file FILE.json");
  PatternSetContent content;
  readHead(reader, content);
  const size_t channels = content.channels.size();
  std::vector<ConfigReader> classes = reader.sections("classes", true);
  for (ConfigReader& motion : classes) content.classes.push_back(readClass(motion, channels));
  std::vector<ConfigReader> patterns = reader.sections("patterns", true);
  for (ConfigReader& pattern : patterns) content.patterns.push_back(readPattern(pattern, channels));
  reader.finish();
  if (const auto problem = firstProblem(content)) {
    const ConfigReader& place =
        problem->place == PatternProblem::Place::kClass     ? classes[problem->index]
        : problem->place == PatternProblem::Place::kPattern ? patterns[problem->index]
                                                            : reader;
    throw place.error(problem->key, problem->line(content));
  }
  std::string why;
  return *PatternSet::make(std::move(content), why);
}

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + formatNumber(value);
  return "[" + text + "]";
}

bool sameBits(const Command& a, const Command& b) {
  for (size_t i = 0; i < Command::kMaxChannels; ++i)
    if (a[i] != b[i] || std::signbit(a[i]) != std::signbit(b[i])) return false;
  return true;
}

std::vector<double> valuesOf(const Command& command, size_t channels) {
  std::vector<double> values;
  for (size_t i = 0; i < channels; ++i) values.push_back(command[i]);
  return values;
}

void writeChannels(std::ostringstream& out, const CommandChannels& channels) {
  if (const auto kind = kindOfTracks(channels)) {
    out << "kind: " << nameOf(*kind) << '\n';
    return;
  }
  out << "channels:\n";
  for (const CommandChannel& channel : channels)
    out << "  - {name: " << formatText(channel.name) << ", kind: " << nameOf(channel.kind)
        << ", lowest: " << formatNumber(channel.lowest)
        << ", highest: " << formatNumber(channel.highest) << "}\n";
}

void writeSeries(std::ostringstream& out, const MotionPattern& pattern, size_t channels) {
  out << "    commands:\n";
  for (size_t i = 0; i < pattern.commands.size();) {
    size_t end = i + 1;
    while (end < pattern.commands.size() && sameBits(pattern.commands[i], pattern.commands[end]))
      ++end;
    std::vector<double> row = valuesOf(pattern.commands[i], channels);
    row.push_back(static_cast<double>(end - i));
    out << "      - " << list(row) << '\n';
    i = end;
  }
  out << "    trajectory:\n";
  for (const Pose2& pose : pattern.trajectory)
    out << "      - " << list({pose.x, pose.y, pose.yaw}) << '\n';
}

void writePattern(std::ostringstream& out, const MotionPattern& pattern, size_t channels) {
  out << "  - id: " << pattern.id << '\n';
  out << "    name: " << formatText(pattern.name) << '\n';
  out << "    entry: " << formatText(pattern.entry_class) << '\n';
  out << "    exit: " << formatText(pattern.exit_class) << '\n';
  if (pattern.times_learned > 0) out << "    times_learned: " << pattern.times_learned << '\n';
  const PoseCovariance& covariance = pattern.end_covariance;
  if (!std::isnan(covariance[0]))
    out << "    end_covariance: " << list({covariance.begin(), covariance.end()}) << '\n';
  writeSeries(out, pattern, channels);
}

}  // namespace

PatternSet readPatternFile(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  return readSet(reader);
}

PatternSet parsePatterns(const std::string& text, const std::string& name) {
  ConfigReader reader = ConfigReader::fromText(text, name);
  return readSet(reader);
}

std::string formatPatterns(const PatternSet& set) {
  const PatternSetContent& content = set.content();
  std::ostringstream out;
  out << (kindOfTracks(content.channels) ? kHeading : kChannelsHeading);
  out << "name: " << formatText(content.name) << '\n';
  out << "version: " << content.version << '\n';
  out << "parent_version: " << content.parent_version << '\n';
  out << "utime: " << content.utime << '\n';
  writeChannels(out, content.channels);
  out << "period_us: " << content.period_us << '\n';
  out << "classes:\n";
  for (const MotionClass& motion : content.classes) {
    out << "  - name: " << formatText(motion.name) << '\n';
    out << "    twist: " << list({motion.twist.v_x, motion.twist.v_y, motion.twist.omega}) << '\n';
    out << "    steady: " << list(valuesOf(motion.steady, content.channels.size())) << '\n';
  }
  out << "patterns:\n";
  for (const MotionPattern& pattern : content.patterns)
    writePattern(out, pattern, content.channels.size());
  return out.str();
}

}  // namespace tread

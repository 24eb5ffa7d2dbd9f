// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/imported_log.hpp"
#include "tools/import/foreign_log.hpp"

using namespace tread;
using namespace tread::recordings;

namespace {

struct Arguments {
  std::string format;
  std::string sessions;
  std::string session;
  std::string csv;
  std::string log;
  bool keep_lag = false;
  Gyro gyro = Gyro::kAtFixes;
  ExecutionLayout layout;
  import::ForeignRobot robot;
};

RecordedDrive read(const Arguments& arguments, const Session& session) {
  if (arguments.format == "steps") return readSteps(arguments.csv, session, arguments.gyro);
  if (arguments.format == "aligned") return readAligned(arguments.csv, session);
  return readContinuous(arguments.csv, session, arguments.gyro);
}

/// Aligned files hold neither the gyro nor the times at which poses were logged.
void checkFormat(const Arguments& arguments) {
  if (arguments.format != "lcm" && arguments.sessions.empty())
    throw RecordingError("--sessions is needed with --format " + arguments.format);
  if (arguments.format == "aligned" && (arguments.keep_lag || arguments.gyro == Gyro::kAll))
    throw RecordingError("--keep-lag and --gyro all: not in aligned files; take --format steps");
}

Session sessionOf(const Arguments& arguments) {
  const std::string name = arguments.session.empty()
                               ? std::filesystem::path(arguments.csv).stem().string()
                               : arguments.session;
  Session session = readSession(arguments.sessions, name);
  session.lag_kept = arguments.keep_lag;
  if (arguments.keep_lag) session.pose_lag = 0.0;
  return session;
}

/// A command is held for a period of the recording, so an execution is a whole number of them.
void checkLength(double length) {
  const double commands = length / kPeriod;
  if (std::abs(commands - std::round(commands)) > 1e-6)
    throw RecordingError("--length: " + std::to_string(length) +
                         " s is no multiple of 0.05 s, the recordings' period");
}

/// What a foreign log does not say about its session.
Session foreignSession(const Arguments& arguments, const RecordedDrive& recording) {
  Session session;
  session.name = std::filesystem::path(arguments.csv).stem().string();
  session.robot = "robot of a foreign log";
  session.surface = "unknown";
  session.baseline = arguments.robot.baseline;
  session.pose_lag = 0.0;
  const std::vector<Fix>& fixes = recording.fixes;
  if (fixes.size() > 1)
    session.pose_rate =
        static_cast<double>(fixes.size() - 1) / (fixes.back().time - fixes.front().time);
  return session;
}

RecordedDrive readForeign(const Arguments& arguments) {
  import::ForeignDrive foreign = import::readForeignLog(arguments.csv, arguments.robot);
  for (const auto& [what, count] : foreign.left_out)
    std::printf("left out: %zu of %s\n", count, what.c_str());
  if (!foreign.pose_channel.empty()) std::printf("poses: %s\n", foreign.pose_channel.c_str());
  return std::move(foreign.drive);
}

void run(const Arguments& arguments) {
  checkLength(arguments.layout.length);
  checkFormat(arguments);
  Session session;
  RecordedDrive recording;
  if (arguments.format == "lcm") {
    recording = readForeign(arguments);
    session = foreignSession(arguments, recording);
  } else {
    session = sessionOf(arguments);
    recording = read(arguments, session);
  }
  LogCounts counts;
  const auto events = makeLog(recording, session, arguments.format, arguments.layout, counts);
  LogWriter writer(arguments.log);
  for (const LogEvent& event : events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  writer.flush();
  std::printf(
      "%s: %zu commands, %zu executions completed, %zu aborted, %zu INS, %zu MOTOR, %zu SCAN, "
      "%.0f s\n",
      arguments.log.c_str(), recording.runs.size(), counts.completed, counts.aborted, counts.ins,
      counts.motor, counts.scans, counts.duration);
}

int parseAndRun(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Turns a recording of a drive (CSV, or an LCM log of a MAEBot or MBot) into an LCM log: INS, "
      "MOTOR, SCAN, EXECUTION, MARK"};
  app.add_option("--format", arguments.format, "which kind of file: lcm, or one of CSV")
      ->required()
      ->check(CLI::IsMember({"steps", "aligned", "continuous", "lcm"}));
  app.add_option("--sessions", arguments.sessions,
                 "sessions.csv: radius, baseline, pose lag; not with lcm");
  app.add_option("--pose-channel", arguments.robot.pose_channel,
                 "lcm: whose poses become INS, if several channels hold poses");
  app.add_option("--baseline", arguments.robot.baseline,
                 "lcm: between the wheels [m]; needed where commands are body speeds")
      ->check(CLI::Range(0.01, 10.0));
  app.add_option("--lidar-height", arguments.robot.lidar_height,
                 "lcm: range finder above the ground [m]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--session", arguments.session, "row of sessions.csv; default: the file's name");
  app.add_option("csv", arguments.csv, "recording")->required();
  app.add_option("-o,--output", arguments.log, "LCM log to write")->required();
  app.add_option("--offset", arguments.layout.offset,
                 "first execution this long after the command began [s]")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  app.add_option("--length", arguments.layout.length, "of an execution [s]")
      ->check(CLI::Range(0.1, 50.0))
      ->capture_default_str();
  app.add_option("--executions", arguments.layout.executions, "per command")
      ->check(CLI::Range(1, 9))
      ->capture_default_str();
  app.add_flag("--keep-lag", arguments.keep_lag,
               "poses at the time at which they were logged, not when they were measured");
  app.add_option("--gyro", arguments.gyro, "readings of the gyro: at fixes, or all")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Gyro>{{"fixes", Gyro::kAtFixes}, {"all", Gyro::kAll}}))
      ->default_str("fixes");
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  run(arguments);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return tread::runProgram("tread-import", [&] { return parseAndRun(argc, argv); });
}

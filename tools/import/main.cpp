// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/mcap/mcap_log.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/imported_log.hpp"
#include "common/store/output_file.hpp"
#include "tools/import/csv_drive.hpp"
#include "tools/import/foreign_log.hpp"
#include "tools/import/rawlog.hpp"

using namespace tread;
using namespace tread::recordings;

namespace {

struct Arguments {
  std::string format;
  std::string sessions;
  std::string session;
  std::string mapping;
  std::vector<std::string> overrides;
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

/// Of robots that the project's own recordings are not of.
bool isForeign(const std::string& format) {
  return format == "lcm" || format == "rawlog" || format == "csv";
}

/// Aligned files hold neither the gyro nor the times at which poses were logged.
void checkFormat(const Arguments& arguments) {
  if (!isForeign(arguments.format) && arguments.sessions.empty())
    throw RecordingError("--sessions is needed with --format " + arguments.format);
  if ((arguments.format == "csv") == arguments.mapping.empty())
    throw RecordingError("--mapping: needed with --format csv, and only there");
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

/// What a foreign recording does not say about its session.
Session foreignSession(const Arguments& arguments, const RecordedDrive& recording) {
  Session session;
  std::filesystem::path path(arguments.csv);
  session.name = (path.has_filename() ? path : path.parent_path()).stem().string();
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

void tell(const import::ForeignDrive& foreign) {
  for (const auto& [what, count] : foreign.left_out)
    std::printf("left out: %zu of %s\n", count, what.c_str());
  if (!foreign.poses.empty()) std::printf("poses: %s\n", foreign.poses.c_str());
}

RecordedDrive readForeign(const Arguments& arguments, Session& session) {
  if (arguments.format != "csv") {
    import::ForeignDrive foreign = arguments.format == "lcm"
                                       ? import::readForeignLog(arguments.csv, arguments.robot)
                                       : import::readRawlog(arguments.csv);
    tell(foreign);
    session = foreignSession(arguments, foreign.drive);
    return std::move(foreign.drive);
  }
  ConfigReader reader = ConfigReader::fromFile(arguments.mapping, arguments.overrides);
  const import::CsvMapping mapping = import::readCsvMapping(reader);
  for (const import::CsvSource& source : mapping.sources)  // tables beside the named one
    refuseToReplace(arguments.log,
                    {(std::filesystem::path(arguments.csv).parent_path() / source.file).string()});
  import::ForeignDrive foreign = import::readMappedCsv(arguments.csv, mapping);
  tell(foreign);
  session = foreignSession(arguments, foreign.drive);
  session.robot = mapping.robot;
  session.surface = mapping.surface;
  session.baseline = mapping.baseline;
  return std::move(foreign.drive);
}

/// Messages as they are, not a drive made of samples.
void takeMcap(const Arguments& arguments) {
  LogWriter writer(arguments.log);
  const mcap::LogCounts counts = mcap::writeLog(arguments.csv, writer);
  writer.close();
  for (const auto& [what, count] : counts.left_out)
    std::printf("left out: %lld of %s\n", static_cast<long long>(count), what.c_str());
  if (!counts.problem.empty()) std::printf("%s\n", counts.problem.c_str());
  std::printf("%s: %lld messages\n", arguments.log.c_str(), static_cast<long long>(counts.taken));
}

void run(const Arguments& arguments) {
  if (arguments.format == "mcap") return takeMcap(arguments);
  checkLength(arguments.layout.length);
  checkFormat(arguments);
  Session session;
  RecordedDrive recording;
  if (isForeign(arguments.format)) {
    recording = readForeign(arguments, session);
  } else {
    session = sessionOf(arguments);
    recording = read(arguments, session);
  }
  LogCounts counts;
  const auto events = makeLog(recording, session, arguments.format, arguments.layout, counts);
  LogWriter writer(arguments.log);
  for (const LogEvent& event : events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  writer.close();
  std::printf(
      "%s: %zu commands, %zu executions completed, %zu aborted, %zu INS, %zu MOTOR, %zu SCAN, "
      "%.0f s\n",
      arguments.log.c_str(), recording.runs.size(), counts.completed, counts.aborted, counts.ins,
      counts.motor, counts.scans, counts.duration);
}

int parseAndRun(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Turns a recording of a drive (CSV, an LCM log of a MAEBot or MBot, or an MRPT rawlog) into "
      "an LCM log: INS, MOTOR, SCAN, EXECUTION, MARK; or an MCAP file of tread-export into the log "
      "that it was made of"};
  app.add_option("--format", arguments.format,
                 "which kind of file: mcap; lcm; rawlog; csv as --mapping says; or one with "
                 "--sessions")
      ->required()
      ->check(CLI::IsMember({"steps", "aligned", "continuous", "lcm", "rawlog", "csv", "mcap"}));
  app.add_option("--mapping", arguments.mapping,
                 "csv: what its columns mean, as config/imports/example.yaml does");
  app.add_option("--set", arguments.overrides,
                 "csv: KEY=VALUE in the place of what the mapping says: wheel_radius=0.18")
      ->expected(1)
      ->take_all();
  app.add_option("--sessions", arguments.sessions,
                 "sessions.csv: radius, baseline, pose lag; not with lcm, rawlog and csv");
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
  app.add_option("csv", arguments.csv, "recording: a file, or a folder of tables")->required();
  Outputs(app).file("-o,--output", arguments.log, "LCM log to write")->required();
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

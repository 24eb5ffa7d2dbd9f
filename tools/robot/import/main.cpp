// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/log/unpacked_file.hpp"
#include "common/mcap/mcap_log.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/drive_recordings.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/store/output_file.hpp"
#include "tools/robot/import/csv_drive.hpp"
#include "tools/robot/import/cut_drive.hpp"
#include "tools/robot/import/foreign_log.hpp"
#include "tools/robot/import/rawlog.hpp"

using namespace tread;
using namespace tread::recordings;

namespace {

struct Arguments {
  std::string format;
  std::string sessions;
  std::string session;
  std::string mapping;
  std::vector<std::string> overrides;
  bool decimal_comma = false;
  std::vector<std::string> files;
  std::string csv;    ///< the recording to read
  std::string input;  ///< `csv`, or its unpacked copy
  std::string log;    ///< or a folder of recordings
  import::CutLayout cut;
  bool cuts = false;
  bool keep_lag = false;
  bool allow_loss = false;
  Gyro gyro = Gyro::kAtFixes;
  ExecutionLayout layout;
  import::ForeignRobot robot;
};

RecordedDrive read(const Arguments& arguments, const Session& session) {
  if (arguments.format == "steps") return readSteps(arguments.input, session, arguments.gyro);
  if (arguments.format == "aligned") return readAligned(arguments.input, session);
  return readContinuous(arguments.input, session, arguments.gyro);
}

constexpr const char* kUnknownSurface = "unknown";

/// Whether the format is one that the project's own recordings do not use.
bool isForeign(const std::string& format) {
  return format == "lcm" || format == "rawlog" || format == "csv";
}

/// Aligned files contain neither the gyro nor the logging times of the poses.
void checkFormat(const Arguments& arguments) {
  if (!isForeign(arguments.format) && arguments.sessions.empty())
    throw RecordingError("--sessions is needed with --format " + arguments.format);
  if ((arguments.format == "csv") == arguments.mapping.empty())
    throw RecordingError("--mapping: needed with --format csv, and only there");
  if (arguments.format == "aligned" && (arguments.keep_lag || arguments.gyro == Gyro::kAll))
    throw RecordingError("--keep-lag and --gyro all: not in aligned files; take --format steps");
}

/// Name of a recording, from its file or folder.
std::string nameOf(std::filesystem::path path) {
  if (!path.has_filename()) path = path.parent_path();
  return (path.extension() == ".gz" ? path.stem() : path).stem().string();
}

Session sessionOf(const Arguments& arguments) {
  const std::string name = arguments.session.empty() ? nameOf(arguments.csv) : arguments.session;
  Session session = readSession(arguments.sessions, name);
  session.lag_kept = arguments.keep_lag;
  if (arguments.keep_lag) session.pose_lag = 0.0;
  return session;
}

/// A command holds for one period of the recording, so an execution must be a multiple of it.
void checkLength(const char* option, double length) {
  const double commands = length / kPeriod;
  if (std::abs(commands - std::round(commands)) > 1e-6)
    throw RecordingError(std::string(option) + ": " + std::to_string(length) +
                         " s is no multiple of 0.05 s, the recordings' period");
}

/// Session data that a foreign recording does not contain.
Session foreignSession(const Arguments& arguments, const RecordedDrive& recording) {
  Session session;
  session.name = nameOf(arguments.csv);
  session.robot = "robot of a foreign log";
  session.surface = kUnknownSurface;
  session.baseline = arguments.robot.baseline;
  session.pose_lag = 0.0;
  const std::vector<Fix>& fixes = recording.fixes;
  if (fixes.size() > 1)
    session.pose_rate =
        static_cast<double>(fixes.size() - 1) / (fixes.back().time - fixes.front().time);
  return session;
}

/// A recording, and what was lost of it.
struct Reading {
  RecordedDrive drive;
  std::vector<import::Loss> losses;
};

Reading taken(import::ForeignDrive foreign) {
  for (const auto& [what, count] : foreign.left_out)
    std::printf("left out: %zu %s\n", count, what.c_str());
  if (!foreign.poses.empty()) std::printf("poses: %s\n", foreign.poses.c_str());
  for (const std::string& note : foreign.notes) std::printf("%s\n", note.c_str());
  return {std::move(foreign.drive), std::move(foreign.losses)};
}

/// Above 1 % of loss the import fails: the rest may not represent the drive.
int verdictOn(const std::vector<import::Loss>& losses, const Arguments& arguments) {
  constexpr double kMostLost = 0.01;
  for (const import::Loss& loss : losses) std::printf("lost: %s\n", lineOf(loss).c_str());
  if (arguments.allow_loss || largestShare(losses) <= kMostLost) return 0;
  std::fprintf(
      stderr,
      "tread-import: %s: more than 1 %% was lost; %s holds the rest, --allow-loss takes it\n",
      arguments.csv.c_str(), arguments.log.c_str());
  return 1;
}

/// Refuses an output that would overwrite an input table: they are next to the mapping.
void refuseTables(const Arguments& arguments, const import::CsvMapping& mapping) {
  const std::filesystem::path parent = std::filesystem::path(arguments.csv).parent_path();
  for (const import::CsvSource& source : mapping.sources)
    refuseToReplace(arguments.log, {(parent / source.file).string()});
}

/// Prints how well the commands explain the motion, by tread-gap's own check; 1 if they do not.
int verdictOnMotion(const std::vector<LogEvent>& events, const Arguments& arguments) {
  std::vector<LogEvent> driven;
  for (const LogEvent& event : events)
    if (event.channel != kScan.name) driven.push_back(event);
  int verdict = 0;
  for (const gap::LogNote& note :
       gap::toDrive(toDriveLog(arguments.csv, std::move(driven))).notes) {
    if (!note.isFatal() && note.isOfCommands()) std::printf("%s\n", note.what.c_str());
    if (note.isFatal() && !note.isOfCommands())
      std::printf("tread-gap will not use it: %s\n", note.what.c_str());
    if (!note.isFatal() || !note.isOfCommands()) continue;
    std::fflush(stdout);
    std::fprintf(stderr, "tread-import: %s: the commands do not explain the motion: %s\n",
                 arguments.csv.c_str(), note.what.c_str());
    verdict = 1;
  }
  return verdict;
}

void tellHoles(const std::vector<CommandHole>& holes) {
  if (holes.empty()) return;
  double sum = 0.0, longest = 0.0;
  for (const CommandHole& hole : holes) {
    sum += hole.end - hole.begin;
    longest = std::max(longest, hole.end - hole.begin);
  }
  std::printf(
      "gaps in the commands: %zu, %.1f s in all, longest %.2f s, first from %.2f to %.2f s; no "
      "MOTOR "
      "is there\n",
      holes.size(), sum, longest, holes.front().begin, holes.front().end);
}

Reading readForeign(const Arguments& arguments, Session& session) {
  if (arguments.format != "csv") {
    import::ForeignDrive foreign = arguments.format == "lcm"
                                       ? import::readForeignLog(arguments.input, arguments.robot)
                                       : import::readRawlog(arguments.csv);
    session = foreignSession(arguments, foreign.drive);
    return taken(std::move(foreign));
  }
  ConfigReader reader = ConfigReader::fromFile(arguments.mapping, arguments.overrides);
  import::CsvMapping mapping = import::readCsvMapping(reader);
  for (import::CsvSource& source : mapping.sources)
    source.layout.decimal_comma = source.layout.decimal_comma || arguments.decimal_comma;
  refuseTables(arguments, mapping);
  import::ForeignDrive foreign = import::readMappedCsv(arguments.csv, mapping);
  session = foreignSession(arguments, foreign.drive);
  session.robot = mapping.robot;
  if (!mapping.surface.empty()) session.surface = mapping.surface;
  session.baseline = mapping.baseline;
  if (!mapping.channels.empty() && !mapping.isOfTracks())
    std::printf("commands: %s\n", describe(mapping.channels).c_str());
  return taken(std::move(foreign));
}

Reading readDrive(const Arguments& arguments, Session& session) {
  if (isForeign(arguments.format)) return readForeign(arguments, session);
  session = sessionOf(arguments);
  return {read(arguments, session), {}};
}

/// Converts messages directly, without resampling.
int takeMcap(const Arguments& arguments) {
  LogWriter writer(arguments.log);
  const mcap::McapCounts counts = mcap::writeLog(arguments.input, writer);
  writer.close();
  for (const auto& [what, count] : counts.left_out)
    std::printf("left out: %lld of %s\n", static_cast<long long>(count), what.c_str());
  if (!counts.problem.empty()) std::printf("%s\n", counts.problem.c_str());
  std::printf("%s: %lld messages\n", arguments.log.c_str(), static_cast<long long>(counts.taken));
  std::vector<import::Loss> losses;
  auto all = static_cast<double>(counts.taken);
  for (const auto& [what, count] : counts.lost) all += static_cast<double>(count);
  for (const auto& [what, count] : counts.lost)
    losses.push_back({what, static_cast<double>(count), all, "messages"});
  if (counts.cut_off) losses.push_back({"what follows the end of the file", 0.0, 0.0, ""});
  if (counts.lost_bytes > 0)
    losses.push_back({"damaged", static_cast<double>(counts.lost_bytes),
                      static_cast<double>(counts.bytes), "bytes"});
  return verdictOn(losses, arguments);
}

int writeLog(const Arguments& arguments) {
  Session session;
  const Reading reading = readDrive(arguments, session);
  const RecordedDrive& recording = reading.drive;
  ImportCounts counts;
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
  tellHoles(counts.holes);
  const bool both = counts.motor > 0 && counts.ins > 0;
  const int motion = both ? verdictOnMotion(events, arguments) : 0;
  return std::max(motion, verdictOn(reading.losses, arguments));
}

/// Surfaces in the order in which they were first driven on.
using CutSurfaces = std::vector<import::CutSurface>;

/// The surface is named by the mapping, by sessions.csv, or by the file name.
int cutInto(CutSurfaces& surfaces, const Arguments& arguments) {
  Session session;
  const Reading reading = readDrive(arguments, session);
  const bool named = session.surface != kUnknownSurface;
  const std::string name = fileName(named ? session.surface : nameOf(arguments.csv));
  auto surface = std::find_if(surfaces.begin(), surfaces.end(),
                              [&](const auto& one) { return one.name == name; });
  if (surface == surfaces.end()) surface = surfaces.insert(surfaces.end(), {name, {}, 0.0, {}, {}});
  const size_t before = surface->pieces.size();
  import::cutDrive(reading.drive, arguments.cut, *surface);
  std::printf("%s: %zu pieces of %g s on %s\n", arguments.csv.c_str(),
              surface->pieces.size() - before, arguments.cut.length, name.c_str());
  return verdictOn(reading.losses, arguments);
}

void tellLeftOut(const CutSurfaces& surfaces, double length) {
  for (const import::CutSurface& surface : surfaces) {
    std::printf("%s: %.0f s under commands, %.0f s of them in pieces\n", surface.name.c_str(),
                surface.seconds, static_cast<double>(surface.pieces.size()) * length);
    for (const auto& [why, part] : surface.left_out)
      std::printf("%s: left out %.1f s (%zu times) %s\n", surface.name.c_str(), part.seconds,
                  part.count, why.c_str());
  }
}

/// Keeps the patterns of existing recordings, so that surfaces can be added.
void writeCut(const Arguments& arguments, const CutSurfaces& surfaces) {
  const std::filesystem::path patterns = std::filesystem::path(arguments.log) / "patterns.yaml";
  std::optional<PatternSet> known;
  if (std::filesystem::exists(patterns)) known = readPatternFile(patterns.string());
  const import::CutRecordings cut = import::recordingsOf(surfaces, arguments.cut, known);
  for (const std::string& note : cut.notes) std::printf("%s\n", note.c_str());
  OutputFolder folder(arguments.log);
  // Unchanged patterns: keep the file with its comments.
  if (known)
    std::filesystem::copy_file(patterns, std::filesystem::path(folder.path()) / "patterns.yaml");
  writeRecordings(folder.path(), cut.recordings);
  folder.commit();
  size_t executions = 0;
  for (const SurfaceRecordings& surface : cut.recordings.surfaces)
    for (const auto& of_pattern : surface.executions) executions += of_pattern.size();
  std::printf("%s: %zu executions of %zu patterns on %zu surfaces%s\n", arguments.log.c_str(),
              executions, cut.recordings.patterns.patterns().size(), surfaces.size(),
              known ? ", existing patterns kept" : "");
}

/// Reads the recordings; packed tables of a mapping are unpacked one at a time, MRPT unpacks
/// rawlogs.
template <class Take>
int unpacked(Arguments arguments, const std::string& name, const Take& take) {
  arguments.csv = arguments.input = name;
  const std::string packing = packingOf(name);
  if (packing.empty() || arguments.format == "csv" ||
      (arguments.format == "rawlog" && packing == "gzip"))
    return take(arguments);
  const UnpackedFile file(name);
  arguments.input = file.path();
  try {
    const int verdict = take(arguments);
    if (file.problem().empty()) return verdict;
    return std::max(verdict, verdictOn({{file.problem(), 0.0, 0.0, ""}}, arguments));
  } catch (const std::exception& error) {
    throw RecordingError(file.reasonOf(error.what()));
  }
}

int cutFiles(const Arguments& arguments) {
  checkLength("--cut", arguments.cut.length);
  CutSurfaces surfaces;
  int verdict = 0;
  for (const std::string& file : arguments.files)
    verdict = std::max(verdict, unpacked(arguments, file, [&](const Arguments& of_file) {
                         return cutInto(surfaces, of_file);
                       }));
  tellLeftOut(surfaces, arguments.cut.length);
  writeCut(arguments, surfaces);
  return verdict;
}

int run(const Arguments& arguments) {
  if (arguments.format == "mcap" && arguments.cuts)
    throw RecordingError("--cut: an MCAP file holds messages, not a drive; cut its original log");
  if (arguments.format != "mcap") checkFormat(arguments);
  if (arguments.cuts) return cutFiles(arguments);
  if (arguments.files.size() > 1)
    throw RecordingError("a log holds one recording; several are for --cut");
  checkLength("--length", arguments.layout.length);
  return unpacked(arguments, arguments.files.front(), [](const Arguments& of_file) {
    return of_file.format == "mcap" ? takeMcap(of_file) : writeLog(of_file);
  });
}

int parseAndRun(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Turns a recording of a drive (CSV, an LCM log of a MAEBot or MBot, or an MRPT rawlog) into "
      "an LCM log: INS, MOTOR, SCAN, EXECUTION, MARK. Turns an MCAP file of tread-export back into "
      "its log. With --cut: turns drives with piecewise constant commands into "
      "recordings of patterns, for tread-experiment"};
  app.add_option("--format", arguments.format,
                 "kind of file: mcap; lcm; rawlog; csv, described by --mapping; or one with "
                 "--sessions")
      ->required()
      ->check(CLI::IsMember({"steps", "aligned", "continuous", "lcm", "rawlog", "csv", "mcap"}));
  app.add_option("--mapping", arguments.mapping,
                 "csv: file with the meaning of the columns, like config/imports/example.yaml");
  app.add_option("--set", arguments.overrides,
                 "csv: KEY=VALUE overrides the mapping, for instance wheel_radius=0.18")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag(
      "--decimal-comma", arguments.decimal_comma,
      "csv: all tables use a decimal comma (0,5), like decimal_comma: true in the mapping");
  app.add_option(
      "--sessions", arguments.sessions,
      "sessions.csv with wheel radius, baseline and pose lag; not for lcm, rawlog and csv");
  app.add_option("--pose-channel", arguments.robot.pose_channel,
                 "lcm: channel of the poses that become INS, if several hold poses");
  app.add_option("--baseline", arguments.robot.baseline,
                 "lcm: distance between the wheels [m]; needed if commands are body speeds")
      ->check(CLI::Range(0.01, 10.0));
  app.add_option("--lidar-height", arguments.robot.lidar_height,
                 "lcm: height of the range finder above the ground [m]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--session", arguments.session, "row of sessions.csv; default: the file's name");
  app.add_option(
         "csv", arguments.files,
         "recording: a file, or a folder of tables; with --cut several, one after the other")
      ->required();
  Outputs(app)
      .fileOrFolder("-o,--output", arguments.log,
                    "LCM log to write; with --cut a folder: patterns.yaml and a SURFACE.csv for "
                    "each surface, named by `surface` in the mapping or after its file; with "
                    "--force existing patterns and "
                    "surfaces are kept")
      ->required();
  auto* const length =
      app.add_option("--length", arguments.layout.length, "duration of an execution [s]")
          ->check(CLI::Range(0.1, 50.0))
          ->capture_default_str();
  auto* const executions =
      app.add_option("--executions", arguments.layout.executions, "per command")
          ->check(CLI::Range(1, 9))
          ->capture_default_str();
  auto* const cut = app.add_option("--cut", arguments.cut.length,
                                   "write recordings of patterns instead of a log: pieces of so "
                                   "many seconds under one command")
                        ->check(CLI::Range(0.1, 50.0))
                        ->excludes(length)
                        ->excludes(executions);
  app.add_option("--offset", arguments.layout.offset,
                 "first execution this long after the command began [s]")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  app.add_option("--alike", arguments.cut.alike,
                 "--cut: merge commands that differ by at most this share of the largest; pieces "
                 "are corrected for the difference [1]")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str()
      ->needs(cut);
  app.add_option("--fewest", arguments.cut.fewest,
                 "--cut: least pieces of a command on each surface that make it a pattern")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str()
      ->needs(cut);
  app.add_flag("--allow-loss", arguments.allow_loss,
               "exit status 0 even where more than 1 % of the recording is lost");
  app.add_flag("--keep-lag", arguments.keep_lag,
               "stamp poses with the time of logging, not of measurement");
  app.add_option("--gyro", arguments.gyro, "gyro readings: at fixes, or all")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Gyro>{{"fixes", Gyro::kAtFixes}, {"all", Gyro::kAll}}))
      ->default_str("fixes");
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  arguments.cuts = cut->count() > 0;
  arguments.cut.settle = arguments.layout.offset;
  return run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return tread::runProgram("tread-import", [&] { return parseAndRun(argc, argv); });
}

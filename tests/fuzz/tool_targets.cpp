// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/drive/drive_log.hpp"
#include "common/drive/robot_log.hpp"
#include "common/link/make_link.hpp"
#include "common/log/unpacked_file.hpp"
#include "common/mcap/mcap_reader.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/drive_recordings.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/recordings/recordings.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/fuzz/reading.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/lab/experiment/trials.hpp"
#include "tools/lab/plan/lattice_file.hpp"
#include "tools/lab/plan/map_file.hpp"
#include "tools/lab/plan/primitives.hpp"
#include "tools/lab/plan/query_file.hpp"
#include "tools/lab/replay/learner_lives.hpp"
#include "tools/lab/replay/mapping_recording.hpp"
#include "tools/lab/replay/robot_replay.hpp"
#include "tools/robot/drive/keyboard.hpp"
#include "tools/robot/drive/pad.hpp"
#include "tools/robot/import/csv_drive.hpp"
#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"
#include "tools/robot/launch/liveness.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/report/chronicle.hpp"
#include "tools/robot/report/hand_record.hpp"

namespace tread::fuzz {
namespace {

/// With a header found by names, one in the first line, and none.
void csv(const uint8_t* bytes, size_t size) {
  recordings::CsvLayout asked;
  asked.columns = {"t", "x"};
  recordings::CsvLayout bare;
  bare.header = false;
  bare.decimal_comma = true;
  for (const recordings::CsvLayout& layout : {asked, bare, recordings::CsvLayout{}})
    refusing([&] {
      const recordings::CsvTable table(textOf(bytes, size), "table", layout);
      for (size_t row = 0; row < table.rows(); ++row)
        for (const char* column : {"x", "1"})
          refusing([&] { require(std::isfinite(table.number(row, column))); });
      table.lastDigit("1");
    });
}

void surfaceFile(const uint8_t* bytes, size_t size) {
  refusing(
      [&] { recordings::parseSurface(textOf(bytes, size), "surface", "grass", shippedSet()); });
}

/// A recorded drive in each format of tread-import, converted to a log.
void recordedDrive(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  recordings::Session session;
  session.wheel_radius = 0.5;
  session.baseline = 1.0;
  session.pose_lag = 0.2;
  session.pose_rate = 10.0;
  session.absolute_attitude = true;
  refusing([&] { session.rows = recordings::CsvTable(file.path()).rows(); });
  for (const std::string format : {"steps", "aligned", "continuous"})
    refusing([&] {
      const recordings::RecordedDrive drive =
          format == "steps"     ? recordings::readSteps(file.path(), session)
          : format == "aligned" ? recordings::readAligned(file.path(), session)
                                : recordings::readContinuous(file.path(), session);
      recordings::ImportCounts counts;
      makeLog(drive, session, format, recordings::ExecutionLayout{}, counts);
    });
}

/// A mapping file, a line of three dashes, and the described table.
void mappedCsv(const uint8_t* bytes, size_t size) {
  const std::string text = textOf(bytes, size);
  const size_t end = text.find("\n---\n");
  if (end == std::string::npos) return;
  refusing([&] {
    ConfigReader reader = ConfigReader::fromText(text.substr(0, end), "mapping");
    import::CsvMapping mapping = import::readCsvMapping(reader);
    for (import::CsvSource& source : mapping.sources) source.file.clear();
    const size_t table = end + 5;
    const MemoryFile file(bytes + table, size - table);
    const recordings::RecordedDrive drive = import::readMappedCsv(file.path(), mapping).drive;
    recordings::Session session;
    session.pose_rate = 10.0;
    recordings::ImportCounts counts;
    makeLog(drive, session, "csv", recordings::ExecutionLayout{}, counts);
  });
}

/// An MCAP file of arbitrary bytes.
void mcapFile(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] {
    mcap::Reader reader(file.path());
    const size_t all = reader.messages();
    mcap::Message message;
    size_t count = 0;
    for (uint64_t last = 0; reader.next(message); last = message.log_time, ++count)
      require(message.log_time >= last);
    require(count == all);
  });
}

/// Messages in any order, in chunks or outside: the lowest bit of a byte ends a chunk, the other
/// bits and the next byte are a time.
void mcapOrder(const uint8_t* bytes, size_t size) {
  using mcap::FieldWriter;
  using mcap::Op;
  FieldWriter channel;
  channel.u16(1).u16(0).text("INS").text("json").u32(0);
  std::string file(mcap::kMagic, mcap::kMagicBytes);
  file += mcap::recordOf(Op::kChannel, channel.bytes);
  std::string chunk;
  const auto end_chunk = [&](bool packed) {
    FieldWriter content;
    content.u64(0).u64(0).u64(chunk.size()).u32(mcap::crc32Of(chunk)).text("").u64(chunk.size());
    file += packed ? mcap::recordOf(Op::kChunk, content.bytes + chunk) : chunk;
    chunk.clear();
  };
  for (size_t i = 0; i + 1 < size; i += 2) {
    FieldWriter message;
    message.u16(1).u32(0).u64(static_cast<uint64_t>(bytes[i] / 2) * 256 + bytes[i + 1]).u64(0);
    chunk += mcap::recordOf(Op::kMessage, message.bytes + std::to_string(i));
    if (bytes[i] % 2 == 1) end_chunk(i % 3 != 0);
  }
  end_chunk(true);
  file += mcap::recordOf(Op::kDataEnd, FieldWriter().u32(0).bytes);
  const MemoryFile memory(reinterpret_cast<const uint8_t*>(file.data()), file.size());
  mcap::Reader reader(memory.path());
  mcap::Message message;
  size_t count = 0;
  std::pair<uint64_t, unsigned long> last{0, 0};
  for (; reader.next(message); ++count) {
    const std::pair now{message.log_time, std::stoul(message.data)};
    require(now >= last);
    last = now;
  }
  require(count == size / 2 && reader.problem().empty());
}

/// Gzipped content.
void packedFile(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] {
    const UnpackedFile unpacked(file.path());
    require(unpacked.named("") == "");
  });
}

/// The table of sessions for recorded drives.
void sessionTable(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] { recordings::readSession(file.path(), "drive"); });
}

/// Recipes of both kinds: for a model, and for recorded drives.
void recipe(const uint8_t* bytes, size_t size) {
  static const ModelDocument model =
      readModelDocument(std::string(TREAD_SOURCE_DIR) + "/config/models/teodor_tarmac.yaml");
  const auto read = [&] { return ConfigReader::fromText(textOf(bytes, size), "recipe"); };
  refusing([&] { patterns::makeSet(read(), model.vehicle); });
  refusing([&] { recordings::readRecipe(read()); });
}

void transitionWorld(const uint8_t* bytes, size_t size) {
  refusing([&] { experiment::parseTransitionWorld(textOf(bytes, size), "world"); });
}

void mapPicture(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const plan::GreyImage image = plan::parsePgm(textOf(bytes, size), "picture");
    require(image.pixels.size() ==
            static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  });
}

/// The map file for such a picture.
void ros2Map(const uint8_t* bytes, size_t size) {
  constexpr char kPicture[] = "P2\n3 2\n255\n0 100 205 254 255 30\n";
  static const NamedFile picture(reinterpret_cast<const uint8_t*>(kPicture), sizeof kPicture - 1,
                                 ".pgm");
  std::string text = textOf(bytes, size);
  const size_t at = text.find("PICTURE");
  if (at != std::string::npos) text.replace(at, 7, picture.path());
  const NamedFile file(reinterpret_cast<const uint8_t*>(text.data()), text.size(), ".yaml");
  refusing([&] { plan::gridForFootprint(plan::readMap(file.path())); });
}

void sbplMap(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const plan::MapFile map = plan::parseSbplEnvironment(textOf(bytes, size), "map");
    plan::gridForPoint(map);
  });
}

void primitives(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const plan::PrimitiveFile file = plan::parsePrimitives(textOf(bytes, size), "primitives");
    plan::onLattice(file, {});
    plan::headingFree(file, {});
  });
}

void lattice(const uint8_t* bytes, size_t size) {
  const MemoryFile memory(bytes, size);
  refusing([&] {
    const plan::PrimitiveFile file = plan::readLattice(memory.path());
    plan::onLattice(file, {});
    plan::headingFree(file, {});
  });
}

void queries(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const auto read = plan::parseQueries(textOf(bytes, size), "queries");
    require(plan::parseQueries(plan::formatQueries(read), "again").size() == read.size());
  });
}

/// Including the command lines of its processes.
void launchFile(const uint8_t* bytes, size_t size) {
  const launch::LaunchSettings settings{"/robot/launch.yaml", "/run/robot", "/bin", "", {}};
  const MemoryFile file(bytes, size);
  refusing([&] { launch::readLaunchName(file.path()); });
  configuration(bytes, size, [&](ConfigReader& reader) {
    const launch::LaunchFile read = launch::readLaunchFile(reader, settings);
    for (const launch::LaunchProcess& process : read.processes)
      require(!launch::startCommand(process, process.program, read.lcm_url, read.key).empty());
  });
}

/// A run folder's path: refused, or identical in every process.
void runPath(const uint8_t* bytes, size_t size) {
  launch::FolderFacts folder;
  folder.path = "/" + textOf(bytes, size);
  folder.writable = true;
  folder.free_bytes = INT64_MAX;
  if (!launch::checkFolder(folder).empty()) return;
  const std::string device = folder.path + "/devices/ins";
  const std::string set = "address=tty:" + device + "?baud=460800";
  ConfigReader reader = ConfigReader::fromText("address: none", "driver", {set});
  std::string address;
  reader.text("address", address);
  require(parseLinkAddress(address).path == device);
}

/// Signs of life of a running process, and the output of `ip route`.
void lifeSigns(const uint8_t* bytes, size_t size) {
  launch::routeDevice(textOf(bytes, size));
  launch::LaunchProcess planner;
  planner.name = "planner";
  launch::Liveness liveness({planner});
  liveness.started("planner", 1234);
  std::istringstream lines(textOf(bytes, size));
  for (std::string line; std::getline(lines, line);) {
    liveness.hear(1234, line);
    liveness.pass(0.7);
  }
}

bool isShare(double share) {
  return std::abs(share) <= 1.0;
}

void gamepad(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] {
    drive::RecordedPad pad(file.path());
    for (const int64_t now : {1'000'000L, 1'020'000L, 2'000'000L, 2'000'000'000'000'000'000L}) {
      const drive::Wishes wishes = pad.read(now);
      for (const double share : {wishes.forward, wishes.turn})
        require(std::isnan(share) || isShare(share));
    }
  });
}

/// Times between the pieces come from the bytes, too.
void keyboard(const uint8_t* bytes, size_t size) {
  drive::KeyState keys;
  int64_t now = 1'000'000;
  for (size_t at = 0; at < size; at += 3) {
    now += 2000 * bytes[at];
    keys.take({reinterpret_cast<const char*>(bytes) + at, std::min<size_t>(3, size - at)}, now);
    const drive::Wishes wishes = keys.wishes(now);
    require(isShare(wishes.forward) && isShare(wishes.turn));
  }
}

/// Recordings for tread-replay mapping.
void carmenLog(const uint8_t* bytes, size_t size) {
  const NamedFile file(bytes, size, ".clf");
  refusing([&] { readMappingRecording(file.path()); });
}

void mbotLog(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] { readMappingRecording(file.path()); });
}

const char* const kLogged[] = {"INS",         "MOTOR",     "EXECUTION",     "MARK",     "CONFIG",
                               "PATTERN_SET", "HEALTH",    "LEARNER_STATE", "LEARNING", "PLAN",
                               "GOAL",        "PLAN_TREE", "SCAN",          "MAP"};

/// Messages in the order of a log: channel, time since the previous one [ms], length, bytes.
std::vector<LogEvent> eventsIn(const uint8_t* bytes, size_t size) {
  std::vector<LogEvent> events;
  int64_t now = 1'000'000;
  for (size_t at = 0; at + 4 <= size;) {
    const size_t length =
        std::min<size_t>(size_t{bytes[at + 2]} * 256 + bytes[at + 3], size - at - 4);
    now += 1000 * bytes[at + 1];
    const uint8_t* const begin = bytes + at + 4;
    events.push_back({now, kLogged[bytes[at] % std::size(kLogged)], {begin, begin + length}});
    at += 4 + length;
  }
  return events;
}

/// All uses of a drive's log by the tools.
void driveLog(const uint8_t* bytes, size_t size) {
  const std::vector<LogEvent> events = eventsIn(bytes, size);
  const DriveTimeline drive = timelineOf(DriveReader(events));
  const report::Chronicle chronicle(drive);
  chronicle.summary(0);
  chronicle.words();
  report::HandRecord(drive).words();
  refusing([&] { replay::learnerLives(toRobotLog("log", events), shippedSet()); });
  refusing([&] { gap::toDrive(toDriveLog("log", events)); });
}

}  // namespace

void addToolTargets(std::map<std::string, Target>& all) {
  all.insert({
      {"carmen_log", carmenLog},
      {"csv", csv},
      {"csv_mapped", mappedCsv},
      {"drive_log", driveLog},
      {"gamepad", gamepad},
      {"keyboard", keyboard},
      {"lattice", lattice},
      {"launch_file", launchFile},
      {"map_picture", mapPicture},
      {"mbot_log", mbotLog},
      {"mcap", mcapFile},
      {"mcap_order", mcapOrder},
      {"packed", packedFile},
      {"primitives", primitives},
      {"queries", queries},
      {"recipe", recipe},
      {"recorded_drive", recordedDrive},
      {"run_path", runPath},
      {"ros2_map", ros2Map},
      {"sbpl_map", sbplMap},
      {"session_table", sessionTable},
      {"life_signs", lifeSigns},
      {"surface_file", surfaceFile},
      {"transition_world", transitionWorld},
  });
}

}  // namespace tread::fuzz

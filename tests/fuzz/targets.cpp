// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/fuzz/targets.hpp"

#include <cstdlib>
#include <sstream>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

#include "common/config/config_reader.hpp"
#include "common/log/event_log.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/seal/seal.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "modules/planner/planner_node.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "modules/simulator/simulator_files.hpp"
#ifdef TREAD_WITH_TOOLS
#include "common/recordings/csv_table.hpp"
#include "common/recordings/recordings.hpp"
#endif

namespace tread::fuzz {
namespace {

std::string textOf(const uint8_t* bytes, size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// What a broken promise of a reader is told by.
void require(bool kept) {
  if (!kept) std::abort();
}

/// A file of these bytes that is nowhere on a disk.
class MemoryFile {
 public:
  MemoryFile(const uint8_t* bytes, size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    require(descriptor_ >= 0 && write(descriptor_, bytes, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// What is taken as a message is the same once more when it is sent.
template <class Message>
void decodeAs(const uint8_t* bytes, size_t size) {
  std::vector<uint8_t> whole;
  const auto fingerprint = static_cast<uint64_t>(Message::getHash());
  for (int shift = 56; shift >= 0; shift -= 8)
    whole.push_back(static_cast<uint8_t>(fingerprint >> shift));
  whole.insert(whole.end(), bytes, bytes + size);
  Message message{};
  const int length = static_cast<int>(whole.size());
  if (message.decode(whole.data(), 0, length) != length) return;
  std::vector<uint8_t> again(static_cast<size_t>(message.getEncodedSize()));
  const int written = message.encode(again.data(), 0, static_cast<int>(again.size()));
  require(written == static_cast<int>(again.size()));
}

/// The first byte chooses the type; its fingerprint stands in front, so that the rest is looked at.
/// A new type comes last: the inputs in the corpus name theirs by its place here.
void message(const uint8_t* bytes, size_t size) {
  constexpr Target kTypes[] = {decodeAs<ins_t>,           decodeAs<scan_t>,
                               decodeAs<map_tile_t>,      decodeAs<goal_t>,
                               decodeAs<plan_t>,          decodeAs<plan_tree_t>,
                               decodeAs<program_t>,       decodeAs<motor_t>,
                               decodeAs<execution_t>,     decodeAs<pattern_set_part_t>,
                               decodeAs<learner_state_t>, decodeAs<learning_t>,
                               decodeAs<health_t>,        decodeAs<arm_t>,
                               decodeAs<operator_t>,      decodeAs<estop_t>,
                               decodeAs<mark_t>,          decodeAs<config_t>,
                               decodeAs<manual_t>,        decodeAs<fence_t>,
                               decodeAs<stopping_t>};
  static_assert(std::size(kTypes) == kChannels.size());
  if (size > 0) kTypes[bytes[0] % std::size(kTypes)](bytes + 1, size - 1);
}

void seal(const uint8_t* bytes, size_t size) {
  require(sizeWithoutSeal(bytes, size) <= size);
  Sealer sealer(SealKey{}, 1, 1);
  require(sealer.open("ARM", bytes, size, 1'000'000).size <= size);
}

void log(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  LogReader reader(file.path());
  LogEvent event;
  while (reader.next(event)) require(event.bytes.size() <= size);
}

/// Parts of a set, each behind its length in two bytes.
void patternSetParts(const uint8_t* bytes, size_t size) {
  PatternSetAssembler sets;
  size_t at = 0;
  while (at + 2 <= size) {
    const size_t length = std::min<size_t>(size_t{bytes[at]} * 256 + bytes[at + 1], size - at - 2);
    pattern_set_part_t part{};
    const int expected = static_cast<int>(length);
    if (part.decode(bytes + at + 2, 0, expected) == expected) sets.add(part);
    at += 2 + length;
  }
}

/// What a reader refuses it refuses in one line.
template <class Read>
void refusing(Read read) {
  try {
    read();
  } catch (const std::runtime_error& refusal) {
    require(refusal.what()[0] != '\0');
  }
}

void patternFile(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const PatternSet set = parsePatterns(textOf(bytes, size), "set");
    require(parsePatterns(formatPatterns(set), "again").checksum() == set.checksum());
  });
}

void modelFile(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const ModelDocument document = parseModelDocument(textOf(bytes, size), "model");
    parseModelDocument(formatModelDocument(document), "again");
  });
}

template <class Read>
void configuration(const uint8_t* bytes, size_t size, Read read) {
  refusing([&] {
    ConfigReader reader = ConfigReader::fromText(textOf(bytes, size), "configuration");
    read(reader);
    reader.finish();
  });
}

/// Each process's own, with the robot in the same text.
void configurations(const uint8_t* bytes, size_t size) {
  configuration(bytes, size, readRobot);
  configuration(bytes, size, planner::readPlannerConfig);
  configuration(bytes, size, planner::readLoggedPlannerConfig);
  configuration(bytes, size, motor::readMotorBridgeConfig);
}

/// With the fingerprint at its end, so that the rest is looked at.
void learnerState(const uint8_t* bytes, size_t size) {
  static const PatternSet shipped =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  uint64_t hash = 14695981039346656037ULL;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211ULL;
  std::ostringstream end;
  end << "end " << std::hex << hash << '\n';
  std::string why;
  require(learner::parseState(textOf(bytes, size) + end.str(), shipped, why) || !why.empty());
}

/// Times between pieces are in the bytes, too.
void nmea(const uint8_t* bytes, size_t size) {
  ins::NmeaIns source{ins::InsConfig{}};
  int64_t now = 1'000'000;
  for (size_t at = 0; at < size; at += 37) {
    now += 1000 * (bytes[at] % 64);
    source.push({reinterpret_cast<const char*>(bytes) + at, std::min<size_t>(37, size - at)}, now);
    while (const auto estimate = source.next(now)) require(estimate->utime <= now + 60'000'000);
  }
  source.refusals();
}

void roboteqReply(const uint8_t* bytes, size_t size) {
  motor::RoboteqConnection connection{motor::RoboteqConfig{}};
  connection.open();
  int64_t now = 1'000'000;
  for (size_t at = 0; at < size; at += 23) {
    now += 1000 * (bytes[at] % 32);
    connection.receive({reinterpret_cast<const char*>(bytes) + at, std::min<size_t>(23, size - at)},
                       now);
    connection.command({0.5, -0.5}, now);
    connection.poll(now);
    connection.report(now);
    connection.telemetry();
  }
}

void roboteqCommand(const uint8_t* bytes, size_t size) {
  sim::RoboteqEmulator emulator;
  emulator.receive(textOf(bytes, size), 1'000'000);
  for (int64_t now = 1'000'000; now < 3'000'000; now += 50'000) {
    for (const double power : emulator.output(now)) require(power >= -1.0 && power <= 1.0);
    emulator.transmit(now);
  }
}

void scip(const uint8_t* bytes, size_t size) {
  sim::ScipEmulator emulator(sim::ScipSettings{}, 1);
  emulator.receive(textOf(bytes, size), 1'000'000);
  sim::LaserScan scan;
  scan.ranges.assign(541, 2.0F);
  emulator.add(scan);
  emulator.transmit(1'100'000);
}

void world(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] { sim::readWorld(file.path()); });
}

#ifdef TREAD_WITH_TOOLS
void csv(const uint8_t* bytes, size_t size) {
  refusing([&] {
    const recordings::CsvTable table(textOf(bytes, size), "table");
    for (size_t row = 0; row < table.rows(); ++row) refusing([&] { table.number(row, "x"); });
  });
}

void surfaceFile(const uint8_t* bytes, size_t size) {
  static const PatternSet shipped =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  refusing([&] { recordings::parseSurface(textOf(bytes, size), "surface", "grass", shipped); });
}
#endif

}  // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> kTargets{
      {"message", message},
      {"seal", seal},
      {"log", log},
      {"pattern_set_parts", patternSetParts},
      {"pattern_file", patternFile},
      {"model_file", modelFile},
      {"configurations", configurations},
      {"learner_state", learnerState},
      {"nmea", nmea},
      {"roboteq_reply", roboteqReply},
      {"roboteq_command", roboteqCommand},
      {"scip", scip},
      {"world", world},
#ifdef TREAD_WITH_TOOLS
      {"csv", csv},
      {"surface_file", surfaceFile},
#endif
  };
  return kTargets;
}

}  // namespace tread::fuzz

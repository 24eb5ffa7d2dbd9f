// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/fuzz/targets.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "common/bus/lcm_address.hpp"
#include "common/bus/tcp_relay.hpp"
#include "common/link/make_link.hpp"
#include "common/log/event_log.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/seal/key_file.hpp"
#include "common/seal/seal.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/ins_driver/novatel/novatel_ins.hpp"
#include "modules/ins_driver/ublox/ublox_ins.hpp"
#include "modules/ins_driver/vectornav/vectornav_ins.hpp"
#include "modules/ins_driver/xsens/xsens_ins.hpp"
#include "modules/learner/core/rules/multi_model.hpp"
#include "modules/learner/core/state_text.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"
#include "modules/mapping/mapping_node.hpp"
#include "modules/motor_bridge/kangaroo/kangaroo_connection.hpp"
#include "modules/motor_bridge/line_protocol/line_connection.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "modules/motor_bridge/vesc/vesc_connection.hpp"
#include "modules/planner/planner_node.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "modules/simulator/emulators/kangaroo/kangaroo_emulator.hpp"
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "modules/simulator/emulators/sabertooth/sabertooth_emulator.hpp"
#include "modules/simulator/emulators/vesc/vesc_emulators.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "modules/simulator/simulator_node.hpp"
#include "tests/fuzz/reading.hpp"

namespace tread::fuzz {
namespace {

/// An accepted message must survive encoding and decoding.
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

/// The first byte selects the type; its fingerprint is prepended, so that the content is decoded.
/// Add new types at the end: corpus inputs refer to a type by its index here.
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
                               decodeAs<stopping_t>,      decodeAs<shock_t>,
                               decodeAs<grip_t>,          decodeAs<fences_t>};
  // INS and SCAN_MATCHING have the same type.
  static_assert(std::size(kTypes) + 1 == kChannels.size());
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

/// Parts of a set, each preceded by its length in two bytes.
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

/// The configuration of each process, including the robot, in one text.
void configurations(const uint8_t* bytes, size_t size) {
  configuration(bytes, size, readRobot);
  configuration(bytes, size, planner::readPlannerConfig);
  configuration(bytes, size, planner::readLoggedPlannerConfig);
  configuration(bytes, size, motor::readMotorBridgeConfig);
  configuration(bytes, size, ins::readInsDriverConfig);
  configuration(bytes, size, learner::readLearnerConfig);
  configuration(bytes, size, lidar::readLidarDriverConfig);
  configuration(bytes, size, mapping::readMappingConfig);
  configuration(bytes, size, sim::readSimulatorConfig);
  refusing([&] { ins::originFrom(textOf(bytes, size)); });
}

/// Lines, each with an address of a device or bus.
void addresses(const uint8_t* bytes, size_t size) {
  std::istringstream lines(textOf(bytes, size));
  for (std::string line; std::getline(lines, line);) {
    parseLcmUrl(line);
    try {
      parseLinkAddress(line);
    } catch (const std::invalid_argument& refusal) {
      require(refusal.what()[0] != '\0');
    }
  }
}

/// A client of the relay on this host, which must then serve the next one.
void relay(const uint8_t* bytes, size_t size) {
  static const TcpRelay server(0);
  static const auto port =
      static_cast<uint16_t>(std::stoi(server.url().substr(server.url().rfind(':') + 1)));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // From varying addresses: a single one would run out of ports after some ten thousand clients.
  static uint32_t clients = 0;
  sockaddr_in own = address;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK + ++clients / 1000);
  require(bind(client, reinterpret_cast<sockaddr*>(&own), sizeof own) == 0);
  address.sin_port = htons(port);
  require(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  send(client, bytes, size, MSG_NOSIGNAL);
  shutdown(client, SHUT_WR);
  char answer[4096];
  while (recv(client, answer, sizeof answer, 0) > 0) {
  }
  close(client);
}

/// A key file must be private; a memory file becomes so only by fchmod.
void keyFile(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  chmod(file.path().c_str(), 0600);
  refusing([&] { readKey(file.path()); });
}

void learnerState(const uint8_t* bytes, size_t size) {
  std::string why;
  require(learner::parseState(sealed(bytes, size), shippedSet(), why) || !why.empty());
}

/// Numbers as a rule's memory: accepted content is written back unchanged and gives finite
/// predictions; refused content changes nothing.
void ruleMemory(const uint8_t* bytes, size_t size) {
  static const learner::MultiModel kFresh(learner::RuleConfig{}, shippedSet());
  static const learner::TrajectoryTable kPredictions(shippedSet().patterns());
  std::istringstream words(textOf(bytes, size));
  std::vector<double> memory;
  for (std::string word; words >> word;) memory.push_back(std::strtod(word.c_str(), nullptr));
  learner::MultiModel rule = kFresh;
  if (!rule.restore(kPredictions, memory)) {
    require(rule.memory() == kFresh.memory());
    return;
  }
  require(rule.memory() == memory);
  for (size_t p = 0; p < shippedSet().patterns().size(); ++p) {
    const Pose2 end = rule.predictEnd(p);
    require(std::isfinite(end.x + end.y + end.yaw));
    const PoseCovariance covariance = *rule.endCovariance(p);
    for (const double number : covariance) require(std::isfinite(number));
  }
}

/// As the version counter, and as unsealed states.
void learnerFiles(const uint8_t* bytes, size_t size) {
  MemoryStore store;
  for (const char* name : {"learner_versions", "learner_state_1"})
    store.write(name, textOf(bytes, size));
  learner::LearnerMemory memory(store);
  require(memory.recall(shippedSet(), 1'700'000'000'000'000).first_version > 0);
}

/// Times between the pieces come from the bytes, too.
template <class Source>
void insBytes(const uint8_t* bytes, size_t size) {
  Source source{ins::InsConfig{}};
  int64_t now = 1'000'000;
  for (size_t at = 0; at < size; at += 37) {
    now += 1000 * (bytes[at] % 64);
    source.push({reinterpret_cast<const char*>(bytes) + at, std::min<size_t>(37, size - at)}, now);
    while (const auto estimate = source.next(now)) require(estimate->utime <= now + 60'000'000);
  }
  source.refusals();
}

/// Output of a motor controller in pieces; times between them come from the bytes, too.
void hearController(motor::MotorController& connection, const uint8_t* bytes, size_t size) {
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

void roboteqReply(const uint8_t* bytes, size_t size) {
  motor::RoboteqConnection connection{motor::RoboteqConfig{}};
  hearController(connection, bytes, size);
}

void kangarooReply(const uint8_t* bytes, size_t size) {
  motor::KangarooConnection connection{motor::KangarooConfig{}};
  hearController(connection, bytes, size);
}

void vescReply(const uint8_t* bytes, size_t size) {
  motor::VescUart connection{motor::VescConfig{}};
  hearController(connection, bytes, size);
}

void vescFrames(const uint8_t* bytes, size_t size) {
  motor::VescCan connection{motor::VescConfig{}};
  hearController(connection, bytes, size);
}

/// A fictitious controller that is defined by its description only.
void lineReply(const uint8_t* bytes, size_t size) {
  static const motor::LineDescription kDescription = [] {
    ConfigReader reader =
        ConfigReader::fromFile(std::string(TREAD_SOURCE_DIR) + "/tests/data/controllers/mole.yaml");
    return motor::readLineDescription(reader, DriveDescription{});
  }();
  motor::LineConnection connection{kDescription};
  hearController(connection, bytes, size);
}

/// A description, followed by input for its lines.
void lineDescription(const uint8_t* bytes, size_t size) {
  configuration(bytes, size, [](ConfigReader& reader) {
    const motor::LineDescription line = motor::readLineDescription(reader, DriveDescription{});
    for (const auto& list : {line.command, line.stop, line.errors})
      for (const motor::LineTemplate& text : list) text.match(text.format({{"left", 1e9}}));
  });
}

/// Commands to an emulated controller: its output stays a power.
template <class Emulator>
void commandEmulator(const uint8_t* bytes, size_t size) {
  Emulator emulator;
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

/// The simulator's record of a drive.
void truthRecord(const uint8_t* bytes, size_t size) {
  const MemoryFile file(bytes, size);
  refusing([&] { sim::readTruthRecord(file.path()); });
}

}  // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> kTargets = [] {
    std::map<std::string, Target> all{
        {"addresses", addresses},
        {"configurations", configurations},
        {"key_file", keyFile},
        {"learner_files", learnerFiles},
        {"learner_state", learnerState},
        {"kangaroo_command", commandEmulator<sim::KangarooEmulator>},
        {"kangaroo_reply", kangarooReply},
        {"line_command", commandEmulator<sim::MoleEmulator>},
        {"line_description", lineDescription},
        {"line_reply", lineReply},
        {"log", log},
        {"message", message},
        {"model_file", modelFile},
        {"nmea", insBytes<ins::NmeaIns>},
        {"novatel", insBytes<ins::NovatelIns>},
        {"pattern_file", patternFile},
        {"pattern_set_parts", patternSetParts},
        {"relay", relay},
        {"roboteq_command", commandEmulator<sim::RoboteqEmulator>},
        {"roboteq_reply", roboteqReply},
        {"rule_memory", ruleMemory},
        {"sabertooth_command", commandEmulator<sim::SabertoothEmulator>},
        {"scip", scip},
        {"seal", seal},
        {"truth_record", truthRecord},
        {"ublox", insBytes<ins::UbloxIns>},
        {"vectornav", insBytes<ins::VectornavIns>},
        {"vesc_can_command", commandEmulator<sim::VescCanEmulator>},
        {"vesc_command", commandEmulator<sim::VescUartEmulator>},
        {"vesc_frames", vescFrames},
        {"vesc_reply", vescReply},
        {"world", world},
        {"xsens", insBytes<ins::XsensIns>},
    };
    addRangeFinderTargets(all);
#ifdef TREAD_WITH_TOOLS
    addToolTargets(all);
#endif
    return all;
  }();
  return kTargets;
}

}  // namespace tread::fuzz

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "type_samples.hpp"

namespace tread {

TEST_CASE("every type round-trips, byte for byte") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    INFO(Message::getTypeName());
    const auto bytes = testing::encode(sample);
    REQUIRE_FALSE(bytes.empty());
    Message decoded{};
    REQUIRE(testing::decode(bytes, decoded));
    CHECK(testing::encode(decoded) == bytes);
  });
}

TEST_CASE("an empty message of every type round-trips, too") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    INFO(Message::getTypeName());
    const auto bytes = testing::encode(Message{});
    Message decoded{};
    REQUIRE(testing::decode(bytes, decoded));
    CHECK(testing::encode(decoded) == bytes);
    CHECK(bytes != testing::encode(sample));
  });
}

TEST_CASE("decoded fields have the values that were sent") {
  auto sent = testing::sampleOf<program_t>();
  sent.lease = 200'000;
  sent.running.execution_id = 51;
  sent.next.execution_id = 62;
  sent.next.command = {{0.5F, -0.5F}, {1.0F, -1.0F}};
  sent.inputs_heard = 63;
  sent.newest_input = "INS";
  sent.newest_input_utime = 1'000'012;
  sent.newest_input_seq = 12;
  program_t program{};
  REQUIRE(testing::decode(testing::encode(sent), program));
  CHECK(program.lease == 200'000);
  CHECK(program.running.execution_id == 51);
  CHECK(program.next.execution_id == 62);
  CHECK(program.next.command[1] == std::vector<float>{1.0F, -1.0F});
  CHECK(program.inputs_heard == 63);
  CHECK(program.newest_input == "INS");
  CHECK(program.newest_input_utime == 1'000'012);
  CHECK(program.newest_input_seq == 12);
  auto sent_tile = testing::sampleOf<map_tile_t>();
  sent_tile.cells = {static_cast<uint8_t>(map_tile_t::CELL_OBSTACLE),
                     static_cast<uint8_t>(map_tile_t::CELL_UNKNOWN)};
  map_tile_t tile{};
  REQUIRE(testing::decode(testing::encode(sent_tile), tile));
  CHECK(tile.cells[0] == map_tile_t::CELL_OBSTACLE);
  CHECK(tile.cells[1] == map_tile_t::CELL_UNKNOWN);
  auto sent_scan = testing::sampleOf<scan_t>();
  sent_scan.ranges = {std::numeric_limits<float>::infinity(),
                      std::numeric_limits<float>::quiet_NaN()};
  sent_scan.points[0] = {1.0F, -2.0F, 0.5F};
  scan_t scan{};
  REQUIRE(testing::decode(testing::encode(sent_scan), scan));
  CHECK(std::isinf(scan.ranges[0]));
  CHECK(std::isnan(scan.ranges[1]));
  CHECK(scan.points[0][1] == -2.0F);
}

TEST_CASE("all fingerprints differ, so that no type is taken for another") {
  // LCM's fingerprint does not include a type's name: two types with equal fields would share it.
  std::map<int64_t, std::string> types;
  testing::forEachType([&](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const auto [entry, fresh] = types.emplace(Message::getHash(), Message::getTypeName());
    INFO(Message::getTypeName() << " and " << entry->second);
    CHECK(fresh);
  });
}

TEST_CASE("no type decodes as another") {
  // Compiled code grows with the number of types, not of pairs.
  struct Type {
    std::string name;
    std::vector<uint8_t> sample;
    std::function<bool(const std::vector<uint8_t>&)> decodes;
  };
  std::vector<Type> types;
  testing::forEachType([&](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    types.push_back({Message::getTypeName(), testing::encode(sample), [](const auto& bytes) {
                       Message received{};
                       return testing::decode(bytes, received);
                     }});
  });
  for (const Type& sent : types)
    for (const Type& read : types) {
      INFO(sent.name << " as " << read.name);
      CHECK(read.decodes(sent.sample) == (read.name == sent.name));
    }
}

TEST_CASE("these tests know every type of lcmtypes") {
  std::set<std::string> tested;
  testing::forEachType(
      [&](const auto& sample) { tested.insert(std::decay_t<decltype(sample)>::getTypeName()); });
  std::set<std::string> written;
  const std::filesystem::path folder = std::string(TREAD_SOURCE_DIR) + "/lcmtypes/tread";
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".lcm") written.insert(file.path().stem().string());
  CHECK(tested == written);
}

}  // namespace tread

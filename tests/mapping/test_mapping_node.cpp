// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <limits>

#include "common/bus/virtual_bus.hpp"
#include "modules/mapping/mapping_node.hpp"
#include "tests/helpers.hpp"
#include "tests/mapping/small_world.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

/// As if it were next to the shipped files.
const std::string kHere = TREAD_SOURCE_DIR "/config/robots/teodor/mapping.yaml";

MappingConfig usualConfig() {
  MappingConfig config;
  config.map = usualMap();
  return config;
}

using tread::testing::kNan;

ins_t insAt(int64_t utime, int64_t seq, const Eigen::Isometry3d& T_map_body) {
  ins_t message{};
  message.utime = utime;
  message.seq = seq;
  const Eigen::Quaterniond q(T_map_body.linear());
  const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
  for (int i = 0; i < 3; ++i) message.position[i] = T_map_body.translation()[i];
  for (int i = 0; i < 4; ++i) message.orientation[i] = orientation[i];
  return message;
}

/// Ranges of a level range finder on a standing robot.
scan_t scanAt(int64_t utime, int64_t seq, const SmallWorld& world,
              const Eigen::Isometry3d& T_map_body) {
  RangeFinder range_finder;
  range_finder.beams = 181;
  scan_t message{};
  message.utime = utime;
  message.seq = seq;
  message.sensor_position[0] = 0.25;
  message.sensor_position[2] = 0.5;
  message.sensor_orientation[0] = 1.0;
  message.duration = 18'000;
  message.angle_first = -0.75 * kPi;
  message.angle_step = 1.5 * kPi / 180.0;
  message.range_min = 0.1;
  message.range_max = 15.0;
  message.num_beams = range_finder.beams;
  for (int i = 0; i < range_finder.beams; ++i) {
    const Beam beam = range_finder.cast(world, T_map_body, i);
    message.ranges.push_back(beam.hit ? static_cast<float>(beam.end.norm())
                                      : std::numeric_limits<float>::infinity());
  }
  return message;
}

/// Plays INS at 50 Hz, 20 ms late, and SCAN at 10 Hz; the robot stands or drives along x.
class Instruments : public Node {
 public:
  Instruments(Bus& bus, const SmallWorld& world) : bus_(bus), world_(world) {}

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override {
    const Eigen::Isometry3d pose = world_.stand(x, 0, 0);
    if (ins_works) {
      ins_t message = insAt(utime - 20'000, seq_, pose);
      message.ins_status = status;
      if (breakIns) breakIns(message);
      bus_.publish(kIns, message);
    }
    status = ins_t::STATUS_GOOD;
    if (seq_++ % 5 == 0 && scans_work) {
      scan_t scan = scanAt(utime - 60'000, seq_ / 5, world_, pose);
      if (breakScan) breakScan(scan);
      bus_.publish(kScan, scan);
    }
    x += speed * 0.02;
  }

  double x = 0.0;
  double speed = 0.0;
  int32_t status = ins_t::STATUS_GOOD;
  bool ins_works = true;
  bool scans_work = true;
  std::function<void(ins_t&)> breakIns;
  std::function<void(scan_t&)> breakScan;

 private:
  Bus& bus_;
  const SmallWorld& world_;
  int64_t seq_ = 0;
};

/// A bus whose time is initially unknown, as for a process that follows the messages' time.
class FollowingBus : public Bus {
 public:
  int64_t now() const override { return time; }
  int64_t bootId() const override { return 1; }
  void tell(const ins_t& message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    receive(kIns.name, bytes.data(), bytes.size());
  }

  int64_t time = 0;
  health_t health{};  // the last that was sent

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    if (std::string(channel) == kHealth.name) health.decode(bytes, 0, static_cast<int>(size));
    return true;
  }
  void listen(const char* /*channel*/) override {}
};

/// The node, its instruments and subscribers.
struct Rig {
  explicit Rig(const FaultPlan& faults = {}, uint64_t seed = 1) : bus(seed, faults) {
    world.boxes = {{{4.03, -2.0, -1.0}, {4.4, 2.0, 2.0}}};
    bus.outside().subscribe<map_tile_t>(kMap, [this](const map_tile_t& m) { hear(m); });
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& m) { health = m; });
    bus.outside().subscribe<config_t>(kConfig,
                                      [this](const config_t& m) { config_text = m.config_text; });
    bus.addNode("instruments",
                [this](Bus& end) { return std::make_unique<Instruments>(end, world); });
    bus.addNode("mapping", [this](Bus& end) { return std::make_unique<MappingNode>(config, end); });
  }

  void run(double seconds) { bus.runUntil(bus.now() + std::llround(seconds * 1e6)); }
  Instruments& instruments() { return dynamic_cast<Instruments&>(*bus.node("instruments")); }
  Cell at(double x, double y) const {
    const CellIndex cell = Grid(0.1, {}, 0, 0).indexOf({x, y});
    return tiles.window(cell, 1, 1).at(cell);
  }
  int64_t counted(const std::string& name) const {
    for (const counter_t& counter : health.counters)
      if (counter.counter_name == name) return counter.counted;
    return 0;
  }

  SmallWorld world;
  MappingConfig config = usualConfig();
  VirtualBus bus;
  TileMap tiles{0.1, 32};
  health_t health{};
  std::string config_text;
  std::map<std::pair<int, int>, int> times_sent;
  std::map<int64_t, size_t> bytes_at;

 private:
  void hear(const map_tile_t& message) {
    times_sent[{message.tile_x, message.tile_y}] += 1;
    bytes_at[bus.now()] += static_cast<size_t>(message.getEncodedSize());
    tiles.put({message.tile_x, message.tile_y, message.utime, message.cells});
  }
};

}  // namespace

TEST_CASE("mapping makes tiles from scans and INS: wall, free space, unknown") {
  Rig rig;
  rig.run(3.0);
  REQUIRE(rig.at(4.05, 0.0) == kObstacle);
  REQUIRE(rig.at(3.0, 0.0) == kFree);
  REQUIRE(rig.at(6.0, 0.0) == kUnknown);
  REQUIRE(rig.health.health_state == health_t::HEALTH_OK);
  REQUIRE(rig.counted("scans taken") >= 19);
  REQUIRE(rig.counted("scans refused: no INS at its time") == 0);
}

TEST_CASE("every tile that was seen is sent within the refresh period, changed or not") {
  Rig rig;
  rig.run(2.0);
  rig.times_sent.clear();
  rig.run(2.2);
  const auto& node = dynamic_cast<MappingNode&>(*rig.bus.node("mapping"));
  REQUIRE(rig.times_sent.size() == node.map().seenTiles().size());
  REQUIRE(rig.times_sent.size() > 30);
}

TEST_CASE("mapping never sends more than 100 kB in 20 ms, however large the window") {
  Rig rig;
  rig.config.map.window_tiles = 24;
  rig.config.map.clearing_range = 35.0;
  rig.bus.kill("mapping");
  rig.bus.restart("mapping");
  rig.world.boxes.clear();
  rig.instruments().breakScan = [](scan_t& scan) {
    scan.range_max = 40.0;
    for (float& range : scan.ranges) range = 40.0f;
  };
  rig.run(3.0);
  REQUIRE(rig.times_sent.size() > 200);
  for (const auto& [utime, bytes] : rig.bytes_at) REQUIRE(bytes < 100'000);
}

TEST_CASE("a scan without INS around it is dropped and counted, and the map goes on afterwards") {
  Rig rig;
  rig.run(1.0);
  rig.instruments().ins_works = false;
  rig.run(2.5);
  REQUIRE(rig.counted("scans refused: no INS at its time") > 5);
  REQUIRE(rig.health.health_state == health_t::HEALTH_DEGRADED);
  REQUIRE(rig.health.health_reason.find("no INS with a pose comes") != std::string::npos);
  rig.instruments().ins_works = true;
  rig.run(2.5);
  REQUIRE(rig.health.health_state == health_t::HEALTH_OK);
  REQUIRE(rig.counted("scans refused: gap in INS at its time") <= 7);  // those that waited
}

TEST_CASE("silence is counted from when the robot's time is known, not from zero") {
  FollowingBus bus;
  MappingNode node(usualConfig(), bus);
  bus.time = 20'000;
  node.step(bus.time);
  // The robot has run for six days.
  bus.time = 500'000'000'000;
  bus.tell(insAt(bus.time, 1, Eigen::Isometry3d::Identity()));
  node.step(bus.time);
  bus.time += 2'500'000;
  node.step(bus.time);
  REQUIRE(bus.health.health_reason.find("for 2 s: no SCAN comes") != std::string::npos);
}

TEST_CASE("no scans: mapping says so in one line") {
  Rig rig;
  rig.instruments().scans_work = false;
  rig.run(3.5);
  REQUIRE(rig.health.health_state == health_t::HEALTH_DEGRADED);
  REQUIRE(rig.health.health_reason.find("is lidar_driver running?") != std::string::npos);
}

TEST_CASE("a jump of the INS begins a new map, whether it is told or not") {
  Rig rig;
  rig.run(2.0);
  REQUIRE(rig.at(4.05, 0.0) == kObstacle);
  rig.instruments().status = ins_t::STATUS_JUMP;
  rig.run(1.0);
  REQUIRE(rig.counted("new maps: INS jumped") == 1);
  rig.instruments().x = 30.0;
  rig.run(2.0);
  REQUIRE(rig.counted("new maps: INS jumped") == 2);
  const auto& node = dynamic_cast<MappingNode&>(*rig.bus.node("mapping"));
  REQUIRE(node.map().grid().at(node.map().grid().indexOf({33.0, 0.0})) == kFree);
}

TEST_CASE("INS without pose, from the future or late is refused and counted") {
  Rig rig;
  int i = 0;
  rig.instruments().breakIns = [&i](ins_t& ins) {
    ++i;
    if (i % 10 == 1) ins.position[1] = kNan;
    if (i % 10 == 2) ins.orientation[0] = 7.0;
    if (i % 10 == 3) ins.utime += 5'000'000;
    if (i % 10 == 4) ins.utime -= 100'000;
  };
  rig.run(4.0);
  REQUIRE(rig.counted("INS without pose") > 20);
  REQUIRE(rig.counted("INS refused: time is ahead") > 10);
  REQUIRE(rig.counted("INS refused: not newer") > 10);
  REQUIRE(rig.at(4.05, 0.0) == kObstacle);
}

TEST_CASE("scans with wrong lengths, NaN or absurd numbers are refused with their reason") {
  const std::vector<std::pair<std::function<void(scan_t&)>, std::string>> faults{
      {[](scan_t& s) { s.angle_step = kNan; }, "angles out of one turn"},
      {[](scan_t& s) { s.angle_step = 0.2; }, "angles out of one turn"},
      {[](scan_t& s) { s.angle_step = 0.0; }, "angle step is zero"},
      {[](scan_t& s) { s.angle_first = 1e9; }, "angles out of one turn"},
      {[](scan_t& s) { s.duration = -5; }, "duration out of 0..1 s"},
      {[](scan_t& s) { s.duration = 2'000'000'000; }, "duration out of 0..1 s"},
      {[](scan_t& s) { s.range_max = 0.01; },
       "range limits are not 0 <= range_min < range_max <= 1000 m"},
      {[](scan_t& s) { s.range_min = kNan; },
       "range limits are not 0 <= range_min < range_max <= 1000 m"},
      {[](scan_t& s) { s.sensor_position[0] = kNan; }, "sensor pose is no pose"},
      {[](scan_t& s) { s.sensor_position[1] = kNan; }, "sensor pose is no pose"},
      {[](scan_t& s) { s.sensor_position[2] = kNan; }, "sensor pose is no pose"},
      {[](scan_t& s) { s.sensor_orientation[3] = kNan; }, "sensor pose is no pose"},
      {[](scan_t& s) { s.sensor_orientation[0] = 0.0; }, "sensor pose is no pose"},
      {[](scan_t& s) { s.ranges.resize(90); }, "another number of beams than stated"},
      {[](scan_t& s) {
         s.num_beams = 0;
         s.ranges.clear();
       },
       "no beams, or too many"},
      {[](scan_t& s) { s.num_points = -3; }, "no beams, or too many"},
      {[](scan_t& s) { s.num_beams = 20'000'000; }, "no beams, or too many"},
      {[](scan_t& s) { s.utime = -1; }, "no time"},
      {[](scan_t& s) { s.utime = INT64_MAX; }, "no time"}};
  const scan_t good = scanAt(1'000'000, 0, SmallWorld{}, Eigen::Isometry3d::Identity());
  std::string refusal;
  REQUIRE(readScan(good, refusal));
  for (const auto& [breakIt, reason] : faults) {
    scan_t bad = good;
    breakIt(bad);
    refusal.clear();
    REQUIRE_FALSE(readScan(bad, refusal));
    REQUIRE(refusal == reason);
  }
}

TEST_CASE("beams that are no measurement are left out, those that hit nothing clear") {
  scan_t scan = scanAt(1'000'000, 0, SmallWorld{}, Eigen::Isometry3d::Identity());
  scan.ranges.assign(181, 5.0f);
  scan.ranges[0] = std::numeric_limits<float>::quiet_NaN();
  scan.ranges[1] = 0.05f;
  scan.ranges[2] = std::numeric_limits<float>::infinity();
  scan.ranges[3] = 15.1f;
  scan.ranges[4] = -std::numeric_limits<float>::infinity();
  std::string refusal;
  const auto read = readScan(scan, refusal);
  REQUIRE(read);
  REQUIRE(read->beams.size() == 178);
  REQUIRE_FALSE(read->beams[0].hit);
  REQUIRE(read->beams[0].end.norm() == Approx(15.0));
  REQUIRE(read->beams[0].share == Approx(2.0 / 180.0));
  REQUIRE_FALSE(read->beams[1].hit);
  REQUIRE(read->beams[2].hit);
  REQUIRE(read->last == 1'018'000);
}

TEST_CASE("a slice of points marks what it hits") {
  Rig rig;
  rig.instruments().breakScan = [](scan_t& scan) {
    scan.num_beams = 0;
    scan.ranges.clear();
    for (int i = 0; i < 200; ++i)
      scan.points.push_back({3.0f, 0.01f * static_cast<float>(i) - 1.0f, 0.1f});
    scan.points.push_back({std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f});
    scan.num_points = static_cast<int32_t>(scan.points.size());
  };
  rig.run(1.0);
  REQUIRE(rig.at(3.25, 0.0) == kObstacle);
  REQUIRE(rig.at(2.0, 0.0) == kFree);
}

TEST_CASE("refused scans change nothing and are counted in HEALTH") {
  Rig rig;
  rig.instruments().breakScan = [](scan_t& scan) { scan.range_max = kNan; };
  rig.run(3.5);
  REQUIRE(rig.tiles.tiles().empty());
  REQUIRE(rig.counted("scans refused: range limits are not 0 <= range_min < range_max <= 1000 m") >
          20);
  REQUIRE(rig.health.health_reason.find("range limits") != std::string::npos);
}

TEST_CASE("dropped, doubled, reordered and corrupted messages leave a true map, and no crash") {
  FaultPlan faults;
  MessageFault fault;
  fault.receiver = "mapping";
  fault.drop = 0.1;
  fault.duplicate = 0.1;
  fault.corrupt = 0.05;
  fault.reorder = 0.1;
  faults.messages.push_back(fault);
  for (const uint64_t seed : {1u, 2u, 3u}) {
    Rig rig(faults, seed);
    rig.instruments().speed = 0.5;
    rig.run(5.0);
    CAPTURE(seed, rig.health.health_reason);
    REQUIRE(rig.counted("scans taken") > 35);
    REQUIRE(rig.counted("new maps: INS jumped") == 0);
    REQUIRE(rig.at(3.0, 0.0) == kFree);
    REQUIRE(rig.at(4.05, 0.0) == kObstacle);
  }
}

TEST_CASE("killed and started again mapping has its map back with the next scans") {
  Rig rig;
  rig.run(2.0);
  rig.bus.kill("mapping");
  rig.run(1.0);
  rig.bus.restart("mapping");
  rig.tiles = TileMap(0.1, 32);
  rig.run(0.5);
  REQUIRE(rig.at(4.05, 0.0) == kObstacle);
  REQUIRE(rig.at(2.0, 0.0) == kFree);
}

TEST_CASE(
    "mapping says its whole configuration, and a mistyped key is one line with file and line") {
  ConfigReader good =
      ConfigReader::fromText("cell_size: 0.2\nground: {slope_doubt: 0.05}\n", kHere);
  const MappingConfig config = readMappingConfig(good);
  REQUIRE(config.map.voxels.cell_size == 0.2);
  REQUIRE(config.map.ground.slope_doubt == 0.05);
  REQUIRE(config.effective.find("marking_range: 10") != std::string::npos);
  ConfigReader typo = ConfigReader::fromText("step: 0.1\nmarking_ranje: 9\n", kHere);
  REQUIRE_THROWS_WITH(readMappingConfig(typo),
                      Catch::Contains("mapping.yaml:2") && Catch::Contains("marking_ranje"));
  ConfigReader odd = ConfigReader::fromText("tile_cells: 20\n", kHere);
  REQUIRE_THROWS_WITH(readMappingConfig(odd), Catch::Contains("mapping.yaml:1"));
  ConfigReader low = ConfigReader::fromText(
      "step: 1.0\ncell_size: 0.2\nrobot: ../../../tests/data/robots/small/robot.yaml\n", kHere);
  REQUIRE_THROWS_WITH(
      readMappingConfig(low),
      Catch::Contains("mapping.yaml:1") && Catch::Contains("must be below the robot's height"));
  ConfigReader fine = ConfigReader::fromText("cell_size: 0.05\n", kHere);
  REQUIRE_THROWS_WITH(readMappingConfig(fine),
                      Catch::Contains("mapping.yaml") &&
                          Catch::Contains("a robot of 1.20 m needs larger cells") &&
                          Catch::Contains("1.10 m"));
}

TEST_CASE("the same scans give the same bytes on MAP") {
  const auto bytesOf = [](uint64_t seed) {
    FaultPlan faults;
    MessageFault fault;
    fault.drop = 0.05;
    fault.reorder = 0.05;
    faults.messages.push_back(fault);
    Rig rig(faults, seed);
    std::vector<uint8_t> all;
    rig.bus.setTap([&](int64_t, const char* channel, const uint8_t* bytes, size_t size) {
      if (std::string(channel) == "MAP") all.insert(all.end(), bytes, bytes + size);
    });
    rig.instruments().speed = 0.8;
    rig.run(3.0);
    return all;
  };
  const auto first = bytesOf(9);
  REQUIRE(first.size() > 100'000);
  REQUIRE(first == bytesOf(9));
}

TEST_CASE(
    "where a map begins as much is free as this robot needs to turn, unless a key says more") {
  const auto radiusOf = [](const std::string& text) {
    ConfigReader reader = ConfigReader::fromText(text, kHere);
    return readMappingConfig(reader).map.start_free_radius;
  };
  const std::string small = "robot: ../../../tests/data/robots/small/robot.yaml\n";
  ConfigReader reader = ConfigReader::fromText(small, kHere);
  const FootprintSize outline = readMappingConfig(reader).map.robot;
  const double corner = std::hypot(std::max(outline.front, outline.rear), outline.half_width);
  REQUIRE(radiusOf(small) > corner + 0.2 - 1e-9);
  REQUIRE(radiusOf(small) < corner + 0.3 + 1e-9);
  REQUIRE(radiusOf("cell_size: 0.1\n") == Approx(1.0));  // of a robot 0.73 m from corner to middle
  REQUIRE(radiusOf(small) < 0.95);
  REQUIRE(radiusOf("start_free_radius: 3\n" + small) == 3.0);
}

TEST_CASE("A frozen range finder is named at once, is left out of the map, and recovers") {
  Rig rig;
  rig.world.boxes.push_back({{-3.0, 2.0, -1.0}, {8.0, 2.4, 2.0}});
  rig.run(1.0);
  std::vector<float> last;
  rig.instruments().breakScan = [&](scan_t& scan) {
    if (last.empty()) last = scan.ranges;
    scan.ranges = last;
  };
  rig.run(1.0);
  // At rest it shows the same, so it cannot be detected.
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
  rig.instruments().speed = 0.8;
  rig.run(0.55);
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
  CHECK_THAT(rig.health.health_reason,
             Catch::Contains("range finder at 0.25, 0.00, 0.50 m") &&
                 Catch::Contains("it repeats bit for bit its scans from before the robot moved"));
  rig.instruments().speed = 0.0;
  const int64_t taken = rig.counted("scans taken");
  rig.run(3.0);
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
  CHECK(rig.counted("scans taken") <= taken + 2);
  CHECK(rig.counted("scans refused: range finder not believed") > 20);
  rig.instruments().breakScan = nullptr;
  rig.run(4.0);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
}

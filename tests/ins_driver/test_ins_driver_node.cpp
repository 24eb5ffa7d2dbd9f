// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <functional>
#include <random>
#include <vector>

#include "common/bus/virtual_bus.hpp"
#include "common/link/make_link.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "tests/helpers.hpp"
#include "tests/ins_driver/nmea_lines.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

using tread::testing::kDeg;
using tread::testing::kSecond;

InsDriverConfig configured(const std::string& yaml = "{}") {
  ConfigReader reader = ConfigReader::fromText(yaml, TREAD_SOURCE_DIR "/config/robots/teodor/test");
  return readInsDriverConfig(reader);
}

/// The driver on the virtual bus, and a device at the other end of its line.
class Rig {
 public:
  explicit Rig(const InsDriverConfig& config = configured(), FaultPlan faults = {})
      : bus(1, std::move(faults)), config_(config) {
    std::tie(device, robot) = makePipe();
    bus.outside().subscribe<ins_t>(kIns, [this](const ins_t& m) { track.push_back(m); });
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& m) { health = m; });
    bus.outside().subscribe<config_t>(kConfig,
                                      [this](const config_t& m) { config_text = m.config_text; });
    bus.addNode("ins_driver", [this](Bus& end) {
      return std::make_unique<InsDriverNode>(config_, end, *robot, store);
    });
  }

  void say(const std::string& bytes) {
    device->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  }
  /// 50 Hz of positions and attitudes for a time, driving east at 1 m/s.
  void drive(double seconds) {
    const int epochs = static_cast<int>(std::lround(seconds * 50.0));
    for (int i = 0; i < epochs; ++i) {
      const double time_of_day = 43200.0 + static_cast<double>(bus.now()) * 1e-6;
      say(gga(time_of_day, static_cast<double>(bus.now()) * 1e-6) + pashr(time_of_day, 90.0) +
          vtg(90.0, 3.6));
      bus.runUntil(bus.now() + 20'000);
    }
  }
  void wait(double seconds) { bus.runUntil(bus.now() + std::llround(seconds * 1e6)); }
  int64_t counter(const std::string& name) const {
    for (const counter_t& counter : health.counters) {
      if (counter.counter_name == name) return counter.counted;
    }
    return -1;
  }
  bool healthSays(const std::string& words) const {
    return health.health_reason.find(words) != std::string::npos;
  }

  VirtualBus bus;
  std::unique_ptr<Link> device;
  std::unique_ptr<Link> robot;
  MemoryStore store;
  std::vector<ins_t> track;
  health_t health{};
  std::string config_text;

 private:
  InsDriverConfig config_;
};

/// Bus of a process whose clock advances within a step.
class HostBus : public Bus {
 public:
  int64_t now() const override { return time; }
  int64_t bootId() const override { return 1; }
  int64_t utc() const override { return date; }

  int64_t time = 10 * kSecond;
  int64_t date = -1;
  std::vector<ins_t> track;
  std::string health;

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    ins_t message;
    if (std::string(channel) == "INS" && message.decode(bytes, 0, static_cast<int>(size)) > 0)
      track.push_back(message);
    health_t told;
    if (std::string(channel) == "HEALTH" && told.decode(bytes, 0, static_cast<int>(size)) > 0)
      health = told.health_reason;
    return true;
  }
  void listen(const char* /*channel*/) override {}
};

/// A line whose first read delays the process.
class HeldUpLink : public Link {
 public:
  HeldUpLink(Link& link, std::function<void()> hold_up)
      : link_(link), hold_up_(std::move(hold_up)) {}
  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override {
    if (armed) hold_up_();
    armed = false;
    return link_.read(buffer, capacity);
  }
  bool write(const uint8_t* bytes, size_t size) override { return link_.write(bytes, size); }
  bool isOpen() const override { return link_.isOpen(); }
  bool reopen(int64_t utime) override { return link_.reopen(utime); }
  void close() override { link_.close(); }
  const std::string& address() const override { return link_.address(); }
  std::string problem() const override { return link_.problem(); }

  bool armed = false;

 private:
  Link& link_;
  std::function<void()> hold_up_;
};

}  // namespace

TEST_CASE("a process that is held up before it reads does not take bytes as older than they are") {
  HostBus bus;
  auto [device, robot] = makePipe();
  const auto epoch = [&bus, &device = device] {
    const double seconds = static_cast<double>(bus.time) * 1e-6;
    const std::string bytes =
        gga(43200.0 + seconds, seconds) + pashr(43200.0 + seconds, 90.0) + vtg(90.0, 3.6);
    device->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  };
  HeldUpLink line(*robot, [&] {
    for (int i = 0; i < 8; ++i) {
      bus.time += 20'000;
      epoch();
    }
  });
  MemoryStore store;
  InsDriverNode node(configured(), bus, line, store);
  const auto drive = [&](int epochs) {
    for (int i = 0; i < epochs; ++i) {
      epoch();
      node.step(bus.time);
      bus.time += 20'000;
    }
  };
  drive(100);
  line.armed = true;
  drive(100);
  REQUIRE(bus.track.size() > 150);
  // 1 m/s to the east: the position shows the true time of a measurement.
  const ins_t& first = bus.track.front();
  for (const ins_t& m : bus.track) {
    const double elapsed = static_cast<double>(m.utime - first.utime) * 1e-6;
    CHECK(elapsed == Approx(m.position[0] - first.position[0]).margin(0.005));
  }
}

TEST_CASE("the driver publishes every epoch as INS, with the map's origin at the first fix") {
  Rig rig;
  rig.drive(4.0);
  rig.wait(1.0);
  REQUIRE(rig.track.size() == 200);
  for (size_t i = 0; i < rig.track.size(); ++i) {
    CHECK(rig.track[i].seq == static_cast<int64_t>(i));
    if (i > 0) CHECK(rig.track[i].utime - rig.track[i - 1].utime == 20'000);
    CHECK(rig.track[i].ins_status == ins_t::STATUS_GOOD);
  }
  const auto pose = planarPose(rig.track.back());
  REQUIRE(pose);
  CHECK(pose->x == Approx(199 * 0.02).margin(0.01));
  CHECK(pose->yaw == Approx(0.0).margin(1e-9));
  CHECK(rig.track.back().velocity[0] == Approx(1.0).margin(1e-6));
  CHECK(rig.track.back().satellites == 12);
  CHECK(rig.health.process == "ins_driver");
  CHECK(rig.counter("GGA") == 200);
  CHECK(rig.counter("PASHR") == 200);
  CHECK(rig.counter("decoded") == 600);
  CHECK(rig.counter("published") == 200);
  CHECK(rig.config_text.find("standstill_speed") != std::string::npos);
}

TEST_CASE("an INS message leaves within a step and the quiet time of its epoch") {
  Rig rig;
  int64_t worst = 0;
  rig.bus.setTap([&](int64_t utime, const char* channel, const uint8_t*, size_t) {
    if (std::string(channel) == kIns.name) {
      worst = std::max(worst, utime % 20'000);  // epochs are at multiples of 20 ms here
    }
  });
  rig.drive(2.0);
  CHECK(worst <= 15'000);
}

TEST_CASE("where the last sentence is known, an INS message leaves within a step") {
  Rig rig(configured("last_sentence: VTG"));
  int64_t worst = 0;
  rig.bus.setTap([&](int64_t utime, const char* channel, const uint8_t*, size_t) {
    if (std::string(channel) == kIns.name) worst = std::max(worst, utime % 20'000);
  });
  rig.drive(2.0);
  CHECK(rig.track.size() == 100);
  CHECK(worst <= 5'000);
}

TEST_CASE("a restart keeps the map frame") {
  Rig rig;
  rig.drive(2.0);
  const double before = rig.track.back().position[0];
  rig.bus.restart("ins_driver");
  rig.drive(1.0);
  CHECK(rig.track.back().position[0] == Approx(before + 1.0).margin(0.01));
  REQUIRE(rig.store.read(kOriginEntry));
  // Without the store it would begin with a new origin.
  rig.store.remove(kOriginEntry);
  rig.bus.restart("ins_driver");
  rig.drive(1.0);
  CHECK(rig.track.back().position[0] < 1.1);
}

TEST_CASE("a configured origin is taken before any fix and never stored") {
  Rig rig(configured("origin: {latitude: 42.0955622, longitude: -88.0340185, altitude: 200}"));
  rig.drive(1.0);
  CHECK(rig.track.front().position[0] == Approx(1.0).margin(0.01));  // the clock starts at 1 s
  CHECK(rig.track.front().position[2] == Approx(21.0).margin(0.001));
  CHECK_FALSE(rig.store.read(kOriginEntry));
}

TEST_CASE("an unreadable stored origin is said and replaced") {
  Rig rig;
  rig.store.write(kOriginEntry, "latitude: forty");
  rig.bus.restart("ins_driver");
  rig.wait(0.5);
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("stored map origin:1"));
  rig.drive(0.5);
  CHECK(rig.track.size() == 25);
  CHECK(originFrom(*rig.store.read(kOriginEntry)).point.latitude == Approx(42.0955622 * kDeg));
}

TEST_CASE("a store that cannot be written is degraded health, not silence") {
  Rig rig;
  rig.store.failWith("disk full");
  rig.drive(3.0);
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("disk full"));
}

TEST_CASE("silence is one clear line in health, and its end is heard") {
  Rig rig;
  rig.drive(2.0);
  rig.wait(3.0);
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
  CHECK(rig.healthSays("no more bytes for"));
  CHECK(rig.health.health_reason.find('\n') == std::string::npos);
  const size_t before = rig.track.size();
  rig.drive(2.0);
  CHECK(rig.track.size() == before + 100);
  CHECK((rig.track[before].ins_status & ins_t::STATUS_GAP) != 0);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("garbage is one clear line in health, and good lines after it are decoded") {
  Rig rig;
  std::mt19937_64 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string garbage(2000, '\0');
    for (char& byte : garbage) byte = static_cast<char>(random() & 0xFF);
    rig.say(garbage);
    rig.wait(0.01);
  }
  CHECK(rig.track.empty());
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
  CHECK(rig.healthSays("no good sentence"));
  CHECK(rig.healthSays("baud rate"));
  CHECK(rig.counter("stray bytes") > 100'000);
  CHECK(rig.counter("refused: not printable") > 100);
  rig.drive(2.0);
  rig.wait(0.1);
  CHECK(rig.track.size() == 100);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("sentences without or with wrong checksums are named in health, not the baud rate") {
  for (const auto& [end, words] : {std::pair("\r\n", "NMEA sentences without checksums"),
                                   std::pair("*00\r\n", "NMEA sentences with wrong checksums")}) {
    Rig rig;
    for (int i = 0; i < 100; ++i) {
      const std::string good = gga(10.0 + 0.02 * i) + pashr(10.0 + 0.02 * i, 90.0);
      std::istringstream lines(good);
      for (std::string one; std::getline(lines, one);) rig.say(one.substr(0, one.find('*')) + end);
      rig.wait(0.02);
    }
    CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
    CHECK(rig.healthSays(words));
    CHECK_FALSE(rig.healthSays("baud rate"));
  }
}

TEST_CASE("a heading sentence that is sent, but marked invalid, is named in health") {
  Rig rig;
  const auto positions = [&](const std::string& heading) {
    for (int i = 0; i < 100; ++i) {
      rig.say(gga(43200.0 + static_cast<double>(rig.bus.now()) * 1e-6, 5.0) + heading);
      rig.bus.runUntil(rig.bus.now() + 20'000);
    }
  };
  positions("");
  CHECK(rig.healthSays("does the device send HDT, THS or PASHR?"));
  positions(line("GNTHS,0.5,V"));
  CHECK(rig.healthSays("the device sends THS without a valid heading (mode V"));
  CHECK_FALSE(rig.healthSays("does the device send"));
}

TEST_CASE("refusals are counted in health by their reason") {
  Rig rig;
  rig.drive(0.5);
  rig.say("$GPHDT,274.07,T*04\r\n$GPHDT,274.07,T\r\n$GPGSV,1,1,00*79\r\n");
  rig.drive(1.5);
  CHECK(rig.counter("refused: wrong checksum") == 1);
  CHECK(rig.counter("refused: no checksum") == 1);
  CHECK(rig.counter("refused: unknown sentence") == 1);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("a line that never said anything is told from one that fell silent") {
  Rig rig;
  rig.wait(2.0);
  CHECK(rig.healthSays("no bytes for"));
  rig.say(line("GPGGA,120000.000,4205.7,N,08802.0,W,4,12,1.0,221,M,,M"));
  rig.wait(2.0);
  CHECK_FALSE(rig.healthSays("no bytes for"));
  CHECK(rig.healthSays("GGA: field count 1"));
  CHECK(rig.counter("refused: GGA: field count") == 1);
}

TEST_CASE("a cut line is reopened with back-off and the track goes on as after a gap") {
  Rig rig;
  rig.drive(2.0);
  setPipeConnected(*rig.device, false);
  rig.wait(3.0);
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
  CHECK_FALSE(rig.health.health_reason.empty());
  CHECK(rig.counter("link losses") == 1);
  const size_t before = rig.track.size();
  setPipeConnected(*rig.device, true);
  rig.device->reopen(rig.bus.now());
  rig.wait(1.1);  // the back-off grows to 1 s
  rig.drive(2.0);
  CHECK(rig.track.size() == before + 100);
  CHECK((rig.track[before].ins_status & ins_t::STATUS_GAP) != 0);
  CHECK(rig.track.back().position[0] > rig.track[before - 1].position[0]);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("a lost fix and a lost heading are degraded health with their remedy") {
  Rig rig;
  rig.drive(1.0);
  for (int i = 0; i < 100; ++i) {
    const double t = 43200.0 + static_cast<double>(rig.bus.now()) * 1e-6;
    rig.say(gga(t, 0.0, 0.0, 0) + pashr(t, 90.0));
    rig.bus.runUntil(rig.bus.now() + 20'000);
  }
  CHECK((rig.track.back().ins_status & ins_t::STATUS_NO_POSITION) != 0);
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("no position"));
  for (int i = 0; i < 100; ++i) {
    rig.say(gga(43200.0 + static_cast<double>(rig.bus.now()) * 1e-6, 5.0));
    rig.bus.runUntil(rig.bus.now() + 20'000);
  }
  CHECK((rig.track.back().ins_status & ins_t::STATUS_NO_HEADING) != 0);
  CHECK(rig.healthSays("no heading"));
}

TEST_CASE("positions without a height are degraded health: mapping cannot use them") {
  Rig rig;
  rig.drive(1.0);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
  for (int i = 0; i < 100; ++i) {
    const double t = 43200.0 + static_cast<double>(rig.bus.now()) * 1e-6;
    std::string whole = gga(t);
    const size_t height = whole.find(",221.000,");
    REQUIRE(height != std::string::npos);
    whole.replace(height, 9, ",,");
    rig.say(line(whole.substr(1, whole.find('*') - 1)) + pashr(t, 90.0));
    rig.bus.runUntil(rig.bus.now() + 20'000);
  }
  CHECK(std::isfinite(rig.track.back().position[0]));
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("positions without a height for "));
  CHECK(rig.healthSays("configure geoid_separation"));
}

TEST_CASE("a fix at another site than the stored origin is told with its distance") {
  Rig rig;
  rig.store.write(kOriginEntry, "latitude: 43.0955622\nlongitude: -88.0340185\naltitude: 200\n");
  rig.bus.restart("ins_driver");
  rig.drive(3.0);
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("111 km from the map's origin"));
  CHECK(rig.healthSays(kOriginEntry));
}

TEST_CASE("the same bytes give the same messages") {
  const auto run = [] {
    Rig rig;
    std::vector<std::vector<uint8_t>> bytes;
    rig.bus.setTap([&](int64_t, const char*, const uint8_t* data, size_t size) {
      bytes.emplace_back(data, data + size);
    });
    std::mt19937_64 random(8);
    for (int i = 0; i < 100; ++i) {
      rig.drive(0.02);
      rig.say(std::string(random() % 50, static_cast<char>(random() & 0xFF)));
    }
    return bytes;
  };
  CHECK(run() == run());
}

TEST_CASE("the configuration is checked: unknown keys, ranges and wrong types name their line") {
  const auto problem = [](const std::string& yaml) -> std::string {
    try {
      configured(yaml);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  CHECK(problem("latenci: 0.1").find("latenci") != std::string::npos);
  CHECK(problem("latency: [0, 0]").find("test:1") != std::string::npos);
  CHECK(problem("latency: 1000").find("test:1") != std::string::npos);
  CHECK(problem("latency: soon").find("test:1") != std::string::npos);
  CHECK(problem("source: nmae").find("allowed nmea") != std::string::npos);
  CHECK(problem("origin: {latitude: 42}").find("longitude") != std::string::npos);
  CHECK(problem("{}").empty());
  CHECK(problem("source: novatel\nimu_rate: 200\nantenna: [0.1, 0, 1]\nlast_message: INSPVAX\n"
                "baseline_yaw: 1.57\nleap_seconds: 18\ngeoid_separation: 47")
            .empty());
  CHECK(problem("source: ublox\nheadings: [dual_antenna, course]\nlast_message: NAV-PVT").empty());
  CHECK(problem("source: vectornav\norigin_max_std: 2\ndrives_backward: false").empty());
  CHECK(problem("source: xsens\ngeoid_separation: 47").empty());
  CHECK(problem("headings: [attitude, compass]").find("test:1") != std::string::npos);
  CHECK(problem("headings: [attitude, attitude]").find("twice") != std::string::npos);
  CHECK(problem("source: vectornav\nimu_rate: 200").find("imu_rate") != std::string::npos);
}

TEST_CASE("the map's origin survives being written and read to a tenth of a millimetre") {
  const GeoOrigin origin{{42.0955622 * kDeg, -88.0340185 * kDeg}, 221.921, 0.3};
  const GeoOrigin again = originFrom(originText(origin));
  CHECK(std::abs(again.point.latitude - origin.point.latitude) * 6.4e6 < 1e-4);
  CHECK(std::abs(again.point.longitude - origin.point.longitude) * 6.4e6 < 1e-4);
  CHECK(again.altitude == origin.altitude);
  CHECK(again.yaw == origin.yaw);
}

TEST_CASE("while the device is silent INS goes on from scan matching, and HEALTH says so") {
  Rig rig(configured("fill_in: {}"));
  int64_t seq = 0;
  // A separate frame, in which the robot drives along x.
  const auto scanned = [&](double seconds, bool device) {
    for (const int64_t end = rig.bus.now() + std::llround(seconds * 1e6); rig.bus.now() < end;) {
      auto message = blank<ins_t>();
      message.utime = rig.bus.now();
      message.seq = seq++;
      message.position[0] = 1e-6 * static_cast<double>(rig.bus.now());
      message.position[1] = message.position[2] = 0.0;
      message.orientation[0] = 1.0;
      message.orientation[1] = message.orientation[2] = message.orientation[3] = 0.0;
      message.velocity[0] = 1.0;
      message.velocity[1] = message.rate[2] = 0.0;
      message.position_std[0] = message.position_std[1] = 0.01;
      message.attitude_std[2] = 0.001;
      message.ins_status = ins_t::STATUS_NO_ATTITUDE | (seq == 1 ? ins_t::STATUS_JUMP : 0);
      rig.bus.outside().publish(kScanMatching, message);
      if (device) {
        rig.drive(0.1);
      } else {
        rig.wait(0.1);
      }
    }
  };
  scanned(2.0, true);
  CHECK(rig.health.health_state == health_t::HEALTH_OK);
  const size_t before = rig.track.size();
  const double from = rig.track.back().position[0];
  scanned(3.0, false);
  CHECK(rig.track.size() - before >= 27);
  for (size_t i = before + 2; i < rig.track.size(); ++i) {
    CHECK(rig.track[i].ins_status == (ins_t::STATUS_FILLED_IN | ins_t::STATUS_NO_ATTITUDE));
    CHECK(rig.track[i].seq == rig.track[i - 1].seq + 1);
  }
  CHECK(rig.track.back().position[0] - from == Approx(3.0).margin(0.15));
  CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(rig.healthSays("no more bytes for"));
  CHECK(rig.healthSays("poses are filled in by scan matching since"));
  CHECK(rig.counter("poses filled in by scan matching") >= 25);

  scanned(1.0, true);
  CHECK(rig.track.back().ins_status == ins_t::STATUS_GOOD);
  rig.drive(2.5);
  CHECK(rig.healthSays("nothing to fill in with: no pose of scan matching for"));
}

TEST_CASE("without a fill_in section scan matching is not listened to") {
  Rig rig;
  rig.drive(1.0);
  auto message = blank<ins_t>();
  message.utime = rig.bus.now();
  rig.bus.outside().publish(kScanMatching, message);
  const size_t before = rig.track.size();
  rig.wait(2.0);
  CHECK(rig.track.size() <= before + 2);
  CHECK(rig.health.health_state == health_t::HEALTH_FAILED);
}

TEST_CASE(
    "an input that comes too seldom for the poses is told with all rates and the key to set") {
  struct Case {
    int heading_every, velocity_every;  // of positions at 20 Hz; 0: never
    const char* says;
    const char* key;
  };
  for (const Case& with :
       {Case{20, 1, "a heading in 10 of 100 poses; GGA 20.0 Hz, HDT 1.0 Hz",
             "let the device send headings 20 times a second; attitude_hold, now 0.06 s"},
        Case{5, 1, "GGA 20.0 Hz, HDT 4.0 Hz", "or set attitude_hold: 0.30"},
        Case{1, 8, "a velocity in", "or set position_hold: 0.4"}, Case{1, 1, nullptr, nullptr},
        Case{2, 1, nullptr, nullptr}, Case{1, 2, nullptr, nullptr}}) {
    CAPTURE(with.heading_every, with.velocity_every);
    Rig rig;
    for (int i = 0; i < 300; ++i) {
      const double seconds = static_cast<double>(rig.bus.now()) * 1e-6;
      std::string bytes = gga(43200.0 + seconds, seconds);
      if (i % with.velocity_every == 0) bytes += vtg(90.0, 3.6);
      if (i % with.heading_every == 0) bytes += line("GNHDT,90.0,T");
      rig.say(bytes);
      rig.bus.runUntil(rig.bus.now() + 50'000);
    }
    INFO(rig.health.health_reason);
    CHECK((rig.health.health_state == health_t::HEALTH_OK) == (with.says == nullptr));
    if (with.says == nullptr) continue;
    CHECK(rig.health.health_state == health_t::HEALTH_DEGRADED);
    CHECK(rig.healthSays(with.says));
    CHECK(rig.healthSays(with.key));
  }
}

TEST_CASE("headings that stay away for a while are no slow input") {
  Rig rig;
  bool slow = false;
  for (int i = 0; i < 400; ++i) {
    const double seconds = static_cast<double>(rig.bus.now()) * 1e-6;
    rig.say(gga(43200.0 + seconds, seconds) + vtg(90.0, 3.6) +
            (i % 100 < 50 ? line("GNHDT,90.0,T") : ""));
    rig.bus.runUntil(rig.bus.now() + 50'000);
    slow = slow || rig.healthSays("a heading in");
  }
  CHECK_FALSE(slow);
}

TEST_CASE("positions too seldom for the attitudes between them are told") {
  Rig rig;
  for (int i = 0; i < 300; ++i) {
    const double time_of_day = 43200.0 + static_cast<double>(rig.bus.now()) * 1e-6;
    rig.say((i % 20 == 0 ? gga(time_of_day, time_of_day - 43200.0) + vtg(90.0, 3.6) : "") +
            pashr(time_of_day, 90.0));
    rig.bus.runUntil(rig.bus.now() + 50'000);
  }
  INFO(rig.health.health_reason);
  CHECK(rig.healthSays("a position near the attitude in"));
  CHECK(rig.healthSays("GGA 1.0 Hz, PASHR 20.0 Hz"));
}

TEST_CASE("a date that is 1024 weeks off this host's is told, another old one is not") {
  constexpr int64_t kWeek = int64_t{7} * 86400 * kSecond;
  for (const int64_t weeks : {0, 1000, 1024, 2048}) {
    HostBus bus;
    auto [device, robot] = makePipe();
    MemoryStore store;
    InsDriverNode node(configured(), bus, *robot, store);
    // The device has the date 2026-11-26.
    bus.date = int64_t{1'795'694'400} * kSecond + weeks * kWeek;
    for (int i = 0; i < 120; ++i, bus.time += 20'000) {
      const double seconds = static_cast<double>(bus.time) * 1e-6;
      const std::string bytes = gga(43200.0 + seconds, seconds) + pashr(43200.0 + seconds, 90.0) +
                                vtg(90.0, 3.6) +
                                line("GNZDA," + hhmmss(43200.0 + seconds) + ",26,11,2026,00,00");
      device->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
      node.step(bus.time);
    }
    CAPTURE(weeks, bus.health);
    CHECK((bus.health.find(std::to_string(weeks) + " weeks behind") != std::string::npos) ==
          (weeks >= 1024));
  }
}

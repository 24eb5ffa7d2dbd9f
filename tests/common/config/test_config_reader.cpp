// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "tests/helpers.hpp"

namespace tread {
namespace {

using tread::testing::kInf;

/// A configuration with a value of each kind.
struct Everything {
  double lease = 0.2;
  int64_t hold = 150'000;
  int64_t port = 7667;
  bool echo = true;
  std::string device = "tty:/dev/ttyUSB0?baud=115200";
  std::string rule = "off";
  std::vector<double> gains{1.0, 2.5};
  std::vector<std::vector<double>> polygon{{0.1, 0.2}, {1e-7, -3.0}};
  std::vector<std::string> names{"rest", "a \"b\"\n\tc", "yes"};
  double gap = 0.1;
  std::vector<std::string> region_names;
  std::vector<double> region_friction;
};

void readEverything(ConfigReader& reader, Everything& c) {
  reader.number("lease", c.lease, {0.05, 1.0}, "s");
  reader.seconds("hold", c.hold, {0.001, 10.0});
  reader.integer("port", c.port, {1, 65535}, "1");
  reader.flag("echo", c.echo);
  reader.text("device", c.device);
  reader.choice("rule", c.rule, {"off", "single", "collective"});
  reader.numbers("gains", c.gains, 2, {-10, 10}, "1");
  reader.table("polygon", c.polygon, 2, {-10, 10}, "m");
  reader.texts("names", c.names);
  ConfigReader gate = reader.section("gate");
  gate.number("max_gap", c.gap, {0, 1}, "s");
  for (ConfigReader& region : reader.sections("regions")) {
    std::string name;
    double friction = 0.5;
    region.text("name", name, true);
    region.number("friction", friction, {0, 1}, "1");
    c.region_names.push_back(name);
    c.region_friction.push_back(friction);
  }
  reader.finish();
}

}  // namespace

TEST_CASE("an empty file leaves every default") {
  for (const char* text : {"", "# only a remark\n", "---\n", "{}\n"}) {
    Everything c;
    ConfigReader reader = ConfigReader::fromText(text, "robot.yaml");
    readEverything(reader, c);
    CHECK(c.lease == 0.2);
    CHECK(c.hold == 150'000);
    CHECK(c.rule == "off");
    CHECK(c.region_names.empty());
  }
}

TEST_CASE("every kind of value is read") {
  const char* text =
      "lease: 0.25\nhold: 0.0290004\nport: 8000\necho: false\ndevice: "
      "\"tcp:localhost:10940\"\nrule: collective\n"
      "gains: [1, -2e-1]\npolygon:\n  - [1, 2]\n  - [3, 4]\nnames: [a, 'b c']\n"
      "gate: {max_gap: 0.5}\nregions:\n  - name: grass\n    friction: 0.7\n  - {name: tarmac}\n";
  Everything c;
  ConfigReader reader = ConfigReader::fromText(text, "robot.yaml");
  readEverything(reader, c);
  CHECK(c.lease == 0.25);
  CHECK(c.hold == 29'000);  // to the nearest microsecond
  CHECK(c.port == 8000);
  CHECK_FALSE(c.echo);
  CHECK(c.device == "tcp:localhost:10940");
  CHECK(c.rule == "collective");
  CHECK(c.gains == std::vector<double>{1.0, -0.2});
  CHECK(c.polygon == std::vector<std::vector<double>>{{1, 2}, {3, 4}});
  CHECK(c.names == std::vector<std::string>{"a", "b c"});
  CHECK(c.gap == 0.5);
  CHECK(c.region_names == std::vector<std::string>{"grass", "tarmac"});
  CHECK(c.region_friction == std::vector<double>{0.7, 0.5});
}

TEST_CASE("the effective configuration reads back to the same values and the same text") {
  Everything first;
  ConfigReader reader = ConfigReader::fromText(
      "lease: 0.1\nregions: [{name: 'x: y'}, {name: off, friction: 0.30000000000000004}]\n", "a");
  readEverything(reader, first);
  const std::string text = reader.effective();
  INFO(text);
  Everything second;
  second.gains = {9, 9};
  second.names.clear();
  ConfigReader again = ConfigReader::fromText(text, "b");
  readEverything(again, second);
  CHECK(second.lease == first.lease);
  CHECK(second.hold == first.hold);
  CHECK(second.gains == first.gains);
  CHECK(second.polygon == first.polygon);
  CHECK(second.names == first.names);
  CHECK(second.device == first.device);
  CHECK(second.region_names == first.region_names);
  CHECK(second.region_friction == first.region_friction);
  CHECK(again.effective() == text);
}

TEST_CASE("the effective configuration holds the defaults, in the order of asking") {
  ConfigReader reader = ConfigReader::fromText("b: 3\n", "a");
  double a = 0.1;
  double b = 0.0;
  double never_set = std::numeric_limits<double>::quiet_NaN();
  reader.number("a", a, {0, 1}, "m");
  reader.number("b", b, {0, 9}, "m");
  reader.number("c", never_set, {0, 9}, "m");
  reader.section("empty");
  CHECK(reader.effective() == "a: 0.1\nb: 3\nempty:\n  {}\n");
}

TEST_CASE("a retired key is no unknown key, and no message or effective text names it") {
  ConfigReader reader = ConfigReader::fromText("old: 3\nold_section: {}\nnew: 1\n", "a.yaml");
  double value = 0.0;
  reader.number("new", value, {0.0, 5.0}, "1");
  CHECK(reader.retired("old"));
  CHECK(reader.retired("old_section"));
  CHECK_FALSE(reader.retired("older"));
  CHECK_NOTHROW(reader.finish());
  CHECK(reader.effective() == "new: 1\n");
  ConfigReader other = ConfigReader::fromText("olf: 3\n", "a.yaml");
  other.retired("old");
  CHECK_THROWS_WITH(other.finish(), !Catch::Contains("old"));
}

TEST_CASE("keys come in the order of the file, so that a map's keys may be names") {
  ConfigReader reader = ConfigReader::fromText("zebra: {w: 1}\nant: {w: 2}\n", "a");
  REQUIRE(reader.keys() == std::vector<std::string>{"zebra", "ant"});
  double sum = 0.0;
  for (const std::string& name : reader.keys()) {
    double w = 0.0;
    reader.section(name).number("w", w, {0, 9}, "kg", true);
    sum += w;
  }
  reader.finish();
  CHECK(sum == 3.0);
}

TEST_CASE("a section may be asked for twice and is one section") {
  ConfigReader reader = ConfigReader::fromText("gate: {a: 1, b: 2}\n", "f");
  double a = 0.0;
  double b = 0.0;
  reader.section("gate").number("a", a, {0, 9}, "m");
  reader.section("gate").number("b", b, {0, 9}, "m");
  reader.finish();
  CHECK(a + b == 3.0);
}

TEST_CASE("CRLF, a byte order mark and a section without content are no errors") {
  ConfigReader reader =
      ConfigReader::fromText("\xEF\xBB\xBFname: \"x\"\r\ngate:\r\nb: 'y'\r\n", "f");
  std::string a;
  std::string b;
  double gap = 0.5;
  reader.text("name", a);
  reader.section("gate").number("gap", gap, {-kInf, kInf}, "s");
  reader.text("b", b);
  reader.finish();
  CHECK(a == "x");
  CHECK(b == "y");
}

TEST_CASE("UTF-16 text is named as what it is") {
  for (const std::string& text : {std::string("\xFF\xFE"
                                              "a\0:\0",
                                              6),
                                  std::string("a\0:\0", 4), std::string("\0a\0:", 4)})
    CHECK_THROWS_WITH(ConfigReader::fromText(text, "f"),
                      Catch::StartsWith("f: is UTF-16 text; save it as UTF-8"));
}

TEST_CASE("a relative path in a file is taken from that file's folder") {
  ConfigReader reader =
      ConfigReader::fromText("a: x.yaml\nb: /etc/y.yaml\nc: ../z\n", "config/r.yaml");
  std::string a;
  std::string b;
  std::string c;
  std::string absent = "as it was";
  reader.path("a", a);
  reader.path("b", b);
  reader.path("c", c);
  reader.path("d", absent);
  reader.finish();
  CHECK(a == "config/x.yaml");
  CHECK(b == "/etc/y.yaml");
  CHECK(c == "config/../z");
  CHECK(absent == "as it was");
}

TEST_CASE("a file is read from disk, an absent one and a folder are one clear line") {
  const std::string path = "/tmp/tread_config_" + std::to_string(::getpid()) + ".yaml";
  std::ofstream(path) << "lease: 0.5\n";
  double lease = 0.0;
  ConfigReader reader = ConfigReader::fromFile(path);
  reader.number("lease", lease, {0, 1}, "s");
  CHECK(lease == 0.5);
  std::remove(path.c_str());
  CHECK_THROWS_WITH(ConfigReader::fromFile(path),
                    path + ": cannot be read (No such file or directory); check the path");
  CHECK_THROWS_WITH(ConfigReader::fromFile("/tmp"), "/tmp: is a folder; a YAML file is needed");
}

TEST_CASE("an override on the command line replaces, adds, and reaches into sections") {
  ConfigReader reader =
      ConfigReader::fromText("lease: 0.3\ngate:\n  max_gap: 0.2\nmap: b.yaml\n", "robots/a.yaml",
                             {"lease=0.4", "gate.max_gap=0.7", "gate.why='so: and so'",
                              "new=x/y.yaml", "list=[1, 2]", "lease=0.5", "deep.er=7"});
  double lease = 0;
  double gap = 0;
  double deep = 0;
  std::string why;
  std::string map;
  std::string fresh;
  std::vector<double> list;
  reader.number("lease", lease, {0, 1}, "s");
  ConfigReader gate = reader.section("gate");
  gate.number("max_gap", gap, {0, 1}, "s");
  gate.text("why", why);
  reader.path("map", map);
  reader.path("new", fresh);
  reader.numbers("list", list, 2, {0, 9}, "1");
  ConfigReader inner = reader.section("deep");
  inner.number("er", deep, {0, 9}, "1");
  reader.finish();
  CHECK(lease == 0.5);
  CHECK(gap == 0.7);
  CHECK(deep == 7);
  CHECK(why == "so: and so");
  CHECK(map == "robots/b.yaml");
  CHECK(fresh == "x/y.yaml");  // as typed: relative to the working directory
  CHECK(list == std::vector<double>{1, 2});
}

TEST_CASE("an override is told as what was typed, never as a line of the file") {
  const auto read = [](const std::string& override_words) {
    ConfigReader reader = ConfigReader::fromText("lease: 0.3", "a.yaml", {override_words});
    double lease = 0;
    reader.number("lease", lease, {0.0, 1.0}, "s");
    std::string map;
    reader.path("map", map);
    reader.finish();
    return std::to_string(lease).substr(0, lease < 1 ? 3 : 1) + " " + map;
  };
  CHECK(read("lease=1") == "1 ");
  CHECK(read("map=b/c") == "0.3 b/c");
  CHECK_THROWS_WITH(read("lease=2"), "--set lease=2: lease is 2 s; allowed 0..1 s");
  CHECK_THROWS_WITH(read("leese=2"),
                    Catch::StartsWith("--set leese=2: unknown key leese; is lease meant?"));
  CHECK_THROWS_WITH(read("lease"), Catch::StartsWith("--set lease: write key=value"));
  CHECK_THROWS_WITH(read("=2"), Catch::Contains("write key=value"));
  CHECK_THROWS_WITH(read("a..b=2"), Catch::Contains("write key=value"));
  CHECK_THROWS_WITH(read("map=[1"), Catch::StartsWith("--set map=[1: the value is no YAML"));
  CHECK_THROWS_WITH(read("map='x"), Catch::StartsWith("--set map='x"));
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"

namespace tread {
namespace {

using Catch::Contains;

/// what() of the ConfigError for this text; a sentence if none is thrown.
std::string refusal(const std::string& text, const std::function<void(ConfigReader&)>& read) {
  try {
    ConfigReader reader = ConfigReader::fromText(text, "r.yaml");
    read(reader);
    reader.finish();
  } catch (const ConfigError& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  return "nothing was refused";
}

std::string lease(const std::string& text) {
  return refusal(text, [](ConfigReader& reader) {
    double value = 0.2;
    reader.number("lease", value, {0.05, 1.0}, "s");
  });
}

std::string port(const std::string& text) {
  return refusal(text, [](ConfigReader& reader) {
    int64_t value = 0;
    reader.integer("port", value, {1, 65535}, "");
  });
}

std::string echo(const std::string& text) {
  return refusal(text, [](ConfigReader& reader) {
    bool value = false;
    reader.flag("echo", value);
  });
}

std::string name(const std::string& text) {
  return refusal(text, [](ConfigReader& reader) {
    std::string value;
    reader.text("name", value);
  });
}

}  // namespace

TEST_CASE("a number out of its range is refused with file, line and the allowed range") {
  CHECK(lease("\n\nlease: 9\n") == "r.yaml:3: lease is 9 s; allowed 0.05..1 s");
  CHECK(lease("lease: -1\n") == "r.yaml:1: lease is -1 s; allowed 0.05..1 s");
  CHECK(refusal("m: -1\n", [](ConfigReader& reader) {
          double m = 0;
          reader.number("m", m, {0, std::numeric_limits<double>::infinity()}, "kg");
        }) == "r.yaml:1: m is -1 kg; allowed at least 0 kg");
}

TEST_CASE("what is not a decimal number is refused") {
  for (const char* bad : {".nan", "nan", ".inf", "-.inf", "0x1F", "010", "0o17", "1e400", "1_000",
                          "0.1s", "half", "true", "+1", "1,5"}) {
    INFO(bad);
    CHECK_THAT(lease(std::string("lease: ") + bad + "\n"),
               Contains("r.yaml:1: lease is ") && Contains("allowed 0.05..1 s"));
  }
  CHECK_THAT(lease("lease: \"0.2\"\n"), Contains("lease is text in quotes; a number, 0.05..1 s"));
  CHECK_THAT(lease("lease: [1]\n"), Contains("r.yaml:1: lease is a list; a number"));
  CHECK_THAT(lease("lease: !!float 0.2\n"), Contains("has the tag"));
}

TEST_CASE("an empty value is refused at the line of its key") {
  CHECK_THAT(lease("a: 1\nlease:\n\nb: 2\n"), Contains("r.yaml:2: lease is empty"));
  CHECK_THAT(lease("lease: ~\n"), Contains("r.yaml:1: lease is empty"));
}

TEST_CASE("an integer must be a plain decimal integer") {
  for (const char* bad : {"010", "0x1F", "1e3", "1.0", "99999999999999999999", "yes", "+5", "-0x1"})
    CHECK_THAT(port(std::string("port: ") + bad + "\n"),
               Contains("r.yaml:1: port is ") && Contains("allowed 1..65535"));
  CHECK(port("port: 70000\n") == "r.yaml:1: port is 70000; allowed 1..65535");
  CHECK(port("port: 8000\n") == "nothing was refused");
}

TEST_CASE("yes, on and 1 are not flags") {
  for (const char* bad : {"yes", "on", "1", "True", "no", "\"true\""})
    CHECK_THAT(echo(std::string("echo: ") + bad + "\n"), Contains("r.yaml:1: echo is "));
  CHECK(echo("echo: yes\n") == "r.yaml:1: echo is \"yes\"; allowed true, false");
}

TEST_CASE("a choice lists the allowed values") {
  CHECK(refusal("rule: colective\n", [](ConfigReader& reader) {
          std::string rule = "off";
          reader.choice("rule", rule, {"off", "single", "collective"});
        }) == "r.yaml:1: rule is colective; is collective meant?; allowed off, single, collective");
}

TEST_CASE("an unknown key is refused with the nearest spelling and the known keys") {
  const std::string said = refusal("port: 5\ngate:\n  maxgap: 0.1\n", [](ConfigReader& reader) {
    int64_t value = 0;
    double gap = 0;
    reader.integer("port", value, {1, 65535}, "");
    ConfigReader gate = reader.section("gate");
    gate.number("max_gap", gap, {0, 1}, "s");
    gate.number("slope", gap, {0, 1}, "rad");
  });
  CHECK(said == "r.yaml:3: unknown key gate.maxgap; is max_gap meant?; known here: max_gap, slope");
  CHECK(lease("velocity: 3\n") == "r.yaml:1: unknown key velocity; known here: lease");
  CHECK_THAT(lease("<<: {lease: 0.2}\n"), Contains("unknown key \"<<\""));
}

TEST_CASE("a key that is only tested for is still unknown if nobody reads it") {
  CHECK_THAT(refusal("a: 1\n", [](ConfigReader& reader) { CHECK(reader.has("a")); }),
             Contains("unknown key a"));
}

TEST_CASE("a required key that is missing is refused, with the mistyped one") {
  const auto read = [](ConfigReader& reader) {
    double value = 0;
    reader.section("gate").number("lease", value, {0, 1}, "s", true);
  };
  CHECK(refusal("a: 1\ngate:\n  b: 2\n", read) == "r.yaml:2: required key 'gate.lease' is missing");
  CHECK(refusal("gate: {laese: 2}\n", read) ==
        "r.yaml:1: required key 'gate.lease' is missing; is laese meant?");
  CHECK_THAT(refusal("", read), Contains("r.yaml:1: required key 'gate.lease' is missing"));
  CHECK_THAT(refusal("a: 1\n", [](ConfigReader& reader) { reader.sections("list", true); }),
             Contains("required key 'list' is missing"));
}

TEST_CASE("a duplicate key is refused with both lines") {
  CHECK(lease("lease: 0.2\na: 1\nlease: 0.3\n") ==
        "r.yaml:3: lease is there twice; it was in line 1 already");
}

TEST_CASE("a second document is refused") {
  CHECK(lease("lease: 0.2\n---\nlease: 0.3\n") ==
        "r.yaml:2: a second document begins here; one is allowed, without --- or brackets between");
  CHECK_THAT(lease("lease: 0.2\n---\n"), Contains("a second document"));
}

TEST_CASE("a quote that is never closed is refused where it begins, not silently the end") {
  CHECK(name("a: 1\nname: \"robot\nlease: 0.2\nport: 5\n") ==
        "r.yaml:2: name begins with a quote that is never closed; close it");
  CHECK_THAT(name("é: 1\r\nname: 'robot\r\nlease: 0.2\r\n"), Contains("r.yaml:2: name begins"));
  CHECK_THAT(name("name: \"a \\\" b\" \n"), Contains("nothing was refused"));
  CHECK_THAT(name("name: |\n  \"block\n  text\n"), Contains("nothing was refused"));
}

TEST_CASE("syntax errors name file and line and nothing of the file is used") {
  CHECK_THAT(lease("lease: 0.2\nb: [1, 2\nc: 3\n"), Contains("r.yaml:") && Contains("check"));
  CHECK_THAT(lease("a: b: c\n"), Contains("r.yaml:1: "));
  CHECK_THAT(lease("a:\n\tb: 1\n"), Contains("r.yaml:2: "));
  CHECK_THAT(lease("a: *x\n"), Contains("r.yaml:1: "));
  CHECK_THAT(lease(std::string(20000, '[')), Contains("r.yaml:"));
  CHECK_THAT(lease("- a\n- b\n"), Contains("r.yaml:1: the file is a list; a map of keys"));
  CHECK_THAT(lease("[1, 2]: 3\n"), Contains("a key is a list"));
  CHECK_THAT(lease(std::string("a: \x01\0\xff", 6)), Contains("r.yaml:"));
}

TEST_CASE("lists name the item that is wrong, by its own line") {
  const auto read = [](ConfigReader& reader) {
    std::vector<double> gains;
    std::vector<std::vector<double>> rows;
    std::vector<std::string> names;
    reader.numbers("gains", gains, 2, {0, 1}, "m");
    reader.table("rows", rows, 2, {0, 1}, "m");
    reader.texts("names", names);
    for (ConfigReader& region : reader.sections("regions")) {
      std::string kind;
      region.text("kind", kind, true);
    }
  };
  CHECK(refusal("gains:\n  - 1\n  - 7\n", read) == "r.yaml:3: gains[1] is 7 m; allowed 0..1 m");
  CHECK(refusal("gains: [1]\n", read) == "r.yaml:1: gains has 1 numbers; 2 needed");
  CHECK(refusal("rows:\n  - [1, 0]\n  - [1, .nan]\n", read) ==
        "r.yaml:3: rows[1][1] is \".nan\", not a decimal number; allowed 0..1 m");
  CHECK(refusal("rows:\n  - [1, 0]\n  - [1]\n", read) ==
        "r.yaml:3: rows[1] has 1 numbers; 2 needed");
  CHECK_THAT(refusal("rows: 3\n", read), Contains("rows is not a list"));
  CHECK_THAT(refusal("names: [a, [b]]\n", read), Contains("names[1] is a list"));
  CHECK_THAT(refusal("regions:\n  - kind: a\n  - kin: b\n", read),
             Contains("r.yaml:3: required key 'regions[1].kind' is missing; is kin meant?"));
  CHECK_THAT(refusal("regions: {a: 1}\n", read), Contains("regions is not a list"));
  CHECK_THAT(refusal("regions: [3]\n", read), Contains("regions[0] is a single value"));
}

TEST_CASE("any damage to a file is read or refused in one line, never more") {
  const std::string whole =
      "lease: 0.2\nname: \"a robot\"\ngains: [1, 2]\ngate:\n  max_gap: 0.5\nregions:\n"
      "  - {kind: 'grass', friction: 0.7}\n  - kind: tarmac\n    friction: 0.9\n";
  const std::string marks = "\n\t :-[]{}'\"#&*!|>%@`,?0e.~x\\";
  std::mt19937_64 random(31);
  int refused = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string text = whole;
    for (size_t i = 0; i < 1 + random() % 3; ++i) {
      const size_t at = random() % text.size();
      if (random() % 3 == 0) text.erase(at, 1 + random() % 5);
      if (!text.empty()) text.insert(random() % text.size(), 1, marks[random() % marks.size()]);
    }
    // refusal() checks that what is thrown is a ConfigError of one line.
    const std::string said = refusal(text, [](ConfigReader& reader) {
      double number = 0.0;
      std::string word;
      std::vector<double> gains;
      reader.number("lease", number, {0, 1}, "s");
      reader.text("name", word);
      reader.numbers("gains", gains, 2, {0, 9}, "1");
      for (const std::string& key : reader.keys())
        if (key[0] == 'g' && key != "gains")
          reader.section(key).number("max_gap", number, {0, 1}, "s");
      for (ConfigReader& region : reader.sections("regions")) {
        region.text("kind", word, true);
        region.number("friction", number, {0, 1}, "1");
      }
      reader.effective();
    });
    refused += said != "nothing was refused";
  }
  CHECK(refused > 2000);
}

TEST_CASE("checks across keys point at the line of a key") {
  ConfigReader reader = ConfigReader::fromText("a: 1\ngate:\n  lease: 3\n", "r.yaml");
  CHECK(std::string(reader.section("gate").error("lease", "longer than the period").what()) ==
        "r.yaml:3: gate.lease: longer than the period");
  CHECK(std::string(reader.section("gate").error("none", "x").what()) == "r.yaml:2: gate.none: x");
}

}  // namespace tread

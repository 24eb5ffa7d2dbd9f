// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <utility>

#include "tests/tools/robot/patterns/patterns_program.hpp"

using namespace tread::patterns::kit;

namespace {

/// A small valid set.
const std::string kGood = R"(name: tiny
kind: power
period_us: 100000
classes:
  - {name: rest, twist: [0, 0, 0], steady: [0, 0]}
patterns:
  - id: 1
    name: nod
    entry: rest
    exit: rest
    commands:
      - [0.5, 0.5, 2]
    trajectory:
      - [0.01, 0, 0]
      - [0.02, 0, 0]
)";

}  // namespace

TEST_CASE("tread-patterns makes a file that it can show") {
  const Folder folder;
  const Run made = run("make " + kConfigFolder + "patterns/recipes/teodor.yaml --model " + kGrass +
                       " -o " + folder.path("set.yaml"));
  INFO(made.printed);
  CHECK(made.status == 0);
  const Run shown = run("show " + folder.path("set.yaml"));
  CHECK(shown.status == 0);
  CHECK(shown.printed == made.printed);
  CHECK(shown.says("hard_left"));
}

TEST_CASE("tread-patterns warns where patterns ask for more than a model was made from") {
  const Folder folder;
  std::ifstream grass(kGrass);
  std::ofstream narrow(folder.path("narrow.yaml"));
  narrow << grass.rdbuf() << "envelope: {v: 1.2, omega: 1.5, v_omega: 2}\n";
  narrow.close();
  const std::string recipe = kConfigFolder + "patterns/recipes/teodor.yaml";
  const Run made = run("make " + recipe + " --model " + folder.path("narrow.yaml") + " -o " +
                       folder.path("set.yaml"));
  CHECK(made.status == 0);
  CHECK(made.says("narrow.yaml: warning: yaw rate up to"));
  CHECK_FALSE(made.says("warning: speed up to"));
  for (const std::string& arguments :
       {"check " + kSet + " --model " + folder.path("narrow.yaml"),
        "record " + kSet + " -n 1 --surface s --recordings " + folder.path("recorded") +
            " --model " + folder.path("narrow.yaml")}) {
    const Run warned = run(arguments);
    INFO(warned.printed);
    CHECK(warned.status == 0);
    CHECK(warned.says("narrow.yaml: warning: yaw rate up to"));
  }
  CHECK_FALSE(run("check " + kSet + " --model " + kGrass).says("asked for"));
  const Run other =
      run("check " + kSet + " --model " + kConfigFolder + "models/warthog_nominal.yaml");
  CHECK(other.status == 2);
  CHECK(other.says("the model takes left [m/s], right [m/s]"));
}

TEST_CASE("tread-patterns says in one line what is wrong") {
  const Run missing = run("show no/such/file.yaml");
  CHECK(missing.status == 2);
  CHECK(missing.printed.find("tread-patterns: no/such/file.yaml") == 0);
  CHECK(missing.printed.find('\n') == missing.printed.size() - 1);
  const Run unwritable = run("make " + kConfigFolder + "patterns/recipes/teodor.yaml --model " +
                             kGrass + " -o /no/such/folder/set.yaml");
  CHECK(unwritable.status == 2);
  CHECK(unwritable.says("cannot be written"));
}

TEST_CASE("A wrong command line ends with code 2 and writes nothing") {
  const Folder folder;
  CHECK(run("").status == 2);
  CHECK(run("fly").status == 2);
  CHECK(run("show").status == 2);
  CHECK(run("mirror " + kSet + " -o " + folder.path("x.yaml") + " --patern left").status == 2);
  CHECK_FALSE(std::filesystem::exists(folder.path("x.yaml")));
  CHECK(run("--help").status == 0);
  CHECK(run("record --help").status == 0);
}

TEST_CASE("Two sets are compared, and drawn into a picture") {
  const Folder folder;
  REQUIRE(run("make " + kConfigFolder + "patterns/recipes/teodor.yaml --model " + kGrass + " -o " +
              folder.path("grass.yaml"))
              .status == 0);
  const Run shown = run("show " + kSet + " --compare " + folder.path("grass.yaml") + " --picture " +
                        folder.path("both.png"));
  INFO(shown.printed);
  CHECK(shown.status == 0);
  CHECK(shown.says("The heading differs most in 'sharp_left': a turns 91.9 deg, b 115.0 deg."));
  CHECK(folder.text("both.png").substr(1, 3) == "PNG");
  const Run over = run("show " + kSet + " --picture " + kSet);
  CHECK(over.status == 2);
  CHECK(over.says("this is the input"));
  CHECK(run("show " + kSet).status == 0);
}

TEST_CASE("A file is checked: ok, or one line with file and line") {
  const Folder folder;
  const Run good = run("check " + kSet);
  CHECK(good.status == 0);
  CHECK(good.printed == kSet + ": ok, 23 patterns, 3 classes, version 1\n");
  std::ofstream(folder.path("bad.yaml")) << "name: bad\nkind: wind\nperiod_us: 50000\n";
  const Run bad = run("check " + folder.path("bad.yaml"));
  CHECK(bad.status == 2);
  CHECK(bad.printed.find("tread-patterns: " + folder.path("bad.yaml") + ":2: ") == 0);
  CHECK(bad.printed.find('\n') == bad.printed.size() - 1);
}

TEST_CASE("A set is mirrored into another file, never over itself") {
  const Folder folder;
  const Run complete = run("mirror " + kSet + " -o " + folder.path("same.yaml"));
  CHECK(complete.status == 0);
  CHECK(complete.says("every pattern that turns already has its mirror image"));
  const Run itself =
      run("mirror " + folder.path("same.yaml") + " -o " + folder.path("./same.yaml"));
  CHECK(itself.status == 2);
  CHECK(itself.says("this is the input"));
  const Run straight =
      run("mirror " + kSet + " -o " + folder.path("x.yaml") + " --pattern straight");
  CHECK(straight.status == 2);
  CHECK(straight.says("its own mirror image"));
}

TEST_CASE("check finds each fault of a pattern file and names its line and what is allowed") {
  const Folder folder;
  const std::string file = folder.path("tiny.yaml");
  const auto checked = [&](const std::string& from, const std::string& to) {
    std::string text = kGood;
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    std::ofstream(file) << text.replace(at, from.size(), to);
    return run("check " + file);
  };
  REQUIRE(checked("nod", "nod").status == 0);
  const struct {
    const char* from;
    const char* to;
    const char* line;
    const char* words;
  } faults[] = {{"name: nod", "nane: nod", "7", "is nane meant"},
                {"[0.5, 0.5, 2]", "[0.5, 1.5, 2]", "11", "1.5"},
                {"[0.5, 0.5, 2]", "[0.5, 0.5, 3]", "", "3 commands but 2 poses"},
                {"[0.5, 0.5, 2]", "[0.5, .nan, 2]", "1", "nan"},
                {"[0.5, 0.5, 2]", "[0.5, fast, 2]", "12", "fast"},
                {"[0.01, 0, 0]", "[9, 0, 0]", "", "jumps"},
                {"exit: rest", "exit: cruise", "10", "'cruise' is not in the set"},
                {"period_us: 100000", "period_us: 1", "3", "5000 to 1000000"},
                {"kind: power", "kind: wind", "2", "track_speed"},
                {"id: 1", "id: one", "7", "one"}};
  for (const auto& fault : faults) {
    const Run found = checked(fault.from, fault.to);
    INFO(fault.to << ": " << found.printed);
    CHECK(found.status != 0);
    CHECK(found.printed.find("tread-patterns: " + file + ":" + fault.line) == 0);
    CHECK(found.says(fault.words));
    CHECK(found.printed.find('\n') == found.printed.size() - 1);
  }
}

TEST_CASE("check of two patterns with one id or one name names the second") {
  const Folder folder;
  const std::string second = kGood.substr(kGood.find("  - id: 1"));
  std::ofstream(folder.path("twice.yaml")) << kGood << second;
  const Run twice = run("check " + folder.path("twice.yaml"));
  INFO(twice.printed);
  CHECK(twice.status != 0);
  CHECK(twice.printed.find('\n') == twice.printed.size() - 1);
  CHECK(twice.says("twice.yaml:1"));
}

TEST_CASE("make, mirror and record give the same bytes again, record for the same seed only") {
  const Folder folder;
  for (const char* name : {"a.yaml", "b.yaml"})
    REQUIRE(run("make " + kConfigFolder + "patterns/recipes/teodor.yaml --model " + kGrass +
                " -o " + folder.path(name))
                .status == 0);
  CHECK(folder.text("a.yaml") == folder.text("b.yaml"));
  REQUIRE(run("mirror " + folder.path("a.yaml") + " -o " + folder.path("c.yaml")).status == 0);
  CHECK(folder.text("c.yaml") == folder.text("a.yaml"));
  for (const auto& [folder_name, seed] :
       {std::pair{"one", "4"}, std::pair{"two", "4"}, std::pair{"six", "6"}})
    REQUIRE(run("record " + kSet + " --recordings " + folder.path(folder_name) + " --model " +
                kGrass + " --surface grass -n 2 --seed " + seed)
                .status == 0);
  CHECK(folder.text("one/grass.csv").size() > 1000);
  CHECK(folder.text("one/grass.csv") == folder.text("two/grass.csv"));
  CHECK(folder.text("one/grass.csv") != folder.text("six/grass.csv"));
}

TEST_CASE("show prints one row a pattern, and draws a single set") {
  const Folder folder;
  const Run shown = run("show " + kSet + " --picture " + folder.path("one.png"));
  INFO(shown.printed);
  CHECK(shown.status == 0);
  // One line for the set, three classes, a heading and 23 patterns.
  CHECK(std::count(shown.printed.begin(), shown.printed.end(), '\n') == 1 + 3 + 1 + 23);
  CHECK(folder.text("one.png").substr(1, 3) == "PNG");
  const Run nowhere = run("show " + kSet + " --picture /nowhere/one.png");
  CHECK(nowhere.status != 0);
  CHECK(nowhere.says("/nowhere/one.png"));
}

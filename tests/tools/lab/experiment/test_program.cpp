// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/lab/experiment/small_world.hpp"

namespace tread::experiment {
namespace {

namespace fs = std::filesystem;
using namespace testing;

/// A temporary folder.
struct Folder {
  Folder() : path(fs::temp_directory_path() / ("tread-experiment-" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  fs::path path;
};

std::pair<int, std::string> run(const std::string& arguments) {
  const auto called = tread::samples::called("tread-experiment transitions " + arguments);
  return {called.status, called.printed};
}

std::vector<std::string> linesOf(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

using tread::testing::contentOf;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

const std::string kFour = " --rules off,single,collective,omniscient --repetitions 100 --threads 2";

void refuses(const std::string& arguments, const std::string& words) {
  const auto [code, printed] = run(arguments);
  INFO(arguments << "\n" << printed);
  CHECK(code == 2);
  CHECK(printed.find("tread-experiment: ") == 0);
  CHECK(printed.find(words) != std::string::npos);
  CHECK(printed.find('\n') == printed.size() - 1);
}

}  // namespace

TEST_CASE("one command writes all tables, pictures and the report of a world") {
  const Folder folder;
  const std::string out = folder / "out";
  const auto [code, printed] =
      run("--world " + kWorlds + "transitions_symmetric.yaml" + kFour + " --out " + out);
  INFO(printed);
  REQUIRE(code == 0);
  for (const char* words : {"TABLE I:", "TABLE II:", "RMS deviation", "Signs of Table II", "KEY"})
    CHECK(printed.find(words) != std::string::npos);

  const auto table1 = linesOf(out + "/table1.csv");
  REQUIRE(table1.size() == 1 + 12 * 2 * 4);
  CHECK(table1[0] == "from,to,quantity,rule,error,low,high");
  CHECK(table1[1].find("cinder,tarmac,position,off,0.") == 0);
  const auto table2 = linesOf(out + "/table2.csv");
  CHECK(table2[0] == "from,to,quantity,rule,against,reduction_percent,low,high");
  CHECK(table2[1].find("cinder,tarmac,position,collective,single,") == 0);
  REQUIRE(table2.size() == 1 + 12 * 2 * 3);
  const auto all = linesOf(out + "/all_patterns.csv");
  CHECK(all[0] == "from,to,quantity,rule,k,error");
  CHECK(all.size() == 1 + 12 * 2 * 4 * 4);
  const auto unchanged = linesOf(out + "/unchanged.csv");
  CHECK(unchanged[0] == "surface,quantity,rule,ratio");
  CHECK(unchanged.size() == 1 + 4 * 2 * 4);
  const auto first = linesOf(out + "/first_executions.csv");
  CHECK(first[0] == "from,to,quantity,rule,k,error");
  CHECK(first.size() == 1 + 16 * 2 * 4 * 6);
  CHECK(linesOf(out + "/regions.csv").size() == 1);  // none of these rules states a region

  CHECK(linesOf(out + "/unchanged_sequences.csv").size() == unchanged.size());
  CHECK(linesOf(out + "/drift.csv").size() == 1 + 4 * 301);
  CHECK(contentOf(out + "/key_figures.txt").find("unchanged") != std::string::npos);

  for (const char* picture : {"/figure4.png", "/figure5.png", "/drift.png"})
    CHECK(contentOf(out + picture).substr(1, 3) == "PNG");
  const std::string report = contentOf(out + "/report.html");
  CHECK(report.find("data:image/png;base64,iVBORw0KGgo") != std::string::npos);
  CHECK(report.find("src=\"http") == std::string::npos);
  CHECK(contentOf(out + "/table1.txt").find("probably a misprint") != std::string::npos);
  CHECK(contentOf(out + "/table2.txt").find("collective against single") != std::string::npos);
}

TEST_CASE("several sets of recordings give means with their spread, and the numbers of each") {
  const Folder folder;
  write(folder / "small.yaml", kSmallWorld);
  const auto [code, printed] =
      run("--world " + (folder / "small.yaml") + kFour +
          " --sets 3 --length 2 --change-inside --out " + (folder / "out"));
  INFO(printed);
  REQUIRE(code == 0);
  CHECK(printed.find("Means over 3 sets") != std::string::npos);
  CHECK(printed.find("paper") == std::string::npos);
  const auto sets = linesOf(folder / "out/sets.csv");
  CHECK(sets[0] == "table,seed,from,to,quantity,rule,against,k,value");
  // Table I, Table II, all patterns, first executions (also on unchanged ground), unchanged.
  CHECK(sets.size() ==
        1 + 3 * (2 * 2 * 4 + 2 * 2 * 3 + 2 * 2 * 4 * 4 + 4 * 2 * 4 * 6 + 2 * (2 * 2 * 4)));
}

TEST_CASE("the usual methods with extras: lines are short, variants are told") {
  const Folder folder;
  write(folder / "small.yaml", kSmallWorld);
  const auto [code, printed] =
      run("--world " + (folder / "small.yaml") +
          " --repetitions 20 --threads 2 --excitations 5 --excitation 40 --extras --out " +
          (folder / "out"));
  INFO(printed);
  REQUIRE(code == 0);
  CHECK(printed.find("VARIANT: each command held twice as long") != std::string::npos);
  CHECK(printed.find("VARIANT: the ground changes in the middle") != std::string::npos);
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 160);
  CHECK(printed.find("REMEMBERED surfaces") != std::string::npos);
  CHECK(printed.find("90 % REGIONS") != std::string::npos);
  const auto regions = linesOf(folder / "out/regions.csv");
  CHECK(regions[0] == "from,to,quantity,rule,execution,share");
  CHECK(regions.size() == 1 + 4 * 12 * 4);  // multi_model with each history
  const std::string report = contentOf(folder / "out/report.html");
  for (const char* words :
       {"over 5 excitation runs of 40", "Under other conditions", "multi_model_unmet"})
    CHECK(report.find(words) != std::string::npos);
  const std::string figures = contentOf(folder / "out/key_figures.txt");
  for (const std::string& method : defaultMethods())
    CHECK(figures.find("\n" + method + " ") != std::string::npos);
}

TEST_CASE("an option replaces keys of the learner's configuration") {
  const Folder folder;
  write(folder / "small.yaml", kSmallWorld);
  const std::string few =
      "--world " + (folder / "small.yaml") +
      " --rules multi_model,collective --repetitions 20 --threads 2 --force --out " +
      (folder / "out");
  const auto table = [&](const std::string& set) {
    const auto [code, printed] = run(few + set);
    INFO(printed);
    REQUIRE(code == 0);
    return linesOf(folder / "out/table1.csv");
  };
  const auto usual = table(""),
             other = table(" --set ground.change_metres=1 --set ground.fresh=0.9");
  CHECK(usual[1] != other[1]);  // multi_model
  CHECK(usual[2] == other[2]);  // collective
  refuses(few + " --set ground.change_meters=1", "change_meters");
  refuses(few + " --set ground.fresh=7", "ground.fresh=7");
}

TEST_CASE("a folder of recordings gives the same tables as the world that they come from") {
  const Folder folder;
  write(folder / "small.yaml", kSmallWorld);
  recordings::writeRecordings(folder / "recorded",
                              record(readTransitionWorld(folder / "small.yaml"), 1));
  REQUIRE(run("--world " + (folder / "small.yaml") + kFour + " --out " + (folder / "a")).first ==
          0);
  REQUIRE(run("--recordings " + (folder / "recorded") + kFour + " --out " + (folder / "b")).first ==
          0);
  CHECK(linesOf(folder / "a/table1.csv").size() == linesOf(folder / "b/table1.csv").size());
  // Surfaces of a folder are sorted by name.
  CHECK(contentOf(folder / "b/table1.csv").find("ice,road,position,off,") != std::string::npos);
}

TEST_CASE("a set without left and right gets sequences of the patterns most apart") {
  const Folder folder;
  std::string world = kSmallWorld;
  for (const auto& [name, other] : {std::pair{"left", "port"}, std::pair{"right", "starboard"}})
    for (size_t at = world.find(name); at != std::string::npos; at = world.find(name, at))
      world.replace(at, std::string(name).size(), other);
  recordings::writeRecordings(folder / "recorded", record(parseTransitionWorld(world, "small"), 1));
  const auto [code, printed] = run("--recordings " + (folder / "recorded") + kFour);
  INFO(printed);
  CHECK(code == 0);
  CHECK(printed.find("test sequences are port, port, starboard") != std::string::npos);
}

TEST_CASE("the real recordings are compared by one command") {
  const std::string drive = tread::testing::recorded("drive");
  if (drive.empty()) {
    WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
    return;
  }
  const auto [code, printed] = run("--recordings " + drive + " --robot warthog" + kFour);
  INFO(printed);
  CHECK(code == 0);
  CHECK(printed.find("asphalt") != std::string::npos);
  CHECK(printed.find("The paper's") == std::string::npos);
}

TEST_CASE("what cannot be done is one clear line") {
  const Folder folder;
  const std::string world = "--world " + kWorlds + "transitions_symmetric.yaml ";
  refuses(world + "--rules off,magic", "unknown rule 'magic'; known are off");
  refuses(world + "--rules off,off", "twice");
  refuses(world + kFour + " --sequence left,port", "unknown pattern 'port'");
  refuses(world + kFour + " --robot husky", "--robot");
  refuses(world + kFour + " --out /proc/nowhere", "/proc/nowhere");
  refuses("--world " + kWorlds + "demo.yaml", "simulator");
  refuses("--world " + (folder / "none.yaml"), "none.yaml");
  refuses("--recordings " + (folder / "none"), "neither sessions.csv");
  refuses("--recordings " + folder.path.string() + " --sets 2", "--world");

  recordings::PatternRecordings recorded = record(parseTransitionWorld(kSmallWorld, "small"), 1);
  recorded.surfaces[1].executions[1].resize(7);
  recordings::writeRecordings(folder / "few", recorded);
  refuses("--recordings " + (folder / "few") + kFour, "at least 8");
  recorded.surfaces.resize(1);
  recordings::writeRecordings(folder / "one", recorded);
  refuses("--recordings " + (folder / "one") + kFour, "two surfaces");
  refuses("--recordings " + (folder / "one") + " --robot husky" + kFour, "sessions.csv");
}

TEST_CASE("a wrong command line ends with code 2") {
  CHECK(run("").first == 2);
  CHECK(run("--world a --recordings b").first == 2);
  CHECK(run("--world a --memory 1").first == 2);
  CHECK(run("--world a --repetitions 0").first == 2);
  CHECK(run("--help").first == 0);
}

}  // namespace tread::experiment

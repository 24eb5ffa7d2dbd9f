// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdlib>

#include "tests/tools/robot/patterns/patterns_program.hpp"
#include "tools/robot/launch/running_robots.hpp"

using namespace tread::patterns::kit;

namespace {

Run record(const Folder& folder, const std::string& more, const std::string& set = kSet) {
  return run("record " + set + " --recordings " + folder.path("recorded") + " --model " + kGrass +
             " " + more);
}

}  // namespace

TEST_CASE("tread-patterns records surfaces into a folder and averages one into a set") {
  const Folder folder;
  const Run first = record(folder, "--surface grass -n 20");
  INFO(first.printed);
  REQUIRE(first.status == 0);
  CHECK(first.says("recorded/grass.csv: 20 executions of each of 23 patterns\n"));
  const Run refused = record(folder, "--surface grass -n 20 --seed 2");
  CHECK(refused.status == 2);
  CHECK(refused.says("recorded/grass.csv: is there already"));
  const Run again = record(folder, "--surface grass -n 20 --seed 2 --force");
  CHECK(again.says("in the place of what was there"));
  CHECK(record(folder, "--surface lawn -n 3").status == 0);
  const Run averaged =
      run("average " + folder.path("recorded") + " grass -o " + folder.path("grass.yaml"));
  INFO(averaged.printed);
  CHECK(averaged.status == 0);
  CHECK(averaged.says("left: 20 executions averaged by pose\n"));
  CHECK(averaged.says("hard_left: 20 executions averaged by twist (a strong turn)\n"));
  CHECK(averaged.says("teodor_grass: version 1, 23 patterns"));
  const Run checked = run("check " + folder.path("grass.yaml"));
  CHECK(checked.status == 0);
  CHECK(checked.says("grass.yaml: ok, 23 patterns"));
}

TEST_CASE("An average says which executions it rejected and why") {
  const Folder folder;
  REQUIRE(record(folder, "--surface grass -n 4").status == 0);
  std::string text = folder.text("recorded/grass.csv");
  const size_t at = text.find("straight,2,5,");
  REQUIRE(at != std::string::npos);
  text.replace(at, text.find('\n', at) - at, "straight,2,5,40,0,0");
  std::ofstream(folder.path("recorded/grass.csv"), std::ios::binary) << text;
  const Run averaged =
      run("average " + folder.path("recorded") + " grass -o " + folder.path("grass.yaml"));
  INFO(averaged.printed);
  CHECK(averaged.status == 0);
  CHECK(
      averaged.says("straight: 3 executions averaged by pose, 1 rejected:\n  execution 2: it "
                    "moves at "));
}

TEST_CASE("Recording and averaging refuse what makes no sense with one line") {
  const Folder folder;
  REQUIRE(record(folder, "--surface grass -n 2").status == 0);
  const Run few = run("average " + folder.path("recorded") + " grass -o " + folder.path("x.yaml"));
  CHECK(few.status == 2);
  CHECK(few.says("pattern 'straight' has 2 fair executions of 2; at least 3 are needed"));
  CHECK_FALSE(std::filesystem::exists(folder.path("x.yaml")));
  const Run unknown =
      run("average " + folder.path("recorded") + " sand -o " + folder.path("x.yaml"));
  CHECK(unknown.status == 2);
  CHECK(unknown.says("no surface 'sand'; recorded are grass"));
  const Run over = run("average " + folder.path("recorded") + " grass --min-executions 1 -o " +
                       folder.path("recorded/patterns.yaml"));
  CHECK(over.status == 2);
  CHECK(over.says("lies in the input"));
  REQUIRE(run("make " + kConfigFolder + "patterns/recipes/teodor.yaml --model " + kGrass + " -o " +
              folder.path("same.yaml"))
              .status == 0);
  CHECK(record(folder, "--surface lawn -n 2", folder.path("same.yaml")).status == 0);
  REQUIRE(run("mirror " + kSet + " -o " + folder.path("other.yaml")).status == 0);
  CHECK(record(folder, "--surface s -n 0").status == 2);
  CHECK(record(folder, "").status == 2);
  const std::string bad =
      "record " + kSet + " --recordings " + folder.path("b") + " --surface a/b ";
  CHECK(run(bad + "--model " + kGrass).status == 2);
  // Before an hour of driving rather than afterwards.
  const Run live = run(bad + "--live");
  CHECK(live.status == 2);
  CHECK(live.says("surface 'a/b': its name is that of its file"));
  CHECK(run(bad + "--live --model " + kGrass).status == 2);
  CHECK(run("record " + kSet + " --live --recordings /proc/none --surface x").status == 2);
}

TEST_CASE("Recording on the robot finds the one that runs here, and its key") {
  const Folder folder;
  const char* const url = std::getenv("LCM_DEFAULT_URL");
  const std::string url_before = url != nullptr ? url : "";
  unsetenv("LCM_DEFAULT_URL");
  setenv("XDG_RUNTIME_DIR", folder.path("").c_str(), 1);
  const tread::launch::Announcement robot({"one", "memq://", folder.path("no.key")});
  const Run live =
      run("record " + kSet + " --live --recordings " + folder.path("b") + " --surface grass");
  unsetenv("XDG_RUNTIME_DIR");
  if (url != nullptr) setenv("LCM_DEFAULT_URL", url_before.c_str(), 1);
  CHECK(live.status == 2);
  CHECK(live.says("no.key: cannot be read"));
}

TEST_CASE("Recordings stay those of the patterns that they began with") {
  const Folder folder;
  REQUIRE(record(folder, "--surface grass -n 2").status == 0);
  const std::string patterns = folder.text("recorded/patterns.yaml");
  std::string other = folder.text("recorded/patterns.yaml");
  const size_t at = other.find("name: straight");
  REQUIRE(at != std::string::npos);
  other.replace(at, 14, "name: forwards");
  std::ofstream(folder.path("other.yaml")) << other;
  const Run refused = record(folder, "--surface lawn -n 2", folder.path("other.yaml"));
  CHECK(refused.status == 2);
  CHECK(refused.says(
      "recorded/patterns.yaml: these recordings are of another set ('straight' in the place of "
      "'forwards'); record into another folder"));
  CHECK(folder.text("recorded/patterns.yaml") == patterns);
}

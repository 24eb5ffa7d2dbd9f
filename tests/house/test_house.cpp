// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The rules of the house, checked on the sources: permitted includes, and what a core must not
// use.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "common/bus/channels.hpp"
#include "tests/house/sources.hpp"

namespace fs = std::filesystem;

namespace {

struct Include {
  std::string file;    // path from the root
  std::string target;  // the text between quotes or brackets
};

using tread::testing::contentOf;
using tread::testing::foldersOf;
using tread::testing::head;
using tread::testing::sourcesUnder;
using tread::testing::startsWith;

std::vector<Include> includesUnder(const std::string& folder) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::vector<Include> includes;
  for (const fs::path& path : sourcesUnder(folder)) {
    std::istringstream lines(contentOf(path));
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
      if (line.find('#') != line.npos && std::regex_search(line, match, kInclude))
        includes.push_back({fs::relative(path, TREAD_SOURCE_DIR).string(), match[1]});
  }
  return includes;
}

/// Every folder named core, and the device folders of motor_bridge, ins_driver and lidar_driver:
/// bytes and time are their arguments.
std::vector<std::string> pureFolders() {
  std::vector<std::string> folders;
  for (const char* top : {"common", "modules", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TREAD_SOURCE_DIR) / top))
      if (entry.is_directory() && entry.path().filename() == "core")
        folders.push_back(fs::relative(entry.path(), TREAD_SOURCE_DIR).string());
  for (const std::string module :
       {"modules/motor_bridge", "modules/ins_driver", "modules/lidar_driver"})
    for (const std::string& device : foldersOf(module))
      if (device != "core") folders.push_back(module + "/" + device);
  return folders;
}

}  // namespace

TEST_CASE("tests that ctest runs are told where recordings are") {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  if (url == nullptr || std::string(url) != "memq://") return;  // not run by ctest
  CHECK(std::getenv("TREAD_RECORDINGS") != nullptr);
}

TEST_CASE("dependencies point one way: lcmtypes, common, modules, tools, tests") {
  for (const Include& include : includesUnder("common")) {
    CAPTURE(include.file, include.target);
    CHECK_FALSE(startsWith(include.target, "modules/"));
    CHECK_FALSE(startsWith(include.target, "tools/"));
    CHECK_FALSE(startsWith(include.target, "tests/"));
  }
  for (const Include& include : includesUnder("modules")) {
    CAPTURE(include.file, include.target);
    CHECK_FALSE(startsWith(include.target, "tools/"));
    CHECK_FALSE(startsWith(include.target, "tests/"));
  }
  for (const Include& include : includesUnder("tools")) {
    CAPTURE(include.file, include.target);
    CHECK_FALSE(startsWith(include.target, "tests/"));
  }
}

// An audit of the robot must not require reading the laboratory. The simulator belongs to both.
TEST_CASE("the robot includes nothing of the laboratory") {
  for (const char* folder : {"common", "modules", "tools/robot"})
    for (const Include& include : includesUnder(folder)) {
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "tools/lab/"));
      if (!startsWith(include.file, "modules/identification/"))
        CHECK_FALSE(startsWith(include.target, "modules/identification/"));
    }
  CHECK(foldersOf("tools") == std::vector<std::string>{"lab", "robot"});
}

TEST_CASE("a module never includes another module") {
  for (const Include& include : includesUnder("modules")) {
    if (!startsWith(include.target, "modules/")) continue;
    CAPTURE(include.file, include.target);
    CHECK(head(include.file, 2) == head(include.target, 2));
  }
}

TEST_CASE(
    "a core knows neither bus nor clock nor files, nor does what stands behind a device's door") {
  const std::set<std::string> forbidden{"chrono", "ctime",   "time.h",        "fstream",
                                        "cstdio", "stdio.h", "iostream",      "filesystem",
                                        "thread", "mutex",   "random_device", "unistd.h"};
  size_t cores = 0;
  for (const std::string& core : pureFolders()) {
    const bool is_core = core.rfind("/core") == core.size() - 5;
    std::set<std::string> concepts{"common/capture",  "common/execution", "common/fence",
                                   "common/geometry", "common/grid",      "common/ground",
                                   "common/parallel", "common/pattern",   "common/statistics",
                                   "common/vehicle",  "common/words"};
    // A device's folder reads its own section of the configuration.
    if (!is_core) concepts.insert("common/config");
    for (const Include& include : includesUnder(core)) {
      ++cores;
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "lcm/"));
      CHECK_FALSE(startsWith(include.target, "tread/"));
      CHECK_FALSE(startsWith(include.target, "yaml-cpp"));
      CHECK(forbidden.count(include.target) == 0);
      if (startsWith(include.target, "common/"))
        CHECK((concepts.count(head(include.target, 2)) == 1 ||
               startsWith(include.target, "common/soundness/core/")));
      if (startsWith(include.target, "modules/"))
        CHECK((startsWith(include.target, core) ||
               (!is_core && startsWith(include.target, head(core, 2) + "/core"))));
    }
    for (const fs::path& path : sourcesUnder(core)) {
      CAPTURE(path);
      const std::string content = contentOf(path);
      CHECK(content.find("random_device") == std::string::npos);
      CHECK(content.find("std::rand") == std::string::npos);
      CHECK(content.find("Eigen::Random") == std::string::npos);
      CHECK(content.find("::Random(") == std::string::npos);
    }
  }
  CHECK(cores > 50);  // the check must not be empty
}

TEST_CASE("concepts link no bus and include no message type") {
  for (const char* folder :
       {"common/capture", "common/execution", "common/fence", "common/geometry", "common/grid",
        "common/ground", "common/parallel", "common/pattern", "common/statistics", "common/vehicle",
        "common/words"})
    for (const Include& include : includesUnder(folder)) {
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "lcm/"));
      CHECK_FALSE(startsWith(include.target, "tread/"));
      CHECK_FALSE(startsWith(include.target, "common/bus"));
    }
}

// The simulator's process may run a model file instead of the ground truth, to show a named effect.
// The ground truth itself must not use the kernel, or a blind test would find its own equations.
TEST_CASE("the two vehicle models share no equations") {
  for (const char* truth : {"modules/simulator/core", "modules/simulator/emulators"})
    for (const Include& include : includesUnder(truth)) {
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "common/vehicle"));
      if (startsWith(include.target, "modules/"))
        CHECK((startsWith(include.target, "modules/simulator/core/") ||
               startsWith(include.target, "modules/simulator/emulators/")));
    }
  for (const Include& include : includesUnder("common/vehicle")) {
    CAPTURE(include.file, include.target);
    CHECK_FALSE(startsWith(include.target, "modules/"));
  }
}

TEST_CASE("what hides effects shares no source with what finds them") {
  for (const Include& include : includesUnder("tests/study/hide")) {
    CAPTURE(include.file, include.target);
    CHECK_FALSE(startsWith(include.target, "common/vehicle"));
    CHECK_FALSE(startsWith(include.target, "modules/identification"));
    CHECK_FALSE(startsWith(include.target, "tools/"));
  }
  for (const char* folder : {"common", "modules", "tools", "tests/study/models"})
    for (const Include& include : includesUnder(folder)) {
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "tests/study/hide"));
    }
}

// A new effect is one entry in the catalogue and one line in the kernel; no other code uses its
// name. The values in common/vehicle are C++ members, not names.
TEST_CASE("only the catalogue names effects") {
  const fs::path catalogue = fs::path(TREAD_SOURCE_DIR) / "common/vehicle";
  const std::regex entry("\n *\\{\"([a-z_]+)\",\\s*\"[^\"]+\",\\s*\"[xyw]+\",");
  std::string effects;
  size_t count = 0;
  for (const auto& file : fs::directory_iterator(catalogue)) {
    if (!startsWith(file.path().filename().string(), "catalogue_")) continue;
    const std::string text = contentOf(file.path());
    for (std::sregex_iterator found(text.begin(), text.end(), entry), end; found != end; ++found) {
      effects += (count++ == 0 ? "" : "|") + (*found)[1].str();
    }
  }
  CHECK(count >= 40);
  // The same word for other quantities: spread between executions, learned gains, moment of
  // inertia.
  const std::set<std::pair<std::string, std::string>> others{
      {"common/vehicle/model_file.cpp", "crab"},
      {"modules/learner/core/state_text.cpp", "crab"},
      {"modules/simulator/simulator_files.cpp", "steering_rate"},
      {"modules/simulator/simulator_files.cpp", "yaw_inertia"},
      {"tools/lab/experiment/ground.cpp", "crab"}};
  const std::regex literal("\"(" + effects + ")[\".]");
  for (const char* folder : {"common", "modules", "tools"})
    for (const fs::path& path : sourcesUnder(folder)) {
      const std::string file = fs::relative(path, TREAD_SOURCE_DIR).string();
      if (startsWith(file, "common/vehicle/catalogue_")) continue;
      const std::string text = contentOf(path);
      for (std::sregex_iterator found(text.begin(), text.end(), literal), end; found != end;
           ++found) {
        CAPTURE(file, (*found)[1].str());
        CHECK(others.count({file, (*found)[1].str()}) == 1);
      }
    }
}

TEST_CASE("nobody needs mrpt-hwdrivers, and only the reader of rawlogs mrpt-obs") {
  for (const char* folder : {"common", "modules", "tools"})
    for (const Include& include : includesUnder(folder)) {
      CAPTURE(include.file, include.target);
      CHECK_FALSE(startsWith(include.target, "mrpt/hwdrivers"));
      if (startsWith(include.target, "mrpt/obs"))
        CHECK(include.file == "tools/robot/import/rawlog_objects.cpp");
    }
}

// Other ways to open a file for writing would truncate it before there is anything to write. The
// exceptions are locks, files that are secret from the first byte on, and what the build makes.
TEST_CASE("only OutputFile opens files for writing") {
  const std::set<std::string> others{
      "common/types/generator_main.cpp",         // headers, while the house is built
      "common/seal/private_file.cpp",            // a new file that nobody else can read at any time
      "tools/robot/launch/host.cpp",             // a lock
      "tools/robot/launch/process_keeper.cpp",   // logs that processes write to
      "tools/robot/launch/running_robots.cpp"};  // a lock with an address in it
  const std::vector<std::string> opens{"ofstream", "fopen(", "O_CREAT", "O_TRUNC", "write_to_png("};
  size_t writers = 0;
  for (const char* folder : {"common", "modules", "tools"})
    for (const fs::path& path : sourcesUnder(folder)) {
      const std::string file = fs::relative(path, TREAD_SOURCE_DIR).string();
      const std::string text = contentOf(path);
      const auto stands = [&](const std::string& word) { return text.find(word) != text.npos; };
      if (std::none_of(opens.begin(), opens.end(), stands)) continue;
      ++writers;
      CAPTURE(file);
      CHECK((file == "common/store/output_file.cpp" || others.count(file) == 1));
    }
  CHECK(writers == 1 + others.size());
}

TEST_CASE("each folder of common serves at least two modules or tools") {
  std::map<std::string, std::set<std::string>> users;
  for (const char* folder : {"modules", "tools"})
    for (const Include& include : includesUnder(folder))
      if (startsWith(include.target, "common/"))
        users[head(include.target, 2)].insert(
            head(include.file, startsWith(include.file, "tools/") ? 3 : 2));
  for (const std::string& folder : foldersOf("common")) {
    CAPTURE(folder);
    CHECK(users["common/" + folder].size() >= 2);
  }
}

TEST_CASE("no test name holds a semicolon: ctest would take it for two tests that do not exist") {
  const std::regex name("TEST_CASE(_METHOD)?\\(\\s*\"([^\"]*)\"");
  size_t names = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TREAD_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = contentOf(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found) {
      ++names;
      CAPTURE(entry.path().string(), (*found)[2].str());
      CHECK((*found)[2].str().find(';') == std::string::npos);
    }
  }
  CHECK(names > 500);
}

TEST_CASE("the top level holds what the user fixed and nothing else") {
  const std::set<std::string> allowed{
      "CMakeLists.txt", "lcmtypes", "modules",           "common", "config", "tests", "tools",
      "README.md",      "LICENSE",  "CMakePresets.json", "build"};
  for (const auto& entry : fs::directory_iterator(TREAD_SOURCE_DIR)) {
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    CHECK((name.front() == '.' || allowed.count(name) == 1));
  }
}

TEST_CASE("the table of channels says what the table in code says") {
  const std::string readme = contentOf(fs::path(TREAD_SOURCE_DIR) / "lcmtypes/README.md");
  for (const tread::ChannelSpec& channel : tread::kChannels) {
    std::ostringstream row;
    row << "| " << channel.name << " | " << channel.type << " | " << channel.publisher << " | ";
    if (channel.rate_hz > 0) {
      row << channel.rate_hz << " Hz |";
    } else {
      row << "on demand |";
    }
    CAPTURE(row.str());
    CHECK(readme.find(row.str()) != std::string::npos);
  }
}

TEST_CASE("packages.txt says for what each package is, in words that tools/setup knows") {
  const fs::path root = TREAD_SOURCE_DIR;
  const std::string setup = contentOf(root / "tools/setup");
  std::smatch list;
  REQUIRE(std::regex_search(setup, list, std::regex("\npurposes=\\(([a-z ]+)\\)")));
  std::istringstream words(list[1].str());
  std::map<std::string, int> packages;
  for (std::string purpose; words >> purpose;) packages[purpose] = 0;
  std::istringstream lines(contentOf(root / "tools/packages.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string package, purpose, why;
    fields >> package >> purpose >> why;
    CAPTURE(line);
    CHECK_FALSE(why.empty());
    REQUIRE(packages.count(purpose) == 1);
    ++packages[purpose];
  }
  for (const auto& [purpose, count] : packages) CHECK(count > 0);
  // A demo builds and drives; it needs no browser, JDK or checkers.
  CHECK(contentOf(root / "tools/demo").find("\ntools/setup build run ") != std::string::npos);
}

TEST_CASE("README is short (at most 9 kB) and manuals stand in the folders") {
  CHECK(contentOf(fs::path(TREAD_SOURCE_DIR) / "README.md").size() <= 9000);
}

TEST_CASE("the page and its tests need no newer node than Debian 12 has") {
  constexpr int kDebiansNode = 18;
  const std::string lock =
      contentOf(fs::path(TREAD_SOURCE_DIR) / "tools/robot/view/page/package-lock.json");
  const std::regex demand("\"node\": \"([^\"]*)\"");
  size_t demands = 0;
  for (std::sregex_iterator found(lock.begin(), lock.end(), demand), end; found != end; ++found) {
    ++demands;
    const std::string versions = (*found)[1];
    CAPTURE(versions);
    REQUIRE(startsWith(versions, ">="));
    CHECK(std::stoi(versions.substr(2)) <= kDebiansNode);
  }
  CHECK(demands > 20);
}

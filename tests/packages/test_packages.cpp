// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Contents of the Debian packages (config/debian), and that installed programs find their
// configuration. tools/package uses the same components.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"

using tread::samples::called;
using tread::samples::OwnFolder;
using tread::testing::contentOf;
using tread::testing::linesOf;
namespace fs = std::filesystem;

namespace {

using Names = std::set<std::string>;

/// The parts of the build, installed as cpack does before packing.
class Staged {
 public:
  Staged(const std::string& components, const std::string& prefix) {
    for (const std::string& component : linesOf(components)) {
      const std::string command = "DESTDIR=" + folder_.path("") + " cmake --install " +
                                  TREAD_BUILD_DIR " --prefix " + prefix + " --component " +
                                  component + " >" + folder_.path("said") + " 2>&1";
      const int status = std::system(command.c_str());
      INFO(folder_.text("said"));
      REQUIRE(status == 0);
    }
  }
  fs::path at(const std::string& path) const { return folder_.path(path); }
  /// All files below a folder, as paths from the root.
  Names files(const std::string& below) const {
    Names names;
    const fs::path root = folder_.path("");
    for (const auto& entry : fs::recursive_directory_iterator(root / below))
      if (!entry.is_directory()) names.insert("/" + fs::relative(entry.path(), root).string());
    return names;
  }
  Names programs() const {
    Names names;
    for (const std::string& path : files("usr/bin")) names.insert(fs::path(path).filename());
    return names;
  }

 private:
  OwnFolder folder_;
};

Names conffilesOf(const std::string& package) {
  const auto lines =
      linesOf(contentOf(fs::path(TREAD_BUILD_DIR) / "debian" / package / "conffiles"));
  return {lines.begin(), lines.end()};
}

const std::string kRobot = "programs\nconfig\n";

}  // namespace

TEST_CASE("the laboratory's package holds tools/lab, the robot's package all else, studies none") {
  const Names lab = Staged("lab\n", "/usr").programs(), robot = Staged(kRobot, "/usr").programs();
  CHECK(lab == Names{"tread-experiment", "tread-gap", "tread-missions", "tread-overlay",
                     "tread-plan", "tread-replay"});
  for (const char* needed : {"tread-launch", "tread-motor-bridge", "tread-simulator", "tread-spy"})
    CHECK(robot.count(needed) == 1);
  for (const std::string& name : lab) CHECK(robot.count(name) == 0);
  CHECK(robot.count("tread-blind") == 0);
}

TEST_CASE("what people may edit is named to dpkg, so that no newer package replaces it") {
  const Staged robot(kRobot, "/usr"), lab("lab\n", "/usr");
  CHECK(robot.files("etc") == conffilesOf("tread"));
  CHECK(lab.files("etc") == conffilesOf("tread-lab"));
  CHECK(conffilesOf("tread").count("/etc/tread/robots/teodor/robot.yaml") == 1);
}

TEST_CASE("the units of the package start its programs with its configuration") {
  const Staged robot(kRobot, "/usr");
  const std::string unit = contentOf(robot.at("usr/lib/systemd/system/tread@.service"));
  CHECK_THAT(unit, Catch::Contains("ExecStart=/usr/bin/tread-launch /etc/tread/launch/robot.yaml "
                                   "--run /var/lib/tread --only %i\n"));
}

TEST_CASE("an installed program finds the configuration that came with it") {
  const Staged all(kRobot + "lab\n", "/opt/tread");
  const fs::path prefix = all.at("opt/tread");
  const fs::path program = fs::relative(prefix / "bin/tread-missions", TREAD_BIN_DIR);
  CHECK(called(program.string() + " --help").says("dying_battery"));
  fs::rename(prefix / "config", prefix / "gone");
  CHECK_FALSE(called(program.string() + " --help").says("dying_battery"));
}

TEST_CASE("other projects link the two cores of an installed Tread") {
  const Staged lab("lab\n", "/opt/tread");
  const auto run = [&](const std::string& words) {
    const std::string command = "cd " + lab.at("").string() + " && " + words + " >said 2>&1";
    const int status = std::system(command.c_str());
    INFO(words << ": " << contentOf(lab.at("said")));
    REQUIRE(status == 0);
    return contentOf(lab.at("said"));
  };
  for (const char* name : {"learn.cpp", "identify.cpp"})
    CHECK(linesOf(contentOf(lab.at("opt/tread/share/doc/tread-lab/examples") / name)).size() <= 40);
  run("cmake -S opt/tread/share/doc/tread-lab/examples -B built -DCMAKE_BUILD_TYPE=Debug "
      "-DCMAKE_PREFIX_PATH=$PWD/opt/tread");
  run("cmake --build built");
  const std::vector<std::string> learned = linesOf(run("built/learn"));
  REQUIRE(learned.size() == 2);
  CHECK(learned[0] == "shipped: left ends at 1.51 0.83 m, 1.00 rad");
  CHECK(learned[1].rfind("learned: left ends at 1.3", 0) == 0);
  CHECK(run("built/identify") == "motor_deadband 0.100\n");
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The program on the simulated robot: real processes over real LCM.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "common/recordings/recordings.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

using namespace tread;
using testing::Process;
using testing::RobotRun;

namespace {

/// start, straight and stop of the shipped set.
PatternSet threePatterns() {
  PatternSetContent content =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml").content();
  std::vector<MotionPattern> chosen;
  for (const MotionPattern& pattern : content.patterns)
    for (const char* name : {"start", "straight", "stop"})
      if (pattern.name == name) chosen.push_back(pattern);
  content.patterns = chosen;
  content.classes.pop_back();  // reverse
  std::string why;
  return PatternSet::make(content, why).value();
}

/// The parts of the simulated robot that a recorder needs, and the recorder.
class RecorderRun {
 public:
  explicit RecorderRun(const std::string& executions)
      : run_(testing::kField, "[-10, 0, 0]"), folder_(run_.folder() + "/recorded") {
    for (const char* name : {"simulator", "ins_driver", "motor_bridge"}) run_.start(name);
    std::ofstream(run_.folder() + "/set.yaml") << formatPatterns(threePatterns());
    const std::vector<std::string> arguments{"record",   run_.folder() + "/set.yaml",
                                             "--live",   "--recordings",
                                             folder_,    "--surface",
                                             "grass",    "-n",
                                             executions, "--room",
                                             "20",       "--lcm-url",
                                             run_.url()};
    recorder_ = std::make_unique<Process>("tread-patterns", arguments, output_file());
  }

  RobotRun& robot() { return run_; }
  Process& recorder() { return *recorder_; }
  const std::string& folder() const { return folder_; }
  std::string output_file() const { return run_.folder() + "/recorder.log"; }
  std::string output() const { return run_.output("recorder"); }

 private:
  RobotRun run_;
  std::string folder_;
  std::unique_ptr<Process> recorder_;
};

}  // namespace

TEST_CASE("tread-patterns record --live drives the robot once it is armed and stores recordings") {
  RecorderRun run("1");
  run.robot().untilDriving(60.0, [&] { return !run.recorder().running(); });
  INFO(run.output());
  REQUIRE_FALSE(run.recorder().running());
  CHECK(run.recorder().exitCode() == 0);
  const recordings::PatternRecordings recorded = recordings::readRecordings(run.folder());
  CHECK(recorded.surfaces[0].surface == "grass");
  for (size_t p = 0; p < 3; ++p) {
    const double ahead = recorded.surfaces[0].executions[p][0].back().x;
    CHECK(ahead == Approx(threePatterns().patterns()[p].end().x).epsilon(0.2));
  }
  CHECK(run.robot().until(1.0, [&] { return !run.robot().driving(); }));
}

TEST_CASE("Ctrl-C stops a recording: the robot stands, and what was measured is kept beside") {
  RecorderRun run("50");
  REQUIRE(run.robot().untilDriving(60.0, [&] {
    return run.output().find("straight 1 of 50") != std::string::npos && run.robot().driving();
  }));
  run.recorder().signal(SIGINT);
  REQUIRE(run.recorder().waitFor(2.0));
  INFO(run.output());
  CHECK(run.recorder().exitCode() == 1);
  CHECK(run.output().find("interrupted, the robot was stopped; the ") != std::string::npos);
  CHECK(run.robot().until(1.0, [&] { return !run.robot().driving(); }));
  CHECK(std::filesystem::exists(run.folder() + "/grass.csv.part"));
  CHECK_FALSE(std::filesystem::exists(run.folder() + "/grass.csv"));
}

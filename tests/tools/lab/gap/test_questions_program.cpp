// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "tests/tools/lab/gap/arc_drive.hpp"
#include "tests/tools/lab/gap/gap_program.hpp"

namespace tread::gap {
namespace {

using samples::Folder;
using samples::kModels;
using samples::run;
using samples::Run;
using samples::writeDrive;

}  // namespace

TEST_CASE("what-if shows what an effect does, as numbers and as pictures") {
  const Folder folder;
  const std::string model = "what-if --model " + kModels + "teodor_grass.yaml ";
  const Run without = run(model + "--remove icr_offset --out " + folder.path("w.svg"));
  CHECK(without.status == 0);
  CHECK(without.says("What if: without centre of rotation"));
  CHECK(without.says("fast turn on the spot"));
  CHECK(folder.text("w.svg").find("</svg>") != std::string::npos);
  CHECK(without.says("teodor_grass.yaml. Full speed of the manoeuvres: full power (1.10 m/s"));
  CHECK(without.says("Before: the model as it is; after: the changed model."));
  CHECK(without.says(" mm "));
  const Run level = run(model + "--add slope_pitch");
  CHECK(level.says("No manoeuvre shows a difference"));
  CHECK_FALSE(run(model + "--add slope_pitch --pitch 10").says("No manoeuvre shows"));
  CHECK(run(model + "--add turn_power_limit --set limit=0.5").status == 0);
}

TEST_CASE("what-if simulates the executions of a log") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 40.0);
  const Run of_log =
      run("what-if --model " + kModels + "warthog_asphalt.yaml --add slip_ratio --log " +
          folder.path("drive.lcmlog") + " --out " + folder.path("w.html"));
  INFO(of_log.printed);
  CHECK(of_log.status == 0);
  CHECK(of_log.says("executions of the log"));
  CHECK(of_log.says("Full speed of the manoeuvres: 1 m/s (the model's file has no envelope"));
  CHECK(of_log.says("drive.lcmlog. Before: "));
  CHECK(of_log.says("before: model as it is"));
  CHECK(folder.text("w.html").find("On the log") != std::string::npos);
}

TEST_CASE("plan writes a pattern set that tells two effects apart, and that can be driven") {
  const Folder folder;
  const std::string model = kModels + "teodor_tarmac.yaml";
  const Run plan =
      run("plan track_asymmetry yaw_pull --model " + model + " --out " + folder.path("p.yaml"));
  INFO(plan.printed);
  CHECK(plan.status == 0);
  CHECK(plan.says("s of driving"));
  const PatternSet set = readPatternFile(folder.path("p.yaml"));
  double seconds = 0.0;
  for (const MotionPattern& pattern : set.patterns())
    seconds += set.periodSeconds() * static_cast<double>(pattern.commands.size());
  CHECK(seconds <= 120.0);
  const Run record = samples::runProgram(
      "tread-patterns", "record " + folder.path("p.yaml") + " --recordings " +
                            folder.path("recorded") + " --surface here -n 1 --model " + model);
  INFO(record.printed);
  CHECK(record.status == 0);
}

TEST_CASE("plan and what-if refuse an effect that the model's vehicle cannot have") {
  const std::string model = " --model " + kModels + "warthog_asphalt.yaml";
  const auto refused = [&](const std::string& question, const std::string& request) {
    const Run answer = run(question + model);
    INFO(answer.printed);
    CHECK(answer.status == 2);
    CHECK(answer.says(request + ": no effect of two tracks, which the model is of"));
  };
  refused("plan yaw_pull steering_ratio", "plan steering_ratio");
  refused("plan wheel_1_loss yaw_pull", "plan wheel_1_loss");
  refused("what-if --add steering_ratio", "--add steering_ratio");
  refused("what-if --set steering_ratio.share=0.1", "--set steering_ratio");
}

TEST_CASE("the order in which plan is given two effects makes no difference") {
  const std::string model = " --model " + kModels + "warthog_asphalt.yaml";
  const Run one = run("plan track_asymmetry yaw_pull" + model);
  const Run other = run("plan yaw_pull track_asymmetry" + model);
  INFO(one.printed << other.printed);
  CHECK(one.status == 0);
  CHECK(one.printed == other.printed);
  CHECK(one.says("if it is yaw pull"));
  CHECK(one.says("if it is left-right asymmetry"));
  CHECK(one.says("warning: it has no envelope; the plan commands up to "));
}

TEST_CASE("a plan stays within what the model was made from, unless a person asks for more") {
  const Folder folder;
  folder.write("seen.yaml",
               "name: a\nkind: track_speed\ngauge: 1.08\nlag: 0.3\nenvelope:\n  v: 2.5\n"
               "  omega: 1.5\n  v_omega: 2\n");
  const std::string plan = "plan centrifugal_drift icr_offset --model " + folder.path("seen.yaml") +
                           " --out " + folder.path("p.yaml");
  const Run within = run(plan);
  INFO(within.printed);
  CHECK(within.status == 0);
  CHECK_FALSE(within.says("warning"));
  const Run check = samples::runProgram(
      "tread-patterns", "check " + folder.path("p.yaml") + " --model " + folder.path("seen.yaml"));
  INFO(check.printed);
  CHECK(check.says("ok, "));
  CHECK_FALSE(check.says("is asked for"));
  const Run beyond = run(plan + " --force --speed 5");
  CHECK(beyond.status == 0);
  CHECK(beyond.says("is asked for, the model was made from up to"));
}

TEST_CASE("plan among the patterns of a set keeps what leads to them and back to standing") {
  const Folder folder;
  const std::string patterns = std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml";
  const Run plan =
      run("plan track_asymmetry gyro_bias --model " + kModels + "teodor_tarmac.yaml --patterns " +
          patterns + " --out " + folder.path("p.yaml"));
  INFO(plan.printed);
  CHECK(plan.status == 0);
  CHECK_NOTHROW(readPatternFile(folder.path("p.yaml")));
}

TEST_CASE("where no drive tells two effects apart, plan names the measurement that does") {
  const Run plan = run("plan icr_offset lever_arm_x --model " + kModels + "teodor_tarmac.yaml");
  INFO(plan.printed);
  CHECK(plan.status == 1);
  CHECK(plan.says("Measure the lever arm with a tape."));
  CHECK(run("plan slope_pitch slip_ratio --model " + kModels + "teodor_tarmac.yaml")
            .says("is not visible in any of these manoeuvres on level ground"));
}

TEST_CASE("compare tells which parameters moved from one log to another") {
  const Folder folder;
  writeDrive(folder.path("yesterday.lcmlog"), 202.0);
  writeDrive(folder.path("today.lcmlog"), 203.0);
  writeDrive(folder.path("sand.lcmlog"), 202.0, 0.4);
  writeDrive(folder.path("short.lcmlog"), 120.0);
  const auto compare = [&](const std::string& second) {
    return run("compare " + folder.path("yesterday.lcmlog") + " " + folder.path(second) +
               " --model " + kModels + "warthog_asphalt.yaml");
  };
  const Run same = compare("today.lcmlog");
  INFO(same.printed);
  CHECK(same.status == 0);
  CHECK(same.says("Nothing moved beyond chance.\nFrom "));
  const Run sand = compare("sand.lcmlog");
  INFO(sand.printed);
  CHECK(sand.status == 10);
  CHECK(sand.says("Changed: yaw_gain ("));
  CHECK(compare("yesterday.lcmlog").status == 2);
  const Run too_short = compare("short.lcmlog");
  CHECK(too_short.status == 2);
  CHECK(
      too_short.says("short.lcmlog: only 120 s of measured driving, too little to tell chance "
                     "from cause: drive at least 200 s"));
}

TEST_CASE("logs of another robot, or imported otherwise, are refused in one line") {
  const Folder folder;
  const std::string measured = "poses: as measured\ngyro: at fixes\n";
  const std::string warthog = "recording: a\nrobot: \"Warthog\"\nformat: steps\nbaseline: 1.08\n";
  const std::string husky = "recording: b\nrobot: \"Husky\"\nformat: steps\nbaseline: 1.08\n";
  writeDrive(folder.path("a.lcmlog"), 30.0, 0.49, warthog + measured);
  writeDrive(folder.path("b.lcmlog"), 31.0, 0.49, warthog + "poses: as logged\ngyro: all\n");
  writeDrive(folder.path("husky.lcmlog"), 32.0, 0.49, husky + measured);
  writeDrive(folder.path("wide.lcmlog"), 33.0, 0.49, "recording: c\nbaseline: 1.1652\n");
  const std::string model = " --model " + kModels + "warthog_asphalt.yaml ";
  const std::string nominal = " --model " + kModels + "warthog_nominal.yaml ";
  const auto logs = [&](const std::string& second) {
    return folder.path("a.lcmlog") + " " + folder.path(second) + " ";
  };
  const std::string out = " --out " + folder.path("out");
  const std::pair<std::string, std::string> kBad[] = {
      {"compare " + logs("b.lcmlog") + model, "import both in the same way"},
      {"compare " + logs("husky.lcmlog") + model, "give logs of one robot"},
      {"compare " + logs("wide.lcmlog") + model,
       "tracks 1.1652 m apart, the model says gauge: 1.08"},
      {"find" + model + "--train " + logs("b.lcmlog") + out, "import both in the same way"},
      {"find" + model + "--train " + logs("wide.lcmlog") + out, "gauge: 1.08"}};
  for (const auto& [arguments, words] : kBad) {
    const Run bad = run(arguments);
    INFO(arguments << "\n" << bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(words));
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("of a truncated log the whole events are compared, and what was lost is said") {
  const Folder folder;
  writeDrive(folder.path("whole.lcmlog"), 202.0);
  writeDrive(folder.path("cut.lcmlog"), 230.0);
  const auto size = std::filesystem::file_size(folder.path("cut.lcmlog"));
  const std::string compare = "compare " + folder.path("whole.lcmlog") + " " +
                              folder.path("cut.lcmlog") + " --model " + kModels +
                              "warthog_asphalt.yaml";
  std::filesystem::resize_file(folder.path("cut.lcmlog"), size * 95 / 100 + 7);
  const Run long_enough = run(compare);
  INFO(long_enough.printed);
  CHECK(long_enough.status == 0);
  CHECK(long_enough.says("ends in the middle of an event"));
  std::filesystem::resize_file(folder.path("cut.lcmlog"), size / 2);
  const Run what_if = run("what-if --add slip_ratio --log " + folder.path("cut.lcmlog") +
                          " --model " + kModels + "warthog_asphalt.yaml");
  CHECK(what_if.says("ends in the middle of an event"));
  const Run too_short = run(compare);
  CHECK(too_short.status == 2);
  CHECK(too_short.says("too little to tell chance from cause"));
  std::filesystem::resize_file(folder.path("cut.lcmlog"), 1000);
  const Run nothing = run("what-if --add slip_ratio --log " + folder.path("cut.lcmlog") +
                          " --model " + kModels + "warthog_asphalt.yaml");
  CHECK(nothing.status == 2);
  CHECK(nothing.says("cut.lcmlog: "));
}

TEST_CASE("repeat wants two logs, and refuses what is none in one line") {
  const Folder folder;
  writeDrive(folder.path("a.lcmlog"), 40.0);
  const std::string model =
      " --model " + kModels + "warthog_asphalt.yaml --out " + folder.path("o");
  const Run alone = run("repeat " + folder.path("a.lcmlog") + model);
  INFO(alone.printed);
  CHECK(alone.status == 2);
  CHECK(alone.says("repeat: one log is not enough; give two or more"));
  const Run twice =
      run("repeat " + folder.path("a.lcmlog") + " " + folder.path("a.lcmlog") + model);
  CHECK(twice.status == 2);
  CHECK(twice.says("the same file as a.lcmlog; give each log once"));
}

}  // namespace tread::gap

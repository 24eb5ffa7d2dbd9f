// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/effects.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/gap/arc_drive.hpp"
#include "tests/tools/gap/gap_program.hpp"

namespace tread::gap {
namespace {

using samples::Folder;
using samples::kModels;
using samples::run;
using samples::Run;
using samples::writeDrive;

}  // namespace

TEST_CASE("every effect of the catalogue is explained, with a check of two minutes") {
  const Run list = run("explain");
  CHECK(list.status == 0);
  for (const Effect& effect : effectCatalogue()) {
    INFO(effect.name);
    CHECK(list.says("  " + effect.name + " "));
    const Run one = run("explain " + effect.name);
    CHECK(one.status == 0);
    for (const char* heading : {"what it is", "equation", "parameters", "changes", "looks like",
                                "tell it apart", "in two minutes"})
      CHECK(one.says(heading));
    CHECK(one.says(effect.title));
  }
  CHECK(run("explain icr_offset").says("lever_arm_x"));
}

TEST_CASE("bad input ends with 2 and one line that says what and where") {
  const Folder folder;
  folder.write(
      "typo.yaml",
      "name: a\nkind: power\nfull_speed: 1\ngauge: 0.6\neffects:\n  slip_ratoi:\n    slip: 0.1\n");
  folder.write("on.yaml",
               "name: a\nkind: track_speed\ngauge: 1\neffects:\n  slip_ratio:\n    slip: 0.1\n");
  folder.write("power.yaml", "name: a\nkind: power\nfull_speed: 1\ngauge: 0.6\n");
  folder.write("no.lcmlog", "this is no log\n");
  writeDrive(folder.path("speeds.lcmlog"), 10.0);
  const std::string grass = "--model " + kModels + "teodor_grass.yaml ";
  const std::string out = " --out " + folder.path("out");
  const std::pair<std::string, std::string> kBad[] = {
      {"", "a command is missing; one of find, explain"},
      {"fnd", "'fnd' is no command; did you mean find?"},
      {"find --train a.lcmlog" + out, "tread-gap find: --model is required"},
      {"find " + grass + "--train a.lcmlog --modle b" + out, "did you mean --model?"},
      {"explain slip_ratoi", "did you mean slip_ratio?"},
      {"find --model none.yaml --train x.lcmlog" + out, "none.yaml: cannot be read"},
      {"find --model " + folder.path("typo.yaml") + " --train x.lcmlog" + out, "typo.yaml:6"},
      {"find " + grass + "--train none.lcmlog" + out, "none.lcmlog"},
      {"find " + grass + "--train " + folder.path("no.lcmlog") + out, "no.lcmlog"},
      {"find " + grass + "--train " + folder.path("speeds.lcmlog") + out,
       "its commands are track speeds"},
      {"what-if " + grass, "nothing to change"},
      {"what-if " + grass + "--remove slip_ratio", "it is off in this model"},
      {"what-if " + grass + "--add slip_ratio --set slip=3", "not plausible"},
      {"what-if " + grass + "--add slip_ratio --set slop=0.3", "no parameter of slip_ratio"},
      {"plan slip_ratio slip_ratio " + grass, "name two effects"},
      {"plan slip_ratio grip " + grass, "'grip' is no effect"},
      {"ladder --log none.lcmlog" + out, "none.lcmlog"},
      {"ladder --log " + folder.path("no.lcmlog") + out, "no.lcmlog"},
      {"ladder --pool --log " + folder.path("speeds.lcmlog") + out, "at least two --log"},
      {"ladder --log " + folder.path("speeds.lcmlog") + " " + folder.path("speeds.lcmlog") + out,
       "give each log once"},
      {"ladder --model " + folder.path("power.yaml") + " --log " + folder.path("speeds.lcmlog") +
           out,
       "its commands are track speeds"},
      {"ladder --model " + folder.path("on.yaml") + " --log " + folder.path("speeds.lcmlog") + out,
       "the effect slip_ratio is on"}};
  for (const auto& [arguments, words] : kBad) {
    const Run bad = run(arguments);
    INFO(arguments << "\n" << bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("a folder that cannot be written is told before anything is read") {
  const Folder folder;
  folder.write("file", "");
  std::filesystem::create_directories(folder.path("taken/model.yaml"));
  const std::string find = "find --model none.yaml --train none.lcmlog --out ";
  const std::pair<std::string, std::string> kBad[] = {{"file", "is no folder"},
                                                      {"file/out", "is no folder"},
                                                      {"taken", "model.yaml in it is a folder"}};
  for (const auto& [out, words] : kBad) {
    const Run bad = run(find + folder.path(out));
    INFO(bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(folder.path(out) + ": cannot be made or written ("));
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
}

TEST_CASE("a log that is too short cannot tell: status 15, the reason, and no model") {
  const Folder folder;
  writeDrive(folder.path("short.lcmlog"), 40.0);
  const std::string find = "find --model " + kModels + "warthog_nominal.yaml --train " +
                           folder.path("short.lcmlog") + " --seed 3";
  const Run first = run(find + " --threads 1 --out " + folder.path("a"));
  INFO(first.printed);
  CHECK(first.status == 15);
  CHECK(first.says("CANNOT_TELL"));
  const auto json = nlohmann::json::parse(folder.text("a/verdict.json"));
  CHECK(json["verdict"] == "CANNOT_TELL");
  CHECK_FALSE(json["reason"].get<std::string>().empty());
  CHECK(json["seed"] == 3);
  CHECK(json["inputs"]["train"][0]["sha256"].get<std::string>().size() == 64);
  CHECK_FALSE(std::filesystem::exists(folder.path("a/model.yaml")));
  CHECK(first.says("No model was written.\n"));
  CHECK(first.says("Report: " + folder.path("a/report.html")));
  SECTION("a model of an earlier run stays as it is, and is said to be one") {
    folder.write("a/model.yaml", "earlier");
    CHECK(
        run(find + " --out " + folder.path("a")).says("a/model.yaml is left from an earlier run"));
    CHECK(folder.text("a/model.yaml") == "earlier");
  }
  SECTION("the same files and seed give the same bytes, whatever the number of threads") {
    CHECK(run(find + " --threads 2 --out " + folder.path("b")).status == 15);
    for (const char* file : {"verdict.json", "report.md", "report.html"}) {
      CHECK_FALSE(folder.text(std::string("a/") + file).empty());
      CHECK(folder.text(std::string("a/") + file) == folder.text(std::string("b/") + file));
    }
  }
}

TEST_CASE("a ladder of a log is a table, a file for people and one for programs, always the same") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 220.0);
  writeDrive(folder.path("short.lcmlog"), 30.0);
  const std::string ladder = "ladder --model " + kModels + "warthog_nominal.yaml --log " +
                             folder.path("drive.lcmlog") + " " + folder.path("short.lcmlog");
  const Run one = run(ladder + " --threads 1 --out " + folder.path("a"));
  INFO(one.printed);
  CHECK(one.status == 0);
  CHECK(one.says("Yaw error after 2 s"));
  CHECK(one.says("short.lcmlog: only 30 s of measured driving, too little to tell chance"));
  const auto json = nlohmann::json::parse(folder.text("a/ladder.json"));
  const auto& rungs = json["nested"][0]["rungs"];
  CHECK(rungs["gain_track"]["yaw_rad"]["median"] < rungs["ideal"]["yaw_rad"]["median"]);
  CHECK(rungs.contains("discovered"));
  CHECK(run(ladder + " --threads 2 --out " + folder.path("b")).status == 0);
  for (const char* file : {"ladder.json", "ladder.md"})
    CHECK(folder.text(std::string("a/") + file) == folder.text(std::string("b/") + file));
}

TEST_CASE("without a model a ladder begins with the track that a recording names, or above it") {
  const Folder folder;
  writeDrive(folder.path("named.lcmlog"), 202.0, 0.49, "recording: a\nbaseline: 1.08\n");
  writeDrive(folder.path("nameless.lcmlog"), 202.0);
  const Run both = run("ladder --log " + folder.path("named.lcmlog") + " " +
                       folder.path("nameless.lcmlog") + " --out " + folder.path("out"));
  INFO(both.printed);
  CHECK(both.status == 0);
  const auto json = nlohmann::json::parse(folder.text("out/ladder.json"));
  const auto& named = json["nested"][0]["rungs"];
  const auto& nameless = json["nested"][1]["rungs"];
  CHECK(named.contains("ideal"));
  CHECK_FALSE(nameless.contains("ideal"));
  // The effective track is fitted, so that it does not matter where it began.
  CHECK(nameless["gain_track"]["yaw_rad"]["rms"].get<double>() ==
        Approx(named["gain_track"]["yaw_rad"]["rms"].get<double>()).epsilon(0.05));
}

TEST_CASE("what-if shows what an effect does, as numbers and as pictures") {
  const Folder folder;
  const std::string model = "what-if --model " + kModels + "teodor_grass.yaml ";
  const Run without = run(model + "--remove icr_offset --out " + folder.path("w.svg"));
  CHECK(without.status == 0);
  CHECK(without.says("What if: without centre of rotation"));
  CHECK(without.says("fast turn on the spot"));
  CHECK(folder.text("w.svg").find("</svg>") != std::string::npos);
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
      "tread-patterns", "record " + folder.path("p.yaml") + " --book " + folder.path("book") +
                            " --surface here -n 1 --model " + model);
  INFO(record.printed);
  CHECK(record.status == 0);
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
  CHECK(one.says("warning: no envelope in it; the plan asks for up to "));
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
  const Run beyond = run(plan + " --speed 5");
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
            .says("shows in none of these manoeuvres on level ground"));
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
      {"find" + model + "--train " + logs("wide.lcmlog") + out, "gauge: 1.08"},
      {"ladder --log " + logs("b.lcmlog") + out, "import both in the same way"},
      {"ladder --pool --log " + logs("husky.lcmlog") + out, "give logs of one robot"},
      {"ladder" + nominal + "--log " + folder.path("wide.lcmlog") + out, "gauge: 1.08"},
      {"ladder" + nominal + "--log " + folder.path("a.lcmlog") + out,
       "only 30 s of measured driving, too little"}};
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
  const Run too_short = run(compare);
  CHECK(too_short.status == 2);
  CHECK(too_short.says("too little to tell chance from cause"));
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The command-line program, and the default rule on recordings of real vehicles.
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/lab/experiment/drawn_driving.hpp"
#include "tools/lab/experiment/adaptation/read_recordings.hpp"
#include "tools/lab/experiment/adaptation/summary.hpp"

namespace tread::adaptation {
namespace {

samples::CalledProgram run(const std::string& arguments) {
  return samples::called("tread-experiment adaptation " + arguments);
}

void refuses(const std::string& arguments, const std::string& words) {
  const samples::CalledProgram result = run(arguments);
  INFO(arguments << "\n" << result.printed);
  CHECK(result.status == 2);
  CHECK(result.printed.rfind("tread-experiment: ", 0) == 0);
  CHECK(result.says(words));
  CHECK(result.isOneLine());
}

TEST_CASE("a folder of drives becomes a page, a picture and two tables") {
  const samples::Folder drives("adaptation");
  const samples::OwnFolder out;
  const std::string folder = writeDriving(drives, {{"a", "grass", 16, 0.46},
                                                   {"b", "grass", 16, 0.5},
                                                   {"c", "sand", 16, 0.54},
                                                   {"d", "ice", 16, 0.3}});
  const samples::CalledProgram result =
      run("--recordings " + folder + " --rules off,multi_model,slip,hindsight --starts 20 --out " +
          out.path("made"));
  INFO(result.printed);
  REQUIRE(result.status == 0);
  CHECK(result.says("surface left out, drawn robot, 10 s ahead"));
  CHECK(result.says("vehicle drawn robot left out: 0 pieces"));
  CHECK(result.says("90 % regions of multi_model that hold the next execution"));
  const std::string page = out.text("made/adaptation.html");
  CHECK(page.find("multi_model relative to no learning") != std::string::npos);
  CHECK(page.find("95 % interval") != std::string::npos);
  CHECK(samples::isPng(out.text("made/adaptation.png")));
  CHECK(out.text("made/adaptation.csv").find("session,\"drawn robot\",5,slip,10,") !=
        std::string::npos);
  CHECK(out.text("made/sessions.csv").find("surface,d,\"drawn robot\",\"ice\",2,off,0,20,") !=
        std::string::npos);
}

TEST_CASE("what cannot be done is refused in one line") {
  const samples::Folder drives("refused");
  refuses("--recordings /nowhere", "neither sessions.csv");
  const std::string folder = writeDriving(drives, {{"a", "grass", 2}, {"b", "grass", 2}});
  refuses("--recordings " + folder, "nothing can be left out");
  refuses("--recordings " + folder + " --rules off,oracle", "unknown rule 'oracle'");
  refuses("--recordings " + folder + " --set ground.nothing=1", "nothing");
}

TEST_CASE("on real drives the default rule is better than no learning and holds its own") {
  const std::string drive = tread::testing::recorded("drive");
  if (drive.empty()) {
    WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
    return;
  }
  Settings settings;
  settings.rules = {kOff, kJudged, "slip"};
  settings.starts = 300;
  settings.threads = 2;
  const Recordings found = readRecordings(drive);
  const AdaptationErrors errors = runAdaptation(found.sessions, settings, nullptr);
  size_t inside = 0, stated = 0;
  for (const SessionErrors& session : errors.sessions)
    if (session.kind == HeldOut::kSession)
      for (size_t k = 2; k < kExecutions.size(); ++k) {
        inside += session.cells[1][k][0].inside;
        stated += session.cells[1][k][0].stated;
      }
  CHECK(stated > 500);
  INFO(inside << " of " << stated << " within 90 % regions");
  // Measured 80 %: the rule does not model the reference's own error.
  CHECK(static_cast<double>(inside) > 0.70 * static_cast<double>(stated));
  CHECK(static_cast<double>(inside) < 0.95 * static_cast<double>(stated));
  size_t judged = 0;
  for (const SummaryLine& line : summaryOf(errors, settings.rules, 1)) {
    if (line.sessions < 2 || line.executions < 3) continue;
    CAPTURE(nameOf(line.kind), line.vehicle, line.rule, line.executions, line.horizon);
    if (line.rule == kJudged) {
      ++judged;
      // Measured .74 to .95 and .58 to 1.00.
      CHECK(line.position.ratio.value < 0.97);
      CHECK(line.yaw.ratio.value < 1.03);
    }
    // Measured .00 to .08 better than slip regression in position; in yaw .00 to .13 better, but
    // .03 worse 10 s ahead in a left-out session.
    if (line.rule == "slip" && line.executions == 3) {
      const bool known_worse = line.kind == HeldOut::kSession && line.horizon == 10;
      CHECK(line.position.difference < 0.01);
      CHECK(line.yaw.difference < (known_worse ? 0.04 : 0.01));
    }
  }
  CHECK(judged == 27);  // session, surface, vehicle; 3, 10, 30 executions; 2, 5, 10 s
}

}  // namespace
}  // namespace tread::adaptation

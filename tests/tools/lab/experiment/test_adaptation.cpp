// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/tools/lab/experiment/drawn_driving.hpp"
#include "tools/lab/experiment/adaptation/adaptation_report.hpp"
#include "tools/lab/experiment/adaptation/summary.hpp"

namespace tread::adaptation {
namespace {

/// Grounds that differ in yaw gain; the last session's is far from the others.
std::vector<SampledSession> drawnSessions(double last_yaw) {
  std::vector<SampledSession> sessions;
  const double yaw[] = {0.46, 0.48, 0.5, 0.52, 0.54};
  for (size_t i = 0; i < 5; ++i)
    sessions.push_back(drawnSession("s" + std::to_string(i), i < 3 ? "grass" : "sand",
                                    {0.95, yaw[i], 0.0}, 20, 0.05, i + 1));
  sessions.push_back(drawnSession("last", "ice", {0.95, last_yaw, 0.0}, 20, 0.05, 20));
  return sessions;
}

Settings few() {
  Settings settings;
  settings.starts = 12;
  return settings;
}

/// Error of a rule relative to no learning in a session.
double ratioOf(const AdaptationErrors& errors, const Settings& settings, HeldOut kind,
               const std::string& session, const std::string& rule, size_t k, size_t h, bool yaw) {
  const auto place = [&](const std::string& name) {
    return static_cast<size_t>(std::find(settings.rules.begin(), settings.rules.end(), name) -
                               settings.rules.begin());
  };
  for (const SessionErrors& one : errors.sessions) {
    if (one.kind != kind || one.session != session) continue;
    const Cell& cell = one.cells[place(rule)][k][h];
    const Cell& off = one.cells[place(kOff)][k][h];
    REQUIRE(cell.starts == off.starts);
    REQUIRE(off.starts > 0);
    return yaw ? cell.yaw / off.yaw : cell.position / off.position;
  }
  return testing::kNan;
}

TEST_CASE("on ground of another yaw gain every rule becomes better, on known ground none worse") {
  const std::vector<SampledSession> sessions = drawnSessions(0.3);
  const Settings settings = few();
  const AdaptationErrors errors = runAdaptation(sessions, settings, nullptr);
  for (const std::string& rule : settings.rules) {
    if (rule == kOff) continue;
    CAPTURE(rule);
    const auto far = [&](size_t k, size_t h) {
      return ratioOf(errors, settings, HeldOut::kSurface, "last", rule, k, h, true);
    };
    // After ten executions; two and ten seconds ahead. The paper's rule scales by single
    // executions.
    const double most = rule == "collective" ? 0.75 : 0.4;
    CHECK(far(3, 0) < most);
    CHECK(far(3, 2) < most);
    if (rule == "collective" || rule == "multi_model_home") continue;
    // The mean of the known grounds: nothing can be gained there.
    CHECK(ratioOf(errors, settings, HeldOut::kSession, "s2", rule, 3, 0, true) < 1.15);
  }
  CHECK(ratioOf(errors, settings, HeldOut::kSurface, "last", kJudged, 0, 0, true) ==
        Approx(1.0).margin(1e-6));
}

TEST_CASE("the same sessions and settings give the same bytes, for any number of threads") {
  const std::vector<SampledSession> sessions = drawnSessions(0.4);
  Report one, two;
  one.settings = two.settings = few();
  one.settings.starts = two.settings.starts = 3;
  two.settings.threads = 2;
  for (Report* report : {&one, &two}) {
    report->errors = runAdaptation(sessions, report->settings, nullptr);
    report->lines = summaryOf(report->errors, report->settings.rules, 1);
  }
  CHECK(csvOfSessions(one) == csvOfSessions(two));
  CHECK(csvOfLines(one) == csvOfLines(two));
  CHECK_THAT(csvOfSessions(one),
             Catch::Contains("surface,last,\"drawn\",\"ice\",10,multi_model,3"));
}

TEST_CASE("longer predictions are pieces in a chain, and what was not measured is not scored") {
  // Without noise, on ground that the reference knows exactly, the chain ends at the truth.
  std::vector<SampledSession> sessions;
  for (size_t i = 0; i < 4; ++i)
    sessions.push_back(drawnSession("s" + std::to_string(i), "grass", {}, 12, 0.0, i + 1));
  const size_t cut = sessions[3].pieces[20].begin + 5;
  sessions[3].segments[0].poses[cut].x = testing::kNan;
  cutPieces(sessions[3]);
  Settings settings = few();
  settings.rules = {kOff, kJudged};
  settings.starts = 100;
  const AdaptationErrors errors = runAdaptation(sessions, settings, nullptr);
  REQUIRE(errors.sessions.size() == 4);  // one surface and one vehicle: only sessions are left out
  CHECK(errors.notes.size() == 2);
  for (const SessionErrors& session : errors.sessions)
    for (size_t h = 0; h < kHorizons.size(); ++h) {
      CAPTURE(session.session, h);
      CHECK(session.cells[0][0][h].position < 0.05);
      CHECK(session.cells[0][0][h].yaw < 0.02);
    }
  // 36 pieces: all begin a prediction of 2 s, the last four none of 10 s.
  CHECK(errors.sessions[0].cells[0][0][0].starts == 36);
  CHECK(errors.sessions[0].cells[0][0][2].starts == 32);
  // One piece is lost at the gap, and four before it do not reach 10 s.
  CHECK(errors.sessions[3].cells[0][0][0].starts == 35);
  CHECK(errors.sessions[3].cells[0][0][2].starts == 27);
}

TEST_CASE("what cannot be left out and rules that nobody knows are refused in one line") {
  const std::vector<SampledSession> one{drawnSession("alone", "grass", {}, 12, 0.0, 1)};
  CHECK_THROWS_WITH(runAdaptation(one, few(), nullptr), Catch::Contains("nothing can be left out"));
  Settings settings = few();
  settings.rules = {kOff, "oracle"};
  CHECK_THROWS_WITH(runAdaptation(one, settings, nullptr),
                    Catch::Contains("unknown rule 'oracle'"));
  settings.rules = {"slip"};
  CHECK_THROWS_WITH(runAdaptation(one, settings, nullptr), Catch::Contains("'off' is required"));
  settings.rules = {kOff, kOff};
  CHECK_THROWS_WITH(runAdaptation(one, settings, nullptr), Catch::Contains("is given twice"));
}

TEST_CASE("intervals are over sessions") {
  CHECK(std::isnan(intervalOf({}, 1).value));
  CHECK(intervalOf({2.0}, 1).value == 2.0);
  CHECK(std::isnan(intervalOf({2.0}, 1).low));
  const ConfidenceInterval same = intervalOf({1.5, 1.5, 1.5}, 1);
  CHECK(same.low == 1.5);
  CHECK(same.high == 1.5);
  // With two values a quarter of the resamples contain only one, a quarter only the other.
  const ConfidenceInterval two = intervalOf({0.0, 1.0}, 1);
  CHECK(two.value == 0.5);
  CHECK(two.low == 0.0);
  CHECK(two.high == 1.0);
}

/// Errors of two rules in some sessions, the same in all cells.
AdaptationErrors drawnErrors(const std::vector<std::pair<double, double>>& off_and_judged) {
  AdaptationErrors errors;
  for (const auto& [off, judged] : off_and_judged) {
    SessionErrors session;
    session.session = "s" + std::to_string(errors.sessions.size());
    session.cells.resize(2);
    for (size_t k = 0; k < kExecutions.size(); ++k)
      for (size_t h = 0; h < kHorizons.size(); ++h) {
        session.cells[0][k][h] = {kLeastStarts, off, off};
        session.cells[1][k][h] = {kLeastStarts, judged, judged};
      }
    errors.sessions.push_back(session);
  }
  return errors;
}

TEST_CASE("better and worse are beyond one standard error over sessions, level is within") {
  const std::vector<std::string> rules{kOff, kJudged};
  const auto standing = [&](const std::vector<std::pair<double, double>>& errors) {
    return summaryOf(drawnErrors(errors), rules, 1).front().position;
  };
  // Ratios 0.8 and 0.9: 0.15 better, standard error 0.05.
  const Standing better = standing({{1.0, 0.8}, {2.0, 1.8}});
  CHECK(better.judged == Verdict::kBetter);
  CHECK(better.difference == Approx(-0.15));
  CHECK(better.standard_error == Approx(0.05));
  CHECK(standing({{1.0, 0.9}, {1.0, 1.1}}).judged == Verdict::kLevel);
  CHECK(standing({{1.0, 1.2}, {1.0, 1.1}}).judged == Verdict::kWorse);
  CHECK(standing({{1.0, 0.5}}).judged == Verdict::kUnknown);  // one session is not enough
  const auto lines = summaryOf(drawnErrors({{1.0, 0.8}, {2.0, 1.8}}), rules, 1);
  const SummaryLine& judged = *std::find_if(
      lines.begin(), lines.end(), [](const SummaryLine& line) { return line.rule == kJudged; });
  CHECK(judged.position.worst == Approx(0.9));
  CHECK(judged.position.worst_session == "s1");
  CHECK(judged.position.error == Approx(1.3));
}

}  // namespace
}  // namespace tread::adaptation

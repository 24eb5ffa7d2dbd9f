// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/study/score/sample_records.hpp"
#include "tests/study/score/score_files.hpp"

using namespace tread::blindtest;
using namespace tread::blindtest::samples;
using Json = nlohmann::ordered_json;

namespace {

const ScoreLine& lineOf(const std::vector<ScoreLine>& lines, const std::string& section,
                        const std::string& what) {
  for (const ScoreLine& line : lines)
    if (line.section == section && line.what == what) return line;
  FAIL("no line " << what);
  return lines.front();
}

const char* const kFalsePositives = "false positives: an effect named in a null log";

const char* const kHeader =
    R"({"format":"tread-blind cases 1","suite":"small","seed":1,"minutes":10.0,"cases":2,"nominal":{}})";

/// A null log with a clean verdict, as a line of cases.jsonl.
std::string recordLine(const std::string& name, const std::string& verdict) {
  const Json nothing = {{"position_m", {{"rms", 0.1}}}, {"yaw_rad", {{"rms", 0.1}}}};
  const Json truth = {{"case", name},
                      {"kind", "null"},
                      {"noise", {{"name", "mid"}}},
                      {"programme", "full"},
                      {"defect", ""},
                      {"size", 0.0},
                      {"minutes", 10.0},
                      {"duration_s", 600.0},
                      {"effects", Json::array()},
                      {"right_verdicts", {"NO_DISCREPANCY"}},
                      {"right_names", Json::array()},
                      {"floor", nothing},
                      {"gap", nothing}};
  const Json said = {{"verdict", verdict},
                     {"reason", ""},
                     {"effects", Json::array()},
                     {"calibrated", Json::object()},
                     {"gap", {{"before", nothing}, {"after", nothing}}},
                     {"unexplained", Json::array()}};
  return Json{{"case", name},
              {"truth", truth},
              {"answer", {{"exit", 0}, {"message", ""}, {"verdict", said}}},
              {"nominal", Json::object()}}
      .dump();
}

/// Temporary folders of shards.
class Shards {
 public:
  Shards() { std::filesystem::create_directories(path_); }
  ~Shards() { std::filesystem::remove_all(path_); }
  std::string add(const std::string& name, const std::vector<std::string>& lines) const {
    std::filesystem::create_directories(path_ / name);
    std::ofstream file(path_ / name / "cases.jsonl");
    for (const std::string& line : lines) file << line << "\n";
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("tread-blind-" + std::to_string(getpid()));
};

}  // namespace

TEST_CASE("null logs: a name is a false positive, other alarms are counted beside it") {
  CaseRecord cannot_tell = hidden({}, "null");
  cannot_tell.answer.verdict = "CANNOT_TELL";
  const std::vector<JudgedCase> cases{judged(hidden({}, "null")),
                                      judged(answered(hidden({}, "null"), {"gyro_bias"})),
                                      judged(cannot_tell)};
  const auto scores = scoresOf(cases);
  CHECK(lineOf(scores, "must", kFalsePositives).hits == 1);
  CHECK(lineOf(scores, "must", "  any verdict but NO_DISCREPANCY in a null log").hits == 2);
  CHECK(lineOf(scores, "null", "an effect is named, 10 min, mid noise").hits == 1);
}

TEST_CASE("single effects are counted for both kinds, and by how their forms fit the catalogue's") {
  CaseRecord vehicle = answered(hidden({"slip_ratio"}, "single"), {"slip_ratio"});
  CaseRecord ins = hidden({"gyro_bias"}, "single");
  ins.truth.effects.front().kind = "measurement";
  ins.truth.effects.front().shape = "other";
  ins.truth.effects.front().form = "kinematic";
  const auto scores = scoresOf({judged(vehicle), judged(ins)});
  const auto named = [&](const std::string& slice) {
    const ScoreLine& line = lineOf(scores, "single: " + slice, "named, 10 min, mid noise, excited");
    return std::make_pair(line.hits, line.cases);
  };
  using Count = std::pair<size_t, size_t>;
  CHECK(named("all") == Count(1, 2));
  CHECK(named("vehicle") == Count(1, 1));
  CHECK(named("measurement") == Count(0, 1));
  CHECK(named("form as in the catalogue") == Count(1, 1));
  CHECK(named("form only like the catalogue's") == Count(0, 1));
  CHECK(named("changed in the 1 kHz dynamics") == Count(1, 1));
}

TEST_CASE("what the drive does not show is no miss, and is listed") {
  CaseRecord record = hidden({"grip_limit"}, "single");
  record.truth.gap = {{0.0001, 0.0001}, {}, 0.0};
  const auto scores = scoresOf({judged(record)});
  CHECK(lineOf(scores, "must", "truth named, single, 10 min, mid noise, excited").cases == 0);
  CHECK(
      lineOf(scores, "not excited: changes the motion by less than 5 % of the noise", "grip_limit")
          .hits == 1);
}

TEST_CASE("cases in recordings are scored by the first name") {
  const auto scores =
      scoresOf({judged(answered(hidden({"gyro_bias"}, "semi"), {"gyro_bias"})),
                judged(answered(hidden({"gyro_bias"}, "semi"), {"yaw_pull", "gyro_bias"}))});
  CHECK(lineOf(scores, "must", "in recordings: first name right").hits == 1);
  CHECK(lineOf(scores, "in recordings", "named").hits == 2);
}

TEST_CASE("the time of answers is read from where the batches left it, and counts for long logs") {
  const Shards shards;
  const std::string a = shards.add("shard-1of1", {kHeader, recordLine("0001", "NO_DISCREPANCY")});
  std::filesystem::create_directories(a + "/batch-1");
  std::ofstream(a + "/batch-1/times.csv") << "case,cpu_s\n0001,12.5\n0002,99\n";
  const ScoredStudy study = scored(merged({a}), secondsBelow({a}));
  const ScoreLine& line =
      lineOf(study.scores, "must", "CPU time of the answer to a 10 min log, with report, median");
  CHECK(line.value == 12.5);
  CHECK(figureWords(line) == "12.5 s (? to ?), n = 1");
}

TEST_CASE("the confusion matrix counts a group with the truth as the truth") {
  CaseRecord twin = answered(hidden({"icr_offset"}, "single"), {"lever_arm_x"});
  twin.truth.effects.front().group = {"lever_arm_x"};
  const Confusion confusion =
      confusionOf({judged(twin), judged(answered(hidden({"icr_offset"}, "single"), {"crab"})),
                   judged(hidden({}, "null"))});
  CHECK(confusion.hidden == std::vector<std::string>{"icr_offset", "nothing"});
  CHECK(confusion.named ==
        std::vector<std::string>{"crab", "icr_offset", "nothing", "unexplained", "refused"});
  CHECK(confusion.share[0] == std::vector<double>{0.5, 0.5, 0.0, 0.0, 0.0});
  CHECK(confusion.share[1][2] == 1.0);
}

TEST_CASE("shards are joined to the same bytes in any order") {
  const Shards shards;
  const std::string a = shards.add("shard-1of2", {kHeader, recordLine("0001", "NO_DISCREPANCY")});
  const std::string b = shards.add("shard-2of2", {kHeader, recordLine("0002", "PARTIAL")});
  const auto lines = merged({a, b});
  CHECK(lines.size() == 3);
  CHECK(merged({b, a}) == lines);
  CHECK(merged({shards.path()}) == lines);
  const ScoredStudy study = scored(lines);
  CHECK(lineOf(study.scores, "must", kFalsePositives).hits == 1);
  CHECK(tableText(study).find("50.0 % (9 to 91), 1 of 2") != std::string::npos);
}

TEST_CASE("shards of another study or with other answers are refused") {
  const Shards shards;
  const std::string a = shards.add("a", {kHeader, recordLine("0001", "NO_DISCREPANCY")});
  const std::string b = shards.add("b", {R"({"seed":2})", recordLine("0002", "PARTIAL")});
  const std::string c = shards.add("c", {kHeader, recordLine("0001", "PARTIAL")});
  CHECK_THROWS_WITH(merged({a, b}), Catch::Contains("of another study"));
  CHECK_THROWS_WITH(merged({a, c}), Catch::Contains("case 0001 is there twice"));
  CHECK_THROWS_WITH(merged({shards.path() + "/none"}), Catch::Contains("neither cases.jsonl"));
}

TEST_CASE("what the motor currents say is right, wrong or nothing, by where the effect is") {
  const auto caseOf = [](const char* place, std::vector<std::optional<bool>> loads) {
    CaseRecord record = answered(hidden({"rolling_resistance"}, "single"),
                                 std::vector<std::string>(loads.size(), "rolling_resistance"));
    record.truth.effects.front().place = place;
    for (size_t i = 0; i < loads.size(); ++i) record.answer.effects[i].load = loads[i];
    return judged(record);
  };
  const std::vector<ScoreLine> lines = scoresOf(
      {caseOf("ground", {true}), caseOf("ground", {true, std::nullopt}), caseOf("ground", {false}),
       caseOf("ground", {true, false}), caseOf("ground", {std::nullopt}), caseOf("drive", {false}),
       caseOf("drive", {}), caseOf("", {true})});
  const auto hits = [&](const char* what) { return lineOf(lines, "motor currents", what).hits; };
  CHECK(lineOf(lines, "motor currents", "ground: right").cases == 5);
  CHECK(hits("ground: right") == 2);
  CHECK(hits("ground: wrong") == 2);
  CHECK(hits("ground: nothing said") == 1);
  CHECK(lineOf(lines, "motor currents", "drive: right").cases == 1);
  CHECK(hits("drive: right") == 1);
}

TEST_CASE("a broken line of cases is named") {
  CHECK_THROWS_WITH(scored({kHeader, R"({"case":"0007"})"}), Catch::Contains("case 0007"));
}

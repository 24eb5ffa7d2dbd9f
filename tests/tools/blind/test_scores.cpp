// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/tools/blind/sample_records.hpp"
#include "tools/blind/score_files.hpp"

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

const char* const kHeader =
    R"({"format":"tread-blind cases 1","suite":"small","seed":1,"minutes":10.0,"cases":2,"nominal":{}})";

/// A null log that was called clean, as a line of cases.jsonl.
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

/// Folders of shards that are gone afterwards.
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

TEST_CASE("a share has Wilson's interval") {
  ScoreLine line;
  line.hits = 9;
  line.cases = 10;
  setShare(line);
  CHECK(line.value == Approx(0.9));
  CHECK(line.low == Approx(0.596).margin(0.001));
  CHECK(line.high == Approx(0.982).margin(0.001));
}

TEST_CASE("a quantile lies between its neighbours") {
  CHECK(quantile({3.0, 1.0, 2.0, 4.0}, 0.5) == Approx(2.5));
  CHECK(quantile({1.0, 2.0}, 0.1) == Approx(1.1));
  CHECK(std::isnan(quantile({}, 0.5)));
}

TEST_CASE("a must with an upper end is short while there are too few cases") {
  ScoreLine line;
  line.must = Must{0.05, false, {}, 0.08};
  CHECK_FALSE(line.met().has_value());
  line.cases = 10;
  setShare(line);
  CHECK(line.met() == false);
  line.cases = 400;
  line.hits = 8;
  setShare(line);
  CHECK(line.met() == true);
}

TEST_CASE("alarms on null logs are counted, whatever they are called") {
  CaseRecord cannot_tell = hidden({}, "null");
  cannot_tell.answer.verdict = "CANNOT_TELL";
  const std::vector<JudgedCase> cases{judged(hidden({}, "null")),
                                      judged(answered(hidden({}, "null"), {"gyro_bias"})),
                                      judged(cannot_tell)};
  const auto scores = scoresOf(cases);
  CHECK(lineOf(scores, "must", "false positives on null logs").hits == 2);
  CHECK(lineOf(scores, "null", "an effect is named, mid noise").hits == 1);
}

TEST_CASE("the confusion matrix counts a group with the truth as the truth") {
  CaseRecord twin = answered(hidden({"icr_offset"}, "single"), {"lever_arm_x"});
  twin.answer.effects.front().group = {"icr_offset"};
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
  CHECK(lineOf(study.scores, "must", "false positives on null logs").hits == 1);
  CHECK(tableText(study).find("50.0 % (9-91), 1 of 2") != std::string::npos);
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

TEST_CASE("a broken line of cases is named") {
  CHECK_THROWS_WITH(scored({kHeader, R"({"case":"0007"})"}), Catch::Contains("case 0007"));
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "common/store/store.hpp"
#include "tests/common/recordings/samples.hpp"

using namespace tread;
using namespace tread::recordings;
using samples::Folder;

namespace {

const std::string kHeader = "pattern,execution,sample,x_m,y_m,yaw_rad\n";

std::string rows(const std::string& pattern, int execution) {
  const std::string start = pattern + "," + std::to_string(execution) + ",";
  return start + "1,0.05,0,0\n" + start + "2,0.1,0,0\n" + start + "3,0.15,0,0\n";
}

/// The error for recordings whose only surface has this text.
std::string errorOf(const std::string& text) {
  const Folder folder;
  folder.write("patterns.yaml", formatPatterns(samples::twoPatterns()));
  folder.write("clay.csv", text);
  try {
    readRecordings(folder.path());
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "no error";
}

void expectError(const std::string& text, const std::string& line, const std::string& part) {
  const std::string message = errorOf(text);
  INFO(message);
  CHECK(message.find("/clay.csv:" + line + ": ") != std::string::npos);
  CHECK(message.find(part) != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("Recordings that were written are read again bit for bit, surfaces sorted by name") {
  const Folder folder;
  PatternRecordings recorded{samples::twoPatterns(), {}};
  recorded.surfaces.push_back(samples::scattered(recorded.patterns, "gravel", 4, 1));
  recorded.surfaces.push_back(samples::scattered(recorded.patterns, "clay", 2, 2));
  writeRecordings(folder.path("new/folder"), recorded);
  const PatternRecordings read = readRecordings(folder.path("new/folder"));
  CHECK(read.patterns.checksum() == recorded.patterns.checksum());
  REQUIRE(read.surfaces.size() == 2);
  CHECK(read.surfaces[0].surface == "clay");
  REQUIRE(read.surfaces[1].executions.size() == 2);
  for (size_t p = 0; p < 2; ++p) {
    REQUIRE(read.surfaces[1].executions[p].size() == 4);
    for (size_t e = 0; e < 4; ++e)
      CHECK(
          samples::same(read.surfaces[1].executions[p][e], recorded.surfaces[0].executions[p][e]));
  }
}

TEST_CASE("Executions may take turns, have numbers left out, and comments between them") {
  const Folder folder;
  folder.write("patterns.yaml", formatPatterns(samples::twoPatterns()));
  folder.write("clay.csv", "# a wet day\n" + kHeader + rows("left", 1) + rows("straight", 1) +
                               "# execution 2 slid off\n\n" + rows("left", 3));
  const PatternRecordings recorded = readRecordings(folder.path());
  CHECK(recorded.surfaces[0].executions[0].size() == 1);
  CHECK(recorded.surfaces[0].executions[1].size() == 2);
}

TEST_CASE("A bad surface is refused with file, line and what to do") {
  const std::string good = rows("straight", 1) + rows("left", 1);
  CHECK(errorOf(kHeader + good) == "no error");
  CHECK(errorOf("").find("is empty") != std::string::npos);
  expectError("a,b\n1,2\n", "1", "no column pattern; needed are pattern, execution");
  expectError(kHeader + rows("straight", 1), "4",
              "pattern 'left' of patterns.yaml has no execution");
  expectError(kHeader + good + rows("lift", 2), "8", "'lift' is not in patterns.yaml");
  expectError(kHeader + good + "left,2,1,0,0,0\n", "8", "1 of 3 samples");
  expectError(kHeader + good + "left,2,1,0,0,0\nleft,2,3,0,0,0\n", "9", "follows sample 1");
  expectError(kHeader + good + "left,2,2,0,0,0\n", "8", "begins with sample 2");
  expectError(kHeader + good + "left,1,4,0,0,0\n", "8", "which has 3 commands");
  expectError(kHeader + good + rows("straight", 1), "8", "rising numbers");
  expectError(kHeader + rows("left", 0), "2", "rising numbers");
  expectError(kHeader + "left,1,1,0.1,nan,0\n", "2", "y_m is 'nan'; a finite number");
  expectError(kHeader + "left,1,1,0.1,0,1e999\n", "2", "yaw_rad is '1e999'");
  expectError(kHeader + "left,1,1,0.1\n", "2",
              "4 columns, the header has 6; is the file truncated?");
  expectError(kHeader + "left,1,1,0,0,0,0\n", "2", "7 columns, the header has 6");
  expectError(kHeader + "left,one,1,0,0,0\n", "2", "execution is 'one'");
}

TEST_CASE("A folder without recordings is refused with what is missing") {
  const Folder folder;
  CHECK_THROWS_WITH(readRecordings(folder.path("none")), Catch::Contains("no such folder"));
  CHECK_THROWS_AS(readRecordings(folder.path()), RecordingError);
  folder.write("patterns.yaml", formatPatterns(samples::twoPatterns()));
  CHECK_THROWS_WITH(readRecordings(folder.path()), Catch::Contains("no surface"));
  folder.write("patterns.yaml", "name: broken\nkind: wind\n");
  CHECK_THROWS_WITH(readRecordings(folder.path()), Catch::Contains("patterns.yaml:2"));
}

TEST_CASE("What could not be read again is not written") {
  const Folder folder;
  PatternRecordings recorded{samples::twoPatterns(), {}};
  recorded.surfaces.push_back(samples::scattered(recorded.patterns, "clay", 2, 2));
  PatternRecordings bad = recorded;
  bad.surfaces[0].surface = "../clay";
  CHECK_THROWS_AS(writeRecordings(folder.path("b"), bad), RecordingError);
  bad = recorded;
  bad.surfaces[0].executions[1].clear();
  CHECK_THROWS_WITH(writeRecordings(folder.path("b"), bad),
                    Catch::Contains("'left' has no execution"));
  bad = recorded;
  bad.surfaces[0].executions[1][1][2].x = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(writeRecordings(folder.path("b"), bad), Catch::Contains("execution 2"));
  CHECK_FALSE(std::filesystem::exists(folder.path("b")));
}

TEST_CASE("Recordings of four surfaces, five patterns and 300 executions are read whole") {
  const Folder folder;
  std::vector<MotionPattern> patterns;
  for (int id = 1; id <= 5; ++id)
    patterns.push_back(
        samples::pattern(id, "pattern_" + std::to_string(id), {0.5, 0.0, 0.1 * id}, 20));
  PatternRecordings recorded{samples::setOf(patterns), {}};
  for (const char* surface : {"a", "b", "c", "d"})
    recorded.surfaces.push_back(samples::scattered(recorded.patterns, surface, 300, 1));
  writeRecordings(folder.path(), recorded);
  const PatternRecordings read = readRecordings(folder.path());
  REQUIRE(read.surfaces.size() == 4);
  for (size_t s = 0; s < 4; ++s) {
    REQUIRE(read.surfaces[s].executions.size() == 5);
    for (size_t p = 0; p < 5; ++p) {
      REQUIRE(read.surfaces[s].executions[p].size() == 300);
      const auto& last = read.surfaces[s].executions[p].back();
      CHECK(last.back().x == Approx(recorded.surfaces[s].executions[p].back().back().x));
    }
  }
}

TEST_CASE("A file is written whole or not at all, through links and into pipes") {
  const Folder folder;
  folder.write("old", "old");
  std::filesystem::create_symlink(folder.path("old"), folder.path("link"));
  writeText(folder.path("link"), "new");
  CHECK(std::filesystem::is_symlink(folder.path("link")));
  CHECK(readText(folder.path("old")) == "new");
  writeText("/dev/null", "nothing");
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK_THROWS_WITH(writeText(folder.path("no/such/file"), "x"),
                    Catch::Contains("cannot be written"));
  CHECK_THROWS_WITH(writeText(folder.path(), "x"), Catch::Contains("cannot be written"));
  size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    CHECK(file.path().extension() != ".tmp");
    ++files;
  }
  CHECK(files == 2);
}

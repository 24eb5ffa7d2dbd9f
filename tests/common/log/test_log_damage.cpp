// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "log_helpers.hpp"

namespace tread {
namespace {

using testing::TemporaryFile;

constexpr size_t kEventSize = 28 + 7;  // header and name "CHANNEL", without the message

/// Offset of event i in the log of writeEvents().
size_t startOf(int i) {
  return static_cast<size_t>(i) * kEventSize + static_cast<size_t>(i * (i - 1) / 2);
}

std::vector<int> range(int from, int to) {
  std::vector<int> numbers;
  for (int i = from; i < to; ++i) numbers.push_back(i);
  return numbers;
}

/// Events in a log of this content.
std::vector<int> eventsIn(const std::string& content, std::string& problem) {
  const TemporaryFile file;
  testing::makeFile(file.path, content);
  return testing::eventsOf(file.path, problem);
}

std::string tenEvents() {
  const TemporaryFile file;
  testing::writeEvents(file.path, 10);
  return testing::contentOf(file.path);
}

}  // namespace

TEST_CASE("a log that ends anywhere gives what is whole and says so") {
  const std::string whole = tenEvents();
  for (size_t size = 0; size <= whole.size(); ++size) {
    std::string problem;
    const auto events = eventsIn(whole.substr(0, size), problem);
    int complete = 0;
    while (complete < 10 && startOf(complete + 1) <= size) ++complete;
    INFO("cut at " << size << ": " << problem);
    CHECK(events == range(0, complete));
    CHECK(problem.empty() == (size == startOf(complete)));
    CHECK(problem.find('\n') == std::string::npos);
  }
}

TEST_CASE("a cut log is told in one line") {
  std::string problem;
  eventsIn(tenEvents().substr(0, startOf(4) + 5), problem);
  CHECK_THAT(problem, Catch::Contains("5 bytes left out at 1 place, the first at byte 146; the log "
                                      "ends in the middle of an event"));
}

TEST_CASE("bytes between events are left out and told") {
  std::string content = tenEvents();
  content.insert(startOf(6), "garbage");
  std::string problem;
  const auto events = eventsIn(content, problem);
  // Whether event 5 or its successor was damaged is unknown; doubtful events are dropped.
  CHECK(events == std::vector<int>{0, 1, 2, 3, 4, 6, 7, 8, 9});
  CHECK_THAT(problem, Catch::Contains("at 1 place") && Catch::Contains("they are damaged"));
}

TEST_CASE("a length that lies costs its event, no memory and no neighbours") {
  for (const size_t field : {20U, 24U}) {
    for (const int byte : {0x01, 0x7F, 0x80, 0xFF}) {
      std::string content = tenEvents();
      for (const size_t i : {0U, 3U}) content[startOf(5) + field + i] = static_cast<char>(byte);
      std::string problem;
      const auto events = eventsIn(content, problem);
      INFO("field " << field << " byte " << byte << ": " << problem);
      CHECK(events == std::vector<int>{0, 1, 2, 3, 4, 6, 7, 8, 9});
      CHECK_FALSE(problem.empty());
    }
  }
}

TEST_CASE("what is no log at all is told") {
  std::string problem;
  CHECK(eventsIn("name: not a log\n", problem).empty());
  CHECK_THAT(problem, Catch::Contains("no complete event in it; is this an LCM log?"));
  CHECK_THROWS_WITH(
      LogReader("/tmp/no such log"),
      "log /tmp/no such log: cannot be read (No such file or directory); check the path");
  CHECK_THROWS_WITH(LogReader("/tmp"), Catch::Contains("Is a directory"));
  CHECK_THROWS_AS(LogReader("/dev/zero"), std::runtime_error);
}

TEST_CASE("any damage is survived, and events away from it are kept") {
  const std::string whole = tenEvents();
  std::mt19937_64 random(3);
  for (int round = 0; round < 2000; ++round) {
    std::string content = whole;
    const size_t at = random() % content.size();
    const size_t count = std::min<size_t>(1 + random() % 40, content.size() - at);
    for (size_t i = 0; i < count; ++i) content[at + i] = static_cast<char>(random());
    if (random() % 4 == 0) content.erase(at, count);
    std::string problem;
    const auto events = eventsIn(content, problem);
    INFO("round " << round << ": " << problem);
    // Forty bytes affect up to three events; with a lost sync word also the one before.
    CHECK(std::count_if(events.begin(), events.end(), [](int i) { return i >= 0; }) >= 6);
    CHECK(events.size() <= 10);
  }
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// One drive, logged by recorders with various clock faults: every tool gives the same results,
// and reports the fault in one line.
#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>

#include "common/drive/drive_log.hpp"
#include "common/mcap/mcap_reader.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/robot/view/feed/feed.hpp"

using namespace tread;
using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::OwnFolder;

namespace {

constexpr int64_t kSecond = 1'000'000;             // [us]
constexpr int64_t kUtc = 1'764'190'000 * kSecond;  // of the recorder when the robot's clock is 0
constexpr int64_t kYears35 = int64_t{1} << 50;     // [us]
const std::string kPatterns = TREAD_SOURCE_DIR "/config/patterns/teodor.yaml";
const std::string kModel = TREAD_SOURCE_DIR "/config/models/teodor_tarmac.yaml";

struct WrongClock {
  const char* name;
  const char* told;  ///< in one line; empty: no problem
  std::function<void(std::vector<LogEvent>&)> spoil;
};

void addFrom(std::vector<LogEvent>& events, size_t from, int64_t us) {
  for (size_t i = from; i < events.size(); ++i) events[i].utime += us;
}

/// Every seventh event of the second half has one bit of its time flipped, a different one each
/// time.
void flipBits(std::vector<LogEvent>& events) {
  size_t at = events.size() / 2;
  for (int bit = 21; bit < 64; ++bit, at += 7)
    events[at].utime =
        static_cast<int64_t>(static_cast<uint64_t>(events[at].utime) ^ uint64_t{1} << bit);
}

const std::vector<WrongClock>& wrongClocks() {
  static const std::vector<WrongClock> all{
      {"set back", "the recorder's clock jumped by -5.0 s at 3.",
       [](auto& events) { addFrom(events, 844, -5 * kSecond); }},
      {"set forward", "the recorder's clock jumped by 5.0 s at 3.",
       [](auto& events) { addFrom(events, 844, 5 * kSecond); }},
      {"a year ahead", "the recorder's clock jumped by 31536000.0 s at 3.",
       [](auto& events) { addFrom(events, 844, 365 * 86'400 * kSecond); }},
      {"one bit", "events with a time that cannot be, placed between their neighbours: 1 on ",
       [](auto& events) { events[1000].utime ^= kYears35; }},
      {"many bits",
       "events with a time that cannot be, placed between their neighbours: ", flipBits},
      {"negative", "events with a time that cannot be, placed between their neighbours: 1 on ",
       [](auto& events) { events[1001].utime = -42; }},
      {"nanoseconds", "its times are nanoseconds, not microseconds", [](auto& events) {
         for (LogEvent& event : events) event.utime *= 1000;
       }}};
  return all;
}

/// A drive as recorded by lcm-logger, in UTC; and the same with a wrong clock.
class Recording {
 public:
  Recording() {
    REQUIRE(called("tread-import --format mcap " TREAD_SOURCE_DIR
                   "/tests/data/corpus/usual.mcap -o " +
                   folder_.path("virtual.lcmlog"))
                .status == 0);
    std::string problem;
    events_ = readEvents({folder_.path("virtual.lcmlog")}, problem);
    addFrom(events_, 0, kUtc);
    write(events_);
  }
  /// Writes the log again under the same name, so that tools' outputs are comparable.
  void spoil(const WrongClock& clock) const {
    std::vector<LogEvent> events = events_;
    clock.spoil(events);
    write(events);
  }
  std::string log() const { return folder_.path("drive.lcmlog"); }
  size_t events() const { return events_.size(); }
  /// A tool's output and exit status for it.
  std::string of(const std::string& tool) const {
    for (const char* output : {"out", "out.csv", "out.mcap", "back.lcmlog"})
      std::filesystem::remove_all(folder_.path(output));
    const CalledProgram result = called(tool);
    return result.printed + "exit status " + std::to_string(result.status) + "\n";
  }
  const OwnFolder& folder() const { return folder_; }

 private:
  void write(const std::vector<LogEvent>& events) const {
    std::filesystem::remove(log());
    LogWriter writer(log());
    for (const LogEvent& event : events)
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
    writer.flush();
  }

  OwnFolder folder_;
  std::vector<LogEvent> events_;
};

/// The text without the lines about damage of the log, and their number.
std::string without(const std::string& told, const std::string& text, int& lines) {
  std::istringstream in(text);
  std::string rest;
  for (std::string line; std::getline(in, line);)
    line.find(told) == std::string::npos ? void(rest += line + "\n") : void(++lines);
  return rest;
}

/// Delays of events with lost times are unknown.
std::string withoutLatencies(const std::string& text) {
  std::istringstream in(text);
  std::string rest;
  for (std::string line; std::getline(in, line);)
    if (line.find("  p50 ") == std::string::npos) rest += line + "\n";
  return rest;
}

void requireSameUnderWrongClocks(const std::string& tool) {
  const Recording recording;
  const size_t at = tool.find("LOG");
  const std::string command = tool.substr(0, at) + recording.log() + tool.substr(at + 3);
  const auto placed = [&] {
    std::string line = command;
    if (const size_t out = line.find("OUT"); out != std::string::npos)
      line.replace(out, 3, recording.folder().path("out"));
    return line;
  };
  const std::string healthy = recording.of(placed());
  CAPTURE(command);
  for (const WrongClock& clock : wrongClocks()) {
    recording.spoil(clock);
    CAPTURE(clock.name);
    int lines = 0;
    const std::string said = without(clock.told, recording.of(placed()), lines);
    if (std::string(clock.name) == "many bits")
      CHECK(withoutLatencies(said) == withoutLatencies(healthy));
    else
      CHECK(said == healthy);
    CHECK(lines == 1);
  }
}

}  // namespace

TEST_CASE("tread-report says the same of a drive under every wrong clock, and one line more") {
  requireSameUnderWrongClocks("tread-report LOG");
}

TEST_CASE("tread-why says the same of a drive under every wrong clock, and one line more") {
  requireSameUnderWrongClocks("tread-why LOG");
}

TEST_CASE("tread-replay says the same of a drive under every wrong clock, and one line more") {
  requireSameUnderWrongClocks("tread-replay planner LOG");
  requireSameUnderWrongClocks("tread-replay learner LOG");
  requireSameUnderWrongClocks("tread-replay learner LOG --rule collective --patterns " + kPatterns);
}

TEST_CASE("tread-gap says the same of a drive under every wrong clock, and one line more") {
  requireSameUnderWrongClocks("tread-gap find --train LOG --out OUT --model " + kModel);
}

TEST_CASE("tread-overlay says the same of a drive under every wrong clock, and one line more") {
  requireSameUnderWrongClocks("tread-overlay LOG --length 2 --model " + kModel);
}

TEST_CASE(
    "tread-export writes every message of a drive under every wrong clock, in the robot's time") {
  requireSameUnderWrongClocks("tread-export LOG -o OUT.csv");
  const Recording recording;
  for (const WrongClock& clock : wrongClocks()) {
    recording.spoil(clock);
    CAPTURE(clock.name);
    recording.of("tread-export --no-scene " + recording.log() + " -o " +
                 recording.folder().path("out.mcap"));
    mcap::Reader reader(recording.folder().path("out.mcap"));
    mcap::Message message;
    size_t count = 0;
    for (uint64_t last = 999'000'000; reader.next(message); last = message.log_time, ++count) {
      CHECK(message.log_time >= last);
      CHECK(message.log_time < 10'000'000'000);
    }
    CHECK(count == recording.events());
  }
}

TEST_CASE("MCAP of a drive under a wrong clock comes back with every message") {
  const Recording recording;
  const auto back = [&] {
    recording.of("tread-export " + recording.log() + " -o " + recording.folder().path("out.mcap"));
    REQUIRE(called("tread-import --format mcap " + recording.folder().path("out.mcap") + " -o " +
                   recording.folder().path("back.lcmlog"))
                .status == 0);
    std::string problem;
    std::vector<LogEvent> events = readEvents({recording.folder().path("back.lcmlog")}, problem);
    CHECK(problem.empty());
    return events;
  };
  const std::vector<LogEvent> healthy = back();
  REQUIRE(healthy.size() == recording.events());
  for (const WrongClock& clock : wrongClocks()) {
    recording.spoil(clock);
    const std::vector<LogEvent> events = back();
    CAPTURE(clock.name);
    REQUIRE(events.size() == healthy.size());
    for (size_t i = 0; i < events.size(); ++i) {
      REQUIRE(events[i].bytes == healthy[i].bytes);
      REQUIRE(std::abs(events[i].utime - healthy[i].utime) < kSecond / 10);
    }
  }
}

TEST_CASE("tread-view plays a drive under every wrong clock from its begin to its end") {
  const Recording recording;
  for (const WrongClock& clock : wrongClocks()) {
    recording.spoil(clock);
    CAPTURE(clock.name);
    size_t got = 0;
    view::Feed feed([](uint32_t id) { return id > 0; }, [&](const view::FeedMessage&) {});
    feed.openLogs({recording.log()});
    CHECK_THAT(feed.problem(), Catch::Contains(clock.told));
    view::LogPlayer player({recording.log()});
    CHECK(player.end() - player.begin() == Approx(8.0 * kSecond).margin(0.1 * kSecond));
    int64_t last = 0;
    player.seek(player.begin(), [&](const LogEvent&) { ++got; });
    player.advance(player.end(), [&](const LogEvent& event) {
      ++got;
      CHECK(event.utime >= last);
      last = event.utime;
    });
    CHECK(got == recording.events());
  }
}

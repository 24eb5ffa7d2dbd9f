// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include <catch2/catch.hpp>
#include <lcm/lcm-cpp.hpp>

#include <sys/mount.h>

#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/log/event_log.hpp"
#include "common/seal/key_file.hpp"
#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/logger/recorder.hpp"

namespace tread::testing {
namespace {

namespace fs = std::filesystem;
using logger::makeRoomForLog;

struct Folder {
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code none;
    fs::remove_all(path, none);
  }
  std::string path = fs::temp_directory_path() / ("tread_recorder_" + std::to_string(::getpid()));
};

/// The seq of all MARK messages of a log, in order.
std::vector<int64_t> marksOf(const std::string& path) {
  std::vector<int64_t> seqs;
  LogReader log(path);
  LogEvent event;
  mark_t mark;
  while (log.next(event))
    if (decode(event, kMark, mark)) seqs.push_back(mark.seq);
  CHECK(log.problem().empty());
  return seqs;
}

/// Publishes MARK messages, one each millisecond.
class Speaker {
 public:
  explicit Speaker(const std::string& url, const std::string& key = "")
      : bus_(BusAccess{url, hostSealer(key)}, TimeSource::kHost) {}
  void say(int count, size_t size = 20) {
    for (int i = 0; i < count; ++i) {
      mark_t mark{};
      mark.utime = hostNow();
      mark.seq = said++;
      mark.mark_value = std::string(size, 'x');
      bus_.publish(kMark, mark);
      ::usleep(1000);
    }
  }
  int64_t said = 0;

 private:
  LcmBus bus_;
};

/// Publishes until the recorder receives.
void meet(Speaker& speaker, const std::string& file) {
  for (int i = 0; i < 100; ++i) {
    speaker.say(20);
    if (fs::exists(file) && fs::file_size(file) > 0) return;
  }
  FAIL("the recorder writes nothing");
}

}  // namespace

TEST_CASE("a recorder that gets no processor for half a second has lost nothing afterwards") {
  const Folder folder;
  const std::string url = ownLcmUrl() + "&recv_buf_size=2097152";
  const std::string file = folder.path + "/robot.lcmlog";
  Process recorder("tread-logger", {file, "--lcm-url", url});
  Speaker speaker(url);
  meet(speaker, file + ".0");
  const int64_t from = speaker.said;
  for (int i = 0; i < 3; ++i) {
    recorder.signal(SIGSTOP);
    speaker.say(400);
    recorder.signal(SIGCONT);
    speaker.say(50);
  }
  recorder.signal(SIGINT);
  REQUIRE(recorder.waitFor(5.0));
  CHECK(recorder.exitCode() == 0);
  const std::vector<int64_t> marks = marksOf(file + ".0");
  REQUIRE(!marks.empty());
  CHECK(marks.front() <= from);
  CHECK(marks.back() == speaker.said - 1);
  for (size_t i = 1; i < marks.size(); ++i) REQUIRE(marks[i] == marks[i - 1] + 1);
}

TEST_CASE("a recorder without the key keeps sealed messages as they were sent, and they are read") {
  const Folder folder;
  const std::string url = ownLcmUrl() + "&recv_buf_size=2097152";
  const std::string file = folder.path + "/robot.lcmlog";
  writeNewKey(folder.path + "/key");
  Process recorder("tread-logger", {file, "--lcm-url", url, "--key", "/no/key"});
  Speaker speaker(url, folder.path + "/key");
  meet(speaker, file + ".0");
  recorder.signal(SIGINT);
  REQUIRE(recorder.waitFor(5.0));
  CHECK_FALSE(marksOf(file + ".0").empty());
  lcm::LogFile log(file + ".0", "r");
  const lcm::LogEvent* event = log.readNextEvent();
  while (event != nullptr && event->channel != kMark.name) event = log.readNextEvent();
  REQUIRE(event != nullptr);
  const auto* const bytes = static_cast<const uint8_t*>(event->data);
  const auto size = static_cast<size_t>(event->datalen);
  CHECK(sizeWithoutSeal(bytes, size) == size - kSealBytes);
}

TEST_CASE("a full file moves up and the next one goes on without a gap") {
  const Folder folder;
  const std::string url = ownLcmUrl() + "&recv_buf_size=2097152";
  const std::string file = folder.path + "/robot.lcmlog";
  Process recorder("tread-logger", {file, "--split-mb", "1", "--keep", "3", "--lcm-url", url});
  Speaker speaker(url);
  meet(speaker, file + ".0");
  // The test's bus refuses messages above MARK's limit, so it sends many small ones.
  for (int i = 0; i < 60 && !fs::exists(file + ".1"); ++i) speaker.say(100, 900);
  speaker.say(400, 900);
  recorder.signal(SIGINT);
  REQUIRE(recorder.waitFor(5.0));
  REQUIRE(fs::exists(file + ".1"));
  CHECK(fs::file_size(file + ".1") > 900'000);
  const std::vector<int64_t> older = marksOf(file + ".1");
  const std::vector<int64_t> newer = marksOf(file + ".0");
  REQUIRE(!older.empty());
  REQUIRE(!newer.empty());
  CHECK(newer.front() == older.back() + 1);
  CHECK(newer.back() == speaker.said - 1);
}

TEST_CASE("a recorder that cannot write says so in one line") {
  const Folder folder;
  const std::string words = folder.path + "/words.txt";
  Process recorder("tread-logger", {"/proc/no/log", "--lcm-url", ownLcmUrl()}, words);
  REQUIRE(recorder.waitFor(5.0));
  CHECK(recorder.exitCode() == 1);
  std::ifstream file(words);
  const std::string said{std::istreambuf_iterator<char>(file), {}};
  CHECK_THAT(said, Catch::StartsWith("tread-logger: ") && Catch::Contains("/proc/no"));
  CHECK(said.find('\n') == said.size() - 1);
  Process misused("tread-logger", {"--no-such-option"});
  REQUIRE(misused.waitFor(5.0));
  CHECK(misused.exitCode() == 2);
}

TEST_CASE("a recorder under nohup goes on when its terminal closes") {
  const Folder folder;
  const std::string url = ownLcmUrl();
  const std::string file = folder.path + "/robot.lcmlog";
  Process recorder("/bin/sh",
                   {"-c", "trap '' HUP; exec \"$0\" \"$@\"",
                    std::string(TREAD_BIN_DIR) + "/tread-logger", file, "--lcm-url", url});
  Speaker speaker(url);
  meet(speaker, file + ".0");
  recorder.signal(SIGHUP);
  CHECK_FALSE(recorder.waitFor(0.5));
  recorder.signal(SIGINT);
  REQUIRE(recorder.waitFor(5.0));
  CHECK(recorder.exitCode() == 0);
}

TEST_CASE("a new log moves the earlier ones up and removes the oldest") {
  const Folder own;
  const fs::path folder = own.path;
  const std::string log = (folder / "x").string();
  makeRoomForLog(log, 3);
  for (const char* content : {"first", "second", "third"}) {
    makeRoomForLog(log, 3);
    std::ofstream(log + ".0") << content;
  }
  CHECK(contentOf(log + ".2") == "first");
  CHECK(contentOf(log + ".0") == "third");
  makeRoomForLog(log, 3);
  CHECK_FALSE(fs::exists(log + ".0"));
  CHECK(contentOf(log + ".1") == "third");
  CHECK(contentOf(log + ".2") == "second");
  CHECK_FALSE(fs::exists(log + ".3"));
  // Beyond a gap no file has to be renamed.
  makeRoomForLog(log, 3);
  CHECK(contentOf(log + ".2") == "second");
  makeRoomForLog((folder / "none/x").string(), 3);
}

TEST_CASE("a full disk is told by HEALTH with what is lost, and recording resumes with room") {
  const Folder folder;
  const std::string disk = folder.path + "/disk";
  fs::create_directories(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=14m") != 0) {
    WARN("no disk can be mounted here: not tested");
    return;
  }
  const std::string url = ownLcmUrl() + "&recv_buf_size=2097152";
  const std::string file = disk + "/robot.lcmlog";
  LcmBus listener(url, TimeSource::kHost);
  const Latest<health_t> health(listener, kHealth);
  const auto until = [&](const std::function<bool()>& done) {
    for (int i = 0; i < 400 && !done(); ++i) listener.handle(50);
    return done();
  };
  Process recorder("tread-logger", {file, "--lcm-url", url});
  Speaker speaker(url);
  meet(speaker, file + ".0");
  CHECK(until([&] { return health.any() && health.message().process == "logger"; }));
  CHECK_THAT(health.message().health_reason, Catch::Contains("MB are free"));
  std::ofstream(disk + "/other") << std::string(13'500'000, 'x');
  const bool failed = until([&] {
    speaker.say(100, 900);
    return health.message().health_state == health_t::HEALTH_FAILED;
  });
  CHECK(failed);
  CHECK_THAT(health.message().health_reason,
             Catch::Contains("nothing is recorded") && Catch::Contains("make room"));
  fs::remove(disk + "/other");
  CHECK(until([&] {
    speaker.say(20, 900);
    return health.message().health_state == health_t::HEALTH_DEGRADED;
  }));
  CHECK_THAT(health.message().health_reason, Catch::Contains("the log has a gap"));
  recorder.signal(SIGINT);
  CHECK(recorder.waitFor(5.0));
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST_CASE("a quota removes the oldest files, and never the newest") {
  const Folder own;
  const std::string log = own.path + "/x";
  for (int i = 0; i < 5; ++i) std::ofstream(log + "." + std::to_string(i)) << std::string(100, 'x');
  logger::keepWithin(log, 250);
  CHECK(fs::exists(log + ".0"));
  CHECK(fs::exists(log + ".2"));
  CHECK_FALSE(fs::exists(log + ".3"));
  CHECK_FALSE(fs::exists(log + ".4"));
}

}  // namespace tread::testing

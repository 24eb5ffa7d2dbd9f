// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/drive/drive_log.hpp"
#include "common/mcap/mcap_reader.hpp"
#include "common/messages/blank.hpp"
#include "tests/tools/called_program.hpp"

using namespace tread;
using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::OwnFolder;

namespace {

/// A log of some messages, one foreign and one damaged.
void writeLog(const std::string& path) {
  LogWriter log(path);
  for (int i = 0; i < 50; ++i) {
    auto ins = blank<ins_t>();
    ins.utime = 2'000'000 + i * 20'000;
    ins.seq = i;
    ins.position[0] = 0.1 * i;
    ins.position[1] = ins.position[2] = 0.0;
    DriveLogBuilder::setAttitude(ins, 0.0);
    ins.ins_status = ins_t::STATUS_GOOD;
    log.write(kIns, ins);
  }
  auto mark = blank<mark_t>();
  mark.utime = 3'000'000;
  mark.mark_kind = "note";
  mark.mark_value = "wet, \"deep\" grass";
  log.write(kMark, mark);
  auto program = blank<program_t>();
  program.utime = 3'000'100;
  program.running.num_commands = 2;
  program.running.num_channels = 1;
  program.running.channel_kind = {1};
  program.running.command = {{0.5F}, {0.25F}};
  log.write(kProgram, program);
  const std::vector<uint8_t> foreign{1, 2, 3};
  log.write(3'000'200, "CAMERA", foreign.data(), foreign.size());
  log.write(3'000'300, "INS", foreign.data(), foreign.size());
}

std::vector<LogEvent> eventsOf(const std::string& path) {
  std::string problem;
  return readEvents({path}, problem);
}

}  // namespace

TEST_CASE("a log becomes MCAP and comes back, message for message") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  const CalledProgram exported =
      called("tread-export " + folder.path("drive.lcmlog") + " -o " + folder.path("drive.mcap"));
  CAPTURE(exported.printed);
  REQUIRE(exported.status == 0);
  REQUIRE(exported.says("52 messages on 3 channels"));
  REQUIRE(exported.says("left out: 1 on CAMERA: not of Tread"));
  REQUIRE(exported.says("left out: 1 on INS: broken"));
  const CalledProgram imported = called("tread-import --format mcap " + folder.path("drive.mcap") +
                                        " -o " + folder.path("back.lcmlog"));
  CAPTURE(imported.printed);
  REQUIRE(imported.status == 0);
  REQUIRE(imported.says("back.lcmlog: 52 messages"));
  const auto before = eventsOf(folder.path("drive.lcmlog"));
  const auto after = eventsOf(folder.path("back.lcmlog"));
  REQUIRE(after.size() == 52);
  for (size_t i = 0; i < after.size(); ++i) {
    CHECK(after[i].utime == before[i].utime);
    CHECK(after[i].channel == before[i].channel);
    CHECK(after[i].bytes == before[i].bytes);
  }
}

TEST_CASE("beside the messages stands what viewers draw, and --no-scene leaves it out") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  for (const bool scene : {true, false}) {
    REQUIRE(called("tread-export " + folder.path("drive.lcmlog") + " -o " + folder.path("d.mcap") +
                   (scene ? "" : " --force --no-scene"))
                .status == 0);
    mcap::Reader reader(folder.path("d.mcap"));
    mcap::Message message;
    int drawn = 0;
    while (reader.next(message)) drawn += message.schema_name == "foxglove.FrameTransform" ? 1 : 0;
    REQUIRE(drawn == (scene ? 50 : 0));
  }
}

TEST_CASE("CSV has a column for each number and text, and arrays that vary in one") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  REQUIRE(
      called("tread-export " + folder.path("drive.lcmlog") + " -o " + folder.path("csv")).status ==
      0);
  const std::string ins = folder.text("csv/INS.csv");
  REQUIRE_THAT(ins, Catch::StartsWith("recorded,utime,seq,device_utc,position[0],position[1],"));
  REQUIRE_THAT(ins, Catch::Contains("\n2020000,2020000,1,-1,0.1,0,0,"));
  REQUIRE_THAT(folder.text("csv/MARK.csv"), Catch::Contains("note,\"wet, \"\"deep\"\" grass\""));
  const std::string program = folder.text("csv/PROGRAM.csv");
  REQUIRE_THAT(program, Catch::Contains(",running.execution_id,"));
  REQUIRE_THAT(program, Catch::Contains(",\"[0.5,0.25]\","));
}

TEST_CASE("channels and times can be chosen") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  const CalledProgram some = called("tread-export " + folder.path("drive.lcmlog") + " -o " +
                                    folder.path("csv") + " --channels INS --from 0.1 --to 0.5");
  CAPTURE(some.printed);
  REQUIRE(some.says("21 messages on 1 channels"));
  REQUIRE_FALSE(std::filesystem::exists(folder.path("csv/MARK.csv")));
}

TEST_CASE("what cannot be exported or imported is one clear line") {
  const OwnFolder folder;
  const CalledProgram missing = called("tread-export /nowhere.lcmlog -o " + folder.path("a.mcap"));
  CHECK(missing.status == 2);
  CHECK(missing.isOneLine());
  writeLog(folder.path("drive.lcmlog"));
  const CalledProgram channel = called("tread-export " + folder.path("drive.lcmlog") + " -o " +
                                       folder.path("a.mcap") + " --channels CAMERA");
  CHECK(channel.status == 2);
  CHECK(channel.isOneLine());
  const CalledProgram no_mcap = called("tread-import --format mcap " + folder.path("drive.lcmlog") +
                                       " -o " + folder.path("b"));
  CHECK(no_mcap.status == 2);
  CHECK(no_mcap.says("is no MCAP file"));
  CHECK(no_mcap.isOneLine());
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// data/logs/two_tracks.lcmlog was recorded when commands still were left and right, by that
// version's
//     tread-missions --missions 1 --seed 1 --length 25 --rule collective --log two_tracks.lcmlog
//       --robot tests/data/robots/skid4 --set learner.patterns=FEW
// FEW: straight, left, right, start and stop of skid4's patterns. The file has the first 8 s of
// CONFIG of the learner, MOTOR, EXECUTION, INS, every tenth PROGRAM, PATTERN_SET, LEARNER_STATE,
// LEARNING, ARM.
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <catch2/catch.hpp>

#include <tread_before/motor_t.hpp>

#include "common/drive/drive_log.hpp"
#include "common/execution/stop_reason.hpp"
#include "common/log/older_types.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/types/message_json.hpp"

namespace tread {
namespace {

std::vector<LogEvent> olderEvents() {
  std::string problem;
  std::vector<LogEvent> events =
      readEvents({std::string(TREAD_SOURCE_DIR) + "/tests/data/logs/two_tracks.lcmlog"}, problem);
  REQUIRE(problem.empty());
  return events;
}

template <class Message>
std::vector<Message> messagesOn(const Channel<Message>& channel) {
  std::vector<Message> messages;
  for (const LogEvent& event : olderEvents()) {
    if (event.channel != channel.name) continue;
    Message message{};
    REQUIRE(decode(event, channel, message));
    messages.push_back(message);
  }
  return messages;
}

}  // namespace

TEST_CASE("an older log is read as if it were of today, no message is left out") {
  const DriveLog log = toDriveLog("two_tracks", olderEvents());
  CHECK(log.problem == "");
  REQUIRE(log.motor.size() == 141);
  const motor_t& driven = log.motor.back();
  REQUIRE(driven.bridge_state == motor_t::STATE_DRIVING);
  CHECK(kindsFrom(driven) == kindsOf(trackChannels(CommandKind::kTrackSpeed)));
  CHECK(driven.command[0] == 0.8F);
  CHECK(std::isnan(driven.command[2]));
  CHECK(driven.channel_kind[2] == 0);
  CHECK(std::abs(driven.measured[0] - 0.8F) < 0.2F);
  CHECK(driven.battery_voltage > 20.0F);
  CHECK(log.motor_stamps.back().seq == driven.seq);
}

TEST_CASE("the sets of an older log are complete, and their checksums are those of today") {
  PatternSetAssembler assembler;
  std::map<int64_t, PatternSet> sets;
  for (const pattern_set_part_t& part : messagesOn(kPatternSet))
    if (auto set = assembler.add(part)) sets.emplace(set->version(), *set);
  CHECK(assembler.refused() == 0);
  REQUIRE(sets.size() == 4);
  const PatternSet& set = sets.rbegin()->second;
  CHECK(set.content().channels == trackChannels(CommandKind::kTrackSpeed));
  CHECK(set.findByName("left")->commands.front() != Command{});
}

TEST_CASE("the programs of an older log order what the patterns of its sets command") {
  const std::vector<pattern_set_part_t> parts = messagesOn(kPatternSet);
  size_t compared = 0;
  for (const program_t& program : messagesOn(kProgram)) {
    const program_slot_t& slot = program.running;
    if (slot.execution_id == 0) continue;
    for (const pattern_set_part_t& part : parts) {
      if (part.set_pattern_id != slot.slot_pattern_id || part.set_version != slot.slot_set_version)
        continue;
      CHECK(slot.channel_kind == part.channel_kind);
      REQUIRE(slot.command.size() == part.command.size());
      for (size_t i = 0; i < slot.command.size(); ++i)
        for (size_t channel = 0; channel < 2; ++channel)
          CHECK(slot.command[i][channel] == static_cast<float>(part.command[i][channel]));
      ++compared;
    }
  }
  CHECK(compared > 5);
}

TEST_CASE("a message whose type had fewer fields keeps them, and the new ones are unknown") {
  std::ifstream file(std::string(TREAD_SOURCE_DIR) + "/lcmtypes/before/2026-11-28/plan_t.lcm");
  const MessageTypes types = MessageTypes::fromText(
      std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()));
  const std::string json = R"({"utime": 7, "seq": 3, "goal_id": -1, "set_version": 12,
      "plan_status": 1, "reason": "stopping to turn on the spot", "time_to_go": 12.5,
      "expansions": 5, "search_time": 0, "num_patterns": 1, "execution_id": [3],
      "pattern_id": [4], "pose": [1.0, 2.0, 0.5], "covariance": [0.1, 0, 0, 0.2, 0, "NaN"]})";
  LogEvent event{0, "PLAN", bytesOf(types, *types.find("plan_t"), json), false};
  renew(event);
  plan_t plan{};
  REQUIRE(decode(event, kPlan, plan));
  CHECK(plan.utime == 7);
  CHECK(plan.goal_id == -1);
  CHECK(plan.plan_status == plan_t::PLAN_DRIVING);
  CHECK(plan.reason == "stopping to turn on the spot");
  CHECK(plan.time_to_go == 12.5);
  CHECK(plan.execution_id == std::vector<int64_t>{3});
  CHECK(plan.pose == std::vector<std::vector<double>>{{1.0, 2.0, 0.5}});
  CHECK(plan.covariance[0][3] == 0.2);
  CHECK(std::isnan(plan.covariance[0][5]));
  CHECK(plan.reason_code == -1);  // its text is not a complete sentence
  CHECK(std::isnan(plan.risk));
  CHECK(std::isnan(plan.risk_per_metre));
}

TEST_CASE(
    "a code that a message does not have is that of its words, where these are a whole sentence") {
  std::ifstream file(std::string(TREAD_SOURCE_DIR) + "/lcmtypes/before/2026-11-28/motor_t.lcm");
  const MessageTypes types = MessageTypes::fromText(
      std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()));
  const auto codeOf = [&](const std::string& words) {
    const std::string zeros = "[0, 0, 0, 0, 0, 0, 0, 0]";
    const std::string json =
        R"({"utime": 1, "seq": 1, "motor_run_id": 0, "execution_id": 0, "command_index": -1,
            "bridge_state": 0, "state_reason": ")" +
        words + R"(", "channel_kind": )" + zeros + R"(, "command": )" + zeros +
        R"(, "device_fault": 0, "battery_voltage": 24, "current": )" + zeros + R"(, "measured": )" +
        zeros + "}";
    LogEvent event{0, "MOTOR", bytesOf(types, *types.find("motor_t"), json), false};
    renew(event);
    motor_t motor{};
    REQUIRE(decode(event, kMotor, motor));
    CHECK(motor.holder.empty());
    CHECK(motor.battery_voltage == 24.0F);
    return stopReasonFrom(motor.state_code);
  };
  CHECK(codeOf("") == StopReason::kNone);
  CHECK(codeOf("idle or driven by the operator") == StopReason::kOperatorDrives);
  CHECK(codeOf("stopped by the planner") == StopReason::kStoppedByPlanner);
  CHECK(codeOf("rolled 34 deg, limit 29") == StopReason::kUnsaid);
}

TEST_CASE("only whole messages of their own channel are taken for older ones") {
  const std::vector<uint8_t> older = encoded(tread_before::motor_t{});
  LogEvent event{0, "MOTOR", older, false};
  renew(event);
  motor_t motor{};
  CHECK(decode(event, kMotor, motor));
  LogEvent elsewhere{0, "ARM", older, false};
  renew(elsewhere);
  CHECK(elsewhere.bytes == older);
  LogEvent broken{0, "MOTOR", {older.begin(), older.end() - 1}, false};
  renew(broken);
  CHECK(broken.bytes.size() == older.size() - 1);
}

}  // namespace tread

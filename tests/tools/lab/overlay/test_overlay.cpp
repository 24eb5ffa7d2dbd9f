// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include <unistd.h>

#include <catch2/catch.hpp>

#include <tread/ins_t.hpp>
#include <tread/motor_t.hpp>

#include "common/log/event_log.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/lab/overlay/drive_pieces.hpp"

namespace tread::overlay {
namespace {

ModelDocument modelWith(const std::string& rest) {
  return parseModelDocument(
      "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\ndelay: 0.03\n" + rest, "m");
}

/// A log of a model's drive: MOTOR at 20 Hz, INS at 50 Hz; temporary.
class Log {
 public:
  /// `silent` [s]: omitted INS messages, by time since the first one.
  explicit Log(
      const ModelDocument& model, bool with_ins = true,
      const std::function<bool(double)>& silent = [](double) { return false; })
      : path_(
            (std::filesystem::temp_directory_path() / ("tread-overlay-" + std::to_string(getpid()) +
                                                       "-" + std::to_string(++count_) + ".lcmlog"))
                .string()) {
    const std::vector<MotionSample> said = drive(model);
    LogWriter writer(path_);
    int commands = 0;
    for (size_t i = 0; i < said.size(); ++i) {  // ordered by time, as recorded
      for (; commands < 40 * 20 && 0.05 * commands <= 0.02 * static_cast<double>(i); ++commands)
        writer.write(kMotor, motor(commands));
      if (with_ins && !silent(0.02 * static_cast<double>(i)))
        writer.write(kIns, ins(said[i], static_cast<int64_t>(i)));
    }
    for (; commands < 40 * 20; ++commands) writer.write(kMotor, motor(commands));
  }
  ~Log() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  static TrackCommand commandAt(int i) {
    static const TrackCommand kCommands[] = {
        {0.8, 0.8}, {0.3, 1.0}, {-0.4, 0.4}, {-0.6, -0.6}, {1.0, 0.7}};
    return kCommands[i / 30 % 5];
  }

  static std::vector<MotionSample> drive(const ModelDocument& model) {
    VehicleKernel kernel(model.vehicle, EntryState{});
    std::vector<MotionSample> motion{{0.0, {5.0, -3.0, 1.0}, 0.0}};
    for (int i = 0; i < 40 * 100; ++i) {
      kernel.step(commandAt(i / 5), 0.01);
      const Pose2 T_map_body = Pose2{5.0, -3.0, 1.0} * kernel.pose();
      if (i % 2 == 1) motion.push_back({0.01 * (i + 1), T_map_body, kernel.twist().omega});
    }
    return measure(motion, model.measurement);
  }

  static motor_t motor(int i) {
    motor_t message{};
    message.utime = 1'000'000 + 50'000 * i;
    message.bridge_state = motor_t::STATE_DRIVING;
    message.channel_kind[0] = message.channel_kind[1] = 1;
    message.command[0] = static_cast<float>(commandAt(i).left);
    message.command[1] = static_cast<float>(commandAt(i).right);
    message.battery_voltage = 25.0F;
    return message;
  }

  static ins_t ins(const MotionSample& said, int64_t i) {
    ins_t message{};
    message.utime = 1'000'000 + 20'000 * i;
    message.position[0] = said.T_map_body.x;
    message.position[1] = said.T_map_body.y;
    message.orientation[0] = std::cos(said.T_map_body.yaw / 2.0);
    message.orientation[3] = std::sin(said.T_map_body.yaw / 2.0);
    return message;
  }

  inline static int count_ = 0;  ///< several may exist at the same time
  std::string path_;
};

gap::Drive driveOf(const std::string& path) {
  std::string problem;
  return readLoggedDrive({path}, problem);
}

}  // namespace

TEST_CASE("the model that drove a log stays on what was measured, another one leaves it") {
  const ModelDocument plain = modelWith("");
  const ModelDocument hidden = modelWith(
      "effects:\n  track_asymmetry: {share: 0.04}\n"
      "measurement:\n  lever_arm_x: {offset: 0.2}\n  ins_latency: {latency: 0.2}\n");
  const Log log(hidden);
  const gap::Drive drive = driveOf(log.path());
  const std::vector<ComparedPiece> pieces = replay(drive, {plain, hidden}, 4.0);
  REQUIRE(pieces.size() == 9);
  const size_t last = pieces[0].measured.size() - 1;
  CHECK(last == 40);
  for (const ComparedPiece& piece : pieces) {
    CHECK(piece.positionError(1, last) < 0.01);
    CHECK(piece.yawError(1, last) < 0.005);
  }
  CHECK(medianErrors(pieces, 0, last).position > 0.1);
  CHECK(medianErrors(pieces, 0, last).yaw > 0.1);
  const std::string picture = log.path() + ".png";
  drawOverlay(picture, "a drive", pieces, {"before.yaml", "after.yaml"});
  std::string bytes(4, '\0');
  std::ifstream(picture, std::ios::binary).read(bytes.data(), 4);
  CHECK(bytes.substr(1) == "PNG");
  std::filesystem::remove(picture);
}

TEST_CASE("a log without INS, and a model of another kind of command, are refused in one line") {
  const ModelDocument plain = modelWith("");
  {
    const Log blind(plain, false);
    CHECK_THROWS_WITH(driveOf(blind.path()), Catch::Contains("holds no INS"));
  }
  const Log log(plain);
  ModelDocument wheels = plain;
  wheels.vehicle.kind = CommandKind::kTrackSpeed;
  CHECK_THROWS_WITH(replay(driveOf(log.path()), {wheels}, 4.0),
                    Catch::Contains("another kind of command"));
  CHECK_THROWS(driveOf("/no/such.lcmlog"));
}

TEST_CASE("a model's error is zero on its own track, and does not grow with the way") {
  const ModelDocument exact = modelWith("");
  const Log log(exact);
  const std::vector<ComparedPiece> pieces = replay(driveOf(log.path()), {exact}, 8.0);
  REQUIRE(pieces.size() == 4);
  for (size_t sample = 0; sample <= 80; sample += 20) {
    // The rest is due to the kernel's steps: 10 ms in the drive, 20 ms here.
    CHECK(medianErrors(pieces, 0, sample).position < 0.01);
    CHECK(medianErrors(pieces, 0, sample).yaw < 0.01);
  }
  for (const ComparedPiece& piece : pieces) {
    CHECK(piece.positionError(0, 0) < 1e-12);
    CHECK(piece.yawError(0, 0) < 1e-12);
  }
}

TEST_CASE("the median of pieces is the middle one, and of no piece zero") {
  std::vector<ComparedPiece> pieces;
  for (const double off : {0.1, 5.0, 0.3}) {
    ComparedPiece piece;
    piece.measured = {{0.0, 0.0, 0.0}};
    piece.predicted = {{{3.0 * off, 4.0 * off, -off}}};
    pieces.push_back(piece);
  }
  CHECK(medianErrors(pieces, 0, 0).position == Approx(1.5));
  CHECK(medianErrors(pieces, 0, 0).yaw == Approx(0.3));
  CHECK(medianErrors({}, 0, 0).position == 0.0);
}

TEST_CASE("pieces in which the INS was silent are left out, the others stay") {
  const ModelDocument plain = modelWith("");
  const Log whole(plain);
  const std::vector<ComparedPiece> all = replay(driveOf(whole.path()), {plain}, 4.0);
  const Log gap(plain, true, [](double time) { return time > 17.0 && time < 17.5; });
  const std::vector<ComparedPiece> some = replay(driveOf(gap.path()), {plain}, 4.0);
  // Pieces begin at 3, 7, 11, 15, 19 s; each also needs the preceding 3 s.
  REQUIRE(all.size() == 9);
  REQUIRE(some.size() == 7);
  for (const ComparedPiece& piece : some) {
    CHECK(piece.begin != 15.0);
    CHECK(piece.begin != 19.0);
  }
  const Log short_gap(plain, true, [](double time) { return time > 17.0 && time < 17.2; });
  CHECK(replay(driveOf(short_gap.path()), {plain}, 4.0).size() == 9);
}

TEST_CASE("a picture of one piece and of many is drawn, with one model and with two") {
  const samples::OwnFolder folder;
  const ModelDocument plain = modelWith("");
  const ModelDocument askew = modelWith("effects:\n  track_asymmetry: {share: 0.04}\n");
  const Log log(plain);
  const std::vector<ComparedPiece> pieces = replay(driveOf(log.path()), {askew, plain}, 4.0);
  drawOverlay(folder.path("many.png"), "many", pieces, {"askew.yaml", "plain.yaml"});
  CHECK(samples::isPng(folder.text("many.png")));
  ComparedPiece alone = pieces.front();
  alone.predicted.resize(1);
  drawOverlay(folder.path("one.png"), "one", {alone}, {"askew.yaml"});
  CHECK(samples::isPng(folder.text("one.png")));
  CHECK_THROWS_WITH(drawOverlay("/nowhere/a.png", "none", pieces, {"askew.yaml", "plain.yaml"}),
                    Catch::Contains("/nowhere/a.png"));
}

TEST_CASE("tread-overlay prints each model's errors at two seconds and at the length, and draws") {
  const samples::OwnFolder folder;
  const std::string text =
      "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\ndelay: 0.03\n";
  const std::string exact = folder.write("exact.yaml", text);
  const std::string askew =
      folder.write("askew.yaml", text + "effects:\n  track_asymmetry: {share: 0.04}\n");
  const Log log(modelWith(""));
  const std::string models = " --model " + askew + " --model " + exact;
  const samples::CalledProgram run =
      samples::called("tread-overlay " + log.path() + models + " --length 4 --picture " +
                      folder.path("overlay.png"));
  INFO(run.printed);
  CHECK(run.status == 0);
  CHECK(run.says("median errors of 9 pieces of the drive"));
  CHECK(run.says(askew + ": after 2 s "));
  CHECK(run.says(askew + ": after 4 s "));
  CHECK(run.says(exact + ": after 4 s 0.00"));
  CHECK(samples::isPng(folder.text("overlay.png")));
  // With a length of 2 s both horizons share a line; a shorter length has only its own.
  const samples::CalledProgram two =
      samples::called("tread-overlay " + log.path() + " --model " + exact + " --length 2");
  CHECK(std::count(two.printed.begin(), two.printed.end(), '\n') == 2);
  const samples::CalledProgram one =
      samples::called("tread-overlay " + log.path() + " --model " + exact + " --length 1");
  CHECK(one.says("after 1 s "));
  CHECK_FALSE(one.says("after 2 s "));
}

TEST_CASE("tread-overlay says in one line what it cannot read, and what to do") {
  const samples::OwnFolder folder;
  const std::string model = folder.write(
      "m.yaml", "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\ndelay: 0.03\n");
  const std::string wheels =
      folder.write("wheels.yaml", "name: wheels\nkind: track_speed\ngauge: 0.6\n");
  const std::string broken = folder.write("broken.yaml", "name: m\nkind: power\ngaug: 0.6\n");
  const Log log(modelWith(""));
  const std::vector<std::pair<std::string, std::string>> refused{
      {"/no/such.lcmlog --model " + model, "/no/such.lcmlog"},
      {log.path() + " --model /no/model.yaml", "/no/model.yaml"},
      {log.path() + " --model " + broken, broken + ":"},
      {log.path() + " --model " + wheels, "give a model of the same vehicle"},
      {log.path() + " --length 60 --model " + model, "try a smaller --length"},
      {log.path() + " --length nan --model " + model, "--length"}};
  for (const auto& [arguments, words] : refused) {
    const samples::CalledProgram run = samples::called("tread-overlay " + arguments);
    INFO(run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
    CHECK(run.printed.find("tread-overlay: ") == 0);
    CHECK(run.says(words));
  }
  for (const std::string& arguments :
       {std::string(), log.path(), log.path() + " --model", log.path() + " --model a --length 0.5",
        log.path() + " --model a --lenght 4"}) {
    const samples::CalledProgram run = samples::called("tread-overlay " + arguments);
    INFO(arguments << ": " << run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
  }
}

}  // namespace tread::overlay

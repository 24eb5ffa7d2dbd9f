// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <catch2/catch.hpp>

#include <tread/ins_t.hpp>
#include <tread/motor_t.hpp>

#include "common/log/event_log.hpp"
#include "common/vehicle/measurement.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/overlay/overlay_picture.hpp"

namespace tread::overlay {
namespace {

ModelDocument modelWith(const std::string& rest) {
  return parseModelDocument(
      "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\ndelay: 0.03\n" + rest, "m");
}

/// A log of a drive that a model did: MOTOR at 20 Hz, INS at 50 Hz; gone with the test.
class Log {
 public:
  explicit Log(const ModelDocument& model, bool with_ins = true)
      : path_((std::filesystem::temp_directory_path() /
               ("tread-overlay-" + std::to_string(getpid()) + ".lcmlog"))
                  .string()) {
    const std::vector<MotionSample> said = drive(model);
    LogWriter writer(path_);
    for (int i = 0; i < 40 * 20; ++i) writer.write(kMotor, motor(i));
    for (size_t i = 0; with_ins && i < said.size(); ++i)
      writer.write(kIns, ins(said[i], static_cast<int64_t>(i)));
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
    message.motor_command_kind = 1;
    message.command_left = static_cast<float>(commandAt(i).left);
    message.command_right = static_cast<float>(commandAt(i).right);
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

  std::string path_;
};

}  // namespace

TEST_CASE("the model that drove a log stays on what was measured, another one leaves it") {
  const ModelDocument plain = modelWith("");
  const ModelDocument hidden = modelWith(
      "effects:\n  track_asymmetry: {share: 0.04}\n"
      "measurement:\n  lever_arm_x: {offset: 0.2}\n  ins_latency: {latency: 0.2}\n");
  const Log log(hidden);
  const LoggedDrive drive = readLoggedDrive({log.path()});
  const std::vector<Piece> pieces = replay(drive, {plain, hidden}, 4.0);
  REQUIRE(pieces.size() == 9);
  const size_t last = pieces[0].measured.size() - 1;
  CHECK(last == 40);
  for (const Piece& piece : pieces) {
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
    CHECK_THROWS_WITH(readLoggedDrive({blind.path()}), Catch::Contains("holds no INS"));
  }
  const Log log(plain);
  ModelDocument wheels = plain;
  wheels.vehicle.kind = CommandKind::kTrackSpeed;
  CHECK_THROWS_WITH(replay(readLoggedDrive({log.path()}), {wheels}, 4.0),
                    Catch::Contains("another kind of command"));
  CHECK_THROWS(readLoggedDrive({"/no/such.lcmlog"}));
}

}  // namespace tread::overlay

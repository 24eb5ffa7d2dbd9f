// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "common/vehicle/kernel.hpp"

using namespace tread;

namespace {

VehicleModel plainModel() {
  VehicleModel model;
  model.full_speed = 1.1;
  model.gauge = 0.6;
  model.lag = 0.15;
  return model;
}

std::vector<TrackCommand> held(const TrackCommand& command, size_t samples) {
  return std::vector<TrackCommand>(samples, command);
}

void expectSame(const Pose2& a, const Pose2& b, double tolerance) {
  CHECK(a.x == Approx(b.x).margin(tolerance));
  CHECK(a.y == Approx(b.y).margin(tolerance));
  CHECK(a.yaw == Approx(b.yaw).margin(tolerance));
}

}  // namespace

TEST_CASE("A steady command from its steady motion drives the circle of the closed form") {
  VehicleModel model = plainModel();
  model.forward_gain = 0.95;
  model.yaw_gain = 1.2;
  model.effects.icr_offset = 0.1;
  const TrackCommand command{0.4, 0.9};
  const double v = 0.95 * 1.1 * 0.65;
  const double omega = 1.2 * 1.1 * 0.5 / 0.6;
  const auto poses = simulate(model, held(command, 200), 0.05, steadyEntry(model, command));
  REQUIRE(poses.size() == 200);
  for (size_t i = 0; i < poses.size(); ++i) {
    const double t = 0.05 * static_cast<double>(i + 1);
    expectSame(poses[i], integrate({v, -0.1 * omega, omega}, t), 1e-9);
  }
  CHECK(poses.back().yaw > 2.0 * kPi);  // unwrapped
}

TEST_CASE(
    "A car drives Ackermann's circle about its rear axle, and straight once its steering is") {
  VehicleModel model = plainModel();
  model.wheelbase = 1.2;
  model.steering_lag = 0.2;
  const TrackCommand command{0.5, 0.3};
  const double v = 1.1 * 0.5;
  const double omega = v * std::tan(0.3) / 1.2;
  const auto poses = simulate(model, held(command, 100), 0.05, steadyEntry(model, command));
  expectSame(poses.back(), integrate({v, 0.0, omega}, 5.0), 1e-9);
  CHECK(steadyTwist(model, command).omega == Approx(omega));
  CHECK(steadyTwist(model, {0.0, 0.3}).omega == 0.0);

  VehicleKernel kernel(model, steadyEntry(model, {0.5, 0.0}));
  for (int i = 0; i < 4; ++i) kernel.step(command, 0.05);
  const double after_one_lag = kernel.twist().omega;
  CHECK(after_one_lag == Approx(v * std::tan(0.3 * (1.0 - std::exp(-1.0))) / 1.2).epsilon(1e-6));
  VehicleKernel copy(model, kernel.state());
  kernel.step({0.5, 0.0}, 2.0);
  copy.step({0.5, 0.0}, 2.0);
  CHECK(copy.twist().omega == Approx(kernel.twist().omega).margin(1e-12));
  CHECK(std::abs(kernel.twist().omega) < 1e-4);
}

TEST_CASE("A body behind lagging tracks moves the same in long steps and in short ones") {
  VehicleModel model = plainModel();
  model.effects.yaw_inertia = 0.03;
  model.effects.body_inertia = 0.08;
  const auto drivenWith = [&model](double step) {
    model.step = step;
    VehicleKernel kernel(model, {});
    for (const TrackCommand& command : {TrackCommand{0.4, 0.9}, TrackCommand{-0.7, 0.2}})
      for (int i = 0; i < 6; ++i) kernel.step(command, 0.1);
    return kernel.pose();
  };
  const Pose2 exact = drivenWith(0.0005);
  expectSame(drivenWith(0.05), exact, 5e-4);
  expectSame(drivenWith(0.1), exact, 1e-3);
}

TEST_CASE("From standstill the distance is that of a first-order lag") {
  const VehicleModel model = plainModel();
  const auto poses = simulate(model, held({1.0, 1.0}, 40), 0.05, {});
  for (size_t i = 0; i < poses.size(); ++i) {
    const double t = 0.05 * static_cast<double>(i + 1);
    const double distance = 1.1 * (t - 0.15 * (1.0 - std::exp(-t / 0.15)));
    expectSame(poses[i], {distance, 0.0, 0.0}, 1e-12);
  }
}

TEST_CASE("Without lag and delay a command acts at once") {
  VehicleModel model = plainModel();
  model.lag = 0.0;
  const auto poses = simulate(model, {{1.0, 1.0}, {-1.0, 1.0}}, 0.1, {});
  expectSame(poses[0], {0.11, 0.0, 0.0}, 1e-12);
  expectSame(poses[1], {0.11, 0.0, 0.1 * 2.2 / 0.6}, 1e-12);
}

TEST_CASE("With a delay the command before it goes on acting") {
  VehicleModel model = plainModel();
  model.lag = 0.0;
  model.delay = 0.12;
  const auto poses = simulate(model, held({1.0, 1.0}, 4), 0.05, {});
  CHECK(poses[1].x == 0.0);
  CHECK(poses[2].x == Approx(1.1 * 0.03));
  CHECK(poses[3].x == Approx(1.1 * 0.08));
  const auto stopping = simulate(model, held({0.0, 0.0}, 4), 0.05, steadyEntry(model, {1.0, 1.0}));
  CHECK(stopping[3].x == Approx(1.1 * 0.12));
}

TEST_CASE("Each command of a series keeps its length behind the delay") {
  VehicleModel model = plainModel();
  model.kind = CommandKind::kTrackSpeed;
  model.lag = 0.0;
  model.delay = 0.075;
  const auto poses = simulate(model, {{2.0, 2.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}, 0.05, {});
  CHECK(poses[0].x == 0.0);
  CHECK(poses[1].x == Approx(2.0 * 0.025));
  CHECK(poses[2].x == Approx(2.0 * 0.05));
  CHECK(poses[3].x == Approx(2.0 * 0.05));
}

TEST_CASE("A command that was given once is held, and acts after its delay") {
  VehicleModel model = plainModel();
  model.full_speed = 1.0;
  model.lag = 0.0;
  model.delay = 0.075;
  VehicleKernel kernel(model, {});
  kernel.give({2.0, 2.0});
  kernel.hold(0.05, {});
  CHECK(kernel.pose().x == 0.0);
  kernel.hold(0.05, {});
  CHECK(kernel.pose().x == Approx(2.0 * 0.025));
  kernel.give({0.0, 0.0});
  kernel.hold(0.5, {});
  CHECK(kernel.pose().x == Approx(2.0 * 0.1));
}

TEST_CASE("To hold a command is to give it again") {
  const VehicleModel model = plainModel();
  VehicleKernel held(model, {});
  VehicleKernel given(model, {});
  held.give({0.3, 0.9});
  for (int i = 0; i < 40; ++i) {
    held.hold(0.05, {});
    given.step({0.3, 0.9}, 0.05);
  }
  expectSame(held.pose(), given.pose(), 1e-5);
}

TEST_CASE("Track speed commands are metres per second") {
  VehicleModel model = plainModel();
  model.kind = CommandKind::kTrackSpeed;
  model.gauge = 1.08;
  const TrackCommand command{1.46, 2.54};  // 2 m/s and 1 rad/s
  const Twist2 twist = steadyTwist(model, command);
  CHECK(twist.v_x == Approx(2.0));
  CHECK(twist.omega == Approx(1.0));
  CHECK(twist.v_y == 0.0);
}

TEST_CASE("Mirrored commands give exactly mirrored poses") {
  VehicleModel model = plainModel();
  model.yaw_gain = 1.0596;
  model.effects.icr_offset = 0.1057;
  std::vector<TrackCommand> commands{{0.1, 1.0}, {-0.4, 0.4}, {0.55, 1.0}, {1.0, 0.8}, {0.3, 0.7}};
  const auto poses = simulate(model, commands, 0.15, steadyEntry(model, {1.0, 1.0}));
  for (TrackCommand& command : commands) command = {command.right, command.left};
  const auto mirrored = simulate(model, commands, 0.15, steadyEntry(model, {1.0, 1.0}));
  for (size_t i = 0; i < poses.size(); ++i) {
    CHECK(mirrored[i].x == poses[i].x);
    CHECK(mirrored[i].y == -poses[i].y);
    CHECK(mirrored[i].yaw == -poses[i].yaw);
  }
}

TEST_CASE("A vehicle that turns by itself breaks the symmetry") {
  VehicleModel model = plainModel();
  model.effects.yaw_rate_offset = 0.03;
  const auto poses = simulate(model, held({1.0, 1.0}, 20), 0.05, steadyEntry(model, {1.0, 1.0}));
  CHECK(poses.back().yaw == Approx(0.03));
  CHECK(poses.back().y > 0.0);
}

TEST_CASE("Finer sample times change the motion by less than a tenth of a millimetre") {
  const VehicleModel model = plainModel();
  const auto coarse = simulate(model, held({0.1, 1.0}, 10), 0.1, {});
  const auto fine = simulate(model, held({0.1, 1.0}, 1000), 0.001, {});
  expectSame(coarse.back(), fine.back(), 1e-4);
}

TEST_CASE("The same drive twice gives the same bits") {
  const VehicleModel model = plainModel();
  const ExecutionNoise noise{1.02, 0.9, 0.03};
  const auto first = simulate(model, held({0.3, 0.9}, 50), 0.05, {}, noise);
  const auto second = simulate(model, held({0.3, 0.9}, 50), 0.05, {}, noise);
  for (size_t i = 0; i < first.size(); ++i) {
    CHECK(first[i].x == second[i].x);
    CHECK(first[i].y == second[i].y);
    CHECK(first[i].yaw == second[i].yaw);
  }
}

TEST_CASE("A kernel that is stepped reaches where the simulation ends, at the lagged speed") {
  const VehicleModel model = plainModel();
  VehicleKernel kernel(model, {});
  for (int i = 0; i < 6; ++i) kernel.step({0.5, 1.0}, 0.05);
  const auto poses = simulate(model, held({0.5, 1.0}, 6), 0.05, {});
  expectSame(kernel.pose(), poses.back(), 0.0);
  const double share = 1.0 - std::exp(-2.0);
  CHECK(kernel.trackSpeeds().right == Approx(1.1 * share));
  CHECK(kernel.twist().v_x == Approx(0.75 * 1.1 * share));
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The residuals that each effect causes: channel, dependence, sign.
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/common/vehicle/rich_drive.hpp"

using namespace tread;

namespace {

constexpr double kGauge = 0.6;

/// Track speeds for a forward speed and a yaw rate.
TrackCommand asking(double v, double omega) {
  return {v - omega * kGauge / 2.0, v + omega * kGauge / 2.0};
}

VehicleModel with(double EffectValues::*place, double value) {
  VehicleModel model = plainVehicle();
  model.effects.*place = value;
  return model;
}

/// Steady residual (with minus without the effect) of a commanded motion.
Twist2 residual(const VehicleModel& model, double v, double omega,
                const DriveContext& context = {}) {
  const Twist2 twist = steadyTwist(model, asking(v, omega), context);
  return {twist.v_x - v, twist.v_y, twist.omega - omega};
}

void expect(const Twist2& twist, double v_x, double v_y, double omega) {
  CHECK(twist.v_x == Approx(v_x).margin(1e-12));
  CHECK(twist.v_y == Approx(v_y).margin(1e-12));
  CHECK(twist.omega == Approx(omega).margin(1e-12));
}

/// Twists every 50 ms after a step from one steady command to another.
std::vector<Twist2> afterStep(const VehicleModel& model, const TrackCommand& from,
                              const TrackCommand& to, int samples) {
  VehicleKernel kernel(model, steadyEntry(model, from));
  std::vector<Twist2> twists;
  for (int i = 0; i < samples; ++i) {
    kernel.step(to, 0.05);
    twists.push_back(kernel.twist());
  }
  return twists;
}

}  // namespace

TEST_CASE("slip_ratio takes the same share of speed and yaw rate") {
  const VehicleModel model = with(&EffectValues::slip_ratio, 0.1);
  expect(residual(model, 1.0, 0.0), -0.1, 0.0, 0.0);
  expect(residual(model, -2.0, 0.5), 0.2, 0.0, -0.05);
}

TEST_CASE("track_asymmetry turns with the speed, flips in reverse and adds speed with the turn") {
  const VehicleModel model = with(&EffectValues::track_asymmetry, 0.03);
  expect(residual(model, 1.0, 0.0), 0.0, 0.0, -0.03 * 2.0 / kGauge);
  expect(residual(model, -1.0, 0.0), 0.0, 0.0, 0.03 * 2.0 / kGauge);
  expect(residual(model, 0.0, 1.0), -0.03 * kGauge / 2.0, 0.0, 0.0);
}

TEST_CASE("track_width takes the same share of every yaw rate and no speed") {
  const VehicleModel model = with(&EffectValues::track_width, 0.25);
  for (const double omega : {-1.0, 0.3, 2.0})
    for (const double v : {0.0, 2.0}) expect(residual(model, v, omega), 0.0, 0.0, -0.2 * omega);
}

TEST_CASE("yaw_rate_skid takes a share that grows with the yaw rate") {
  const VehicleModel model = with(&EffectValues::yaw_rate_skid, 0.25);
  expect(residual(model, 1.0, 1.0), 0.0, 0.0, -0.2);
  expect(residual(model, 1.0, -2.0), 0.0, 0.0, 2.0 / 3.0);
}

TEST_CASE("turn_power_limit is flat beyond a yaw rate, at every speed, and leaves the speed") {
  const VehicleModel model = with(&EffectValues::turn_power_limit, 1.0 / 1.5);
  expect(residual(model, 1.0, 1.4), 0.0, 0.0, 0.0);
  expect(residual(model, 0.0, 2.0), 0.0, 0.0, -0.5);
  expect(residual(model, 3.0, -2.5), 0.0, 0.0, 1.0);
}

TEST_CASE("yaw_breakaway takes a constant and lets gentle turns go straight") {
  const VehicleModel model = with(&EffectValues::yaw_breakaway, 0.1);
  expect(residual(model, 1.0, 0.5), 0.0, 0.0, -0.1);
  expect(residual(model, 1.0, -1.0), 0.0, 0.0, 0.1);
  expect(residual(model, 1.0, 0.05), 0.0, 0.0, -0.05);
}

TEST_CASE("speed_understeer grows with the square of the speed") {
  const VehicleModel model = with(&EffectValues::speed_understeer, 0.0625);
  expect(residual(model, 0.0, 1.0), 0.0, 0.0, 0.0);
  expect(residual(model, 2.0, 1.0), 0.0, 0.0, -0.2);
  expect(residual(model, -4.0, 1.0), 0.0, 0.0, -0.5);
}

TEST_CASE("yaw_pull turns in proportion to the speed, with its sign") {
  const VehicleModel model = with(&EffectValues::yaw_pull, 0.05);
  expect(residual(model, 2.0, 0.3), 0.0, 0.0, 0.1);
  expect(residual(model, -1.0, 0.3), 0.0, 0.0, -0.05);
  expect(residual(model, 0.0, 0.3), 0.0, 0.0, 0.0);
}

TEST_CASE("yaw_rate_offset turns by a constant, at standstill, too") {
  const VehicleModel model = with(&EffectValues::yaw_rate_offset, 0.03);
  for (const double v : {-1.0, 0.0, 2.0}) expect(residual(model, v, 0.0), 0.0, 0.0, 0.03);
}

TEST_CASE("motor_deadband takes a constant speed and stops the slow inner track") {
  const VehicleModel model = with(&EffectValues::motor_deadband, 0.1);
  expect(residual(model, 1.0, 0.0), -0.1, 0.0, 0.0);
  expect(residual(model, -1.0, 0.5), 0.1, 0.0, 0.0);
  // inner track stands, 0.55 on the outer one
  const Twist2 inner = steadyTwist(model, {0.05, 0.65});
  expect(inner, 0.275, 0.0, 0.55 / kGauge);
}

TEST_CASE("speed_saturation caps both tracks at the top") {
  const VehicleModel model = with(&EffectValues::speed_saturation, 1.0 / 1.6);
  expect(residual(model, 1.5, 0.0), 0.0, 0.0, 0.0);
  expect(residual(model, -2.0, 0.0), 0.4, 0.0, 0.0);
  expect(steadyTwist(model, {1.0, 2.0}), 1.3, 0.0, 0.6 / kGauge);
}

TEST_CASE("actuator_lag decays from the start of a step, in proportion to it") {
  VehicleModel model = with(&EffectValues::actuator_lag, 0.2);
  model.delay = 0.0;
  const auto twists = afterStep(model, {0.0, 0.0}, {1.0, 1.0}, 40);
  for (size_t i = 0; i < twists.size(); ++i)
    CHECK(twists[i].v_x == Approx(1.0 - std::exp(-0.05 * static_cast<double>(i + 1) / 0.35)));
  model.effects.actuator_lag = -0.15;  // removes the model's own lag
  CHECK(afterStep(model, {0.0, 0.0}, {1.0, 1.0}, 1)[0].v_x == Approx(1.0));
}

TEST_CASE("command_delay shifts the whole motion") {
  VehicleModel model = with(&EffectValues::command_delay, 0.1);
  const auto late = afterStep(model, {0.2, 0.4}, {1.0, 0.6}, 40);
  const auto plain = afterStep(plainVehicle(), {0.2, 0.4}, {1.0, 0.6}, 40);
  for (size_t i = 2; i < late.size(); ++i)
    CHECK(late[i].v_x == Approx(plain[i - 2].v_x).margin(1e-12));
  CHECK(late[1].v_x == Approx(0.3));
}

TEST_CASE("slew_limit makes ramps whose duration is proportional to the step") {
  VehicleModel model = with(&EffectValues::slew_limit, 0.5);  // 2 m/s2
  model.lag = model.delay = 0.0;
  const auto small = afterStep(model, {0.0, 0.0}, {0.5, 0.5}, 20);
  const auto large = afterStep(model, {0.0, 0.0}, {1.0, 1.0}, 20);
  CHECK(small[3].v_x == Approx(0.4));
  CHECK(small[4].v_x == Approx(0.5));
  CHECK(large[8].v_x == Approx(0.9));
  CHECK(large[9].v_x == Approx(1.0));
  CHECK(large[19].v_x == Approx(1.0));
}

TEST_CASE("slew_limit before a lag is a ramp that the lag follows, however time is cut") {
  VehicleModel model = with(&EffectValues::slew_limit, 0.5);  // 2 m/s2
  model.delay = 0.0;
  model.lag = 0.2;
  // On a ramp of slope s the lagged value is behind by s (t - lag (1 - e^(-t / lag))).
  const double on_ramp = 2.0 * (0.3 - 0.2 * (1.0 - std::exp(-0.3 / 0.2)));
  const double at_its_end = 2.0 * (0.5 - 0.2 * (1.0 - std::exp(-0.5 / 0.2)));
  const double after = 1.0 - (1.0 - at_its_end) * std::exp(-0.25 / 0.2);
  for (const std::vector<double>& steps : {std::vector<double>{0.3, 0.45}, {0.1, 0.2, 0.4, 0.05}}) {
    VehicleKernel kernel(model, {});
    double time = 0.0;
    for (const double step : steps) {
      kernel.step({1.0, 1.0}, step);
      time += step;
      if (std::abs(time - 0.3) < 1e-9) CHECK(kernel.twist().v_x == Approx(on_ramp));
    }
    CHECK(kernel.twist().v_x == Approx(after));
    // Another kernel continues from its state.
    VehicleKernel other(model, kernel.state());
    kernel.step({0.0, 0.0}, 0.2);
    other.step({0.0, 0.0}, 0.2);
    CHECK(other.twist().v_x == Approx(kernel.twist().v_x));
  }
}

TEST_CASE("a soft limit lets a share of what is beyond it through") {
  VehicleModel model = with(&EffectValues::turn_power_limit, 1.0 / 1.5);
  const double hard = steadyTwist(model, {-1.0, 1.0}).omega;
  const double free = steadyTwist(plainVehicle(), {-1.0, 1.0}).omega;
  REQUIRE(free > 1.6);
  CHECK(hard == Approx(1.5));
  model.effects.turn_power_beyond = 0.2;
  CHECK(steadyTwist(model, {-1.0, 1.0}).omega == Approx(1.5 + 0.2 * (free - 1.5)));
  CHECK(steadyTwist(model, {1.0, -1.0}).omega == Approx(-1.5 - 0.2 * (free - 1.5)));
  CHECK(steadyTwist(model, {0.2, 0.3}).omega == steadyTwist(plainVehicle(), {0.2, 0.3}).omega);
}

TEST_CASE("lag_asymmetry acts when slowing down only") {
  const VehicleModel model = with(&EffectValues::lag_asymmetry, 0.15);
  const auto up = afterStep(model, {0.2, 0.2}, {1.0, 1.0}, 10);
  const auto plain_up = afterStep(plainVehicle(), {0.2, 0.2}, {1.0, 1.0}, 10);
  const auto down = afterStep(model, {1.0, 1.0}, {0.2, 0.2}, 10);
  const auto plain_down = afterStep(plainVehicle(), {1.0, 1.0}, {0.2, 0.2}, 10);
  for (size_t i = 0; i < up.size(); ++i) {
    CHECK(up[i].v_x == plain_up[i].v_x);
    if (i > 1) CHECK(down[i].v_x > plain_down[i].v_x + 0.01);
  }
}

TEST_CASE("battery_sag takes a share that grows with session time, or with the voltage") {
  const VehicleModel by_time = with(&EffectValues::battery_sag_per_hour, 0.2);
  expect(residual(by_time, 1.0, 0.5), 0.0, 0.0, 0.0);
  expect(residual(by_time, 1.0, 0.5, {1800.0}), -0.1, 0.0, -0.05);
  const VehicleModel by_voltage = with(&EffectValues::battery_sag_per_drop, 1.5);
  DriveContext context;
  context.battery_drop = 0.1;
  expect(residual(by_voltage, -1.0, 0.5, context), 0.15, 0.0, -0.075);
}

TEST_CASE("thermal_derating follows the work and recovers in a rest") {
  VehicleModel model = with(&EffectValues::thermal_derating, 0.2);
  model.effects.thermal_time = 60.0;
  VehicleKernel kernel(model, {});
  kernel.step({1.0, 1.0}, 60.0);
  const double hot = kernel.twist().v_x;
  CHECK(hot == Approx(1.0 - 0.2 * (1.0 - std::exp(-1.0))).epsilon(1e-3));
  kernel.step({0.0, 0.0}, 120.0);
  kernel.step({1.0, 1.0}, 2.0);
  CHECK(kernel.twist().v_x > hot + 0.1);
}

TEST_CASE("payload_change is a step in yaw rate, speed and side at one moment") {
  VehicleModel model = with(&EffectValues::payload_yaw, -0.2);
  model.effects.payload_speed = -0.05;
  model.effects.payload_icr = 0.1;
  model.effects.payload_time = 100.0;
  expect(residual(model, 1.0, 0.5, {99.9}), 0.0, 0.0, 0.0);
  expect(residual(model, 1.0, 0.5, {100.0}), -0.05, -0.04, -0.1);
}

TEST_CASE("terrain_change changes slip, width and break-away by parts of the session") {
  VehicleModel model = with(&EffectValues::terrain_slip_1, 0.1);
  model.effects.track_width = 0.25;
  model.effects.terrain_breakaway_2 = 0.1;
  model.effects.terrain_width_2 = -0.25;
  model.effects.terrain_time_1 = 50.0;
  model.effects.terrain_time_2 = 90.0;
  expect(steadyTwist(model, asking(1.0, 0.5), {0.0}), 1.0, 0.0, 0.4);
  expect(steadyTwist(model, asking(1.0, 0.5), {60.0}), 0.9, 0.0, 0.36);
  expect(steadyTwist(model, asking(1.0, 0.5), {100.0}), 1.0, 0.0, 0.4);
  expect(steadyTwist(model, asking(1.0, 1.0), {100.0}), 1.0, 0.0, 0.9);
  model.effects.terrain_time_2 = 0.0;  // never
  expect(steadyTwist(model, asking(1.0, 0.5), {100.0}), 0.9, 0.0, 0.36);
}

TEST_CASE("A change within a step of integration moves the end of the drive continuously") {
  VehicleModel model = with(&EffectValues::terrain_slip_1, 0.5);
  double last = 0.0;
  for (int i = 0; i <= 20; ++i) {
    model.effects.terrain_time_1 = 1.0 + 0.0005 * i;
    const double x = simulate(model, std::vector<TrackCommand>(40, {1.0, 1.0}), 0.05, {}).back().x;
    if (i > 0) CHECK(x - last == Approx(0.5 * 0.0005).epsilon(0.02));
    last = x;
  }
}

TEST_CASE("slope_pitch slows down uphill and speeds up downhill, whatever the command") {
  const VehicleModel model = with(&EffectValues::slope_pitch, 0.05);
  DriveContext downhill;
  downhill.pitch = 0.1;  // nose down
  const double pull = 0.05 * 9.81 * std::sin(0.1);
  expect(residual(model, 1.0, 0.2, downhill), pull, 0.0, 0.0);
  expect(residual(model, -0.5, 0.0, downhill), pull, 0.0, 0.0);
  expect(residual(model, 0.0, 0.0, downhill), 0.0, 0.0, 0.0);
  downhill.pitch = -0.1;
  expect(residual(model, 1.0, 0.0, downhill), -pull, 0.0, 0.0);
}

TEST_CASE("slope_roll slides downhill to the side while it drives") {
  const VehicleModel model = with(&EffectValues::slope_roll, 0.05);
  DriveContext slope;
  slope.roll = 0.1;  // the left side is up: it slides to the right
  const double slide = -0.05 * 9.81 * std::sin(0.1);
  expect(residual(model, 1.0, 0.0, slope), 0.0, slide, 0.0);
  expect(residual(model, -1.0, 0.0, slope), 0.0, slide, 0.0);
  expect(residual(model, 0.0, 0.0, slope), 0.0, 0.0, 0.0);
}

TEST_CASE("centrifugal_drift carries outwards with speed times yaw rate") {
  const VehicleModel model = with(&EffectValues::centrifugal_drift, 0.15);
  expect(residual(model, 2.0, 0.5), 0.0, -0.15, 0.0);
  expect(residual(model, 2.0, -0.5), 0.0, 0.15, 0.0);
  expect(residual(model, 0.0, 1.0), 0.0, 0.0, 0.0);
}

TEST_CASE("grip_limit caps fast curves and not turns on the spot") {
  const VehicleModel model = with(&EffectValues::grip_limit, 1.0 / 0.2);
  expect(residual(model, 0.0, 3.0), 0.0, 0.0, 0.0);
  expect(residual(model, 1.0, 1.5), 0.0, 0.0, 0.0);
  expect(residual(model, 4.0, 1.0), 0.0, 0.0, 0.2 * 9.81 / 4.0 - 1.0);
  expect(residual(model, -4.0, -1.0), 0.0, 0.0, 1.0 - 0.2 * 9.81 / 4.0);
}

TEST_CASE("rolling_resistance takes a constant speed and leaves the yaw rate") {
  const VehicleModel model = with(&EffectValues::rolling_resistance, 0.05);
  expect(residual(model, 1.0, 0.4), -0.05, 0.0, 0.0);
  expect(residual(model, -2.0, 0.4), 0.05, 0.0, 0.0);
  expect(residual(model, 0.03, 0.0), -0.03, 0.0, 0.0);
}

TEST_CASE("quadratic_drag grows with the square of the speed") {
  const VehicleModel model = with(&EffectValues::quadratic_drag, 0.05);
  expect(residual(model, 1.0, 0.4), -0.05, 0.0, 0.0);
  expect(residual(model, -2.0, 0.4), 0.2, 0.0, 0.0);
}

TEST_CASE("turn_speed_loss is even in the yaw rate") {
  const VehicleModel model = with(&EffectValues::turn_speed_loss, 0.25);
  expect(residual(model, 1.0, 1.0), -0.2, 0.0, 0.0);
  expect(residual(model, 1.0, -1.0), -0.2, 0.0, 0.0);
  expect(residual(model, 1.0, 0.0), 0.0, 0.0, 0.0);
}

TEST_CASE("reverse_speed_gain and reverse_yaw_gain depend on the direction of travel") {
  const VehicleModel speed = with(&EffectValues::reverse_speed_gain, 0.05);
  expect(residual(speed, 1.0, 0.2), 0.05, 0.0, 0.0);
  expect(residual(speed, -1.0, 0.2), 0.05, 0.0, 0.0);
  const VehicleModel yaw = with(&EffectValues::reverse_yaw_gain, 0.1);
  expect(residual(yaw, 1.0, 0.5), 0.0, 0.0, 0.05);
  expect(residual(yaw, -1.0, 0.5), 0.0, 0.0, -0.05);
  expect(residual(yaw, 0.0, 0.5), 0.0, 0.0, 0.0);
}

TEST_CASE("icr_offset moves the middle sideways with the yaw rate, on the spot, too") {
  const VehicleModel model = with(&EffectValues::icr_offset, 0.1);
  expect(residual(model, 0.0, 1.0), 0.0, -0.1, 0.0);
  expect(residual(model, 2.0, -0.5), 0.0, 0.05, 0.0);
}

TEST_CASE("crab drifts with the speed and flips in reverse") {
  const VehicleModel model = with(&EffectValues::crab, 0.05);
  expect(residual(model, 1.0, 0.3), 0.0, std::tan(0.05), 0.0);
  expect(residual(model, -1.0, 0.3), 0.0, -std::tan(0.05), 0.0);
}

TEST_CASE("yaw_inertia carries the yaw rate over and leaves the speed") {
  VehicleModel model = with(&EffectValues::yaw_inertia, 0.3);
  model.lag = model.delay = 0.0;
  const auto twists = afterStep(model, asking(0.5, 1.0), asking(1.0, -0.5), 20);
  for (size_t i = 0; i < twists.size(); ++i) {
    CHECK(twists[i].v_x == Approx(1.0));
    CHECK(twists[i].omega ==
          Approx(-0.5 + 1.5 * std::exp(-0.05 * static_cast<double>(i + 1) / 0.3)));
  }
}

TEST_CASE("body_inertia carries the speed over and leaves the yaw rate") {
  VehicleModel model = with(&EffectValues::body_inertia, 0.2);
  model.lag = model.delay = 0.0;
  const auto twists = afterStep(model, asking(0.5, 1.0), asking(1.0, -0.5), 20);
  for (size_t i = 0; i < twists.size(); ++i) {
    CHECK(twists[i].omega == Approx(-0.5));
    CHECK(twists[i].v_x == Approx(1.0 - 0.5 * std::exp(-0.05 * static_cast<double>(i + 1) / 0.2)));
  }
}

TEST_CASE("track_backlash costs a fixed distance after each reversal, not a time") {
  VehicleModel model = with(&EffectValues::track_backlash, 0.04);
  model.lag = model.delay = 0.0;
  for (const double speed : {0.5, 1.0}) {
    VehicleKernel kernel(model, steadyEntry(model, {1.0, 1.0}));
    kernel.step({1.0, 1.0}, 1.0);
    CHECK(kernel.pose().x == Approx(1.0));
    kernel.step({-speed, -speed}, 1.0);
    CHECK(kernel.pose().x == Approx(1.0 - (speed - 0.04)));
    kernel.step({0.0, 0.0}, 1.0);
    kernel.step({-speed, -speed}, 1.0);  // already taken up
    CHECK(kernel.pose().x == Approx(1.0 - (2.0 * speed - 0.04)));
    kernel.step({speed, speed}, 1.0);
    CHECK(kernel.pose().x == Approx(1.0 - speed).margin(1e-9));
  }
}

TEST_CASE("A kernel that begins in another one's state goes on in the same way") {
  VehicleModel model = with(&EffectValues::yaw_inertia, 0.3);
  model.delay = 0.0;
  model.effects.thermal_derating = 0.3;
  VehicleKernel kernel(model, {});
  kernel.step({1.0, 0.5}, 0.4);
  VehicleKernel next(model, kernel.state());
  const Pose2 T_start_join = kernel.pose();
  kernel.step({0.2, 0.9}, 0.7);
  next.step({0.2, 0.9}, 0.7);
  const Pose2 joined = T_start_join * next.pose();
  CHECK(joined.x == Approx(kernel.pose().x));
  CHECK(joined.y == Approx(kernel.pose().y));
  CHECK(joined.yaw == Approx(kernel.pose().yaw));
}

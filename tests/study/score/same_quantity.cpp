// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/same_quantity.hpp"

namespace tread::blindtest {
namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]

struct Row {
  const char* effect;
  const char* symbol;
  SameQuantity same;
};

const Row kRows[] = {
    {"slip_ratio", "s", {"slip"}},
    {"track_asymmetry", "e", {"share"}},
    {"motor_deadband", "d", {"speed"}},
    {"speed_saturation", "u_max", {"limit", 1.0, true}},
    {"actuator_lag", "tau", {"lag"}},
    {"command_delay", "T_d", {"delay"}},
    {"slew_limit", "a_max", {"limit", 1.0, true}},
    {"lag_asymmetry", "d_tau", {"slowing"}},
    {"thermal_derating", "h", {"loss"}},
    {"track_backlash", "beta", {"slack"}},
    {"track_width", "k_t", {"widening"}},
    {"yaw_rate_skid", "k_2", {"skid"}},
    {"turn_power_limit", "omega_max", {"limit", 1.0, true}},
    {"yaw_breakaway", "omega_c", {"rate"}},
    {"speed_understeer", "K", {"gain"}},
    {"yaw_pull", "k", {"pull"}},
    {"grip_limit", "a_lat", {"friction", 1.0 / kGravity, true}},
    {"reverse_yaw_gain", "k", {"gain"}},
    {"yaw_inertia", "tau_w", {"lag"}},
    {"payload_change", "k", {"yaw"}},
    {"slope_pitch", "g_p", {"compliance"}},
    {"slope_roll", "g_r", {"compliance"}},
    {"centrifugal_drift", "k_c", {"time"}},
    {"rolling_resistance", "c", {"speed"}},
    {"quadratic_drag", "k", {"drag"}},
    {"turn_speed_loss", "k", {"loss"}},
    {"reverse_speed_gain", "k", {"gain"}},
    {"icr_offset", "x_icr", {"offset"}},
    {"body_inertia", "tau_v", {"lag"}},
    {"ins_latency", "L", {"latency"}},
    {"heading_latency", "T_h", {"latency"}},
    {"gyro_bias", "b", {"rate"}},
    {"heading_misalignment", "psi_0", {"angle"}},
    {"lever_arm_x", "l_x", {"offset"}},
    {"lever_arm_y", "l_y", {"offset"}},
    {"position_scale", "k", {"scale"}},
};

}  // namespace

std::optional<SameQuantity> sameQuantity(const std::string& effect, const std::string& symbol,
                                         double duration) {
  if (effect == "battery_sag" && symbol == "s" && duration > 0.0)
    return SameQuantity{"per_hour", 3600.0 / duration};
  for (const Row& row : kRows)
    if (effect == row.effect && symbol == row.symbol) return row.same;
  return std::nullopt;
}

}  // namespace tread::blindtest

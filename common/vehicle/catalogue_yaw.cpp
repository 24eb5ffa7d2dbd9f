// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> yawEffects() {
  using V = EffectValues;
  return {
      {"reverse_yaw_gain",
       "Turning unlike in reverse",
       EffectKind::kVehicle,
       "w",
       "It turns more willingly in one direction of travel than in the other.",
       "omega -> omega (1 + gain v)",
       "The yaw rate is too large forwards and too small backwards, or the other way round; right "
       "on the spot.",
       "The same arcs forwards and backwards.",
       "Drive one circle forwards and one backwards.",
       {strength("gain", "s/m", -0.5, 0.5, 0.08, &V::reverse_yaw_gain)}},
      {"payload_change",
       "Change of payload or centre of mass",
       EffectKind::kVehicle,
       "xyw",
       "From a certain moment on the vehicle carries something else and drives differently.",
       "from time of the session on: omega -> omega (1 + yaw), v -> v (1 + speed), x_icr -> x_icr "
       "+ "
       "icr",
       "A step in the yaw rate residual, perhaps in those of speed and side, at one moment; "
       "everything after it is changed.",
       "Repeat a drive on one surface with and without the load: another ground would be tied to a "
       "place.",
       "Ask who put what on it, and when; weigh front and rear.",
       {strength("yaw", "1", -0.8, 1.0, 0.2, &V::payload_yaw),
        strength("speed", "1", -0.5, 0.5, 0.05, &V::payload_speed),
        strength("icr", "m", -0.5, 0.5, 0.1, &V::payload_icr),
        shape(strength("time", "s", 0.0, 1e6, 300.0, &V::payload_time))}},
      {"grip_limit",
       "Grip limit, shear failure",
       EffectKind::kVehicle,
       "w",
       "The ground gives no more sideways force than its friction; fast curves get wider.",
       "|v omega| <= friction 9.81 m/s2; inverse_limit = 1 / friction",
       "The yaw rate is capped only where speed times yaw rate is large; on the spot it is right.",
       "The same yaw rate in a fast wide and in a slow tight turn.",
       "Drive one circle faster and faster until it widens.",
       {inverseLimit("1", 50.0, 4.0, &V::grip_limit, {1.5, 3.0, 6.0, 12.0}, "friction", "1")}},
      {"yaw_pull",
       "Yaw pull",
       EffectKind::kVehicle,
       "w",
       "It pulls to one side in proportion to its speed.",
       "omega -> omega + pull v",
       "The yaw rate residual is proportional to the forward speed and flips in reverse; the "
       "forward speed in turns is right.",
       "Forwards only it looks like a gyro bias, which is there at standstill, too; a left-right "
       "asymmetry changes the forward speed in turns, a little.",
       "Drive 20 m straight slowly and fast: a pull misses by the same angle, a bias by more when "
       "slow.",
       {strength("pull", "rad/m", -0.5, 0.5, 0.05, &V::yaw_pull)}},
      {"yaw_rate_offset",
       "Constant turning",
       EffectKind::kVehicle,
       "w",
       "The vehicle turns by itself at a constant rate, whatever the tracks do.",
       "omega -> omega + rate",
       "The same yaw rate residual in all motions; the path is bent accordingly.",
       "Stand still for 30 s: a gyro bias stays without any motion of the vehicle.",
       "Stand still and look whether heading or gyro go on turning.",
       {strength("rate", "rad/s", -0.5, 0.5, 0.03, &V::yaw_rate_offset)}},
  };
}

}  // namespace tread

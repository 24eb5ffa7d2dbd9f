// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::sim {

/// Battery, power stage, motors and gears of a tracked vehicle, seen at the tracks.
struct DriveParameters {
  double free_speed = 1.20;     ///< track speed at full power, nominal voltage and no load [m/s]
  double stiffness = 4000.0;    ///< loss of drive force per track speed, one track [N s/m]
  double force_limit = 2500.0;  ///< current limit of the power stage, as force at the track [N]
  double power_lag = 0.09;      ///< first-order lag of the power stage's output [s]
  double dead_power = 0.0;      ///< commands up to it give nothing, larger ones lose as much [1]
  double track_mass = 60.0;     ///< belt, sprockets, gear and rotor, as mass at the track [kg]
  double gear_friction = 40.0;  ///< dry friction of gear and belt, one track [N]
  double brake_force = 2000.0;  ///< parking brake, holds while there is no power [N]
  double brake_power = 0.004;   ///< below this output the parking brake may close [1]
  double brake_speed = 0.02;    ///< and only below this track speed [m/s]
  double force_per_current = 20.0;   ///< [N/A] of motor current
  double nominal_voltage = 25.0;     ///< [V]
  double full_voltage = 25.6;        ///< without load, battery full [V]
  double empty_voltage = 22.5;       ///< without load, battery empty [V]
  double inner_resistance = 0.015;   ///< of battery and cables [ohm]
  double capacity = 100.0 * 3600.0;  ///< [A s]
  double idle_current = 3.0;         ///< electronics and instruments [A]
};

/// One motor with its track: what it does now.
struct TrackDrive {
  double power = 0.0;    ///< output of the power stage, -1..1
  double speed = 0.0;    ///< belt speed, forward positive [m/s]
  double current = 0.0;  ///< motor current, positive when it drives forward [A]
};

/// The battery now.
struct Battery {
  double charge = 1.0;    ///< share left, 1 = full
  double voltage = 25.6;  ///< at the terminals [V]
  double current = 0.0;   ///< [A], positive when discharging
};

/// What acts on one track from outside.
struct TrackLoad {
  double ground_force = 0.0;  ///< of the ground on the belt, forward positive [N]
  double dry_friction = 0.0;  ///< rolling resistance that does not depend on speed [N]
};

/// Advances one track by dt [s] under the commanded power (-1..1) and the battery's voltage [V].
void stepTrack(const DriveParameters& parameters, double commanded_power, double voltage,
               const TrackLoad& load, double dt, TrackDrive& track);

/// Advances the battery by dt, loaded by both motors.
void stepBattery(const DriveParameters& parameters, const TrackDrive& left, const TrackDrive& right,
                 double dt, Battery& battery);

}  // namespace tread::sim

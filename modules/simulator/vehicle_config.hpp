// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/config/config_reader.hpp"
#include "modules/simulator/core/vehicle.hpp"

namespace tread::sim {

/// Reads what differs from the calibrated dynamic vehicle, in physical quantities: how a drive that
/// has lost power or a weak battery is hidden behind the serial lines.
/** What is not named stays as it is. The ranges keep the integration stable at 1 ms. */
void readVehicle(ConfigReader reader, VehicleParameters& vehicle);

}  // namespace tread::sim

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/link/link.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// Makes a device's session.
using MakeScanDevice = std::function<std::unique_ptr<ScanDevice>()>;

/// A device that the configuration's key `device` may name, with the data its reader needs.
struct DeviceChoice {
  std::string name = "hokuyo";  ///< the key's value
  MakeScanDevice make;
};

/// Reads the key `device` and the section of that name; `latency` [s] is the driver's.
DeviceChoice readScanDevice(ConfigReader& reader, double latency);

/// Throws std::invalid_argument with one clear line if a device cannot have such an address.
LinkAddress checkDeviceAddress(const std::string& device, const std::string& address);

}  // namespace tread::lidar

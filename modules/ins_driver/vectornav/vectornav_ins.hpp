// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string_view>

#include "modules/ins_driver/core/binary_ins.hpp"
#include "modules/ins_driver/vectornav/vectornav_message.hpp"

namespace tread::ins {

/// A VectorNav VN-200 or VN-300 that sends binary messages (VN-300 User Manual).
/** Axes are forward, right, down. Each message is one instant. InsStatus is required: position,
 * velocity and heading are used only while the filter tracks; position and velocity while it
 * aligns; the attitude in a GNSS outage. Heights are above the ellipsoid: geoid_separation must be
 * configured. Device time is TimeStartup, which fixes do not change, otherwise TimeGps. */
class VectornavIns : public BinaryIns {
 public:
  explicit VectornavIns(const InsConfig& config);

  InsAdvice advice() const override;

 protected:
  Reading read(std::string_view frame, int64_t arrival) override;

 private:
  const char* readPlace(const VectornavFields& fields, DeviceEpoch& part) const;
};

}  // namespace tread::ins

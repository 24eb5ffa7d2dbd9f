// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string_view>

#include "modules/ins_driver/core/binary_ins.hpp"
#include "modules/ins_driver/xsens/xbus_message.hpp"

namespace tread::ins {

/// An Xsens MTi with GNSS that sends MTData2 (MT Low Level Communication Protocol).
/** Axes are forward, left, up; orientation and velocity relative to east, north, up (the factory
 * setting; others are refused). Each message is one instant. StatusWord is required: position and
 * velocity are used only while the filter uses GNSS; the attitude also while it coasts without;
 * before and after, only roll and pitch. Accuracies come from the last GnssPvtData, which is
 * rarer. Heights are above the ellipsoid: geoid_separation must be configured. Device time is
 * SampleTimeFine. */
class XsensIns : public BinaryIns {
 public:
  explicit XsensIns(const InsConfig& config);

  InsAdvice advice() const override;

 protected:
  Reading read(std::string_view frame, int64_t arrival) override;

 private:
  void readGnss(std::string_view pvt, int64_t time);
  const char* readPlace(const XbusFields& fields, int64_t time, DeviceEpoch& part) const;

  /// Accuracies from the last GnssPvtData.
  struct Accuracy {
    int64_t time = -1;                ///< of the device [us]; -1: none yet
    double horizontal = kUnmeasured;  ///< [m]
    double vertical = kUnmeasured;    ///< [m]
    double speed = kUnmeasured;       ///< [m/s]
    int satellites = -1;
  };
  Accuracy accuracy_;
};

}  // namespace tread::ins

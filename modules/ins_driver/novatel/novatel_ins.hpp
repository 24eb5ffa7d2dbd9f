// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "modules/ins_driver/core/binary_ins.hpp"
#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/novatel/imu_rate.hpp"
#include "modules/ins_driver/novatel/novatel_message.hpp"

namespace tread::ins {

/// A NovAtel OEM receiver, with or without SPAN (OEM7 Commands and Logs Reference Manual).
/** Axes of SPAN's vehicle frame are right, forward, up. While the inertial solution is good, it
 * alone gives positions (INSPVAX before INSPVA); BESTPOS is then used only for satellites, geoid
 * and, with INSPVA, the accuracy. A second after the inertial solution is lost, or without any,
 * BESTPOS, BESTVEL and HEADING are used; their reference point is the antenna. CORRIMUDATA
 * contains radians per sample of the IMU. */
class NovatelIns : public BinaryIns {
 public:
  explicit NovatelIns(const InsConfig& config);

  InsAdvice advice() const override;
  NamedCounts counters() const override;

 protected:
  Reading read(std::string_view frame, int64_t arrival) override;

 private:
  const char* use(const NovatelFrame& frame, NovatelKind kind, int64_t arrival);
  const char* readBestpos(std::string_view body, DeviceEpoch& part);
  const char* readBestvel(std::string_view body, DeviceEpoch& part) const;
  const char* readInspva(std::string_view body, DeviceEpoch& part) const;
  const char* readInspvax(std::string_view body, DeviceEpoch& part);
  const char* readInsatt(std::string_view body, DeviceEpoch& part) const;
  const char* readHeading(std::string_view body, DeviceEpoch& part) const;
  const char* readCorrimu(std::string_view body, int64_t time);
  bool inertialIsGood(int64_t time) const;

  GpsWeeks weeks_;
  ImuRate imu_rate_;
  int time_status_ = -1;                  ///< of the last long header
  std::optional<int64_t> last_inertial_;  ///< GPS time of the last good inertial solution [us]
  std::optional<double> geoid_;           ///< above the ellipsoid [m]
  Eigen::Vector3d bestpos_std_ = Eigen::Vector3d::Constant(kUnmeasured);
  int satellites_ = -1;
};

}  // namespace tread::ins

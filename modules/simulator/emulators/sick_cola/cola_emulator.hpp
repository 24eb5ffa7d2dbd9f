// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Faults of the device or its line, for the next scan or from now on.
struct ColaFaults {
  bool silent = false;         ///< receives but does not send
  bool half_telegram = false;  ///< scans break off in the middle
  bool dropped_byte = false;   ///< scans lack one byte
  bool bad_checksum = false;   ///< of the binary dialect: scans have a wrong one
  bool repeats = false;        ///< the previous scan is sent again, byte for byte
};

/// A SICK LMS1xx with CoLa A and B, telegram by telegram (listing 8014631).
/** It answers each request in the request's dialect, and streams in that of sEN LMDscandata 1.
 * Angles: 90 degrees are forward; no echo is 0, ranges are mm of 16 bits. LMCstartmeas requires a
 * login. */
class ColaEmulator final : public LaserEmulator {
 public:
  explicit ColaEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  void reconnect() override;  ///< the stream ends with its connection
  /// Power cycle: nobody is logged in, nothing streams, its clock restarts at 0.
  void reboot(int64_t utime);
  void setFaults(const ColaFaults& faults) { faults_ = faults; }

 private:
  /// Extracts one telegram from the input; false if there is no complete one.
  bool next(std::string& telegram, bool& binary);
  void run(const std::string& telegram, bool binary);
  std::string scanTelegram(const LaserScan& scan);
  std::string frame(const std::string& telegram, bool binary) const;

  LaserParameters laser_;
  ColaFaults faults_;
  std::string in_;
  std::string out_;
  std::string last_scan_;
  bool logged_in_ = false;
  bool streaming_ = false;
  bool binary_ = false;
  int64_t power_on_ = 0;
  uint16_t telegrams_ = 0;
};

}  // namespace tread::sim

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// What is wrong with the device or its line, for the next scan or from then on.
struct ColaFaults {
  bool silent = false;         ///< hears and says nothing
  bool half_telegram = false;  ///< scans end in their middle
  bool dropped_byte = false;   ///< scans lack one byte
  bool bad_checksum = false;   ///< of the binary dialect: scans carry a wrong one
  bool repeats = false;        ///< the scan before is sent again, to the byte
};

/// A SICK LMS1xx that speaks CoLa A and B, telegram by telegram (listing 8014631).
/** It answers each request in the dialect in which it came, and streams in that of sEN LMDscandata
 * 1. Angles: 90 degrees are ahead; no echo is 0, ranges are mm of 16 bits. LMCstartmeas asks for a
 * login. */
class ColaEmulator final : public LaserEmulator {
 public:
  explicit ColaEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  void reconnect() override;  ///< the stream ends with its connection
  /// Power off and on: nobody is logged in, nothing streams, its clock begins at 0.
  void reboot(int64_t utime);
  void setFaults(const ColaFaults& faults) { faults_ = faults; }

 private:
  /// Takes one telegram off the input; false if there is none in full.
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

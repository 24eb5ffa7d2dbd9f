// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// The range finder's description of itself (PP and VV).
struct ScipSettings {
  std::string model = "UTM-30LX-EW (emulated)";
  std::string serial_number = "T0000001";
  int range_min_mm = 100;       ///< DMIN
  int range_max_mm = 15000;     ///< DMAX
  int steps_per_turn = 720;     ///< ARES
  int first_step = 0;           ///< AMIN
  int last_step = 540;          ///< AMAX
  int front_step = 270;         ///< AFRT
  int turns_per_minute = 2400;  ///< SCAN: of its mirror, including skipped revolutions
  bool scip1 = false;           ///< speaks SCIP 1.1 until it is switched to 2.0
};

/// Settings that match a simulated laser.
ScipSettings scipSettingsOf(const LaserParameters& laser);

/// Faults of the device or its line.
struct ScipFaults {
  bool silent = false;        ///< receives but does not send
  bool garbage = false;       ///< random bytes between scans
  bool bad_sums = false;      ///< one byte of each scan is changed: its sum is wrong
  bool dropped_byte = false;  ///< one byte of each scan is missing
  bool half_scan = false;     ///< the second half of each scan is missing
  bool repeats = false;       ///< the first scan again, with its time
  bool ill = false;           ///< its laser does not switch on
  bool trouble = false;       ///< a status instead of each scan
};

/// A laser range finder with SCIP 2.0, byte by byte; for TCP or a serial line.
/** Commands end with LF or CR: QT RS BM HS SS PP VV II MD MS and SCIP2.0. An answer is the
 * command's echo, a status with its sum, lines each with a sum, and an empty line. Ranges are
 * three characters (18 bits, mm), after MS two; 65533 (4095) means no hit, 1 no measurement. MD
 * and MS switch the laser on. */
class ScipEmulator final : public LaserEmulator {
 public:
  ScipEmulator(const ScipSettings& settings, uint64_t seed);

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  /// Unread commands are lost, streaming stops.
  void reconnect() override;
  void setFaults(const ScipFaults& faults) { faults_ = faults; }

 private:
  /// A measurement request: MD or MS with its fields.
  struct Request {
    std::string command;  ///< as received, without the count
    std::string note;     ///< text after ';'
    int characters = 3;   ///< a range
    int first = 0;
    int last = 0;
    int cluster = 1;
    int interval = 0;  ///< scans to skip between two
    int count = 0;     ///< remaining scans; 0 = endless
    bool endless = true;
  };

  void runLine(const std::string& line);
  void answer(const std::string& line, const std::string& status,
              const std::vector<std::string>& lines = {});
  bool runInScip1(const std::string& line);
  void startMeasuring(const std::string& line);
  void spoil(std::string& scan, size_t values);
  std::string parseRequest(const std::string& line, Request& request) const;
  std::string rangesOf(const LaserScan& scan, const Request& request) const;
  void appendScan(std::string& out, const LaserScan& scan, const Request& request) const;
  std::vector<std::string> versionLines() const;
  std::vector<std::string> parameterLines() const;

  ScipSettings settings_;
  ScipFaults faults_;
  std::mt19937_64 random_;
  std::string line_;
  std::string out_;
  bool laser_on_ = false;
  bool scip1_;
  std::string first_scan_;  ///< while it repeats
  std::optional<Request> streaming_;
  int skipped_ = 0;
};

/// Sum character of SCIP 2.0: the low six bits of the sum of all bytes, plus 0x30.
char scipSum(std::string_view bytes);
/// A number in characters of six bits each, plus 0x30, most significant first.
std::string scipEncode(uint32_t value, int characters);

}  // namespace tread::sim

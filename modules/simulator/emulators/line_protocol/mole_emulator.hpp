// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "modules/simulator/emulators/serial_motor_emulator.hpp"

namespace tread::sim {

/// A controller with an invented protocol, for testing described drivers.
/** Lines $BODY*CCCC LF; CCCC is CRC-16/XMODEM of BODY without its $, in hexadecimal. Lines with a
 * wrong checksum are not answered.
 *
 *      $DRV,LLLL,RRRR  power, 32000 = full, two's complement   $OK or $ERR,reason
 *                      (n words for n motors, also in $TEL)
 *      $HLT            zero                                    $OK
 *      $WDT,s.ss       watchdog (1.00 after power-up)          $OK or $ERR,range
 *      $WDT?                                                   $WDT,s.ss
 *      $STA            $STA,faults (hex),volts,degC
 *      $TEL            $TEL,amperes,amperes,mm/s,mm/s
 *      $LCK, $ULK      latches and releases a stop (fault 1)   $OK
 *
 * After power-up it sends $BOOT. Only $DRV and $HLT feed the watchdog; after it has expired, the
 * next of them, and also $ULK, resume the old speed first, like the worst real controllers. */
class MoleEmulator final : public SerialMotorEmulator {
 public:
  explicit MoleEmulator(size_t motors = 2)
      : SerialMotorEmulator(115200, 400, 300'000), power_(motors, 0) {}

  MotorValues output(int64_t utime) override;
  void measure(const DriveMeasurements& measurements) override { measurements_ = measurements; }
  /// Faults in addition to the lock: 2 undervoltage, 4 stall.
  void setFaults(int faults) { faults_ = faults; }
  double watchdog() const { return watchdog_; }
  /// How often the motors resumed at another speed than zero after a watchdog stop.
  int resumed() const { return resumed_; }

 private:
  void run(int64_t utime) override;
  void powerUp(int64_t utime) override;
  void hear(char byte, int64_t utime) override;
  std::string answer(const std::string& body, int64_t utime);
  std::string drive(const std::vector<int>& power, int64_t utime);
  std::string setWatchdog(const std::string& text);
  std::string status() const;
  std::string telemetry() const;
  static std::string framed(const std::string& body);

  DriveMeasurements measurements_;
  std::string line_;
  std::vector<int> power_;  ///< of 32000
  double watchdog_ = 1.0;   ///< [s]
  bool expired_ = true;
  bool locked_ = false;
  int faults_ = 0;
  int resumed_ = 0;
  int64_t fed_ = 0;
};

}  // namespace tread::sim

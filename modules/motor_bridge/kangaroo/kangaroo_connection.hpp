// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/core/pending_replies.hpp"
#include "modules/motor_bridge/kangaroo/kangaroo_codec.hpp"

namespace tread::motor {

/// A Kangaroo x2 on a Sabertooth: it controls the speeds of both tracks itself.
struct KangarooConfig {
  int address = 128;             ///< 128..135
  double units_per_metre = 0.0;  ///< of its speeds, along the track [1/m]
  double full_speed = 0.0;       ///< of a track [m/s]; upper limit of commands
  int left_channel = 1;          ///< 1 or 2; the right track uses the other
  bool invert_left = false;
  bool invert_right = false;
  ConnectionTimes times;
};

/// Reads the section `kangaroo`; throws ConfigError with file:line.
KangarooConfig readKangarooConfig(ConfigReader& reader, const DriveDescription& drive);

/// The connection to a Kangaroo.
/** Start-up: serial timeout, which is its watchdog, and start of each channel until it reports a
 * speed; zero. The timeout is lost in a power cycle and cannot be read: it is repeated every half
 * second. Only Get is answered: both channels are queried in turn, 20 times a second in all. A
 * channel that is no longer started was restarted or timed out: the start-up is repeated, and the
 * robot stands until then. Lost control is a fault of the device until the stop is released. */
class KangarooConnection : public ControllerConnection {
 public:
  explicit KangarooConnection(const KangarooConfig& config)
      : ControllerConnection(config.times), config_(config), packets_(config.address) {}

  void receive(std::string_view bytes, int64_t now) override;
  void holdStop(bool /*hold*/) override {}
  void releaseStop(int64_t now) override;
  MotorTelemetry telemetry() const override;
  std::string notice() const override;

 private:
  enum Step { kFirst, kSecond, kZero, kSteps };

  /// A channel's latest answer.
  struct Channel {
    int64_t heard_at = 0;  ///< [us]
    KangarooStatus told;
  };

  std::string zero() const override { return commandBytes({}); }
  int startupSteps() const override { return kSteps; }
  std::string startupRequest(int step) const override;
  std::string startupName(int step) const override;
  bool isAnswered(int step) const override { return step != kZero; }
  void forget() override;
  void begin(int64_t now) override;
  void give(const Command& command, int64_t now) override;
  std::string talk(int64_t now) override;
  std::string lost(int64_t now) const override;
  DeviceReport reported(int64_t now) const override;
  std::map<std::string, int64_t> counted() const override;

  std::string commandBytes(const TrackCommand& command) const;
  std::string setUp() const;
  void take(const KangarooStatus& status, int64_t now);
  /// Of a track [m/s]; NaN while unknown.
  double speedOf(bool left) const;

  KangarooConfig config_;
  KangarooPackets packets_;
  PendingReplies pending_;
  std::array<Channel, 2> channels_;
  std::string output_;
  int64_t asked_at_ = 0;
  int64_t set_up_at_ = 0;
  size_t next_ = 0;       ///< channel to query next
  bool stopped_ = false;  ///< a channel is no longer started
  int64_t commands_ = 0;
};

}  // namespace tread::motor

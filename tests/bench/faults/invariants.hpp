// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tread/health_t.hpp>
#include <tread/ins_t.hpp>
#include <tread/manual_t.hpp>
#include <tread/map_tile_t.hpp>
#include <tread/plan_t.hpp>
#include <tread/program_t.hpp>

#include "common/bus/channels.hpp"
#include "common/grid/footprint.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread::faults {

/// A message as delivered to a receiver, without its seal.
struct Received {
  int64_t utime = 0;  ///< [us] of receipt
  std::string channel;
  std::vector<uint8_t> bytes;
  bool changed = false;  ///< altered in transit
};

/// Decodes a message of a channel; nullopt for another channel or a damaged message.
template <class Message>
std::optional<Message> messageOf(const Channel<Message>& channel, const Received& received) {
  if (received.channel != channel.name) return std::nullopt;
  try {
    Message message{};
    const int size = static_cast<int>(received.bytes.size());
    if (message.decode(received.bytes.data(), 0, size) == size) return message;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

/// Settings in the robot's files that the motors' rule depends on.
struct MotorLimits {
  int64_t operator_lease_us = 1'000'000;  ///< [us]
  int64_t hand_lease_us = 200'000;        ///< [us] of MANUAL
  double tilt = 1e9;                      ///< [rad] hard limit of roll and pitch
  bool go_back = false;                   ///< the armed robot may return without its operator
};

/// The motors must be at zero unless the bridge has received an operator, an arming that is still
/// valid, and either a program with motion, a live INS and no tilt beyond its limit, or manual
/// control with the button held, a recent view of the robot, and a stick measured at rest.
/** With `go_back` an armed robot may move without its operator, which ReturnRule checks; arming
 * needs the operator. Manual control needs neither program nor INS, so their loss requires no new
 * ARM. A tilt beyond the limit does if it lasts for three measurements and 100 ms, and programs
 * wait until a measurement is within. The rule knows only the messages delivered to the bridge and
 * the power of the motors, and decides doubtful cases in favour of the bridge. */
class MotorRule {
 public:
  explicit MotorRule(const MotorLimits& limits) : limits_(limits) {}

  void receive(const Received& received);
  /// The bridge was started or ended.
  void start(int64_t now);
  void end(int64_t now);
  /// Power of both motors at a time; returns the violation, empty if none. Call every few
  /// milliseconds.
  std::string check(int64_t now, const std::array<double, 2>& power);

 private:
  /// A station with manual control: its newest message and its state.
  struct Hand {
    int64_t seq = INT64_MIN;
    int64_t until = INT64_MIN / 2;  ///< [us] the tracks may move
    bool holds = false;             ///< the robot may be under its control
    bool rested = false;            ///< measured at rest since it was last silent or unknown
    int64_t heard = INT64_MIN / 2;  ///< [us]
  };

  void receiveManual(const manual_t& message, bool changed, int64_t now);
  void receiveTilt(const ins_t& message, int64_t now);
  bool present(int64_t now) const;
  bool inHand() const;
  bool handMoves(int64_t now) const;
  /// Why nothing may move, or empty. `faults` only: why the robot must be armed again.
  std::string stopReason(int64_t now, bool faults) const;
  std::string programStopReason(int64_t now, bool faults) const;

  MotorLimits limits_;
  bool up_ = true;
  bool estop_ = false;
  int64_t operator_seen_ = INT64_MIN / 2;   ///< [us] newest MOTOR received by an operator
  int64_t program_until_ = INT64_MIN / 2;   ///< [us] lease of the newest PROGRAM
  int64_t moving_until_ = INT64_MIN / 2;    ///< [us] lease of the newest PROGRAM with motion
  int64_t ins_utime_ = INT64_MIN / 2;       ///< [us] of the newest measurement
  int64_t ins_received_ = INT64_MIN / 2;    ///< [us]
  int64_t arm_ = INT64_MIN / 2;             ///< [us] newest ARM
  int64_t armed_ = INT64_MIN / 2;           ///< [us] newest ARM in the presence of an operator
  std::map<int64_t, Hand> hands_;           ///< by station
  std::optional<int64_t> tilt_since_;       ///< [us] of the first measurement beyond the limit
  int tilts_ = 0;                           ///< consecutive measurements beyond it
  bool tilted_ = false;                     ///< for 100 ms and three of them
  int64_t needs_arm_ = 0;                   ///< [us] earlier ARMs are void
  std::optional<int64_t> fault_since_;      ///< [us]
  std::optional<int64_t> forbidden_since_;  ///< [us]
  std::string why_;
};

/// No pattern may be sent whose footprint meets obstacles that the planner's newest map has had for
/// long enough.
class PathRule {
 public:
  explicit PathRule(const FootprintSize& footprint)
      : bare_(footprint, 0.0), wide_(footprint, kTolerance), footprint_(footprint, -kTolerance) {}

  void receive(const Received& received);
  void start();
  /// PLAN as sent by the planner; returns the violation, empty if none.
  std::string check(int64_t now, const plan_t& plan);
  int64_t judged() const { return judged_; }

 private:
  /// [m] tolerance for corners cut between poses, and for rounding.
  static constexpr double kTolerance = 0.01;
  /// [us] the planner's reaction: one cycle, and 100 ms between two views of its map.
  static constexpr int64_t kDelay = 170'000;
  struct KnownTile {
    int64_t utime = 0;
    std::vector<Cell> cells;
    std::vector<int64_t> since;  ///< [us] time of each cell's last change
  };
  struct Blocked {
    int obstacles = 0;
    int all = 0;
  };

  void take(int64_t now, const map_tile_t& tile);
  void standOn(const Pose2& T_map_body);
  Blocked under(const Footprint& footprint, const Pose2& T_map_body, int64_t before) const;
  std::string checkStep(int64_t now, const plan_t& plan, size_t i);

  Footprint bare_;
  Footprint wide_;       ///< slightly larger: around the start of a pattern
  Footprint footprint_;  ///< slightly smaller
  static constexpr int64_t kForgotten = 3'000'000;  ///< [us] without a tile
  int64_t taken_ = 0;                               ///< [us] the last tile
  double cell_ = 0.0;
  int side_ = 0;
  std::map<std::pair<int, int>, KnownTile> tiles_;
  PatternSetAssembler sets_;
  std::map<int64_t, PatternSet> by_version_;
  std::map<int64_t, std::pair<double, double>> judged_at_;  ///< by execution: its end
  int64_t judged_ = 0;
};

/// Each message that a node must refuse appears in its HEALTH within 1 s.
class CountRule {
 public:
  explicit CountRule(bool keyed) : keyed_(keyed) {}
  void sent(const std::string& channel, const std::vector<uint8_t>& bytes);
  void receive(const std::string& node, const std::string& channel,
               const std::vector<uint8_t>& bytes);
  void start(const std::string& node) { nodes_.erase(node); }
  std::string check(const health_t& health);

 private:
  struct Node {
    int64_t bad = 0;
    int64_t bad_before = 0;  ///< at its last HEALTH
    std::set<std::pair<std::string, size_t>> seen;
  };
  bool keyed_;
  std::map<std::string, std::vector<uint8_t>> types_;  ///< fingerprint of each channel
  std::map<std::string, Node> nodes_;
};

}  // namespace tread::faults

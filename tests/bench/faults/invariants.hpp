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

/// A message as a receiver was handed it, without its seal.
struct Received {
  int64_t utime = 0;  ///< [us] of receipt
  std::string channel;
  std::vector<uint8_t> bytes;
  bool changed = false;  ///< on its way
};

/// Decodes a message of a channel; nothing if it is of another channel or broken.
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

/// What the robot's files say, as far as the motors' rule depends on it.
struct MotorLimits {
  int64_t operator_lease_us = 1'000'000;  ///< [us]
  int64_t hand_lease_us = 200'000;        ///< [us] of MANUAL
  double tilt = 1e9;                      ///< [rad] hard limit of roll and pitch
  bool go_back = false;                   ///< without its operator the armed robot may return
};

/// The motors are at zero unless the bridge was told of an operator, an arming that nothing has
/// ended since, and either a program that wants motion, an INS that goes on and no tilt beyond its
/// limit, or a hand that holds the button, sees the robot, and was seen at rest.
/** With `go_back` an armed robot may move without its operator, and then the planner's word decides
 * (ReturnRule); but arming it needs the operator. In the hand neither program nor INS is needed:
 * what a robot that may be in the hand lost of them asks for no ARM. A tilt beyond the limit in
 * three measurements and for 100 ms does, and programs wait until a measurement is within. Knows
 * only what the bridge was handed and what power reaches the motors; counts in favour of the
 * bridge what it cannot tell. */
class MotorRule {
 public:
  explicit MotorRule(const MotorLimits& limits) : limits_(limits) {}

  void receive(const Received& received);
  /// The bridge was started or ended.
  void start(int64_t now);
  void end(int64_t now);
  /// Power of both motors at a time; what is wrong, or empty. Call it every few milliseconds.
  std::string check(int64_t now, const std::array<double, 2>& power);

 private:
  /// A hand that was told of: which of its messages is the newest, and what it wants.
  struct Hand {
    int64_t seq = INT64_MIN;
    int64_t until = INT64_MIN / 2;  ///< [us] the tracks may move
    bool holds = false;             ///< the robot may be in this hand
    bool rested = false;            ///< seen at rest since it was last silent or not known
    int64_t heard = INT64_MIN / 2;  ///< [us]
  };

  void receiveManual(const manual_t& message, bool changed, int64_t now);
  void receiveTilt(const ins_t& message, int64_t now);
  bool present(int64_t now) const;
  bool inHand() const;
  bool handMoves(int64_t now) const;
  /// Why nothing may move, or empty. `faults` only: why arming is needed again.
  std::string stopReason(int64_t now, bool faults) const;
  std::string programStopReason(int64_t now, bool faults) const;

  MotorLimits limits_;
  bool up_ = true;
  bool estop_ = false;
  int64_t operator_seen_ = INT64_MIN / 2;   ///< [us] newest MOTOR that an operator has seen
  int64_t program_until_ = INT64_MIN / 2;   ///< [us] lease of the newest PROGRAM
  int64_t moving_until_ = INT64_MIN / 2;    ///< [us] lease of the newest one that wants motion
  int64_t ins_utime_ = INT64_MIN / 2;       ///< [us] of the newest measurement
  int64_t ins_received_ = INT64_MIN / 2;    ///< [us]
  int64_t arm_ = INT64_MIN / 2;             ///< [us] newest ARM
  int64_t armed_ = INT64_MIN / 2;           ///< [us] newest ARM beside an operator
  std::map<int64_t, Hand> hands_;           ///< by station
  std::optional<int64_t> tilt_since_;       ///< [us] of the first measurement beyond the limit
  int tilts_ = 0;                           ///< measurements beyond it in turn
  bool tilted_ = false;                     ///< for 100 ms and three of them
  int64_t needs_arm_ = 0;                   ///< [us] an ARM from before counts for nothing
  std::optional<int64_t> fault_since_;      ///< [us]
  std::optional<int64_t> forbidden_since_;  ///< [us]
  std::string why_;
};

/// No pattern is handed over whose footprint meets what the planner's newest map has long had.
class PathRule {
 public:
  explicit PathRule(const FootprintSize& footprint)
      : bare_(footprint, 0.0), wide_(footprint, kTolerance), footprint_(footprint, -kTolerance) {}

  void receive(const Received& received);
  void start();
  /// PLAN as the planner sends it; what is wrong, or empty.
  std::string check(int64_t now, const plan_t& plan);
  int64_t judged() const { return judged_; }

 private:
  /// [m] by which corners may be cut between poses, and rounding.
  static constexpr double kTolerance = 0.01;
  /// [us] the planner takes a cycle to know, and 100 ms between two views of its map.
  static constexpr int64_t kDelay = 170'000;
  struct KnownTile {
    int64_t utime = 0;
    std::vector<Cell> cells;
    std::vector<int64_t> since;  ///< [us] each cell is as it is since then
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
  Footprint wide_;       ///< a little larger: around where a pattern begins
  Footprint footprint_;  ///< a little smaller
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

/// Each message that a node must refuse is in its HEALTH a second later.
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

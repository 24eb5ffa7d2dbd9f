// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "tools/robot/operator/calls.hpp"

namespace tread::operators {

/// Handles the commands of a page or terminal, with the operator's lease: it holds while the page
/// sends signs of life.
/** When a page is closed, hidden, frozen or cut off, the robot stops as for a halted tread-goal.
 * The emergency stop is accepted from every page. */
class OperatorConsole {
 public:
  /// `why`: reason for the log of its arming and stopping.
  OperatorConsole(Bus& bus, std::string operator_name, std::string why);

  /// Processes a command as JSON. Always accepted: {"op": "estop"}, "clear_estop", "disarm",
  /// "cancel". With "seen", the time [us] of this host at which the newest MOTOR shown by the page
  /// arrived: "alive", "arm", "goal" (x, y, optional yaw [rad]), "fence" (name, keep_out, corners
  /// [m]), "remove_fence" (name).
  /** Returns the error in one line; empty = accepted. `page` identifies the page. */
  std::string take(const std::string& json, uint64_t page, int64_t utime);
  /// A page was closed.
  void leave(uint64_t page, int64_t utime);
  /// Call about every 20 ms.
  void step(int64_t utime);

  /// Page that holds the robot; 0 = none.
  uint64_t holder() const { return page_; }
  /// Status of the calls for the page, one line each: stops first, then newest first.
  std::string words() const;
  /// Whether nothing runs and so many calls have ended that bus and console should be replaced:
  /// subscriptions of ended calls live as long as the bus.
  bool worn() const;

 private:
  static constexpr int64_t kPageLease = 600'000;  ///< [us] after the page's last sign of life
  static constexpr int64_t kShown = 6'000'000;    ///< [us] an ended call is shown

  struct Running {
    std::string what;
    std::unique_ptr<Call> call;
    bool holds = false;  ///< valid only while its page is alive
    bool ended = false;
    int64_t ended_at = 0;  ///< [us]
    std::string words;
  };
  /// Commands that only stop, and their undoing; they do not require that the page holds the robot.
  bool takeStop(const std::string& op, int64_t utime);
  bool runs(const std::string& what) const;
  void start(const std::string& what, std::unique_ptr<Call> call, bool holds);
  static void end(Running& running, int64_t utime, const std::string& why);

  /// Cancels all calls that move the robot, or those of one name.
  void letGo(int64_t utime, const std::string& why, const std::string& only = "");

  Bus& bus_;
  Requester requester_;
  std::list<Running> calls_;
  /// Ended calls are kept: the bus still calls them.
  std::list<std::unique_ptr<Call>> past_;
  uint64_t page_ = 0;  ///< holds the robot; 0 = none
  int64_t alive_ = 0;  ///< [us] its last sign of life
};

}  // namespace tread::operators

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "tools/robot/operator/calls.hpp"

namespace tread::operators {

/// What a page, or a terminal, asks of the robot with the operator's lease: it holds for as long as
/// the page is alive, shown by its signs of life.
/** A page that is closed, hidden, frozen or cut off lets the robot stop as tread-goal does that is
 * halted. The emergency stop is taken from every page. */
class OperatorConsole {
 public:
  /// `why`: what the log says of its arming and stopping.
  OperatorConsole(Bus& bus, std::string operator_name, std::string why);

  /// A command as JSON: {"op": "estop"}, "clear_estop", "disarm", "cancel"; and with "seen", the
  /// time
  /// [us] of this host at which the newest MOTOR came that the page has shown: "alive", "arm",
  /// "goal" (x, y, perhaps yaw [rad]), "fence" (name, keep_out, corners [m]), "remove_fence"
  /// (name).
  /** Returns what is wrong with it in one line; empty = taken. `page` differs for each page. */
  std::string take(const std::string& json, uint64_t page, int64_t utime);
  /// A page is gone.
  void leave(uint64_t page, int64_t utime);
  /// Call each 20 ms or so.
  void step(int64_t utime);

  /// The page that holds the robot; 0 = none.
  uint64_t holder() const { return page_; }
  /// How the calls go, a line each, stops first and newest first: what the page shows.
  std::string words() const;
  /// Nothing runs, and so many calls are over that a new bus and console should take their place:
  /// the bus calls them all back, to its end.
  bool worn() const;

 private:
  static constexpr int64_t kPageLease = 600'000;  ///< [us] without a sign of life of the page
  static constexpr int64_t kShown = 6'000'000;    ///< [us] for which an ended call is shown

  struct Running {
    std::string what;
    std::unique_ptr<Call> call;
    bool holds = false;  ///< only while its page lives
    bool ended = false;
    int64_t ended_at = 0;  ///< [us]
    std::string words;
  };
  /// Commands that only stop, and their undoing: no page must hold the robot for them.
  bool takeStop(const std::string& op, int64_t utime);
  bool runs(const std::string& what) const;
  void start(const std::string& what, std::unique_ptr<Call> call, bool holds);
  static void end(Running& running, int64_t utime, const std::string& why);

  /// Ends what moves the robot: all of it, or what is called so.
  void letGo(int64_t utime, const std::string& why, const std::string& only = "");

  Bus& bus_;
  Requester requester_;
  std::list<Running> calls_;
  /// Ended ones stay: the bus calls them back.
  std::list<std::unique_ptr<Call>> past_;
  uint64_t page_ = 0;  ///< that holds the robot; 0 = none
  int64_t alive_ = 0;  ///< [us] its last sign of life
};

}  // namespace tread::operators

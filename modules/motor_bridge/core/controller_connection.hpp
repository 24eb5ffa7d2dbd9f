// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "modules/motor_bridge/core/motor_controller.hpp"

namespace tread::motor {

/// Timing common to all connections to motor controllers.
struct ConnectionTimes {
  int64_t watchdog_us = 250'000;       ///< of the controller [us]
  int64_t reply_timeout_us = 100'000;  ///< a reply that takes longer counts as missing [us]
  /// Longest time without a sign that it receives commands [us]
  int64_t silence_limit_us = 250'000;
  int64_t stop_interval_us = 50'000;  ///< interval of zeros on a faulty link [us]
  int64_t backoff_min_us = 100'000;   ///< before the next start-up [us], doubling
  int64_t backoff_max_us = 1'000'000;
  int startup_tries = 3;  ///< of each request
};

/// Common part of the connections to all controllers; each kind adds its own protocol.
/** Start-up at each (re)connect: requests in turn, each repeated until it is answered. Commands are
 * sent only after the start-up; after silence zero is sent first, because a controller whose
 * watchdog expired may resume its old speed with the next command; on a faulty link zero is
 * repeated until the next start-up. */
class ControllerConnection : public MotorController {
 public:
  void open() override;
  void close(const std::string& problem) override;
  bool isOpen() const override { return phase_ != Phase::kClosed; }
  void command(const Command& command, int64_t now) override;
  std::string poll(int64_t now) override;
  std::string zeros(int times) const override;
  DeviceReport report(int64_t now) const override;
  bool ready() const override { return phase_ == Phase::kReady; }
  std::string lineProblem() const override;
  std::map<std::string, int64_t> counters() const override;

 protected:
  explicit ControllerConnection(const ConnectionTimes& times) : times_(times) {}

  // The protocol of a kind.
  /// Bytes that stop the motors, once.
  virtual std::string zero() const = 0;
  virtual int startupSteps() const = 0;
  /// Bytes of one step of the start-up.
  virtual std::string startupRequest(int step) const = 0;
  /// The same, named for people.
  virtual std::string startupName(int step) const = 0;
  /// Whether the step needs an answer; without one it is done as soon as it is sent.
  virtual bool isAnswered(int /*step*/) const { return true; }
  /// Discards partly received lines and packets.
  virtual void forget() = 0;
  /// The last step of the start-up was completed at now [us].
  virtual void begin(int64_t now) = 0;
  /// A command after the start-up, to be sent with the next talk().
  virtual void give(const Command& command, int64_t now) = 0;
  /// Timeouts and queries after the start-up; returns all bytes to write now [us].
  virtual std::string talk(int64_t now) = 0;
  /// Why the start-up must be repeated; empty = no reason.
  virtual std::string lost(int64_t now) const = 0;
  /// The controller's report after the start-up.
  virtual DeviceReport reported(int64_t now) const = 0;
  /// Counters of the kind itself.
  virtual std::map<std::string, int64_t> counted() const = 0;

  const ConnectionTimes& times() const { return times_; }
  /// The start-up step that waits for its answer; -1 = none.
  int waitingStep() const { return phase_ == Phase::kStarting ? step_ : -1; }
  /// The step was answered: the next one is sent with the next poll.
  void stepDone(int64_t now);
  /// The step was refused: it is repeated with the next poll.
  void stepRefused(int64_t now);
  void fail(const std::string& problem, int64_t now, const std::string& detail = "");
  void count(const std::string& name) { ++counters_[name]; }

 private:
  /// Number of exchanges up to a time, and how many of them failed.
  struct Exchanges {
    int64_t utime = 0;  ///< [us]
    int64_t all = 0;
    int64_t failed = 0;
  };
  enum class Phase { kClosed, kStarting, kReady, kBackoff };

  void enter(Phase phase);
  void pollStartup(int64_t now);
  void sendZero(int64_t now);
  Exchanges exchanges(int64_t now) const;
  void watchLine(int64_t now);

  ConnectionTimes times_;
  Phase phase_ = Phase::kClosed;
  std::string problem_ = "not opened yet";
  std::string output_;
  std::map<std::string, int64_t> counters_;
  std::deque<Exchanges> line_;  ///< of the last seconds
  int step_ = 0;                ///< of the start-up
  int tries_ = 0;               ///< of the current step
  int64_t asked_at_ = 0;        ///< when the current request was sent
  int64_t backoff_us_ = 0;
  int64_t retry_at_ = 0;
  int64_t zero_at_ = 0;       ///< last zero sent outside of a session
  int64_t commanded_at_ = 0;  ///< last command given in a session
};

}  // namespace tread::motor

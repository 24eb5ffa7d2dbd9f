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

/// Times that every connection to a motor controller has.
struct ConnectionTimes {
  int64_t watchdog_us = 250'000;       ///< of the controller [us]
  int64_t reply_timeout_us = 100'000;  ///< a reply that takes longer is missing [us]
  int64_t silence_limit_us = 250'000;  ///< longest time without a sign that it hears us [us]
  int64_t stop_interval_us = 50'000;   ///< zero is repeated on a faulty link this often [us]
  int64_t backoff_min_us = 100'000;    ///< before starting up again [us], doubling
  int64_t backoff_max_us = 1'000'000;
  int startup_tries = 3;  ///< of each request
};

/// What the connections to all controllers have in common; a kind adds its own words.
/** Start-up at each (re)connect: requests in turn, each repeated until it is answered. Commands
    leave only to a controller that was started up; after silence zero goes first, because a
    controller whose watchdog expired may resume its old speed with the next command; on a faulty
    link zero is repeated until the next start-up. */
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

  // The words of a kind.
  /// All bytes that make the motors stand, once.
  virtual std::string zero() const = 0;
  virtual int startupSteps() const = 0;
  /// Bytes of one step of the start-up.
  virtual std::string startupRequest(int step) const = 0;
  /// The same for people.
  virtual std::string startupName(int step) const = 0;
  /// Whether the step needs an answer; without one it is done once it is sent.
  virtual bool isAnswered(int /*step*/) const { return true; }
  /// Half received lines and packets are forgotten.
  virtual void forget() = 0;
  /// The last step of the start-up was done at now [us].
  virtual void begin(int64_t now) = 0;
  /// A command to a controller that was started up, to be sent with the next talk().
  virtual void give(const Command& command, int64_t now) = 0;
  /// Timeouts and queries of a controller that was started up; all bytes to be written now [us].
  virtual std::string talk(int64_t now) = 0;
  /// Why the controller must be started up anew; empty = all is well.
  virtual std::string lost(int64_t now) const = 0;
  /// What a controller that was started up reports.
  virtual DeviceReport reported(int64_t now) const = 0;
  /// What the kind itself has counted.
  virtual std::map<std::string, int64_t> counted() const = 0;

  const ConnectionTimes& times() const { return times_; }
  /// The step of the start-up that waits for its answer; -1 = none.
  int waitingStep() const { return phase_ == Phase::kStarting ? step_ : -1; }
  /// The step was answered: the next one goes out with the next poll.
  void stepDone(int64_t now);
  /// The step was refused: it is repeated with the next poll.
  void stepRefused(int64_t now);
  void fail(const std::string& problem, int64_t now, const std::string& detail = "");
  void count(const std::string& name) { ++counters_[name]; }

 private:
  /// How many exchanges there were until a time, and how many of them failed.
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
  int tries_ = 0;               ///< of the present step
  int64_t asked_at_ = 0;        ///< when the present request was sent
  int64_t backoff_us_ = 0;
  int64_t retry_at_ = 0;
  int64_t zero_at_ = 0;       ///< last zero sent outside of a session
  int64_t commanded_at_ = 0;  ///< last command given in it
};

}  // namespace tread::motor

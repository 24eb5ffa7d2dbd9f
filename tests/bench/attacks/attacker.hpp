// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <unordered_set>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/channels.hpp"

namespace tread::testing {

/// An attacker on the robot's bus without its key: receives everything and sends forged messages,
/// recorded ones, and recorded ones with a changed byte, at a given rate.
class Attacker {
 public:
  Attacker(const std::string& url, double rate, uint64_t seed);
  ~Attacker();
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;

  /// Only listens while not set.
  void attack(bool attacks) { attacks_ = attacks; }
  int64_t sent() const { return sent_; }

 private:
  using Bytes = std::vector<uint8_t>;
  struct Heard {
    std::string channel;
    Bytes bytes;
  };

  void run();
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void sendOne();
  void send(const std::string& channel, const Bytes& bytes);
  template <class Message>
  void sendForged(const Channel<Message>& channel, Message message);
  void forge();

  lcm::LCM lcm_;
  double rate_;
  std::mt19937_64 random_;
  std::deque<Heard> heard_;           ///< the newest sealed ones of other senders
  std::unordered_set<size_t> known_;  ///< hashes of received or sent messages
  program_t program_{};               ///< the newest
  std::atomic<bool> attacks_{false};
  std::atomic<bool> stop_{false};
  std::atomic<int64_t> sent_{0};
  std::thread thread_;
};

}  // namespace tread::testing

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"

namespace tread {

/// Seeded faults on messages between a publisher and one receiver, each drawn per message and
/// receiver.
struct MessageFault {
  std::string channel = "*";   ///< channel name, or * for all
  std::string receiver = "*";  ///< node name, or * for all
  double drop = 0.0;           ///< probability 0..1
  double duplicate = 0.0;      ///< probability 0..1: delivered twice
  double corrupt = 0.0;        ///< probability 0..1: one byte changed
  /// Probability 0..1: held back by up to reorder_us, so that later ones overtake it
  double reorder = 0.0;
  int64_t reorder_us = 100'000;
  int64_t delay_us = 0;       ///< constant delay of each message
  int64_t from = 0;           ///< [us] since the start of the run
  int64_t until = INT64_MAX;  ///< [us] since the start of the run
};

/// A node is killed, and perhaps started again.
struct NodeFault {
  std::string node;
  int64_t kill_at = 0;         ///< [us] since the start of the run
  int64_t restart_after = -1;  ///< [us] after the kill; negative = never
};

/// What goes wrong in a run on the virtual bus.
struct FaultPlan {
  std::vector<MessageFault> messages;
  std::vector<NodeFault> nodes;
};

/// Simulated duration of a node's steps and handlers: their messages leave this much later.
struct NodeTiming {
  /// [us] from the start of a step to its messages' departure; the node is busy meanwhile
  int64_t compute_us = 0;
  int64_t phase_us = 0;  ///< [us] of the first step after the start
};

/// All nodes in one process and in virtual time; every message is really encoded and decoded, with
/// seeded faults.
/** Same nodes, seed and faults give the same messages in the same order. */
class VirtualBus {
 public:
  using Factory = std::function<std::unique_ptr<Node>(Bus&)>;
  /// Called with each message when it leaves its publisher: a recorder.
  using Tap =
      std::function<void(int64_t utime, const char* channel, const uint8_t* bytes, size_t size)>;
  /// Called with each message when it reaches a node, as the node receives it.
  using ArrivalTap = std::function<void(int64_t utime, const std::string& receiver,
                                        const char* channel, const uint8_t* bytes, size_t size)>;

  explicit VirtualBus(uint64_t seed, FaultPlan faults = {}, int64_t start_utime = 1'000'000);
  ~VirtualBus();
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;

  /// Adds and starts a node; the factory builds it again after each kill-and-restart.
  void addNode(const std::string& name, Factory factory, NodeTiming timing = {});
  /// Ends a node as SIGKILL does: no shutdown; its subscriptions and unsent messages are lost.
  void kill(const std::string& name);
  void restart(const std::string& name);
  /// A node stops stepping for a while [us]; messages to it wait meanwhile.
  void hang(const std::string& name, int64_t duration);
  /// The running node of that name or nullptr; for tests that look inside.
  Node* node(const std::string& name);
  const BusStatistics& statistics(const std::string& name) const;

  /// All endpoints, outside() included, seal and open their messages; inject() does not.
  void useKey(const SealKey& key);

  /// An endpoint for the tool or test itself: receives and publishes without delay or faults.
  Bus& outside();
  void setTap(Tap tap) { tap_ = std::move(tap); }
  void setArrivalTap(ArrivalTap tap) { arrival_tap_ = std::move(tap); }

  /// Puts raw bytes on a channel, as another program would.
  void inject(const char* channel, const uint8_t* bytes, size_t size);

  /// Runs until virtual time reaches `utime`.
  void runUntil(int64_t utime);
  int64_t now() const { return now_; }

 private:
  struct Packet;
  class Endpoint;
  struct Participant;
  class MessageFaults;

  Participant& participant(const std::string& name) const;
  void start(Participant& participant);
  static void kill(Participant& participant);
  void schedule(int64_t utime, std::function<void()> action);
  void publish(Participant& sender, const char* channel, const uint8_t* bytes, size_t size);
  void step(Participant& participant, uint64_t life, int64_t planned);
  void depart(const Participant& sender, uint64_t life, const Packet& packet);
  void route(const Packet& packet, Participant& receiver, MessageFaults& faults);
  void arrive(Participant& receiver, uint64_t life, const Packet& packet);

  int64_t start_;  ///< [us]
  int64_t now_;    ///< [us]
  std::optional<SealKey> key_;
  uint64_t sealers_ = 0;  ///< made so far
  Tap tap_;
  ArrivalTap arrival_tap_;
  std::unique_ptr<MessageFaults> faults_;
  /// For overheard messages: its own random stream, so that a seed still gives the same mission.
  std::unique_ptr<MessageFaults> faults_beside_;
  std::vector<std::unique_ptr<Participant>> participants_;  ///< the first is outside()
  /// Scheduled events by time; events of the same time in the order of scheduling.
  std::multimap<int64_t, std::function<void()>> events_;
};

}  // namespace tread

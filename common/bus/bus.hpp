// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "common/bus/bus_sealer.hpp"
#include "common/bus/channels.hpp"
#include "common/seal/seal.hpp"

namespace tread {

/// Which message it was.
struct Receipt {
  std::string channel;  ///< empty = none
  int64_t utime = 0;    ///< [us]
  int64_t seq = -1;
};

/// What a bus endpoint has counted since its start. Every refusal is counted; none is silent.
struct BusStatistics {
  int64_t received = 0;     ///< messages that reached a handler
  Receipt newest;           ///< the newest of them, in the order of receipt
  int64_t undecodable = 0;  ///< of another or broken type
  int64_t lost = 0;         ///< missing by seq
  int64_t late = 0;         ///< older on receipt than their channel's maximum age
  int64_t jumps = 0;        ///< with a utime too far ahead for the followed time
  int64_t failed = 0;       ///< handler threw
  int64_t oversized = 0;    ///< own messages above the channel's max_bytes: not sent
  /// This process has no key, but others have: they refuse its messages
  bool sealed_unread = false;
  /// messages refused, by reason: "too large", and with a key "unsealed", "replayed"
  std::map<std::string, int64_t> refused;
  std::string last_refusal;  ///< the newest refusal in one line: channel, what, size
};

/// Duration of a node's steps [us].
struct CycleTimes {
  int32_t mean_us = 0;
  int32_t max_us = 0;
};

/// A node's end of the message bus. Two kinds: LcmBus (real LCM) and the endpoints of a VirtualBus.
/** All calls come from one thread. Handlers run between steps, never inside publish(). With a key
 * each message is sealed, and only sealed ones are accepted, except those that stop the robot
 * (stops()); without a key seals are stripped unverified. */
class Bus {
 public:
  virtual ~Bus() = default;
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Present time of the robot [us], monotonic. Only processes with a device take it from the
  /// host.
  virtual int64_t now() const = 0;
  /// Differs for each start of a process on this robot [us]; serves as the planner's run id and as
  /// the boot id in HEALTH.
  virtual int64_t bootId() const = 0;
  /// Differs for each call, and between processes: the id of an operator program.
  int64_t newStation() { return bootId() + stations_++; }
  /// The host's UTC [us since 1970], only to date logs; -1 in virtual time.
  virtual int64_t utc() const { return -1; }
  /// How long the node's steps took since the last call; zero in virtual time.
  virtual CycleTimes takeCycleTimes() { return {}; }
  /// Reports the process's state, in one line, to the program that started it.
  virtual void tellStarter(const std::string& /*line*/) {}

  /// Encodes and sends. Returns false if it could not be sent (oversized, no network).
  template <class Message>
  bool publish(const Channel<Message>& channel, const Message& message) {
    const int size = message.getEncodedSize();
    if (size < 0 || size > channel.max_bytes) return refuseOversized(channel, size);
    buffer_.resize(static_cast<size_t>(size));
    if (message.encode(buffer_.data(), 0, size) != size) return refuseOversized(channel, size);
    if (sealer_) sealer_->seal(channel.name, buffer_, sealClock());
    return send(channel.name, buffer_.data(), buffer_.size());
  }

  /// Calls the handler for each good message. Decoding must consume every byte; failures are
  /// counted.
  template <class Message>
  void subscribe(const Channel<Message>& channel, std::function<void(const Message&)> handler) {
    const ChannelSpec spec = channel;
    const bool first = !hears(channel.name);
    Subscribed& subscribed = subscribed_[channel.name];
    subscribed.most = static_cast<size_t>(channel.max_bytes) + kSealBytes;
    if constexpr (MayStop<Message>::value) subscribed.stops = &isStop<Message>;
    subscribed.handlers.push_back(
        [this, spec, handler = std::move(handler)](const uint8_t* bytes, size_t size) {
          Message message{};
          if (!decode(spec, bytes, size, message)) return;
          noteReceipt(spec, message.utime, message.seq);
          if (!trusted_) forgetSender(message);
          handler(message);
        });
    if (first && !overhears(channel.name)) listen(channel.name);
  }
  bool hears(const std::string& channel) const { return subscribed_.count(channel) > 0; }

  /// The same, for a channel that is not an input of this node: not counted, not used as a source
  /// of time; bad messages are skipped.
  template <class Message>
  void overhear(const Channel<Message>& channel, std::function<void(const Message&)> handler) {
    const bool first = !hears(channel.name) && !overhears(channel.name);
    Subscribed& overheard = overheard_[channel.name];
    overheard.most = static_cast<size_t>(channel.max_bytes) + kSealBytes;
    overheard.handlers.push_back([handler = std::move(handler)](const uint8_t* bytes, size_t size) {
      Message message{};
      if (decodes(bytes, size, message)) handler(message);
    });
    if (first) listen(channel.name);
  }
  bool overhears(const std::string& channel) const { return overheard_.count(channel) > 0; }
  /// The subscribed channels, sorted.
  std::vector<std::string> heard() const;
  /// With a key but on another host, a bus may receive the robot's messages in two sessions. One of
  /// them is a recording, and the bus cannot distinguish them, so no message is proof of anything
  /// then.
  bool hearsTwoSessions() const;

  const BusStatistics& statistics() const { return statistics_; }

 protected:
  virtual bool send(const char* channel, const uint8_t* bytes, size_t size) = 0;
  /// Called at the first subscription to a channel.
  virtual void listen(const char* channel) = 0;
  /// The clock that stamps seals [us]: one clock for all who share a key.
  virtual int64_t sealClock() const { return now(); }
  /// Called for each good message, with its utime, on a channel that has a maximum age. False if
  /// the utime cannot be of the present.
  virtual bool onReceipt(int64_t /*utime*/) { return true; }
  /// False where a log is replayed to the node: there are no other processes to listen to.
  virtual bool hasCompany() const { return true; }

  /// Seals and opens messages from now on; call it before anything is published or received.
  void setSealer(std::optional<Sealer> sealer);
  /// Handles a received message: opens its seal once, then calls the channel's handlers.
  void receive(const std::string& channel, const uint8_t* bytes, size_t size);

 private:
  using RawHandler = std::function<void(const uint8_t* bytes, size_t size)>;

  template <class Message, class = void>
  struct MayStop : std::false_type {};
  template <class Message>
  struct MayStop<Message, std::void_t<decltype(stops(std::declval<const Message&>()))>>
      : std::true_type {};
  /// Whether these bytes are a message that stops the robot.
  template <class Message>
  static bool isStop(const uint8_t* bytes, size_t size) {
    Message message{};
    return decodes(bytes, size, message) && stops(message);
  }
  struct Subscribed {
    std::deque<RawHandler> handlers;  ///< not moved by a subscription made while a handler runs
    bool (*stops)(const uint8_t* bytes, size_t size) = nullptr;  ///< null: nothing here stops
    size_t most = 0;  ///< [bytes] of the channel's largest message and its seal
  };

  void receiveBeside(const std::string& channel, const uint8_t* bytes, size_t size);
  void refuse(const std::string& channel, const std::string& why, const std::string& remedy);
  /// The message's size without its seal; nullopt if the message is refused.
  std::optional<size_t> unseal(const std::string& channel, const Subscribed& subscribed,
                               const uint8_t* bytes, size_t size);
  /// Runs a raw handler behind the exception firewall: no exception may pass through LCM's C
  /// frames.
  void deliver(const RawHandler& handler, const std::string& channel, const uint8_t* bytes,
               size_t size);

  template <class Message>
  static bool decodes(const uint8_t* bytes, size_t size, Message& message) {
    // A negative length in a broken message makes the generated code throw std::length_error.
    try {
      const int expected = static_cast<int>(size);
      return message.decode(bytes, 0, expected) == expected;
    } catch (const std::exception&) {
      return false;
    }
  }
  template <class Message>
  bool decode(const ChannelSpec& spec, const uint8_t* bytes, size_t size, Message& message) {
    const bool good = decodes(bytes, size, message);
    if (!good) noteUndecodable(spec, size);
    return good;
  }
  void noteReceipt(const ChannelSpec& spec, int64_t utime, int64_t seq);
  void noteLoss(const ChannelSpec& spec, int64_t utime, int64_t seq);
  void noteUndecodable(const ChannelSpec& spec, size_t size);
  bool refuseOversized(const ChannelSpec& spec, int size);

  std::map<std::string, Subscribed> subscribed_;
  std::map<std::string, Subscribed> overheard_;
  std::optional<BusSealer> sealer_;
  bool trusted_ = true;  ///< whether the message being handled was sealed, where seals are required
  BusStatistics statistics_;
  int64_t stations_ = 0;
  /// The newest message of a channel, for counting missing ones.
  struct Newest {
    int64_t seq;
    int64_t utime;
  };
  std::map<std::string, Newest> newest_;
  std::vector<uint8_t> buffer_;
};

/// The newest message of a channel: a mailbox, so that a node polls instead of being called.
template <class Message>
class Latest {
 public:
  Latest(Bus& bus, const Channel<Message>& channel) {
    bus.subscribe<Message>(channel, [this, &bus](const Message& message) {
      message_ = message;
      received_ = bus.now();
      ++count_;
    });
  }
  Latest(const Latest&) = delete;
  Latest& operator=(const Latest&) = delete;

  bool any() const { return count_ > 0; }
  int64_t count() const { return count_; }
  const Message& message() const { return message_; }
  /// Time since receipt [us]; INT64_MAX if no message was received.
  int64_t age(int64_t now) const { return any() ? now - received_ : INT64_MAX; }

 private:
  Message message_{};
  int64_t received_ = 0;
  int64_t count_ = 0;
};

/// What a process runs: built from (config, Bus&, Link& where it has a device, Store& where it
/// keeps files).
class Node {
 public:
  virtual ~Node() = default;
  Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Time between steps [us], constant over the node's life.
  virtual int64_t period() const = 0;
  /// Takes the latest messages, checks their age and plausibility, calls the core, publishes.
  virtual void step(int64_t utime) = 0;
  /// Makes outputs safe before the process ends (SIGINT, SIGTERM, a step that threw). Not called
  /// when it is killed.
  virtual void shutdown(int64_t /*utime*/) {}
};

/// Another process of the same name, known from its HEALTH.
struct Namesake {
  int64_t boot_id = 0;
  int64_t heard = 0;  ///< [us] when last
  int count = 0;      ///< how often
};

/// State and reason in one line: "DEGRADED: no PROGRAM for 3 s".
std::string inWords(const health_t& health);

/// Publishes HEALTH at 1 Hz and CONFIG at the start and every 10 s for a node.
class HealthReporter {
 public:
  /// `effective_config` is the whole configuration as YAML with defaults.
  HealthReporter(Bus& bus, std::string process, std::string effective_config);
  HealthReporter(const HealthReporter&) = delete;  // the bus may call it back
  HealthReporter& operator=(const HealthReporter&) = delete;

  /// From now on HEALTH is DEGRADED while another process of this name lives: for processes that
  /// must be unique on a robot.
  void watchNamesakes();
  /// A single message may be a corrupted one of our own.
  static constexpr int kSureAfter = 2;
  /// The other process of this name that started first, if at least `heard_at_least` of its
  /// messages were received and the newest is recent; else nullopt.
  std::optional<Namesake> namesake(int64_t now, int heard_at_least = kSureAfter) const;

  /// One clear line: what, where, what to do. Empty reason with kOk.
  void setState(int16_t state, const std::string& reason);
  /// Sets HEALTH_FAILED; published in the next step, not up to a second later.
  void fail(const std::string& reason);
  /// Sets a named counter, for instance {"refused: wrong checksum", 3}.
  void setCounter(const std::string& name, int64_t value);
  void addToCounter(const std::string& name, int64_t increment = 1);
  /// Call in each step.
  void step(int64_t utime);

  int64_t bootId() const { return boot_id_; }

 private:
  void publishHealth(int64_t utime);
  /// What is wrong: this process's state, and whether another process has its name.
  std::string describe(int64_t utime) const;
  void publishConfig(int64_t utime);

  Bus& bus_;
  std::string process_;
  std::string config_text_;
  int64_t boot_id_;
  int64_t next_health_ = 0;
  int64_t next_config_ = 0;
  int64_t seq_health_ = 0;
  int64_t seq_config_ = 0;
  int16_t state_ = 0;
  std::string reason_;
  std::map<std::string, int64_t> counters_;
  std::map<int64_t, Namesake> namesakes_;  ///< by boot id
};

}  // namespace tread

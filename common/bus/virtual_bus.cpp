// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/virtual_bus.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>

namespace tread {
namespace {

/// [us] between processes: about as long as LCM needs on one host (measured: 6 to 11 us, one in a
/// hundred 11 to 29 us).
constexpr int64_t kTransportUs = 20;

}  // namespace

/// A message in transit; all receivers share its bytes.
struct VirtualBus::Packet {
  std::string channel;
  std::shared_ptr<const std::vector<uint8_t>> bytes;
};

/// A node's endpoint.
class VirtualBus::Endpoint : public Bus {
 public:
  Endpoint(VirtualBus& bus, Participant& participant)
      : bus_(bus), participant_(participant), boot_id_(bus.now_) {
    useKey();
  }
  int64_t now() const override { return bus_.now_; }
  int64_t bootId() const override { return boot_id_; }
  void arrive(const Packet& packet) {
    receive(packet.channel, packet.bytes->data(), packet.bytes->size());
  }
  void useKey() {
    if (bus_.key_) setSealer(Sealer(*bus_.key_, ++bus_.sealers_, kSession));
  }

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    bus_.publish(participant_, channel, bytes, size);
    return true;
  }
  void listen(const char* /*channel*/) override {}

 private:
  static constexpr uint64_t kSession = 1;  // virtual time never begins again

  VirtualBus& bus_;
  Participant& participant_;
  int64_t boot_id_;
};

/// A node with its endpoint and its timing model.
struct VirtualBus::Participant {
  std::string name;
  Factory factory;
  NodeTiming timing;
  std::unique_ptr<Endpoint> endpoint;  // outlives the node, which refers to it
  std::unique_ptr<Node> node;
  uint64_t life = 0;       ///< counts kills, to discard events of an earlier life
  int64_t busy_until = 0;  ///< [us]
  BusStatistics last_statistics;
};

/// Draws the faults of each message for each receiver.
class VirtualBus::MessageFaults {
 public:
  struct Passage {
    int64_t delay = kTransportUs;  ///< [us]
    int copies = 1;
    Packet packet;
  };

  MessageFaults(uint64_t seed, std::vector<MessageFault> faults)
      : random_(seed), faults_(std::move(faults)) {}

  Passage pass(const Packet& packet, const std::string& receiver, int64_t since_start) {
    Passage passage;
    passage.packet = packet;
    for (const MessageFault& fault : faults_) {
      if (!applies(fault, packet.channel, receiver, since_start)) continue;
      passage.delay += fault.delay_us;
      if (draw(fault.drop)) passage.copies = 0;
      if (draw(fault.duplicate)) ++passage.copies;
      if (draw(fault.reorder))
        passage.delay += static_cast<int64_t>(random_() % uint64_t(fault.reorder_us + 1));
      if (draw(fault.corrupt)) corrupt(passage.packet);
    }
    return passage;
  }

 private:
  static bool applies(const MessageFault& fault, const std::string& channel,
                      const std::string& receiver, int64_t since_start) {
    return (fault.channel == "*" || fault.channel == channel) &&
           (fault.receiver == "*" || fault.receiver == receiver) && since_start >= fault.from &&
           since_start < fault.until;
  }
  bool draw(double probability) {
    return probability > 0.0 && static_cast<double>(random_() >> 11) * 0x1.0p-53 < probability;
  }
  void corrupt(Packet& packet) {
    auto changed = std::make_shared<std::vector<uint8_t>>(*packet.bytes);
    if (!changed->empty())
      (*changed)[random_() % changed->size()] ^= static_cast<uint8_t>(1 + random_() % 255);
    packet.bytes = changed;
  }

  std::mt19937_64 random_;
  std::vector<MessageFault> faults_;
};

VirtualBus::VirtualBus(uint64_t seed, FaultPlan faults, int64_t start_utime)
    : start_(start_utime),
      now_(start_utime),
      faults_(std::make_unique<MessageFaults>(seed, faults.messages)),
      faults_beside_(std::make_unique<MessageFaults>(seed, std::move(faults.messages))) {
  participants_.push_back(std::make_unique<Participant>());
  participants_.front()->name = "outside";
  participants_.front()->endpoint = std::make_unique<Endpoint>(*this, *participants_.front());
  for (const NodeFault& fault : faults.nodes) {
    const std::string name = fault.node;
    schedule(start_ + fault.kill_at, [this, name] { kill(name); });
    if (fault.restart_after >= 0)
      schedule(start_ + fault.kill_at + fault.restart_after, [this, name] { restart(name); });
  }
}

VirtualBus::~VirtualBus() = default;

void VirtualBus::addNode(const std::string& name, Factory factory, NodeTiming timing) {
  for (const auto& other : participants_)
    if (other->name == name) throw std::invalid_argument("virtual bus: two nodes named " + name);
  participants_.push_back(std::make_unique<Participant>());
  Participant& added = *participants_.back();
  added.name = name;
  added.factory = std::move(factory);
  added.timing = timing;
  start(added);
}

VirtualBus::Participant& VirtualBus::participant(const std::string& name) const {
  for (const auto& participant : participants_)
    if (participant->name == name) return *participant;
  throw std::invalid_argument("virtual bus: no node named " + name);
}

void VirtualBus::kill(const std::string& name) {
  kill(participant(name));
}

void VirtualBus::restart(const std::string& name) {
  kill(participant(name));
  start(participant(name));
}

void VirtualBus::hang(const std::string& name, int64_t duration) {
  Participant& hung = participant(name);
  hung.busy_until = std::max(hung.busy_until, now_ + duration);
}

Node* VirtualBus::node(const std::string& name) {
  return participant(name).node.get();
}

const BusStatistics& VirtualBus::statistics(const std::string& name) const {
  const Participant& asked = participant(name);
  return asked.endpoint ? asked.endpoint->statistics() : asked.last_statistics;
}

void VirtualBus::useKey(const SealKey& key) {
  key_ = key;
  for (const auto& participant : participants_)
    if (participant->endpoint) participant->endpoint->useKey();
}

Bus& VirtualBus::outside() {
  return *participants_.front()->endpoint;
}

void VirtualBus::inject(const char* channel, const uint8_t* bytes, size_t size) {
  publish(*participants_.front(), channel, bytes, size);
}

void VirtualBus::runUntil(int64_t utime) {
  while (!events_.empty() && events_.begin()->first <= utime) {
    auto event = events_.extract(events_.begin());
    now_ = std::max(now_, event.key());
    event.mapped()();
  }
  now_ = std::max(now_, utime);
}

void VirtualBus::schedule(int64_t utime, std::function<void()> action) {
  events_.emplace(utime, std::move(action));
}

void VirtualBus::start(Participant& participant) {
  participant.endpoint = std::make_unique<Endpoint>(*this, participant);
  participant.node = participant.factory(*participant.endpoint);
  participant.busy_until = now_;
  const int64_t first = now_ + participant.timing.phase_us;
  schedule(first, [this, &participant, life = participant.life, first] {
    step(participant, life, first);
  });
}

void VirtualBus::kill(Participant& participant) {
  ++participant.life;
  if (participant.endpoint) participant.last_statistics = participant.endpoint->statistics();
  participant.node.reset();
  participant.endpoint.reset();
}

void VirtualBus::step(Participant& participant, uint64_t life, int64_t planned) {
  if (life != participant.life) return;
  int64_t next = participant.busy_until;
  if (participant.busy_until <= now_) {
    participant.busy_until = now_ + participant.timing.compute_us;
    participant.node->step(now_);
    // Steps stay on their grid; a step missed by a busy node is not made up for.
    const int64_t period = participant.node->period();
    const int64_t origin = planned - (planned - start_ - participant.timing.phase_us) % period;
    next = std::max(origin + period, now_ + 1);
  }
  schedule(next, [this, &participant, life, next] { step(participant, life, next); });
}

void VirtualBus::publish(Participant& sender, const char* channel, const uint8_t* bytes,
                         size_t size) {
  Packet packet{channel, std::make_shared<const std::vector<uint8_t>>(bytes, bytes + size)};
  schedule(now_ + sender.timing.compute_us,
           [this, &sender, life = sender.life, packet = std::move(packet)] {
             depart(sender, life, packet);
           });
}

void VirtualBus::depart(const Participant& sender, uint64_t life, const Packet& packet) {
  if (life != sender.life) return;
  if (tap_) tap_(now_, packet.channel.c_str(), packet.bytes->data(), packet.bytes->size());
  for (size_t i = 0; i < participants_.size(); ++i) {
    Participant& receiver = *participants_[i];
    if (!receiver.endpoint) continue;
    const bool hears = receiver.endpoint->hears(packet.channel);
    if (!hears && !receiver.endpoint->overhears(packet.channel)) continue;
    if (i == 0)
      receiver.endpoint->arrive(packet);
    else
      route(packet, receiver, hears ? *faults_ : *faults_beside_);
  }
}

void VirtualBus::route(const Packet& packet, Participant& receiver, MessageFaults& faults) {
  const MessageFaults::Passage passage = faults.pass(packet, receiver.name, now_ - start_);
  for (int copy = 0; copy < passage.copies; ++copy)
    schedule(now_ + passage.delay, [this, &receiver, life = receiver.life, sent = passage.packet] {
      arrive(receiver, life, sent);
    });
}

void VirtualBus::arrive(Participant& receiver, uint64_t life, const Packet& packet) {
  if (life != receiver.life) return;
  if (receiver.busy_until <= now_) {
    if (arrival_tap_ && receiver.endpoint->hears(packet.channel))
      arrival_tap_(now_, receiver.name, packet.channel.c_str(), packet.bytes->data(),
                   packet.bytes->size());
    return receiver.endpoint->arrive(packet);
  }
  schedule(receiver.busy_until,
           [this, &receiver, life, packet] { arrive(receiver, life, packet); });
}

}  // namespace tread

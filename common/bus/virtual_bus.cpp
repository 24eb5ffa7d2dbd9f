// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/virtual_bus.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <queue>
#include <random>
#include <stdexcept>

namespace tread {
namespace {

/// Time that a message needs from process to process; the order of what LCM needs on one host
/// (lcm.md, row 17).
constexpr int64_t kTransportUs = 20;

using Bytes = std::shared_ptr<const std::vector<uint8_t>>;

struct Letter {
  std::string channel;
  Bytes bytes;
};

}  // namespace

class VirtualBus::Core {
 public:
  Core(uint64_t seed, FaultPlan faults, int64_t start_utime)
      : random_(seed), faults_(std::move(faults)), start_(start_utime), now_(start_utime) {
    stations_.push_back(std::make_unique<Station>());
    stations_[kOutside]->name = "outside";
    stations_[kOutside]->end = std::make_unique<End>(*this, kOutside);
    for (const NodeFault& fault : faults_.nodes) scheduleNodeFault(fault);
  }

  void addNode(const std::string& name, Factory factory, NodeTiming timing) {
    if (indexOf(name)) throw std::invalid_argument("virtual bus: two nodes named " + name);
    auto station = std::make_unique<Station>();
    station->name = name;
    station->factory = std::move(factory);
    station->timing = timing;
    stations_.push_back(std::move(station));
    start(stations_.size() - 1);
  }

  void kill(const std::string& name) { killAt(required(name)); }
  void restart(const std::string& name) {
    const size_t index = required(name);
    killAt(index);
    start(index);
  }
  Node* node(const std::string& name) { return stations_[required(name)]->node.get(); }
  const BusStatistics& statistics(const std::string& name) {
    const Station& station = *stations_[required(name)];
    return station.end ? station.end->statistics() : station.last_statistics;
  }
  Bus& outside() { return *stations_[kOutside]->end; }
  void setTap(Tap tap) { tap_ = std::move(tap); }
  int64_t now() const { return now_; }

  void publish(size_t sender, const char* channel, const uint8_t* bytes, size_t size) {
    Event event;
    event.kind = Event::kDepart;
    event.station = sender;
    event.life = stations_[sender]->life;
    event.letter = {channel, std::make_shared<const std::vector<uint8_t>>(bytes, bytes + size)};
    push(std::move(event), now_ + stations_[sender]->timing.compute_us);
  }

  void runUntil(int64_t utime) {
    while (!events_.empty() && events_.top().time <= utime) {
      Event event = events_.top();
      events_.pop();
      now_ = std::max(now_, event.time);
      handle(event);
    }
    now_ = std::max(now_, utime);
  }

 private:
  static constexpr size_t kOutside = 0;

  struct Event {
    enum Kind { kStep, kDepart, kArrive, kKill, kRestart };
    int64_t time = 0;
    uint64_t order = 0;
    Kind kind = kStep;
    size_t station = 0;
    uint64_t life = 0;  ///< events of a killed node's former life are void
    Letter letter;
    std::string node;
  };
  struct Later {
    bool operator()(const Event& a, const Event& b) const {
      return a.time != b.time ? a.time > b.time : a.order > b.order;
    }
  };

  class End : public Bus {
   public:
    End(Core& core, size_t station) : core_(core), station_(station), boot_id_(core.now_) {}
    int64_t now() const override { return core_.now_; }
    int64_t bootId() const override { return boot_id_; }
    bool hears(const std::string& channel) const { return handlers_.count(channel) > 0; }
    void arrive(const Letter& letter) {
      // Index loop and deque: a handler may subscribe, and must not be moved while it runs.
      const auto found = handlers_.find(letter.channel);
      if (found == handlers_.end()) return;
      for (size_t i = 0; i < found->second.size(); ++i)
        deliver(found->second[i], letter.channel.c_str(), letter.bytes->data(),
                letter.bytes->size());
    }

   protected:
    bool send(const char* channel, const uint8_t* bytes, size_t size) override {
      core_.publish(station_, channel, bytes, size);
      return true;
    }
    void listen(const char* channel, RawHandler handler) override {
      handlers_[channel].push_back(std::move(handler));
    }

   private:
    Core& core_;
    size_t station_;
    int64_t boot_id_;
    std::map<std::string, std::deque<RawHandler>> handlers_;
  };

  struct Station {
    std::string name;
    Factory factory;
    NodeTiming timing;
    std::unique_ptr<End> end;  // outlives the node, which refers to it
    std::unique_ptr<Node> node;
    uint64_t life = 0;
    int64_t busy_until = 0;
    BusStatistics last_statistics;
  };

  void push(Event event, int64_t time) {
    event.time = time;
    event.order = next_order_++;
    events_.push(std::move(event));
  }

  std::optional<size_t> indexOf(const std::string& name) const {
    for (size_t i = 0; i < stations_.size(); ++i)
      if (stations_[i]->name == name) return i;
    return std::nullopt;
  }
  size_t required(const std::string& name) const {
    const auto index = indexOf(name);
    if (!index) throw std::invalid_argument("virtual bus: no node named " + name);
    return *index;
  }

  void scheduleNodeFault(const NodeFault& fault) {
    Event kill;
    kill.kind = Event::kKill;
    kill.node = fault.node;
    push(kill, start_ + fault.kill_at);
    if (fault.restart_after < 0) return;
    kill.kind = Event::kRestart;
    push(kill, start_ + fault.kill_at + fault.restart_after);
  }

  void start(size_t index) {
    Station& station = *stations_[index];
    station.end = std::make_unique<End>(*this, index);
    station.node = station.factory(*station.end);
    station.busy_until = now_;
    Event step;
    step.kind = Event::kStep;
    step.station = index;
    step.life = station.life;
    push(step, now_ + station.timing.phase_us);
  }

  void killAt(size_t index) {
    Station& station = *stations_[index];
    ++station.life;
    if (station.end) station.last_statistics = station.end->statistics();
    station.node.reset();
    station.end.reset();
  }

  void handle(Event& event) {
    switch (event.kind) {
      case Event::kStep:
        return step(event);
      case Event::kDepart:
        return depart(event);
      case Event::kArrive:
        return arrive(event);
      case Event::kKill:
        return kill(event.node);
      case Event::kRestart:
        return restart(event.node);
    }
  }

  void step(Event& event) {
    Station& station = *stations_[event.station];
    if (event.life != station.life) return;
    if (station.busy_until > now_) return push(event, station.busy_until);
    station.busy_until = now_ + station.timing.compute_us;
    station.node->step(now_);
    // Steps stay on their grid; one that a busy node missed is not made up for.
    const int64_t period = station.node->period();
    const int64_t origin = event.time - (event.time - start_ - station.timing.phase_us) % period;
    push(event, std::max(origin + period, now_ + 1));
  }

  void depart(Event& event) {
    if (event.life != stations_[event.station]->life) return;
    if (tap_)
      tap_(now_, event.letter.channel.c_str(), event.letter.bytes->data(),
           event.letter.bytes->size());
    for (size_t i = 0; i < stations_.size(); ++i) {
      if (!stations_[i]->end || !stations_[i]->end->hears(event.letter.channel)) continue;
      if (i == kOutside) {
        stations_[i]->end->arrive(event.letter);
      } else {
        route(event.letter, i);
      }
    }
  }

  void route(const Letter& letter, size_t receiver) {
    int64_t delay = kTransportUs;
    int copies = 1;
    Letter sent = letter;
    for (const MessageFault& fault : faults_.messages) {
      if (!applies(fault, letter.channel, stations_[receiver]->name)) continue;
      delay += fault.delay_us;
      if (draw(fault.drop)) copies = 0;
      if (draw(fault.duplicate)) ++copies;
      if (draw(fault.reorder))
        delay += static_cast<int64_t>(random_() % uint64_t(fault.reorder_us + 1));
      if (draw(fault.corrupt)) sent.bytes = corrupted(*sent.bytes);
    }
    for (int copy = 0; copy < copies; ++copy) {
      Event event;
      event.kind = Event::kArrive;
      event.station = receiver;
      event.life = stations_[receiver]->life;
      event.letter = sent;
      push(std::move(event), now_ + delay);
    }
  }

  void arrive(Event& event) {
    Station& station = *stations_[event.station];
    if (event.life != station.life || !station.end) return;
    if (station.busy_until > now_) return push(event, station.busy_until);
    station.end->arrive(event.letter);
  }

  bool applies(const MessageFault& fault, const std::string& channel,
               const std::string& receiver) const {
    const int64_t since_start = now_ - start_;
    return (fault.channel == "*" || fault.channel == channel) &&
           (fault.receiver == "*" || fault.receiver == receiver) && since_start >= fault.from &&
           since_start < fault.until;
  }
  bool draw(double probability) {
    return probability > 0.0 && static_cast<double>(random_() >> 11) * 0x1.0p-53 < probability;
  }
  Bytes corrupted(const std::vector<uint8_t>& bytes) {
    auto changed = std::make_shared<std::vector<uint8_t>>(bytes);
    if (!changed->empty())
      (*changed)[random_() % changed->size()] ^= static_cast<uint8_t>(1 + random_() % 255);
    return changed;
  }

  std::mt19937_64 random_;
  FaultPlan faults_;
  int64_t start_;
  int64_t now_;
  uint64_t next_order_ = 0;
  Tap tap_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::priority_queue<Event, std::vector<Event>, Later> events_;
};

VirtualBus::VirtualBus(uint64_t seed, FaultPlan faults, int64_t start_utime)
    : core_(std::make_unique<Core>(seed, std::move(faults), start_utime)) {}
VirtualBus::~VirtualBus() = default;
void VirtualBus::addNode(const std::string& name, Factory factory, NodeTiming timing) {
  core_->addNode(name, std::move(factory), timing);
}
void VirtualBus::kill(const std::string& name) {
  core_->kill(name);
}
void VirtualBus::restart(const std::string& name) {
  core_->restart(name);
}
Node* VirtualBus::node(const std::string& name) {
  return core_->node(name);
}
const BusStatistics& VirtualBus::statistics(const std::string& name) const {
  return core_->statistics(name);
}
Bus& VirtualBus::outside() {
  return core_->outside();
}
void VirtualBus::setTap(Tap tap) {
  core_->setTap(std::move(tap));
}
void VirtualBus::inject(const char* channel, const uint8_t* bytes, size_t size) {
  core_->publish(0, channel, bytes, size);
}
void VirtualBus::runUntil(int64_t utime) {
  core_->runUntil(utime);
}
int64_t VirtualBus::now() const {
  return core_->now();
}

}  // namespace tread

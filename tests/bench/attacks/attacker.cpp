// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/attacks/attacker.hpp"

#include <string_view>

#include "common/bus/host_clock.hpp"
#include "common/seal/seal.hpp"

namespace tread::testing {
namespace {

constexpr size_t kRemembered = 400;  // messages
// bytes; large messages are few, else the rate would be limited by bytes
constexpr size_t kLarge = 3'000;
constexpr uint64_t kLargeShare = 200;

size_t hashOf(const std::vector<uint8_t>& bytes) {
  return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

template <class Message>
bool isStop(const std::vector<uint8_t>& bytes) {
  Message message{};
  const auto size = static_cast<int>(sizeWithoutSeal(bytes.data(), bytes.size()));
  return message.decode(bytes.data(), 0, size) == size && stops(message);
}

/// Messages that would stop the robot: anybody may send them, but they are no attack.
bool wouldStop(const std::string& channel, const std::vector<uint8_t>& bytes) {
  return (channel == kEstop.name && isStop<estop_t>(bytes)) ||
         (channel == kArm.name && isStop<arm_t>(bytes)) ||
         (channel == kGoal.name && isStop<goal_t>(bytes));
}

}  // namespace

Attacker::Attacker(const std::string& url, double rate, uint64_t seed)
    : lcm_(url), rate_(rate), random_(seed) {
  for (const ChannelSpec& spec :
       {ChannelSpec(kArm), ChannelSpec(kGoal), ChannelSpec(kOperator), ChannelSpec(kProgram),
        ChannelSpec(kPatternSet), ChannelSpec(kEstop), ChannelSpec(kMap), ChannelSpec(kIns)})
    lcm_.subscribe(spec.name, &Attacker::hear, this)->setQueueCapacity(1000);
  thread_ = std::thread([this] { run(); });
}

Attacker::~Attacker() {
  stop_ = true;
  thread_.join();
}

void Attacker::hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  const auto* const bytes = static_cast<const uint8_t*>(buffer->data);
  Heard heard{channel, {bytes, bytes + buffer->data_size}};
  if (sizeWithoutSeal(bytes, buffer->data_size) == buffer->data_size) return;  // our own
  if (!known_.insert(hashOf(heard.bytes)).second || wouldStop(channel, heard.bytes)) return;
  if (channel == kProgram.name)
    program_.decode(bytes, 0, static_cast<int>(sizeWithoutSeal(bytes, buffer->data_size)));
  heard_.push_back(std::move(heard));
  if (heard_.size() > kRemembered) heard_.pop_front();
}

void Attacker::run() {
  int64_t last = hostNow();
  double due = 0.0;
  while (!stop_) {
    lcm_.handleTimeout(1);
    for (int i = 0; i < 200 && lcm_.handleTimeout(0) > 0; ++i) {
    }
    const int64_t now = hostNow();
    due += attacks_ ? rate_ * 1e-6 * static_cast<double>(now - last) : 0.0;
    last = now;
    for (; due >= 1.0; due -= 1.0) sendOne();
  }
}

void Attacker::send(const std::string& channel, const Bytes& bytes) {
  lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  ++sent_;
}

void Attacker::sendOne() {
  const uint64_t way = random_() % 4;
  if (way < 2 || heard_.empty()) return forge();
  const Heard& chosen = heard_[random_() % heard_.size()];
  if (chosen.bytes.size() > kLarge && random_() % kLargeShare != 0) return forge();
  if (way == 2) return send(chosen.channel, chosen.bytes);
  Bytes changed = chosen.bytes;
  changed[8 + random_() % (changed.size() - 8)] ^= static_cast<uint8_t>(1 + random_() % 255);
  if (wouldStop(chosen.channel, changed)) return forge();
  known_.insert(hashOf(changed));
  send(chosen.channel, changed);
}

template <class Message>
void Attacker::sendForged(const Channel<Message>& channel, Message message) {
  message.utime = hostNow();
  message.seq = static_cast<int64_t>(random_() % 1'000'000);
  Bytes bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  send(channel.name, bytes);
}

/// Messages that would move or deceive the robot if accepted.
void Attacker::forge() {
  switch (random_() % 8) {
    case 0: {
      arm_t arm{};
      arm.armed = 1;
      arm.armed_by = "test";
      arm.arm_reason = "attack";
      return sendForged(kArm, arm);
    }
    case 1: {
      goal_t goal{};
      goal.goal_id = hostNow();
      goal.goal_pose[0] = -30.0;
      goal.goal_pose[1] = 30.0;
      goal.position_tolerance = 0.5;
      goal.yaw_tolerance = 3.0;
      return sendForged(kGoal, goal);
    }
    case 2: {
      program_t program = program_;
      for (program_slot_t* slot : {&program.running, &program.next})
        for (std::vector<float>& values : slot->command)
          for (float& value : values) value = 1.0F;
      return sendForged(kProgram, program);
    }
    case 3: {
      pattern_set_part_t part{};
      part.set_version = 1'000'000;
      part.part_count = 1;
      return sendForged(kPatternSet, part);
    }
    case 4:
      return sendForged(kEstop, estop_t{});  // engaged = 0: clears
    case 5: {
      map_tile_t tile{};
      tile.cell_size = 0.1;
      return sendForged(kMap, tile);
    }
    case 6:
      return sendForged(kIns, ins_t{});
    default: {
      operator_t station{};
      station.station = 1;
      station.operator_name = "test";
      station.allowed = operator_t::ALLOW_DRIVING;
      station.seen_utime = hostNow();
      return sendForged(kOperator, station);
    }
  }
}

}  // namespace tread::testing

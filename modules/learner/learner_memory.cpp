// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/learner_memory.hpp"

#include "modules/learner/learner_node.hpp"

#include <algorithm>
#include <sstream>

#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"
#include "modules/learner/core/state_text.hpp"

namespace tread::learner {
namespace {

constexpr const char* kSlots[2] = {"learner_state_1", "learner_state_2"};
constexpr const char* kVersions = "learner_versions";
/// Versions reserved at a time, and number left at which the next are reserved.
constexpr int64_t kReserve = 100 * Learner::kVersions;
constexpr int64_t kReserveLeft = 50 * Learner::kVersions;
/// Added to a state's version if its reserve is lost.
constexpr int64_t kWithoutReserve = 1000 * Learner::kVersions;
/// Robot time per version if no file exists [us].
constexpr int64_t kTimePerVersionUs = 20'000;

void append(std::string& problem, const std::string& another) {
  problem += (problem.empty() ? "" : "; ") + another;
}

/// Bytes per step of 20 ms; the rest of LCM's 100 kB is left to LEARNING and HEALTH.
constexpr int kPortion = 60'000;
constexpr size_t kStateBytes = 50'000;
constexpr size_t kWaitingStates = 2;

}  // namespace

std::optional<int64_t> LearnerMemory::storedReserve(std::string& problem) const {
  const auto content = store_.read(kVersions);
  if (!content) return std::nullopt;
  std::istringstream in(*content);
  int64_t reserve = 0;
  // The whole entry must be the number: a truncated one would be lower.
  const bool whole = (in >> reserve) && (in >> std::ws).eof();
  if (whole && reserve >= 1 && reserve <= PatternSet::kHighestVersion) return reserve;
  append(problem, std::string(kVersions) + " is damaged: versions go on far above");
  return std::nullopt;
}

StoredLearning LearnerMemory::recall(const PatternSet& shipped, int64_t utime) {
  StoredLearning found;
  for (int slot = 0; slot < 2; ++slot) {
    const auto content = store_.read(kSlots[slot]);
    if (!content) continue;
    std::string why;
    auto state = parseState(*content, shipped, why);
    if (!state) {
      append(found.problem, std::string(kSlots[slot]) + " " + why);
      continue;
    }
    if (found.state && found.state->set.version() >= state->set.version()) continue;
    found.state = std::move(state);
    next_slot_ = 1 - slot;
  }
  if (!found.problem.empty())
    found.problem += found.state
                         ? ": going on from version " + std::to_string(found.state->set.version())
                         : ": starting from the shipped set";
  const auto reserve = storedReserve(found.problem);
  const int64_t known = std::max(shipped.version(), found.state ? found.state->set.version() : 0);
  if (reserve) {
    found.first_version = std::max(*reserve, known) + 1;
  } else if (found.state) {
    found.first_version = std::max(known + kWithoutReserve, utime / kTimePerVersionUs);
  } else {
    found.first_version = std::max(shipped.version(), utime / kTimePerVersionUs);
  }
  return found;
}

std::optional<std::string> LearnerMemory::reserve(int64_t version) {
  if (version + kReserveLeft <= reserved_) return std::nullopt;
  const int64_t reserve = version + kReserve;
  auto problem = store_.write(kVersions, std::to_string(reserve) + "\n");
  if (!problem) reserved_ = reserve;
  return problem;
}

std::optional<std::string> LearnerMemory::save(const std::string& state_text) {
  auto problem = store_.write(kSlots[next_slot_], state_text);
  if (!problem) next_slot_ = 1 - next_slot_;
  return problem;
}

void SetPublisher::putSet(const PatternSet& set) {
  const auto parts = toMessages(replacement_ ? replacement_(set) : set);
  sets_.assign(parts.begin(), parts.end());
}

void SetPublisher::putState(const PatternSet& set, const std::string& rule,
                            const std::string& text) {
  const auto last_parts = std::count_if(states_.begin(), states_.end(), [](const auto& part) {
    return part.state_part + 1 == part.state_part_count;
  });
  if (static_cast<size_t>(last_parts) >= kWaitingStates) states_.clear();
  const auto count = static_cast<int32_t>((text.size() + kStateBytes - 1) / kStateBytes);
  for (int32_t part = 0; part < count; ++part) {
    auto message = blank<learner_state_t>();
    message.state_version = set.version();
    message.state_part = part;
    message.state_part_count = count;
    message.rule_name = rule;
    const std::string piece = text.substr(static_cast<size_t>(part) * kStateBytes, kStateBytes);
    message.num_bytes = static_cast<int32_t>(piece.size());
    message.state_bytes.assign(piece.begin(), piece.end());
    states_.push_back(std::move(message));
  }
}

void SetPublisher::step(int64_t utime, bool with_sets) {
  int left = kPortion;
  const auto send = [&](const auto& channel, auto& waiting, int64_t& seq) {
    while (!waiting.empty()) {
      const int size = waiting.front().getEncodedSize();
      if (size > left && left < kPortion) return;
      waiting.front().seq = seq++;
      bus_.publish(channel, waiting.front());
      waiting.pop_front();
      left -= size;
    }
  };
  if (with_sets) send(kPatternSet, sets_, seq_set_);
  if (with_sets && !sets_.empty()) return;
  for (learner_state_t& state : states_) state.utime = utime;
  send(kLearnerState, states_, seq_state_);
}

}  // namespace tread::learner

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/drive_reader.hpp"

#include <unordered_map>
#include <utility>

#include "common/report/text.hpp"

namespace tread {
namespace {

/// What is known of a channel's messages without decoding them: each begins with its type's
/// fingerprint and its utime.
struct Heading {
  int64_t fingerprint = 0;
  /// Published by one process, with the time of sending or of a fresh measurement; not PROGRAM: a
  /// planner that has just started does not know the time
  bool is_stamp = false;
  bool (*decodes)(const LogEvent&) = nullptr;  ///< null: too large to try
};

constexpr size_t kHeadingSize = 16;  // [bytes]

template <class Message>
Heading headingOf(const Channel<Message>& channel, bool is_stamp) {
  constexpr int kLarge = 2000;  // [bytes]
  Heading heading{Message::getHash(), is_stamp, nullptr};
  if (channel.max_bytes > kLarge) return heading;
  heading.decodes = [](const LogEvent& event) {
    Message message{};
    const auto size = static_cast<int>(event.bytes.size());
    try {
      return message.decode(event.bytes.data(), 0, size) == size;
    } catch (const std::exception&) {
      return false;
    }
  };
  return heading;
}

using Headings = std::unordered_map<std::string, Heading>;

const Headings& headings() {
  static const Headings all = [] {
    Headings table;
    const auto add = [&](bool is_stamp, const auto&... channels) {
      (table.emplace(channels.name, headingOf(channels, is_stamp)), ...);
    };
    add(true, kIns, kMotor, kExecution);
    add(false, kScanMatching, kScan, kMap, kGoal, kPlan, kPlanTree, kProgram, kPatternSet,
        kLearnerState, kLearning, kShock, kGrip, kHealth, kArm, kOperator, kManual, kEstop,
        kStoppingTime, kFence, kFences, kMark, kConfig);
    return table;
  }();
  return all;
}

int64_t numberAt(const LogEvent& event, size_t at) {
  uint64_t value = 0;
  for (size_t i = 0; i < 8; ++i) value = value << 8 | event.bytes[at + i];
  return static_cast<int64_t>(value);
}

std::string countedOn(const std::map<std::string, int64_t>& counts) {
  std::vector<std::string> words;
  for (const auto& [channel, count] : counts)
    words.push_back(std::to_string(count) + " on " + channel);
  return joined(words);
}

}  // namespace

DriveReader::DriveReader(std::vector<std::string> files) : paths_(std::move(files)) {}
DriveReader::DriveReader(std::vector<LogEvent> events) : memory_(std::move(events)) {}

bool DriveReader::next(DriveEvent& event) {
  while (!ended_ && pending_.empty()) {
    if (!readOn(event)) break;
    if (date(event)) return true;
    // Its time is uncertain until more events are read.
    pending_.push_back(std::move(event));
    event = {};
  }
  while (!pending_.empty()) {
    if (date(pending_.front())) {
      event = std::move(pending_.front());
      pending_.pop_front();
      return true;
    }
    DriveEvent next;
    if (readOn(next)) pending_.push_back(std::move(next));
  }
  return false;
}

/// Assigns a time to the first event without one, if it is known.
bool DriveReader::date(DriveEvent& event) {
  const auto dated = clock_.next();
  if (!dated) return false;
  event.utime = dated->utime;
  event.wrong_time = dated->wrong;
  event.restarts = dated->restarts;
  if (dated->wrong) ++wrong_times_[event.channel];
  return true;
}

/// Reads the next event and passes its times to the clock.
bool DriveReader::readOn(DriveEvent& event) {
  if (!read(event)) {
    ended_ = true;
    clock_.close();
    return false;
  }
  event.recorded = event.utime;
  clock_.add(event.recorded, stampOf(event));
  return true;
}

/// The robot's time in a stamp; counts messages that cannot be read.
std::optional<int64_t> DriveReader::stampOf(const LogEvent& event) {
  const auto found = headings().find(event.channel);
  if (found == headings().end()) return std::nullopt;
  const Heading& heading = found->second;
  const bool is_type = event.bytes.size() >= kHeadingSize &&
                       numberAt(event, 0) == heading.fingerprint &&
                       (heading.decodes == nullptr || heading.decodes(event));
  if (!is_type) {
    ++undecodable_[event.channel];
    return std::nullopt;
  }
  const int64_t utime = numberAt(event, 8);
  if (!isPossibleTime(utime)) ++impossible_[event.channel];
  return heading.is_stamp ? std::optional(utime) : std::nullopt;
}

bool DriveReader::read(DriveEvent& event) {
  if (!paths_.empty()) return readFiles(event);
  if (next_in_memory_ == memory_.size()) return false;
  static_cast<LogEvent&>(event) = std::move(memory_[next_in_memory_++]);
  return true;
}

bool DriveReader::readFiles(DriveEvent& event) {
  for (;;) {
    if (!files_.empty()) {
      event.file = static_cast<uint32_t>(files_.size() - 1);
      event.position = files_.back()->position();
      if (files_.back()->next(event)) return true;
      if (damage_.empty()) damage_ = files_.back()->problem();
    }
    if (files_.size() == paths_.size()) return false;
    files_.push_back(std::make_unique<LogReader>(paths_[files_.size()]));
  }
}

bool DriveReader::again(const EventPlace& place, LogEvent& event) {
  LogReader& file = *files_.at(place.file);
  file.seek(place.position);
  if (!file.next(event)) return false;
  event.utime = place.utime;
  return true;
}

std::vector<std::string> DriveReader::notes() const {
  std::vector<std::string> lines = clock_.notes();
  if (!wrong_times_.empty())
    lines.push_back("events with a time that cannot be, placed between their neighbours: " +
                    countedOn(wrong_times_));
  if (!impossible_.empty())
    lines.push_back("messages with a utime that cannot be (nanoseconds?), left out: " +
                    countedOn(impossible_));
  if (!undecodable_.empty())
    lines.push_back("messages that are broken or of another type, left out: " +
                    countedOn(undecodable_));
  return lines;
}

std::string DriveReader::problem() const {
  std::string line = damage_;
  for (const std::string& note : notes()) line += (line.empty() ? "" : "; ") + note;
  return line;
}

std::vector<LogEvent> readEvents(const std::vector<std::string>& paths, std::string& problem,
                                 const std::function<bool(const LogEvent&)>& keep) {
  std::vector<LogEvent> events;
  DriveReader reader(paths);
  for (DriveEvent event; reader.next(event);)
    if (keep(event)) events.push_back(std::move(event));
  problem = reader.problem();
  return events;
}

}  // namespace tread

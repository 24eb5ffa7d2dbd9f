// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <optional>

#include "tools/gap/log_checks.hpp"

namespace tread::gap {
namespace {

constexpr size_t kFewClashes = 5;
constexpr size_t kRepeated = 20;          // the same message so many times: its publisher hangs
constexpr int64_t kOvertaking = 200'000;  // [us] by which messages may come out of order

bool sameMessage(const Stamp& a, const Stamp& b) {
  return a.seq == b.seq && a.utime == b.utime;
}

/// How often seq does not grow although the message is another one.
size_t seqFallsBack(const std::vector<Stamp>& stamps) {
  size_t count = 0;
  bool counts = false;
  for (size_t i = 1; i < stamps.size(); ++i) {
    counts = counts || stamps[i].seq != stamps[0].seq;
    if (stamps[i].seq <= stamps[i - 1].seq && !sameMessage(stamps[i], stamps[i - 1])) ++count;
  }
  return counts ? count : 0;
}

bool bootsAlternate(std::vector<int64_t> boots) {
  std::sort(boots.begin(), boots.end());
  return std::adjacent_find(boots.begin(), boots.end()) != boots.end();
}

/// One publisher whose clock went back: in the order of their numbers, which have no gap, the
/// messages go back in time once or twice. The number of the message before that, or none.
std::optional<Stamp> clockWentBack(std::vector<Stamp> stamps) {
  std::stable_sort(stamps.begin(), stamps.end(),
                   [](const Stamp& a, const Stamp& b) { return a.seq < b.seq; });
  std::optional<Stamp> place;
  size_t times = 0;
  for (size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i].utime >= stamps[i - 1].utime - kOvertaking) continue;
    if (!isNext(stamps[i].seq, stamps[i - 1].seq) || ++times > 2) return std::nullopt;
    if (!place) place = stamps[i - 1];
  }
  return place;
}

void checkRepeated(const std::string& channel, const std::vector<Stamp>& stamps,
                   const LogMessages& messages, NoteBook& notes) {
  size_t run = 1;
  for (size_t i = 1; i < stamps.size(); ++i) {
    run = sameMessage(stamps[i], stamps[i - 1]) ? run + 1 : 1;
    if (run == kRepeated)
      return notes.fatal("the " + channel + " is frozen: one message of " +
                         digits(messages.seconds(stamps[i].utime)) + " s comes again and again");
  }
}

void checkChannel(const std::string& channel, const std::vector<Stamp>& stamps, size_t clashes,
                  const LogMessages& messages, NoteBook& notes) {
  checkRepeated(channel, stamps, messages, notes);
  const size_t falls = seqFallsBack(stamps);
  if (std::max(falls, clashes) < std::max(kFewClashes, stamps.size() / 100)) {
    if (falls > 0)
      notes.note(channel + "'s publisher was started again " + std::to_string(falls) +
                 " times, or messages came out of order");
    return;
  }
  if (const auto place = clockWentBack(stamps))
    return notes.fatal("clock jump: " + channel + " goes back at " +
                       digits(messages.seconds(place->utime)) +
                       " s, and its messages of both times are mixed; cut the log there");
  notes.fatal("two robots in one log: " + channel + " has two publishers (its seq falls back " +
              std::to_string(falls) + " times, " + std::to_string(clashes) +
              " messages contradict another one of the same time); record one robot");
}

}  // namespace

void checkPublishers(const LogMessages& messages, NoteBook& notes) {
  checkChannel("MOTOR", messages.motor_stamps, messages.motor_clashes, messages, notes);
  checkChannel("INS", messages.ins_stamps, messages.ins_clashes, messages, notes);
  for (const auto& [process, boots] : messages.boots)
    if (bootsAlternate(boots))
      return notes.fatal("two robots in one log: CONFIG of " + process +
                         " alternates between two boots; record one robot");
}

}  // namespace tread::gap

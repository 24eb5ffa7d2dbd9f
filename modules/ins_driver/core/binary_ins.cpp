// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/binary_ins.hpp"

namespace tread::ins {

void BinaryIns::push(std::string_view bytes, int64_t arrival) {
  arrival_ = arrival;
  pipeline_.collector().noteBytes(arrival);
  framer_.push(bytes, arrival);
  readFrames();
}

void BinaryIns::readFrames() {
  while (const auto frame = framer_.next()) {
    ++frames_;
    last_frame_ = arrival_;
    const Reading reading = read(frame->bytes, frame->arrival);
    if (reading.refusal[0] == '\0') {
      ++decoded_[reading.name];
    } else {
      ++unused_[reading.name + ": " + reading.refusal];
    }
  }
}

void BinaryIns::interrupt() {
  framer_.interrupt();
  readFrames();
  pipeline_.collector().finish();
}

ReasonCounts BinaryIns::reasons() const {
  ReasonCounts all = framer_.refusals();
  for (const auto& [reason, count] : unused_) all[reason] += count;
  return all;
}

InsTally BinaryIns::tally() const {
  return {framer_.bytes(), framer_.strayBytes(), frames_, decoded_, reasons()};
}

NamedCounts BinaryIns::counters() const {
  NamedCounts all{
      {"bytes", framer_.bytes()}, {"stray bytes", framer_.strayBytes()}, {"messages", frames_}};
  for (const auto& [name, count] : decoded_) all.emplace_back(name, count);
  for (const auto& [reason, count] : reasons()) all.emplace_back("refused: " + reason, count);
  pipeline_.addCounters(all);
  return all;
}

}  // namespace tread::ins

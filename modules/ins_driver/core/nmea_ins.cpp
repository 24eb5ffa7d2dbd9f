// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/nmea_ins.hpp"

#include "modules/ins_driver/core/nmea_parser.hpp"

namespace tread::ins {
namespace {

/// True if the device left out, or marked as invalid, everything that the sentence is there for.
bool isEmpty(const NmeaSentence& sentence) {
  struct Visitor {
    bool operator()(const Gga& s) const { return !s.position; }
    bool operator()(const Rmc& s) const { return !s.position && !s.speed; }
    bool operator()(const Vtg& s) const { return !s.speed; }
    bool operator()(const Hdt& s) const { return !s.yaw; }
    bool operator()(const Pashr& s) const { return !s.yaw && !s.roll && !s.pitch; }
    bool operator()(const Rot& s) const { return !s.yaw_rate; }
    bool operator()(const Zda& s) const { return !s.date; }
  };
  return std::visit(Visitor{}, sentence);
}

}  // namespace

void NmeaIns::push(std::string_view bytes, int64_t arrival) {
  arrival_ = arrival;
  collector_.noteBytes(arrival);
  counts_.bytes += static_cast<int64_t>(bytes.size());
  for (const char byte : bytes) {
    const std::optional<std::string_view> body = framer_.push(byte);
    if (framer_.justStarted()) sentence_start_ = arrival;
    if (body) take(*body);
  }
}

void NmeaIns::take(std::string_view body) {
  const ParseResult result = parseNmea(body);
  if (const auto* reason = std::get_if<Refusal>(&result)) {
    counts_.refused.add(*reason);
    // Even a sentence that we do not know shows that the device is alive.
    last_sentence_ = arrival_;
    return;
  }
  const NmeaSentence& sentence = std::get<NmeaSentence>(result);
  last_sentence_ = arrival_;
  if (!collector_.push(sentence, sentence_start_)) {
    counts_.refused.add(Refusal::kLate);
    return;
  }
  ++counts_.decoded;
  ++counts_.of_type[sentence.index()];
  if (isEmpty(sentence)) ++counts_.empty[sentence.index()];
}

void NmeaIns::observePending() {
  while (observed_ < pending_.size()) {
    if (observed_ > 0 && pending_[observed_].clock_was_set) return;
    assembler_.observe(pending_[observed_++]);
  }
}

std::optional<InsEstimate> NmeaIns::next(int64_t now) {
  while (std::optional<Epoch> epoch = collector_.next(now)) pending_.push_back(*epoch);
  while (!pending_.empty()) {
    observePending();
    std::optional<InsEstimate> estimate = assembler_.solve(pending_.front());
    pending_.pop_front();
    --observed_;
    if (estimate) return estimate;
  }
  return std::nullopt;
}

void NmeaIns::interrupt() {
  framer_.interrupt();
  collector_.finish();
}

NmeaCounts NmeaIns::counts() const {
  NmeaCounts counts = counts_;
  counts.sentences = framer_.sentences();
  counts.stray_bytes = framer_.strayBytes();
  for (size_t i = 0; i < kRefusalCount; ++i) counts.refused.of[i] += framer_.refusals().of[i];
  return counts;
}

}  // namespace tread::ins

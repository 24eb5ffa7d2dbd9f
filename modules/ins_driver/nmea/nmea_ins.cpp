// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_ins.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "modules/ins_driver/nmea/nmea_epoch.hpp"

namespace tread::ins {
namespace {

/// Whether the device left empty, or marked as invalid, everything that the sentence is for.
bool isEmpty(const NmeaSentence& sentence) {
  struct Visitor {
    bool operator()(const Gga& s) const { return !s.position; }
    bool operator()(const Rmc& s) const { return !s.position && !s.speed; }
    bool operator()(const Vtg& s) const { return !s.speed; }
    bool operator()(const Hdt& s) const { return !s.yaw; }
    bool operator()(const Pashr& s) const { return !s.yaw && !s.roll && !s.pitch; }
    bool operator()(const Rot& s) const { return !s.yaw_rate; }
    bool operator()(const Zda& s) const { return !s.date; }
    bool operator()(const Ths& s) const { return !s.yaw; }
  };
  return std::visit(Visitor{}, sentence);
}

}  // namespace

void NmeaIns::push(std::string_view bytes, int64_t arrival) {
  arrival_ = arrival;
  pipeline_.collector().noteBytes(arrival);
  counts_.bytes += static_cast<int64_t>(bytes.size());
  for (const char byte : bytes) {
    const std::optional<std::string_view> body = framer_.push(byte);
    if (framer_.justStarted()) sentence_start_ = arrival;
    if (body) take(*body);
  }
}

void NmeaIns::refuse(std::string_view type, SentenceRefusal reason) {
  counts_.refused.add(reason);
  const std::string words = name(reason);
  ++counts_.reasons[type.empty() ? words : std::string(type) + ": " + words];
}

void NmeaIns::take(std::string_view body) {
  const ParseResult result = parseNmea(body);
  // Even an unknown sentence shows that the device is alive.
  last_sentence_ = arrival_;
  if (const auto* reason = std::get_if<SentenceRefusal>(&result)) {
    refuse(typeOf(body), *reason);
    return;
  }
  const NmeaSentence& sentence = std::get<NmeaSentence>(result);
  if (!collect(sentence)) {
    refuse(typeOf(body), SentenceRefusal::kLate);
    return;
  }
  ++counts_.decoded;
  ++counts_.of_type[sentence.index()];
  if (isEmpty(sentence)) ++counts_.empty[sentence.index()];
}

bool NmeaIns::collect(const NmeaSentence& sentence) {
  EpochCollector& collector = pipeline_.collector();
  if (const auto* zda = std::get_if<Zda>(&sentence)) {
    if (zda->date && zda->time_of_day) {
      const int64_t utc = daysSinceEpoch(*zda->date) * kDayUs + *zda->time_of_day;
      collector.pushDate(utc, *zda->time_of_day, sentence.index());
    }
    return true;
  }
  return collector.push(partOf(sentence, config_), sentence.index(), timeOfDay(sentence),
                        sentence_start_);
}

void NmeaIns::interrupt() {
  framer_.interrupt();
  pipeline_.collector().finish();
}

NmeaCounts NmeaIns::counts() const {
  NmeaCounts counts = counts_;
  counts.sentences = framer_.sentences();
  counts.stray_bytes = framer_.strayBytes();
  for (size_t i = 0; i < kRefusalCount; ++i) {
    const int64_t cut_out = framer_.refusals().of[i];
    counts.refused.of[i] += cut_out;
    if (cut_out > 0) counts.reasons[name(static_cast<SentenceRefusal>(i))] += cut_out;
  }
  return counts;
}

InsTally NmeaIns::tally() const {
  const NmeaCounts line = counts();
  InsTally tally{line.bytes, line.stray_bytes, line.sentences, {}, line.reasons};
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (line.of_type[i] > 0) tally.decoded[kSentenceNames[i]] = line.of_type[i];
  }
  return tally;
}

/// Sentences that should contain a heading but do not are named: the device already sends them.
std::string NmeaIns::headingAdvice() const {
  std::string names;
  for (const auto& [sentence, when] : {std::pair("HDT", ""), std::pair("PASHR", ""),
                                       std::pair("THS", " (mode V, or an empty field)")}) {
    const auto* const found =
        std::find(std::begin(kSentenceNames), std::end(kSentenceNames), std::string_view(sentence));
    const auto i = static_cast<size_t>(found - std::begin(kSentenceNames));
    if (counts_.empty[i] > 0)
      names +=
          (names.empty() ? "" : ", ") + std::string(sentence) + " without a valid heading" + when;
  }
  if (names.empty()) return "does the device send HDT, THS or PASHR?";
  return "the device sends " + names +
         ": is it aligned, does it see enough satellites with both antennas?";
}

/// Other instruments' bytes are refused for other reasons.
std::string NmeaIns::checksumAdvice() const {
  const SentenceRefusals& refusals = framer_.refusals();
  const int64_t without = refusals[SentenceRefusal::kNoChecksum];
  const int64_t wrong = refusals[SentenceRefusal::kWrongChecksum];
  if (2 * (without + wrong) <= framer_.sentences()) return "";
  return without > wrong
             ? "these are NMEA sentences without checksums (*hh): let the device send them"
             : "these are NMEA sentences with wrong checksums: let the device send right ones, and "
               "check the line";
}

InsAdvice NmeaIns::advice() const {
  return {"is the device powered and set to send NMEA?", "no good sentence",
          "does the device have a fix, and does it send GGA or RMC?", headingAdvice(),
          checksumAdvice()};
}

std::vector<std::pair<std::string, int64_t>> NmeaIns::counters() const {
  const NmeaCounts line = counts();
  std::vector<std::pair<std::string, int64_t>> all{{"bytes", line.bytes},
                                                   {"stray bytes", line.stray_bytes},
                                                   {"sentences", line.sentences},
                                                   {"decoded", line.decoded}};
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (line.of_type[i] > 0) all.emplace_back(kSentenceNames[i], line.of_type[i]);
    const std::string empty = std::string(kSentenceNames[i]) + " without a value";
    if (line.empty[i] > 0) all.emplace_back(empty, line.empty[i]);
  }
  for (const auto& [reason, count] : line.reasons) all.emplace_back("refused: " + reason, count);
  pipeline_.addCounters(all);
  return all;
}

}  // namespace tread::ins

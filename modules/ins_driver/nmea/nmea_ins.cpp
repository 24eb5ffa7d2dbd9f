// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_ins.hpp"

#include <cmath>
#include <iterator>
#include <sstream>

#include "modules/ins_driver/nmea/nmea_parser.hpp"

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

/// "cut short 3, wrong checksum 12".
std::string listed(const SentenceRefusals& refused) {
  std::ostringstream text;
  for (size_t i = 0; i < kRefusalCount; ++i) {
    if (refused.of[i] == 0) continue;
    text << (text.tellp() > 0 ? ", " : "") << name(static_cast<SentenceRefusal>(i)) << " "
         << refused.of[i];
  }
  return text.str();
}

void readTiming(ConfigReader& reader, InsConfig& ins) {
  reader.seconds("latency", ins.latency_us, {0.0, 1.0});
  reader.seconds("quiet", ins.quiet_us, {0.001, 0.2});
  reader.seconds("attitude_hold", ins.attitude_hold_us, {0.0, 0.5});
  reader.seconds("offset_window", ins.offset_window_us, {1.0, 600.0});
  double rate = 0.0;
  reader.number("rate", rate, {0.0, 200.0}, "Hz");
  ins.period_us = rate > 0.0 ? std::llround(1e6 / rate) : 0;
}

/// The sentence that ends each epoch; "none" where the order is not known.
void readLastType(ConfigReader& reader, InsConfig& ins) {
  std::string last = "none";
  std::vector<std::string> allowed{"none"};
  allowed.insert(allowed.end(), std::begin(kSentenceNames), std::end(kSentenceNames));
  reader.choice("last_sentence", last, allowed);
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (last == kSentenceNames[i]) ins.last_type = i;
  }
}

}  // namespace

InsConfig readNmeaConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins;
  ins.p_body_antenna = robot.ins.p_body;
  ins.body_device = robot.ins.angles;
  ins.max_speed = robot.max_speed;
  readTiming(reader, ins);
  readLastType(reader, ins);
  reader.number("standstill_speed", ins.standstill_speed, {0.0, 1.0}, "m/s");
  reader.number("jump_slack", ins.jump_slack, {0.01, 100.0}, "m");
  reader.flag("attitude_epochs", ins.attitude_epochs);
  reader.number("origin_max_hdop", ins.origin_max_hdop, {0.5, 100.0}, "1");
  reader.number("max_distance", ins.max_distance, {100.0, 100000.0}, "m");
  return ins;
}

std::function<std::unique_ptr<InsSource>(const std::optional<GeoOrigin>&)> nmeaSource(
    const InsConfig& config) {
  return [config](const std::optional<GeoOrigin>& origin) {
    InsConfig with_origin = config;
    if (origin) with_origin.origin = origin;
    return std::make_unique<NmeaIns>(with_origin);
  };
}

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
  if (const auto* reason = std::get_if<SentenceRefusal>(&result)) {
    counts_.refused.add(*reason);
    // Even a sentence that we do not know shows that the device is alive.
    last_sentence_ = arrival_;
    return;
  }
  const NmeaSentence& sentence = std::get<NmeaSentence>(result);
  last_sentence_ = arrival_;
  if (!collector_.push(sentence, sentence_start_)) {
    counts_.refused.add(SentenceRefusal::kLate);
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

std::string NmeaIns::refusals() const {
  const NmeaCounts line = counts();
  return "stray bytes " + std::to_string(line.stray_bytes) + ", refused: " + listed(line.refused);
}

InsAdvice NmeaIns::advice() const {
  return {"is the device powered and set to send NMEA?", "no good sentence",
          "does the device have a fix, and does it send GGA?",
          "does the device send HDT or PASHR?"};
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
  for (size_t i = 0; i < kRefusalCount; ++i) {
    const std::string refused = std::string("refused: ") + name(static_cast<SentenceRefusal>(i));
    if (line.refused.of[i] > 0) all.emplace_back(refused, line.refused.of[i]);
  }
  const AssemblerCounts& epochs = assembler_.counts();
  all.insert(all.end(), {{"epochs", epochs.epochs},
                         {"published", epochs.published},
                         {"gaps", epochs.gaps},
                         {"jumps", epochs.jumps},
                         {"device clock set", epochs.clock_steps},
                         {"refused: time not after the last", epochs.not_newer},
                         {"refused: far from the origin", epochs.too_far}});
  return all;
}

}  // namespace tread::ins

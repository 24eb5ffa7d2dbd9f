// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "modules/ins_driver/core/ins_pipeline.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/ins_driver/nmea/nmea_framer.hpp"

namespace tread::ins {

/// Totals of received sentences. Sentences = decoded + refused.
struct NmeaCounts {
  int64_t bytes = 0;
  int64_t stray_bytes = 0;  ///< in no sentence
  int64_t sentences = 0;    ///< starts seen
  int64_t decoded = 0;
  std::array<int64_t, kSentenceTypes> of_type{};  ///< decoded, in the order of kSentenceNames
  /// Of those: well-formed, but without a measurement
  std::array<int64_t, kSentenceTypes> empty{};
  SentenceRefusals refused;
  /// The same by sentence if its checksum was good ("GGA: field count"), otherwise by the bare
  /// reason.
  ReasonCounts reasons;
};

/// Converts the bytes of an NMEA 0183 device to estimates: framer, parser, epochs, assembler.
class NmeaIns : public PipelineIns {
 public:
  explicit NmeaIns(const InsConfig& config) : PipelineIns(config, kDayUs) {}

  void push(std::string_view bytes, int64_t arrival) override;
  void interrupt() override;
  std::optional<int64_t> lastMessage() const override { return last_sentence_; }
  InsTally tally() const override;
  InsAdvice advice() const override;
  std::vector<std::pair<std::string, int64_t>> counters() const override;

  NmeaCounts counts() const;

 private:
  void take(std::string_view body);
  bool collect(const NmeaSentence& sentence);
  void refuse(std::string_view type, SentenceRefusal reason);
  std::string headingAdvice() const;
  std::string checksumAdvice() const;

  NmeaFramer framer_;
  int64_t sentence_start_ = 0;
  int64_t arrival_ = 0;
  std::optional<int64_t> last_sentence_;
  NmeaCounts counts_;
};

}  // namespace tread::ins

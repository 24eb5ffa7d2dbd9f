// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string_view>

#include "modules/ins_driver/core/epoch_collector.hpp"
#include "modules/ins_driver/core/ins_assembler.hpp"
#include "modules/ins_driver/core/nmea_framer.hpp"

namespace tread::ins {

/// What came over the line. Sentences = decoded + refused.
struct NmeaCounts {
  int64_t bytes = 0;
  int64_t stray_bytes = 0;  ///< in no sentence
  int64_t sentences = 0;    ///< starts seen
  int64_t decoded = 0;
  std::array<int64_t, kSentenceTypes> of_type{};  ///< decoded, in the order of kSentenceNames
  std::array<int64_t, kSentenceTypes>
      empty{};  ///< of those: well-formed, but no measurement in them
  RefusalCounts refused;
};

/// From the bytes of an NMEA 0183 device to estimates: framer, parser, epochs, assembler.
/** Bytes in, with the time at which they were read; then next() until it has nothing. */
class NmeaIns {
 public:
  explicit NmeaIns(const InsConfig& config)
      : collector_(config.quiet_us, config.last_type), assembler_(config) {}

  /// Takes bytes that were read at `arrival` [us].
  void push(std::string_view bytes, int64_t arrival);
  /// The next finished estimate. `now` decides whether the line has been quiet [us].
  std::optional<InsEstimate> next(int64_t now);
  /// The link was closed or the log is at its end: what is under way ends here.
  void interrupt();

  NmeaCounts counts() const;
  const InsAssembler& assembler() const { return assembler_; }
  /// Host time of the last good sentence [us]; nothing before the first.
  const std::optional<int64_t>& lastSentence() const { return last_sentence_; }

 private:
  void take(std::string_view body);
  void observePending();

  NmeaFramer framer_;
  EpochCollector collector_;
  InsAssembler assembler_;
  std::deque<Epoch> pending_;
  size_t observed_ = 0;  ///< how many of them the assembler has observed
  int64_t sentence_start_ = 0;
  int64_t arrival_ = 0;
  std::optional<int64_t> last_sentence_;
  NmeaCounts counts_;
};

}  // namespace tread::ins

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "modules/ins_driver/core/binary_framer.hpp"
#include "modules/ins_driver/core/ins_pipeline.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Result of reading a frame.
struct Reading {
  std::string name;          ///< of the message, in its manufacturer's terms
  const char* refusal = "";  ///< why it was not used; empty if it was
};

/// Converts the bytes of a device with binary messages to estimates; devices differ in their
/// protocol.
class BinaryIns : public PipelineIns {
 public:
  void push(std::string_view bytes, int64_t arrival) override;
  void interrupt() override;
  std::optional<int64_t> lastMessage() const override { return last_frame_; }
  InsTally tally() const override;
  NamedCounts counters() const override;

  /// Decoded frames, by name.
  const std::map<std::string, int64_t>& decoded() const { return decoded_; }
  /// Refused bytes and unused messages, by reason.
  ReasonCounts reasons() const;
  const BinaryFramer& framer() const { return framer_; }
  int64_t frames() const { return frames_; }

 protected:
  BinaryIns(const InsConfig& config, LookForFrame look, int64_t cycle_us)
      : PipelineIns(config, cycle_us), framer_(look) {}

  /// Reads a frame with a good checksum and passes its content to the pipeline.
  virtual Reading read(std::string_view frame, int64_t arrival) = 0;

 private:
  void readFrames();

  BinaryFramer framer_;
  std::optional<int64_t> last_frame_;
  int64_t arrival_ = 0;
  int64_t frames_ = 0;
  std::map<std::string, int64_t> decoded_;
  ReasonCounts unused_;
};

}  // namespace tread::ins

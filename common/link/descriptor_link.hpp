// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <sys/types.h>

#include "common/link/link.hpp"

namespace tread {

/// Spaces attempts to open a link: 100 ms, doubling with each failure up to 1 s.
/** The first spacing also follows a success, so that a peer that accepts and hangs up at once is
 *  not called without end. */
class BackOff {
 public:
  /// Whether an attempt may be made now; if so, it counts as made.
  bool attempt(int64_t utime) {
    // A clock that went back belongs to another run: do not wait for it to come round.
    const bool waiting = last_ && utime >= *last_ && utime < *last_ + spacing_;
    if (!waiting) last_ = utime;
    return !waiting;
  }
  void failed() {
    if (failed_before_) spacing_ = std::min(2 * spacing_, kLongest);
    failed_before_ = true;
  }
  void succeeded() {
    spacing_ = kShortest;
    failed_before_ = false;
  }

 private:
  static constexpr int64_t kShortest = 100'000;   // [us]
  static constexpr int64_t kLongest = 1'000'000;  // [us]

  std::optional<int64_t> last_;
  int64_t spacing_ = kShortest;
  bool failed_before_ = false;
};

/// What links over a file descriptor have in common: reading, writing all or none, hanging up,
/// coming back.
class DescriptorLink : public Link {
 public:
  ~DescriptorLink() override;

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override;
  bool write(const uint8_t* bytes, size_t size) override;
  bool isOpen() const override { return fd_ >= 0; }
  bool reopen(int64_t utime) override;
  int descriptor() const override { return fd_; }
  const std::string& address() const override { return address_; }
  std::string problem() const override { return isOpen() ? std::string() : problem_; }

 protected:
  explicit DescriptorLink(std::string address) : address_(std::move(address)) {}

  /// Opens the device without blocking and returns its descriptor, or -1 and the reason.
  virtual int openDevice(std::string& reason) = 0;
  /// As ::read; 0 means that the line has ended.
  virtual ssize_t readSome(uint8_t* buffer, size_t capacity);
  /// As ::write.
  virtual ssize_t writeSome(const uint8_t* bytes, size_t size);
  /// Takes what is queued for sending off the line, just before it is closed for a failure.
  virtual void dropQueued() {}

  /// One attempt to open; the constructors of the kinds make the first.
  bool attempt();
  /// The line is up with this descriptor.
  void adopt(int fd);
  /// The line is down for this reason.
  void hangUp(const std::string& reason);
  /// The line is still down, for this reason.
  void noteProblem(const std::string& reason);

 private:
  bool writeRest(const uint8_t* bytes, size_t size);

  std::string address_;
  std::string problem_;
  BackOff back_off_;
  int fd_ = -1;
};

/// The system's words for an errno value.
std::string systemReason(int error);

}  // namespace tread

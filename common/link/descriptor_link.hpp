// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <sys/types.h>
#include <termios.h>

#include "common/link/link.hpp"

namespace tread {

/// Reason while another program uses the device.
inline constexpr const char* kInUse = "in use by another program";
/// Reason while it listens without a peer.
inline constexpr const char* kNobody = "nobody has connected";

/// Spaces attempts to open a link: 100 ms, doubling with each failure up to 1 s.
/** The first spacing also applies after a success, so that a peer that accepts and hangs up at once
 * is not called endlessly. */
class BackOff {
 public:
  /// Whether an attempt may be made now; if so, it counts as made.
  bool attempt(int64_t utime) {
    // A clock that went back belongs to another run: do not wait for it to catch up.
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

/// Common part of links over a file descriptor: reading, writing all or none, hanging up,
/// reopening.
class DescriptorLink : public Link {
 public:
  ~DescriptorLink() override;

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override;
  bool write(const uint8_t* bytes, size_t size) override;
  bool isOpen() const override { return fd_ >= 0; }
  bool reopen(int64_t utime) override;
  void close() override;
  int descriptor() const override { return fd_; }
  const std::string& address() const override { return address_; }
  std::string problem() const override { return isOpen() ? std::string() : problem_; }

 protected:
  explicit DescriptorLink(std::string address) : address_(std::move(address)) {}

  /// Opens the device without blocking and returns its descriptor, or -1 and the reason.
  virtual int openDevice(std::string& reason) = 0;
  /// As ::read; 0 means that the line was closed.
  virtual ssize_t readSome(uint8_t* buffer, size_t capacity);
  /// As ::write.
  virtual ssize_t writeSome(const uint8_t* bytes, size_t size);
  /// Discards bytes queued for sending, just before the line is closed for a failure.
  virtual void dropQueued() {}

  /// One attempt to open; the derived constructors make the first.
  bool attempt();
  /// The line is open with this descriptor.
  void adopt(int fd);
  /// Closes the line for this reason.
  void hangUp(const std::string& reason);
  /// The line stays closed, for this reason.
  void noteProblem(const std::string& reason);

 private:
  bool writeRest(const uint8_t* bytes, size_t size);

  std::string address_;
  std::string problem_;
  BackOff back_off_;
  int fd_ = -1;
};

/// The system's message for an errno value.
std::string systemReason(int error);

/// Reads a file once, from start to end, and then stays closed. It never writes.
std::unique_ptr<Link> makeFileLink(const LinkAddress& address);

/// The termios constant of a baud rate [1/s]; nullopt if serial lines do not support it.
inline std::optional<speed_t> speedOf(int baud) {
  static constexpr std::pair<int, speed_t> kRates[] = {
      {1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},
      {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
      {230400, B230400},   {460800, B460800},   {500000, B500000},   {921600, B921600},
      {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000}, {3000000, B3000000},
      {4000000, B4000000}};
  for (const auto& [rate, speed] : kRates)
    if (rate == baud) return speed;
  return std::nullopt;
}

}  // namespace tread

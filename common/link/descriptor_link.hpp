// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>

#include "common/link/back_off.hpp"
#include "common/link/link.hpp"

namespace tread {

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

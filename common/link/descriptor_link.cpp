// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/descriptor_link.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>

namespace tread {
namespace {

/// How long the rest of a partly written command may wait for room.
constexpr std::chrono::milliseconds kWriteDeadline{20};

bool isBusy(int error) {
  return error == EAGAIN || error == EWOULDBLOCK;
}

/// Poll events of a descriptor within a time; 0 at its end.
short pollFor(int fd, short events, int timeout_ms) {
  pollfd entry{fd, events, 0};
  return ::poll(&entry, 1, timeout_ms) > 0 ? entry.revents : static_cast<short>(0);
}

}  // namespace

std::string systemReason(int error) {
  return std::generic_category().message(error);
}

DescriptorLink::~DescriptorLink() {
  if (fd_ >= 0) ::close(fd_);
}

ssize_t DescriptorLink::readSome(uint8_t* buffer, size_t capacity) {
  return ::read(fd_, buffer, capacity);
}

ssize_t DescriptorLink::writeSome(const uint8_t* bytes, size_t size) {
  return ::write(fd_, bytes, size);
}

std::optional<size_t> DescriptorLink::read(uint8_t* buffer, size_t capacity) {
  if (!isOpen()) return std::nullopt;
  if (capacity == 0) return 0;
  ssize_t count = 0;
  do {
    count = readSome(buffer, capacity);
  } while (count < 0 && errno == EINTR);
  if (count > 0) return static_cast<size_t>(count);
  // A zero read, EIO and POLLHUP all mean that a device is gone.
  const bool busy = count < 0 && isBusy(errno);
  if (busy && (pollFor(fd_, POLLIN, 0) & (POLLHUP | POLLERR | POLLNVAL)) == 0) return 0;
  hangUp(count < 0 && !busy ? systemReason(errno) : "the other end hung up");
  return std::nullopt;
}

bool DescriptorLink::write(const uint8_t* bytes, size_t size) {
  if (!isOpen()) return false;
  if (size == 0) return true;
  ssize_t count = 0;
  do {
    count = writeSome(bytes, size);
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    // A full line drops this command: it would be stale by the time there is room.
    if (!isBusy(errno)) hangUp(systemReason(errno));
    return false;
  }
  const auto taken = static_cast<size_t>(count);
  return taken == size || writeRest(bytes + taken, size - taken);
}

bool DescriptorLink::writeRest(const uint8_t* bytes, size_t size) {
  const auto deadline = std::chrono::steady_clock::now() + kWriteDeadline;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) break;
    pollFor(fd_, POLLOUT, static_cast<int>(left.count()));
    const ssize_t count = writeSome(bytes, size);
    if (count < 0 && !isBusy(errno) && errno != EINTR) {
      hangUp(systemReason(errno));
      return false;
    }
    if (count <= 0) continue;
    bytes += count;
    size -= static_cast<size_t>(count);
    if (size == 0) return true;
  }
  // Half a command is in transit and cannot be recalled. The next command would be appended to it
  // and could mean anything, so the line is closed and the queued rest discarded. The device's
  // start-up after reopening must begin with an end of line, to terminate the half that it may have
  // received.
  hangUp("the line took only part of a command and had no room for the rest");
  return false;
}

bool DescriptorLink::reopen(int64_t utime) {
  if (isOpen()) return true;
  if (!back_off_.attempt(utime)) return false;
  if (attempt()) return true;
  back_off_.failed();
  return false;
}

void DescriptorLink::close() {
  if (!isOpen()) return;
  ::close(fd_);
  fd_ = -1;
  problem_.clear();
}

bool DescriptorLink::attempt() {
  std::string reason;
  const int fd = openDevice(reason);
  if (fd < 0) {
    noteProblem(reason);
    return false;
  }
  adopt(fd);
  return true;
}

void DescriptorLink::adopt(int fd) {
  fd_ = fd;
  problem_.clear();
  back_off_.succeeded();
}

void DescriptorLink::hangUp(const std::string& reason) {
  dropQueued();
  ::close(fd_);
  fd_ = -1;
  noteProblem(reason);
}

void DescriptorLink::noteProblem(const std::string& reason) {
  problem_ = address_ + ": " + reason;
}

}  // namespace tread

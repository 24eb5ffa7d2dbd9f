// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/life_sign.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace tread {
namespace {

constexpr int64_t kPeriod = 250'000;  // [us]

/// A socket's address as the system calls need it, with its size.
struct Address {
  explicit Address(const std::string& place) {
    parts.sun_family = AF_UNIX;
    std::copy(place.begin(), place.end(), parts.sun_path);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + place.size());
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&parts); }

  sockaddr_un parts{};
  socklen_t size;
};

bool fits(const std::string& place) {
  return place.size() < sizeof sockaddr_un::sun_path;
}

}  // namespace

LifeSign::LifeSign() {
  const char* const place = std::getenv("NOTIFY_SOCKET");
  if (place == nullptr || (*place != '/' && *place != '@')) return;
  place_ = place;
  if (!fits(place_)) return;
  if (place_.front() == '@') place_.front() = '\0';  // no file: Linux's abstract names
  descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
}

LifeSign::~LifeSign() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool LifeSign::send(const std::string& lines) const {
  if (descriptor_ < 0) return true;
  const Address address(place_);
  return sendto(descriptor_, lines.data(), lines.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address.get(),
                address.size) >= 0;
}

void LifeSign::beat(int64_t host) {
  if (host < next_) return;
  next_ = host + kPeriod;
  // A full queue accepts nothing: READY=1 must arrive once, the others are repeated anyway.
  ready_ |= send(ready_ ? "WATCHDOG=1" : "READY=1\nWATCHDOG=1");
}

void LifeSign::tell(const std::string& line) {
  if (line == told_) return;
  std::string status = "STATUS=" + line;
  std::replace(status.begin(), status.end(), '\n', ' ');
  if (send(status)) told_ = line;
}

LifeSignListener::LifeSignListener(std::string path)
    : path_(std::move(path)), descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  unlink(path_.c_str());  // of a listener that was killed
  const int on = 1;
  if (!fits(path_) || setsockopt(descriptor_, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) != 0 ||
      bind(descriptor_, Address(path_).get(), Address(path_).size) != 0 ||
      chmod(path_.c_str(), 0600) != 0) {
    close(descriptor_);
    throw std::runtime_error(path_ + ": no socket can be made there");
  }
}

LifeSignListener::~LifeSignListener() {
  close(descriptor_);
  unlink(path_.c_str());
}

std::optional<LifeSignListener::Word> LifeSignListener::take() {
  char text[4096];
  alignas(cmsghdr) char credentials[CMSG_SPACE(sizeof(ucred))];
  iovec piece{text, sizeof text};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = credentials;
  message.msg_controllen = sizeof credentials;
  const ssize_t size = recvmsg(descriptor_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  const cmsghdr* const header = CMSG_FIRSTHDR(&message);
  if (size < 0 || header == nullptr || header->cmsg_type != SCM_CREDENTIALS) return std::nullopt;
  const auto* const sender = reinterpret_cast<const ucred*>(CMSG_DATA(header));
  return Word{sender->pid, std::string(text, static_cast<size_t>(size))};
}

}  // namespace tread

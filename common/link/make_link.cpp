// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cerrno>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/link/descriptor_link.hpp"
#include "common/link/kinds.hpp"

namespace tread {
namespace {

class FileLink final : public DescriptorLink {
 public:
  explicit FileLink(const LinkAddress& address)
      : DescriptorLink(address.text), path_(address.path) {
    attempt();
  }

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override {
    if (!isOpen() || capacity == 0) return DescriptorLink::read(buffer, capacity);
    const ssize_t count = readSome(buffer, capacity);
    if (count > 0) return static_cast<size_t>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    ended_ = true;
    hangUp(count == 0 ? "the file is at its end" : systemReason(errno));
    return std::nullopt;
  }
  bool write(const uint8_t* /*bytes*/, size_t /*size*/) override { return false; }
  /// A file that was read to its end does not begin again: a recording is played once.
  bool reopen(int64_t utime) override { return !ended_ && DescriptorLink::reopen(utime); }

 private:
  int openDevice(std::string& reason) override {
    const int fd = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    struct stat entry {};
    if (fd < 0) {
      reason = systemReason(errno);
    } else if (::fstat(fd, &entry) == 0 && S_ISDIR(entry.st_mode)) {
      reason = systemReason(EISDIR);
      ::close(fd);
      return -1;
    }
    return fd;
  }

  std::string path_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Link> makeFileLink(const LinkAddress& address) {
  return std::make_unique<FileLink>(address);
}

std::unique_ptr<Link> makeLink(const std::string& address) {
  const LinkAddress parsed = parseLinkAddress(address);
  switch (parsed.kind) {
    case LinkAddress::Kind::kTty:
      return makeTtyLink(parsed);
    case LinkAddress::Kind::kPty:
      return makePtyLink(parsed);
    case LinkAddress::Kind::kTcpServer:
      return makeTcpServerLink(parsed);
    case LinkAddress::Kind::kTcp:
      return makeTcpLink(parsed);
    case LinkAddress::Kind::kUdp:
      return makeUdpLink(parsed);
    case LinkAddress::Kind::kFile:
      return makeFileLink(parsed);
  }
  throw std::invalid_argument("link address \"" + address + "\": unknown kind");
}

}  // namespace tread

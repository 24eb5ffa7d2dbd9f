// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/make_link.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <deque>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/link/can_link.hpp"
#include "common/link/descriptor_link.hpp"
#include "common/link/serial_links.hpp"
#include "common/link/socket_links.hpp"

namespace tread {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& problem) {
  throw std::invalid_argument("link address \"" + text + "\": " + problem);
}

/// A plain decimal number from 1 to `max`; 0 for anything else.
int positive(const std::string& digits, int max) {
  int value = 0;
  const char* end = digits.data() + digits.size();
  const auto result = std::from_chars(digits.data(), end, value);
  const bool good = result.ec == std::errc() && result.ptr == end && value >= 1 && value <= max;
  return good ? value : 0;
}

uint16_t portOf(const LinkAddress& address, const std::string& digits) {
  const int port = positive(digits, 65535);
  if (port == 0) refuse(address.text, "the port is \"" + digits + "\"; allowed 1..65535");
  return static_cast<uint16_t>(port);
}

void parseTty(LinkAddress& address, const std::string& rest) {
  const size_t question = rest.find('?');
  address.path = rest.substr(0, question);
  if (address.path.empty())
    refuse(address.text, "the device is missing; write tty:/dev/ttyUSB0?baud=115200");
  if (question == std::string::npos) return;
  const std::string option = rest.substr(question + 1);
  const std::string key = "baud=";
  if (option.compare(0, key.size(), key) != 0)
    refuse(address.text, "unknown option \"" + option + "\"; allowed baud=");
  address.baud = positive(option.substr(key.size()), 4'000'000);
  if (!speedOf(address.baud))
    refuse(address.text,
           "\"" + option + "\" is no rate of a serial line; for instance baud=115200");
}

void parseTcp(LinkAddress& address, const std::string& rest) {
  const size_t colon = rest.rfind(':');
  if (colon == std::string::npos || colon == 0)
    refuse(address.text, "host or port is missing; write tcp:host:port");
  address.host = rest.substr(0, colon);
  if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']')
    address.host = address.host.substr(1, address.host.size() - 2);
  address.port = portOf(address, rest.substr(colon + 1));
}

/// A port, or an address and a port.
void parseListener(LinkAddress& address, const std::string& rest) {
  const size_t colon = rest.rfind(':');
  if (colon != std::string::npos) address.host = rest.substr(0, colon);
  address.port = portOf(address, colon == std::string::npos ? rest : rest.substr(colon + 1));
}

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
  /// A file that was read to its end does not restart: a recording is played once.
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

/// Shared by both ends: the bytes in transit and the state of the plug.
struct Cable {
  explicit Cable(size_t capacity_bytes) : capacity(capacity_bytes) {}

  const size_t capacity;
  std::deque<uint8_t> toward[2];  // bytes that end 0 and end 1 have not read yet
  bool connected = true;
  int64_t connections = 1;  // how often the plug was connected
};

class PipeEnd final : public Link {
 public:
  PipeEnd(std::shared_ptr<Cable> cable, size_t side, std::string address)
      : cable_(std::move(cable)), side_(side), address_(std::move(address)) {}
  ~PipeEnd() override { setConnected(false); }

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override {
    if (!isOpen()) return std::nullopt;
    std::deque<uint8_t>& bytes = cable_->toward[side_];
    const size_t count = std::min(capacity, bytes.size());
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(bytes.begin(), end, buffer);
    bytes.erase(bytes.begin(), end);
    return count;
  }

  bool write(const uint8_t* bytes, size_t size) override {
    std::deque<uint8_t>& queue = cable_->toward[1 - side_];
    if (!isOpen() || size > cable_->capacity - queue.size()) return false;
    queue.insert(queue.end(), bytes, bytes + size);
    return true;
  }

  /// A disconnected end stays closed until it is reopened, like a device file.
  bool isOpen() const override { return cable_->connected && seen_ == cable_->connections; }
  bool reopen(int64_t /*utime*/) override {
    // No back-off: checking a plug in memory costs nothing, and an emulator must be fast.
    if (cable_->connected) seen_ = cable_->connections;
    return isOpen();
  }
  /// Closes both ends, as of a connection; bytes in transit are lost.
  void close() override {
    if (!isOpen()) return;
    setConnected(false);
    setConnected(true);
  }
  const std::string& address() const override { return address_; }
  std::string problem() const override {
    if (isOpen()) return {};
    return address_ + (cable_->connected ? ": was unplugged, not yet reopened" : ": unplugged");
  }

  void setConnected(bool connected) {
    if (connected == cable_->connected) return;
    cable_->connected = connected;
    cable_->connections += connected;
    for (auto& bytes : cable_->toward) bytes.clear();
  }

 private:
  std::shared_ptr<Cable> cable_;
  size_t side_;
  int64_t seen_ = 1;
  std::string address_;
};

}  // namespace

LinkAddress parseLinkAddress(const std::string& text) {
  LinkAddress address;
  address.text = text;
  const size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (kind == "tty" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTty;
    parseTty(address, rest);
  } else if (kind == "tcp" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTcp;
    parseTcp(address, rest);
  } else if (kind == "tcp-server" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTcpServer;
    parseListener(address, rest);
  } else if (kind == "udp" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kUdp;
    parseListener(address, rest);
  } else if (kind == "pty" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kPty;
    address.path = rest;
    if (rest.empty()) refuse(text, "the name is missing; write pty:path of a link to make");
  } else if (kind == "can" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kCan;
    address.path = rest;
    if (rest.empty() || rest.size() > 15)
      refuse(text, "the interface has 1 to 15 characters; write can:can0");
  } else if (kind == "file" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kFile;
    address.path = rest;
    if (rest.empty()) refuse(text, "the path is missing; write file:path");
  } else {
    refuse(text,
           "unknown kind; allowed tty:/dev/ttyUSB0?baud=115200, tcp:host:port, udp:port, "
           "can:can0, file:path, and for emulators pty:path, tcp-server:port");
  }
  return address;
}

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
    case LinkAddress::Kind::kCan:
      return makeCanLink(parsed);
  }
  throw std::invalid_argument("link address \"" + address + "\": unknown kind");
}

void requireFree(const Link& link) {
  if (link.isOpen() || link.problem().find(kInUse) == std::string::npos) return;
  throw std::runtime_error(link.address() + ": " + kInUse +
                           "; stop that one, or name another device in the configuration");
}

void requireListening(const std::string& address) {
  const LinkAddress::Kind kind = parseLinkAddress(address).kind;
  if (kind != LinkAddress::Kind::kTcpServer && kind != LinkAddress::Kind::kUdp) return;
  const std::string problem = makeLink(address)->problem();
  if (!problem.empty() && problem.find(kNobody) == std::string::npos)
    throw std::runtime_error(problem + "; end the program that has this port, or name another one");
}

std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> makePipe(size_t capacity) {
  const auto cable = std::make_shared<Cable>(capacity);
  return {std::make_unique<PipeEnd>(cable, 0, "pipe:0"),
          std::make_unique<PipeEnd>(cable, 1, "pipe:1")};
}

void setPipeConnected(Link& end, bool connected) {
  auto* const pipe = dynamic_cast<PipeEnd*>(&end);
  if (pipe == nullptr)
    throw std::invalid_argument("link " + end.address() + " is no in-memory pipe to cut or mend");
  pipe->setConnected(connected);
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>

#include "common/link/baud_rates.hpp"
#include "common/link/descriptor_link.hpp"
#include "common/link/kinds.hpp"

namespace tread {
namespace {

/// Raw, 8N1, without flow control, at this rate; false with errno where the device refuses.
bool configure(int fd, speed_t speed) {
  termios line{};
  if (::tcgetattr(fd, &line) != 0) return false;
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  // With VMIN 0 a silent line would read as 0 bytes, which is how a line that is gone reads.
  line.c_cc[VMIN] = 1;
  line.c_cc[VTIME] = 0;
  return ::cfsetispeed(&line, speed) == 0 && ::cfsetospeed(&line, speed) == 0 &&
         ::tcsetattr(fd, TCSANOW, &line) == 0;
}

bool isPseudoTerminal(int fd) {
  constexpr unsigned kFirstMajor = 136;
  constexpr unsigned kLastMajor = 143;
  struct stat entry {};
  if (::fstat(fd, &entry) != 0) return false;
  return major(entry.st_rdev) >= kFirstMajor && major(entry.st_rdev) <= kLastMajor;
}

/// Keeps other programs off the line.
bool claim(int fd) {
  // The lock goes with the process, even a killed one. TIOCEXCL goes with the last descriptor; an
  // emulator keeps one open on its pseudo-terminal, where the mark would outlive us and lock us
  // out.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) return false;
  return isPseudoTerminal(fd) || ::ioctl(fd, TIOCEXCL) == 0;
}

class TtyLink final : public DescriptorLink {
 public:
  explicit TtyLink(const LinkAddress& address)
      : DescriptorLink(address.text), path_(address.path), speed_(*speedOf(address.baud)) {
    attempt();
  }
  ~TtyLink() override { drain(); }

 private:
  int openDevice(std::string& reason) override {
    // By name each time: a device that comes back may have another number behind its symlink.
    const int fd = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && ::isatty(fd) == 0) {
      reason = "not a terminal; name a serial device";
    } else if (fd >= 0 && claim(fd) && configure(fd, speed_)) {
      ::tcflush(fd, TCIOFLUSH);
      return fd;
    } else {
      reason = errno == EWOULDBLOCK ? "in use by another program" : systemReason(errno);
    }
    if (fd >= 0) ::close(fd);
    return -1;
  }

  // Closing a serial line waits for its queue, up to half a minute where nobody takes it.
  void dropQueued() override { ::tcflush(descriptor(), TCIOFLUSH); }

  /// Lets a last command (the motors' zero) out at a proper end, but not for long.
  void drain() {
    constexpr int kSteps = 20;
    constexpr useconds_t kStep = 1000;  // [us]
    int queued = 0;
    for (int i = 0; isOpen() && i < kSteps; ++i) {
      if (::ioctl(descriptor(), TIOCOUTQ, &queued) != 0 || queued == 0) return;
      ::usleep(kStep);
    }
    if (isOpen()) dropQueued();
  }

  std::string path_;
  speed_t speed_;
};

}  // namespace

std::unique_ptr<Link> makeTtyLink(const LinkAddress& address) {
  return std::make_unique<TtyLink>(address);
}

}  // namespace tread

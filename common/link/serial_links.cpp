// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/serial_links.hpp"

#include <cerrno>
#include <filesystem>

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include "common/link/descriptor_link.hpp"

namespace tread {
namespace {

/// Raw, 8N1, without flow control, at this rate; false with errno if the device refuses.
bool configure(int fd, speed_t speed) {
  termios line{};
  if (::tcgetattr(fd, &line) != 0) return false;
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  // With VMIN 0 a silent line would return 0 bytes, like a line that is gone.
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

/// Reserves the line for this process.
bool claim(int fd) {
  // The lock ends with the process, even if killed. TIOCEXCL ends with the last descriptor; an
  // emulator keeps one open on its pseudo-terminal, so the mark would outlive us and lock us out.
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
    // By name each time: a device that returns may have another number behind its symlink.
    const int fd = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && ::isatty(fd) == 0) {
      reason = "not a terminal; name a serial device";
    } else if (fd >= 0 && claim(fd) && configure(fd, speed_)) {
      ::tcflush(fd, TCIOFLUSH);
      return fd;
    } else {
      // By our lock, or by TIOCEXCL.
      reason = errno == EWOULDBLOCK || errno == EBUSY ? kInUse : systemReason(errno);
    }
    if (fd >= 0) ::close(fd);
    return -1;
  }

  // Closing a serial line waits for its queue, up to half a minute if the other end does not read.
  void dropQueued() override { ::tcflush(descriptor(), TCIOFLUSH); }

  /// Sends a last command (zero to the motors) at an orderly end, but not for long.
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

namespace fs = std::filesystem;

class PtyLink final : public DescriptorLink {
 public:
  explicit PtyLink(const LinkAddress& address) : DescriptorLink(address.text), name_(address.path) {
    attempt();
  }
  ~PtyLink() override {
    std::error_code none;
    // A later emulator may own the name now.
    if (!device_.empty() && fs::read_symlink(name_, none) == device_) fs::remove(name_, none);
    if (other_side_ >= 0) ::close(other_side_);
  }

  /// Bytes that do not fit are lost, as on a line with a slow reader.
  bool write(const uint8_t* bytes, size_t size) override {
    return isOpen() && ::write(descriptor(), bytes, size) == static_cast<ssize_t>(size);
  }

 private:
  int openDevice(std::string& reason) override {
    const int fd = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0 && ::grantpt(fd) == 0 && ::unlockpt(fd) == 0 && openOtherSide(fd) &&
        publish(reason))
      return fd;
    if (reason.empty()) reason = systemReason(errno);
    if (fd >= 0) ::close(fd);
    return -1;
  }

  /// Held open, so that reconnecting robots cause no hang-up; raw, so that nothing is echoed before
  /// one connects.
  bool openOtherSide(int fd) {
    char device[128];
    if (::ptsname_r(fd, device, sizeof device) != 0) return false;
    device_ = device;
    if (other_side_ >= 0) ::close(other_side_);
    other_side_ = ::open(device, O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios line{};
    if (other_side_ < 0 || ::tcgetattr(other_side_, &line) != 0) return false;
    ::cfmakeraw(&line);
    return ::tcsetattr(other_side_, TCSANOW, &line) == 0;
  }

  /// Replaces the symlink atomically: the name always exists.
  bool publish(std::string& reason) {
    std::error_code error;
    const fs::path parent = fs::path(name_).parent_path();
    if (!parent.empty()) fs::create_directories(parent, error);
    if (fs::exists(fs::symlink_status(name_, error)) && !fs::is_symlink(name_, error)) {
      reason = "the name is taken by a file that is no link; remove it";
      return false;
    }
    const std::string fresh = name_ + ".new";
    fs::remove(fresh, error);
    fs::create_symlink(device_, fresh, error);
    if (!error) fs::rename(fresh, name_, error);
    if (error) reason = "the link cannot be made (" + error.message() + ")";
    return !error;
  }

  std::string name_;
  std::string device_;
  int other_side_ = -1;
};

}  // namespace

std::unique_ptr<Link> makeTtyLink(const LinkAddress& address) {
  return std::make_unique<TtyLink>(address);
}

std::unique_ptr<Link> makePtyLink(const LinkAddress& address) {
  return std::make_unique<PtyLink>(address);
}

}  // namespace tread

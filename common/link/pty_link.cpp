// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "common/link/descriptor_link.hpp"
#include "common/link/kinds.hpp"

namespace tread {
namespace {

namespace fs = std::filesystem;

class PtyLink final : public DescriptorLink {
 public:
  explicit PtyLink(const LinkAddress& address) : DescriptorLink(address.text), name_(address.path) {
    attempt();
  }
  ~PtyLink() override {
    std::error_code none;
    // A later emulator may have taken the name over.
    if (!device_.empty() && fs::read_symlink(name_, none) == device_) fs::remove(name_, none);
    if (other_side_ >= 0) ::close(other_side_);
  }

  /// What does not fit is lost, as on a line whose reader does not keep up.
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

  /// Held open, so that a robot that comes and goes is no hang-up; raw, so that nothing is echoed
  /// before it comes.
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

  /// The symlink, put in place in one step: nobody ever finds the name gone.
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

std::unique_ptr<Link> makePtyLink(const LinkAddress& address) {
  return std::make_unique<PtyLink>(address);
}

}  // namespace tread

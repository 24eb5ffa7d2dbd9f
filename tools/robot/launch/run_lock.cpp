// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/run_lock.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace tread::launch {
namespace {

struct flock wholeFile() {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  return range;
}

}  // namespace

RunLock::RunLock(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0)
    throw std::runtime_error(path + ": cannot be made (" + std::strerror(errno) + ")");
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int pid = owner(path);
    close(descriptor_);
    throw std::runtime_error("runs already in this folder" +
                             (pid > 0 ? " (pid " + std::to_string(pid) + ")" : std::string()) +
                             "; stop it with --stop, or use another folder with --run");
  }
  struct flock range = wholeFile();
  fcntl(descriptor_, F_SETLK, &range);
}

RunLock::~RunLock() {
  close(descriptor_);
}

bool RunLock::isHeld(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  close(descriptor);
  return held;
}

int RunLock::owner(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  struct flock range = wholeFile();
  const bool asked = fcntl(descriptor, F_GETLK, &range) == 0;
  close(descriptor);
  return asked && range.l_type != F_UNLCK ? range.l_pid : 0;
}

}  // namespace tread::launch

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/real_time.hpp"

#include <cerrno>
#include <system_error>

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace tread::motor {
namespace {

/// Above ordinary processes, below the kernel's own threads (50).
constexpr int kPriority = 20;

/// Later allocations are locked, too, unless a limit could make that fail.
bool lockMemory() {
  rlimit limit{};
  const bool unlimited = ::geteuid() == 0 || (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 &&
                                              limit.rlim_cur == RLIM_INFINITY);
  return ::mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0;
}

std::string reason() {
  return std::generic_category().message(errno);
}

}  // namespace

std::string becomeRealTime() {
  std::string refused;
  if (!lockMemory()) refused += "memory is not locked (" + reason() + ")";
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  // Threads and programs started later do not inherit it.
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) != 0)
    refused += (refused.empty() ? "" : ", ") + ("no fixed priority (" + reason() + ")");
  if (refused.empty()) return refused;
  return refused + ": commands may leave late on a busy host; give it LimitRTPRIO=20 and " +
         "LimitMEMLOCK=infinity (systemd), or rtprio and memlock in limits.conf";
}

}  // namespace tread::motor

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Preloaded into a process: shifts its date by the seconds in the file JUMPING_CLOCK, as if an
// operator or NTP had set it. CLOCK_MONOTONIC is not changed, as on a real host.
#include <cstdlib>
#include <ctime>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

/// [s]; the file is mapped, so a process sees each change at once.
time_t offset() {
  static const volatile int* const seconds = [] {
    static const int none = 0;
    const char* const path = std::getenv("JUMPING_CLOCK");
    const int file = path != nullptr ? ::open(path, O_RDONLY | O_CLOEXEC) : -1;
    void* const map =
        file >= 0 ? ::mmap(nullptr, sizeof(int), PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
    if (file >= 0) ::close(file);
    return map != MAP_FAILED ? static_cast<const int*>(map) : &none;
  }();
  return *seconds;
}

}  // namespace

extern "C" int clock_gettime(clockid_t id, timespec* time) noexcept {
  using Call = int (*)(clockid_t, timespec*);
  static const auto next = reinterpret_cast<Call>(::dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = next(id, time);
  if (id == CLOCK_REALTIME) time->tv_sec += offset();
  return result;
}

extern "C" int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return result;
}

extern "C" time_t time(time_t* copy) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (copy != nullptr) *copy = now.tv_sec;
  return now.tv_sec;
}

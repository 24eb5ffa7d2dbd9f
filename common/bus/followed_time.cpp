// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/followed_time.hpp"

#include <cstdlib>

namespace tread {
namespace {

/// No clock runs that long (126 years): sums of times cannot overflow.
constexpr int64_t kLargestUtime = 4'000'000'000'000'000;
constexpr int kEnoughAgreeing = 3;
constexpr int64_t kAgreementUs = 1'000'000;
constexpr int64_t kUnopposedUs = 200'000;

}  // namespace

bool FollowedTime::observe(int64_t utime, int64_t host) {
  if (utime < 0 || utime > kLargestUtime) return false;
  const int64_t ahead = utime - now(host);
  if (!started_ || ahead > max_jump_us_) return observeCandidate(utime, host);
  // An old message says nothing about the present, neither for nor against it.
  if (ahead >= -kAgreementUs) agreeing_ = 0;
  if (ahead > 0) set(utime, host);
  return true;
}

bool FollowedTime::observeCandidate(int64_t utime, int64_t host) {
  const int64_t expected = candidate_ + (host - candidate_host_);
  if (agreeing_ == 0 || std::abs(utime - expected) > kAgreementUs) {
    agreeing_ = 1;
    first_agreeing_ = host;
    candidate_ = utime;
    candidate_host_ = host;
  } else if (utime > candidate_) {
    // The same message once more, or one that was under way for longer, confirms nothing.
    ++agreeing_;
    candidate_ = utime;
    candidate_host_ = host;
  }
  const bool unopposed = !started_ || host - first_agreeing_ >= kUnopposedUs;
  if (agreeing_ < kEnoughAgreeing || !unopposed) return !started_;
  set(candidate_, candidate_host_);
  return true;
}

void FollowedTime::set(int64_t utime, int64_t host) {
  utime_ = utime;
  host_ = host;
  started_ = true;
  agreeing_ = 0;
}

}  // namespace tread

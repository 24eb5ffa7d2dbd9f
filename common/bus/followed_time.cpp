// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/followed_time.hpp"

#include <cstdlib>

namespace tread {
namespace {

/// No clock runs that long (126 years): sums of times cannot overflow.
constexpr int64_t kLargestUtime = 4'000'000'000'000'000;
constexpr int kWitnesses = 3;
constexpr int64_t kAgreementUs = 1'000'000;
constexpr int64_t kUnopposedUs = 200'000;

}  // namespace

bool FollowedTime::hear(int64_t utime, int64_t host) {
  if (utime < 0 || utime > kLargestUtime) return false;
  const int64_t ahead = utime - now(host);
  if (!started_ || ahead > max_jump_us_) return hearWitness(utime, host);
  // An old message says nothing about the present, neither for nor against it.
  if (ahead >= -kAgreementUs) witnesses_ = 0;
  if (ahead > 0) set(utime, host);
  return true;
}

bool FollowedTime::hearWitness(int64_t utime, int64_t host) {
  const int64_t claimed = claim_ + (host - claim_host_);
  if (witnesses_ == 0 || std::abs(utime - claimed) > kAgreementUs) {
    witnesses_ = 1;
    first_witness_ = host;
    claim_ = utime;
    claim_host_ = host;
  } else if (utime > claim_) {
    // The same message once more, or one that was under way for longer, is no further witness.
    ++witnesses_;
    claim_ = utime;
    claim_host_ = host;
  }
  const bool unopposed = !started_ || host - first_witness_ >= kUnopposedUs;
  if (witnesses_ < kWitnesses || !unopposed) return !started_;
  set(claim_, claim_host_);
  return true;
}

void FollowedTime::set(int64_t utime, int64_t host) {
  utime_ = utime;
  host_ = host;
  started_ = true;
  witnesses_ = 0;
}

}  // namespace tread

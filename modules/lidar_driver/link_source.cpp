// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/link_source.hpp"

#include <array>

namespace tread::lidar {
namespace {

/// A device that floods us is cut off here until the next step.
constexpr size_t kMaxBytesPerStep = 65536;

}  // namespace

std::vector<RangeScan> LinkSource::take(int64_t utime) {
  if (keepOpen(utime)) {
    read(utime);
    const std::string request = device_->poll(utime);
    link_->write(reinterpret_cast<const uint8_t*>(request.data()), request.size());
  }
  return device_->take(utime);
}

bool LinkSource::keepOpen(int64_t utime) {
  if (device_->lost()) {
    // Links have no close: one that is made anew begins with a new connection.
    device_->close();
    was_open_ = false;
    link_.reset();
    link_ = make_link_();
  }
  const bool open = link_->isOpen() || link_->reopen(utime);
  if (was_open_ && !open) device_->close();
  if (!was_open_ && open) {
    ++connections_;
    device_->open(utime);
  }
  was_open_ = open;
  if (open) last_open_ = utime;
  return open;
}

void LinkSource::read(int64_t utime) {
  std::array<uint8_t, 4096> buffer;
  for (size_t total = 0; total < kMaxBytesPerStep && device_->hungry();) {
    const auto size = link_->read(buffer.data(), buffer.size());
    if (size.value_or(0) == 0) return;
    device_->receive({reinterpret_cast<const char*>(buffer.data()), *size}, utime);
    total += *size;
  }
}

/// Whoever asks has the address already.
std::string LinkSource::linkProblem() const {
  const std::string problem = link_->problem();
  const std::string address = link_->address() + ": ";
  return problem.compare(0, address.size(), address) == 0 ? problem.substr(address.size())
                                                          : problem;
}

Reason LinkSource::reason(int64_t utime, bool /*ground*/) const {
  // What a file held does not grow old: nothing more comes of it.
  const bool file = link_->address().rfind("file:", 0) == 0;
  Reason reason = device_->reason(file && !was_open_ ? last_open_ : utime);
  const std::string problem = was_open_ ? "" : linkProblem();
  if (problem.empty()) return reason;
  if (reason.rank <= Rank::kSilent) return {Rank::kSilent, problem};
  reason.words += (reason.words.back() == '?' ? " " : "; ") + problem;
  return reason;
}

std::map<std::string, int64_t> LinkSource::counters() const {
  std::map<std::string, int64_t> counters = device_->counters();
  counters["connections"] = connections_;
  return counters;
}

}  // namespace tread::lidar

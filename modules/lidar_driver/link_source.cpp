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

std::string LinkSource::problem() const {
  // A device that was lost tells more than the line that is being opened anew.
  if (was_open_ || link_->problem().empty()) return device_->problem();
  // Whoever asks has the address already.
  const std::string problem = link_->problem();
  const std::string address = link_->address() + ": ";
  return problem.compare(0, address.size(), address) == 0 ? problem.substr(address.size())
                                                          : problem;
}

std::map<std::string, int64_t> LinkSource::counters() const {
  std::map<std::string, int64_t> counters = device_->counters();
  counters["connections"] = connections_;
  return counters;
}

}  // namespace tread::lidar

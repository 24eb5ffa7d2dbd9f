// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/scan_connection.hpp"

#include <array>

namespace tread::lidar {
namespace {

/// The bytes of a flooding device are cut off here until the next step.
constexpr size_t kMaxBytesPerStep = 65536;
/// [us] between connections without a scan: a peer may close each one at once.
constexpr int64_t kPause = 500'000;

}  // namespace

ScanConnection::~ScanConnection() {
  if (!device_ || !was_open_ || !link_->isOpen()) return;
  const std::string bytes = device_->farewell();
  link_->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

std::vector<RangeScan> ScanConnection::take(int64_t utime) {
  if (keepOpen(utime)) {
    read(utime);
    const std::string request = device_->poll(utime);
    link_->write(reinterpret_cast<const uint8_t*>(request.data()), request.size());
  }
  std::vector<RangeScan> scans = device_->take(utime);
  scanned_ = scanned_ || !scans.empty();
  return scans;
}

bool ScanConnection::keepOpen(int64_t utime) {
  if (device_->lost()) link_->close();
  if (was_open_ && !link_->isOpen()) {
    device_->close();
    was_open_ = false;
    open_from_ = utime + (scanned_ ? 0 : kPause);
  }
  if (!link_->isOpen() && (utime < open_from_ || !link_->reopen(utime))) return false;
  if (!was_open_) {
    ++connections_;
    scanned_ = false;
    device_->open(utime);
  }
  was_open_ = true;
  last_open_ = utime;
  return true;
}

void ScanConnection::read(int64_t utime) {
  std::array<uint8_t, 4096> buffer;
  for (size_t total = 0; total < kMaxBytesPerStep && device_->hungry();) {
    const auto size = link_->read(buffer.data(), buffer.size());
    if (size.value_or(0) == 0) return;
    device_->receive({reinterpret_cast<const char*>(buffer.data()), *size}, utime);
    total += *size;
  }
}

/// Callers already have the address.
std::string ScanConnection::linkProblem() const {
  const std::string problem = link_->problem();
  const std::string address = link_->address() + ": ";
  return problem.compare(0, address.size(), address) == 0 ? problem.substr(address.size())
                                                          : problem;
}

NotedReason ScanConnection::reason(int64_t utime) const {
  // A file's data do not age: nothing more comes from it.
  const bool file = link_->address().rfind("file:", 0) == 0;
  NotedReason reason = device_->reason(file && !was_open_ ? last_open_ : utime);
  const std::string problem = was_open_ ? "" : linkProblem();
  if (problem.empty()) return reason;
  if (reason.rank <= Rank::kSilent) return {Rank::kSilent, problem};
  reason.words += (reason.words.back() == '?' ? " " : "; ") + problem;
  return reason;
}

std::map<std::string, int64_t> ScanConnection::counters() const {
  std::map<std::string, int64_t> counters = device_->counters();
  counters["connections"] = connections_;
  return counters;
}

}  // namespace tread::lidar

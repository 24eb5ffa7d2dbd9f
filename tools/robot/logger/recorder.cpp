// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/logger/recorder.hpp"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/multicast_only.hpp"
#include "common/config/problem_words.hpp"

namespace tread::logger {
namespace {

constexpr int kQueue = 100'000;                  // messages
constexpr int64_t kMaintenancePeriod = 250'000;  // [us] between flushes
constexpr int kWaitMs = 100;
constexpr int kSilenceMs = 30;            // of silence after which no message is in flight
constexpr int64_t kLastUs = 100'000;      // [us] of receiving after a stop
constexpr int64_t kRetry = 1'000'000;     // [us] between attempts after the disk was full
constexpr int64_t kReserve = 10'000'000;  // [bytes] of free space needed to begin again
constexpr int64_t kScarce = 500'000'000;  // [bytes] of free space below which a warning is given
constexpr int kMostFailures = 10;         // of LCM in succession
constexpr int64_t kOverhead = 60;         // [bytes] of an event's header, about

namespace fs = std::filesystem;

std::string numbered(const std::string& file, int number) {
  return file + "." + std::to_string(number);
}

}  // namespace

void makeRoomForLog(const std::string& file, int keep) {
  int gap = 0;
  while (gap < keep && fs::exists(numbered(file, gap))) ++gap;
  for (int i = gap - 1; i >= 0; --i) {
    if (i + 1 >= keep)
      fs::remove(numbered(file, i));
    else
      fs::rename(numbered(file, i), numbered(file, i + 1));
  }
}

void keepWithin(const std::string& file, int64_t bytes) {
  int64_t sum = 0;
  for (int i = 1; fs::exists(numbered(file, i)); ++i) {
    sum += static_cast<int64_t>(fs::file_size(numbered(file, i)));
    if (sum > bytes) fs::remove(numbered(file, i));
  }
}

Recorder::Recorder(const RecorderSettings& settings)
    : settings_(settings),
      lcm_(std::make_unique<lcm::LCM>(settings.lcm_url)),
      bus_(BusAccess{settings.lcm_url, {}}, TimeSource::kHost),
      health_(bus_, "logger",
              "file: " + settings.file + "\nkeep: " + std::to_string(settings.keep) +
                  "\nsplit: " + std::to_string(settings.split) +
                  "\nquota: " + std::to_string(settings.quota) + "\n") {
  if (settings_.quota > 0) settings_.split = std::min(settings_.split, settings_.quota / 4);
  if (!openForMulticastOnly(*lcm_, settings.lcm_url))
    throw std::runtime_error("LCM cannot be used" +
                             (settings.lcm_url.empty() ? "" : " at " + settings.lcm_url) +
                             "; tread-launch FILE --check says what is missing");
  begin();
  lcm::Subscription* all = lcm_->subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Recorder* self) {
        self->record(channel, static_cast<const uint8_t*>(buffer->data), buffer->data_size);
      },
      this);
  if (all == nullptr) throw std::runtime_error("LCM refuses to subscribe");
  all->setQueueCapacity(kQueue);
}

Recorder::~Recorder() = default;

void Recorder::begin() {
  makeRoomForLog(settings_.file, settings_.keep);
  if (settings_.quota > 0) keepWithin(settings_.file, settings_.quota - settings_.split);
  writer_ = std::make_unique<LogWriter>(settings_.file + ".0", OutputFile::Kind::kGrowing);
  written_ = 0;
}

void Recorder::giveUp(const std::string& why) {
  std::fprintf(stderr, "tread-logger: %s; recording resumes when there is space\n", why.c_str());
  trouble_ = why;
  writer_.reset();
  next_try_ = hostNow() + kRetry;
}

int64_t Recorder::freeBytes() const {
  std::error_code none;
  return static_cast<int64_t>(
      fs::space(fs::absolute(settings_.file).parent_path(), none).available);
}

void Recorder::reportHealth(int64_t now) {
  const int64_t free_mb = freeBytes() / 1'000'000;
  const std::string lost = std::to_string(lost_) + " messages are lost";
  if (!writer_) {
    health_.setState(health_t::HEALTH_FAILED,
                     "nothing is recorded, " + lost + ": " + trouble_ + "; make room");
  } else if (lost_ > 0) {
    health_.setState(health_t::HEALTH_DEGRADED, lost + ": the log has a gap (" + trouble_ + ")");
  } else if (free_mb < kScarce / 1'000'000) {
    health_.setState(health_t::HEALTH_DEGRADED,
                     "only " + std::to_string(free_mb) + " MB are free for " + settings_.file +
                         "; remove old logs, or limit them with --quota-mb");
  } else {
    health_.setState(health_t::HEALTH_OK, "");
  }
  health_.setCounter("recorded messages", recorded_);
  health_.setCounter("lost messages", lost_);
  health_.setCounter("free space [MB]", free_mb);
  health_.step(now);
}

void Recorder::record(const std::string& channel, const uint8_t* bytes, size_t size) {
  if (!writer_) {
    ++lost_;
    return;
  }
  try {
    writer_->write(hostUtc(), channel, bytes, size);
    written_ += kOverhead + static_cast<int64_t>(size);
    ++recorded_;
  } catch (const std::exception& error) {
    ++lost_;
    giveUp(wordsOf(error));
  }
}

void Recorder::maintain(int64_t now) {
  next_maintenance_ = now + kMaintenancePeriod;
  try {
    if (writer_) {
      writer_->flush();
      if (written_ >= settings_.split) begin();
    } else if (now >= next_try_) {
      next_try_ = now + kRetry;
      if (freeBytes() < kReserve) return;
      begin();
      std::fprintf(stderr, "tread-logger: recording again; %lld messages are lost\n",
                   static_cast<long long>(lost_));
    }
  } catch (const std::exception& error) {
    giveUp(wordsOf(error));
  }
}

void Recorder::run(const std::atomic<bool>& stop) {
  int failures = 0;
  while (!stop) {
    // Handle one queue's length at a time, so that a flood does not delay writing.
    const int handled = lcm_->handleTimeout(kWaitMs);
    if (handled > 0)
      for (int i = 0; i < kQueue && lcm_->handleTimeout(0) > 0; ++i) {
      }
    // A signal interrupts it once.
    failures = handled < 0 ? failures + 1 : 0;
    if (failures >= kMostFailures)
      throw std::runtime_error("LCM fails repeatedly, so recording ends; start tread-logger again");
    if (const int64_t now = hostNow(); now >= next_maintenance_) {
      maintain(now);
      reportHealth(now);
    }
    bus_.lifeSign().beat(hostNow());
  }
  bus_.lifeSign().stopping();
  // Messages sent before the stop are still in LCM's thread; the deadline is for a flood.
  const int64_t last = hostNow() + kLastUs;
  while (hostNow() < last && lcm_->handleTimeout(kSilenceMs) != 0) {
  }
  for (int i = 0; i < kQueue && lcm_->handleTimeout(0) > 0; ++i) {
  }
  maintain(hostNow());
}

}  // namespace tread::logger

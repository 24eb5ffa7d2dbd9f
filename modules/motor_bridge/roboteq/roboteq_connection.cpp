// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"

#include <algorithm>

namespace tread::motor {
namespace {

constexpr int64_t kLineSpan = 5'000'000;  // [us] over which a line is judged
constexpr int64_t kFewExchanges = 50;
constexpr int64_t kWorstPercent = 5;  // of exchanges may fail on a sound line

/// Fault flags older than this are unknown [us]; they are read about thirty times a second.
constexpr int64_t kFlagsMaxAge = 1'000'000;

}  // namespace

RoboteqConfig readRoboteqConfig(ConfigReader& reader, const DriveDescription& drive) {
  RoboteqConfig config;
  RoboteqLayout& layout = config.layout;
  layout.full_scale = drive.fullCommand();
  layout.left_channel = drive.left_channel;
  layout.invert_left = drive.invert_left;
  layout.invert_right = drive.invert_right;
  int64_t watchdog_us = 1000 * config.watchdog_ms;
  // Zero is repeated every 0.1 s: a shorter watchdog would expire while the robot stands.
  reader.seconds("watchdog", watchdog_us, {0.15, 0.25});
  config.watchdog_ms = watchdog_us / 1000;
  reader.flag("both_in_one_line", layout.both_in_one_line);
  reader.number("rpm_per_mps", layout.rpm_per_mps, {0.0, 100000.0}, "rpm s/m");
  return config;
}

void RoboteqConnection::open() {
  backoff_us_ = 0;
  enter(Phase::kEcho);
  ++counters_["link opened"];
}

void RoboteqConnection::close(const std::string& problem) {
  counters_["link lost"] += isOpen();
  problem_ = problem;
  enter(Phase::kClosed);
}

void RoboteqConnection::enter(Phase phase) {
  phase_ = phase;
  tries_ = 0;
  if (phase == Phase::kEcho || phase == Phase::kClosed || phase == Phase::kBackoff) {
    lines_.clear();
    output_.clear();
  }
}

void RoboteqConnection::fail(const std::string& problem, int64_t now, const std::string& detail) {
  problem_ = problem + detail;
  ++counters_["controller lost: " + problem];
  backoff_us_ = std::clamp(2 * backoff_us_, config_.backoff_min_us, config_.backoff_max_us);
  retry_at_ = now + backoff_us_;
  enter(Phase::kBackoff);
  // Perhaps only its answers are lost: let it stand at once instead of waiting for its watchdog.
  sendZero(now);
}

void RoboteqConnection::sendZero(int64_t now) {
  for (const std::string& line : commandLines({}, config_.layout)) send(line);
  zero_at_ = now;
}

std::string RoboteqConnection::zeros(int times) const {
  std::string bytes;
  for (const std::string& line : commandLines({}, config_.layout)) {
    for (int i = 0; i < times; ++i) bytes += line + "\r";
  }
  return bytes;
}

void RoboteqConnection::receive(std::string_view bytes, int64_t now) {
  for (const std::string& line : lines_.push(bytes)) {
    const RoboteqReply reply = parseReply(line);
    if (isEcho(line)) {
      ++counters_["echoed lines"];
      if (phase_ == Phase::kReady) {
        // We switched the echo off: it was switched on anew and has its default watchdog again.
        fail("it was restarted", now);
      }
    } else if (reply.kind == RoboteqReply::Kind::kOther) {
      ++counters_["unreadable lines"];
    } else if (phase_ == Phase::kReady) {
      session_.take(reply, now);
    } else if (phase_ != Phase::kBackoff && phase_ != Phase::kClosed) {
      takeStartup(reply, now);
    }
  }
}

void RoboteqConnection::command(const TrackCommand& command, int64_t now) {
  if (phase_ == Phase::kReady) session_.command(command, now);
}

std::string RoboteqConnection::poll(int64_t now) {
  if (phase_ == Phase::kBackoff && now >= retry_at_) enter(Phase::kEcho);
  if (phase_ == Phase::kReady) {
    output_ += session_.poll(now);
    watchLine(now);
    if (!session_.problem().empty()) fail(session_.problem(), now);
  } else if (phase_ == Phase::kBackoff && now - zero_at_ >= config_.stop_interval_us) {
    sendZero(now);
  } else if (phase_ != Phase::kBackoff && phase_ != Phase::kClosed) {
    pollStartup(now);
  }
  std::string output;
  output.swap(output_);
  return output;
}

RoboteqConnection::Exchanges RoboteqConnection::exchanges(int64_t now) const {
  Exchanges sum{now, 0, 0};
  for (const auto& [name, count] : counters()) {
    if (name == "commands sent" || name == "queries sent") sum.all += count;
    for (const char* failure : {"replies missing", "commands refused", "queries refused"})
      if (name == failure) sum.failed += count;
  }
  return sum;
}

void RoboteqConnection::watchLine(int64_t now) {
  if (!line_.empty() && now - line_.back().utime < kLineSpan / 10) return;
  line_.push_back(exchanges(now));
  while (line_.size() > 2 && now - line_.front().utime > kLineSpan) line_.pop_front();
}

std::string RoboteqConnection::lineProblem() const {
  if (line_.empty() || !ready()) return "";
  const int64_t all = line_.back().all - line_.front().all;
  const int64_t failed = line_.back().failed - line_.front().failed;
  if (all < kFewExchanges || 100 * failed < kWorstPercent * all) return "";
  return std::to_string(100 * failed / all) + " % of the exchanges with the controller failed in " +
         "the last " + std::to_string(kLineSpan / 1'000'000) +
         " s; check cable, plugs and earthing";
}

std::string RoboteqConnection::request() const {
  switch (phase_) {
    case Phase::kEcho:
      return "^ECHOF 1";
    case Phase::kWatchdog:
      return "^RWD " + std::to_string(config_.watchdog_ms);
    case Phase::kReadBack:
      return "~RWD";
    case Phase::kZero:
      return "zero";
    case Phase::kIdentify:
      return "?FID";
    default:
      return "";
  }
}

void RoboteqConnection::pollStartup(int64_t now) {
  if (tries_ > 0 && now - asked_at_ < config_.reply_timeout_us) return;
  if (tries_ == config_.startup_tries) {
    fail("no good answer to " + request(), now);
    return;
  }
  ++tries_;
  asked_at_ = now;
  if (phase_ != Phase::kZero) send(request());
  // Zero also follows the very first line: it may complete half a command that a killed predecessor
  // left in the controller. Its acknowledgement is mistaken for that of the watchdog's setting,
  // which is read back anyway.
  if (phase_ == Phase::kZero || phase_ == Phase::kEcho) sendZero(now);
}

void RoboteqConnection::takeStartup(const RoboteqReply& reply, int64_t now) {
  const bool expects_value = phase_ == Phase::kReadBack || phase_ == Phase::kIdentify;
  if (reply.kind == RoboteqReply::Kind::kRefused) {
    ++counters_["start-up requests refused"];
    asked_at_ = now - config_.reply_timeout_us;  // repeat with the next poll
  } else if (phase_ == Phase::kReadBack && reply.key == "RWD") {
    checkWatchdog(reply, now);
  } else if (phase_ == Phase::kIdentify && reply.key == "FID") {
    firmware_ = reply.text;
    advance(now);
  } else if (reply.kind == RoboteqReply::Kind::kAck && !expects_value) {
    advance(now);
  }
}

void RoboteqConnection::checkWatchdog(const RoboteqReply& reply, int64_t now) {
  const std::string wanted = std::to_string(config_.watchdog_ms);
  if (reply.text == wanted) {
    advance(now);
  } else {
    fail("its watchdog did not take its setting", now,
         ": it reads " + reply.text + " ms instead of " + wanted);
  }
}

void RoboteqConnection::advance(int64_t now) {
  enter(static_cast<Phase>(static_cast<int>(phase_) + 1));
  if (phase_ == Phase::kReady) {
    backoff_us_ = 0;
    session_.begin(now);
    ++counters_["start-ups"];
  } else {
    pollStartup(now);
  }
}

DeviceReport RoboteqConnection::report(int64_t now) const {
  DeviceReport report;
  const RoboteqTelemetry told = known();
  if (phase_ == Phase::kClosed || phase_ == Phase::kBackoff) {
    report.link_fault = "controller lost: " + problem_;
  } else if (phase_ != Phase::kReady) {
    report.link_fault = "controller is being started up";
  } else if (!told.faults_read_at || !told.status_read_at) {
    report.link_fault = "controller's fault flags not read yet";
  } else if (now - std::min(*told.faults_read_at, *told.status_read_at) > kFlagsMaxAge) {
    report.link_fault = "controller's fault flags are out of date";
  } else {
    report.device_fault = describeFaults(told.fault_flags, told.status_flags);
    report.stop_latched = session_.stopLatched();
  }
  return report;
}

std::map<std::string, int64_t> RoboteqConnection::counters() const {
  std::map<std::string, int64_t> counters = counters_;
  for (const auto& [name, count] : session_.counters()) counters[name] += count;
  counters["overlong lines"] += lines_.overlong();
  counters["garbage bytes"] += lines_.garbageBytes();
  return counters;
}

}  // namespace tread::motor

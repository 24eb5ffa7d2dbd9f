// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/line_protocol/line_connection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::motor {
namespace {

/// Older faults count as unknown [us].
constexpr int64_t kFaultsMaxAge = 1'000'000;
/// The controller's emergency stop and its release are repeated at this interval, the release for
/// this long [us].
constexpr int64_t kStopRepeat = 100'000;
constexpr int64_t kReleaseSpan = 1'000'000;

/// A count of the controller; NaN becomes zero: this is the last check.
double countsOf(double value, bool invert, const LineDescription& line) {
  const double share = value / line.full_scale;
  if (!std::isfinite(share)) return 0.0;
  return (invert ? -1.0 : 1.0) * std::clamp(share, -1.0, 1.0) * line.full_command;
}

/// From a car's steering angle [rad]; NaN becomes straight ahead.
double steeringCounts(double angle, const LineDescription& line) {
  const double share =
      std::isfinite(angle) ? std::clamp(angle / line.max_steering, -1.0, 1.0) : 0.0;
  return line.steering_centre + (line.invert_right ? -share : share) * line.full_steering;
}

}  // namespace

LineConnection::LineConnection(const LineDescription& line)
    : ControllerConnection(line.times), line_(line), lines_(line.end.back()) {}

std::string LineConnection::notice() const {
  std::string words;
  const auto add = [&words](const std::string& what) {
    words += (words.empty() ? "" : "; ") + what;
  };
  if (!line_.readsWatchdog())
    add("no reply reads its watchdog back: whether it stops by itself is unproved");
  if (line_.acknowledge.empty() && line_.queries.empty())
    add("it answers nothing: a controller that is gone is not noticed");
  if (!readsFaults()) add("its faults are not read");
  return words.empty() ? words : line_.name + ": " + words;
}

bool LineConnection::readsFaults() const {
  return std::any_of(line_.queries.begin(), line_.queries.end(),
                     [](const LineExchange& query) { return query.expect.has("faults"); });
}

LineValues LineConnection::commandValues(const Command& command) const {
  const std::vector<std::string> wheels = line_.wheels();
  if (!wheels.empty()) {
    LineValues values;
    for (size_t i = 0; i < wheels.size(); ++i)
      values[wheels[i]] = countsOf(command[i], line_.invert_wheels[i], line_);
    return values;
  }
  double left = countsOf(command[0], line_.invert_left, line_);
  if (line_.max_steering > 0.0)
    return {{"throttle", left}, {"steering", steeringCounts(command[1], line_)}};
  double right = countsOf(command[1], line_.invert_right, line_);
  if (line_.swapped) std::swap(left, right);
  return {{"left", left}, {"right", right}};
}

std::string LineConnection::zero() const {
  std::string bytes;
  for (const LineTemplate& line : line_.stop.empty() ? line_.command : line_.stop)
    bytes += line_.framed(line.format(commandValues({})));
  return bytes;
}

const LineExchange* LineConnection::exchangeOf(int step) const {
  const bool described = step >= 1 && step <= static_cast<int>(line_.start.size());
  return described ? &line_.start[static_cast<size_t>(step - 1)] : nullptr;
}

std::string LineConnection::startupRequest(int step) const {
  const LineExchange* exchange = exchangeOf(step);
  if (exchange != nullptr)
    return line_.framed(exchange->send.format({{"watchdog", line_.watchdogCounts()}}));
  // Preceded by an end of line: a killed predecessor may have left half a command.
  return (step == 0 ? line_.end : "") + zero();
}

std::string LineConnection::startupName(int step) const {
  const LineExchange* exchange = exchangeOf(step);
  return exchange == nullptr ? "zero"
                             : exchange->send.format({{"watchdog", line_.watchdogCounts()}});
}

bool LineConnection::isAnswered(int step) const {
  if (exchangeOf(step) != nullptr) return true;
  // The first zero goes to a controller that may not be configured for answers yet.
  return step > 0 && !line_.acknowledge.empty();
}

void LineConnection::forget() {
  lines_.clear();
  output_.clear();
}

void LineConnection::begin(int64_t now) {
  forget();
  pending_.clear();
  telemetry_ = MotorTelemetry{};
  problem_.clear();
  heard_at_ = queried_at_ = now;
  faults_read_at_.reset();
  watchdog_mismatches_ = 0;
  given_ = Command{};
  repeat_ = latched_ = false;
}

void LineConnection::receive(std::string_view bytes, int64_t now) {
  for (std::string& line : lines_.push(bytes)) {
    if (line_.unframe(line)) {
      takeLine(line, now);
    } else {
      ++bad_checksums_;
    }
  }
}

void LineConnection::takeLine(const std::string& line, int64_t now) {
  if (!line_.restarted.empty() && line == line_.restarted) {
    if (ready() || waitingStep() > 0) fail("it was restarted", now);
  } else if (waitingStep() >= 0) {
    takeStartup(line, now);
  } else if (ready()) {
    takeReply(line, now);
  }
}

bool LineConnection::refuses(const std::string& line) const {
  return std::any_of(line_.errors.begin(), line_.errors.end(),
                     [&line](const LineTemplate& error) { return error.match(line).has_value(); });
}

void LineConnection::takeStartup(const std::string& line, int64_t now) {
  if (refuses(line)) {
    stepRefused(now);
    return;
  }
  const LineExchange* exchange = exchangeOf(waitingStep());
  if (exchange == nullptr) {
    if (line == line_.acknowledge) stepDone(now);
    return;
  }
  const std::optional<LineValues> values = exchange->expect.match(line);
  if (!values) return;
  const auto watchdog = values->find("watchdog");
  if (watchdog == values->end() || isWatchdog(exchange->expect, watchdog->second)) {
    stepDone(now);
  } else {
    fail("its watchdog did not take its setting", now, ": it reads \"" + line + "\"");
  }
}

void LineConnection::takeReply(const std::string& line, int64_t now) {
  if (!line_.acknowledge.empty() && line == line_.acknowledge) {
    if (pending_.acknowledged()) heard_at_ = now;
    return;
  }
  if (refuses(line)) {
    repeat_ = pending_.refused() == PendingReplies::Refused::kCommand || repeat_;
    // A controller in emergency stop may refuse to move: that is no fault of the link.
    if (latched_) heard_at_ = now;
    return;
  }
  for (const LineExchange& query : line_.queries) {
    const std::optional<LineValues> values = query.expect.match(line);
    if (!values) continue;
    const bool asked = pending_.answered(query.send.text());
    if (asked && line_.acknowledge.empty()) heard_at_ = now;
    takeValues(query.expect, *values, now);
    return;
  }
  ++unreadable_;
}

/// Whether a reply contains the watchdog's setting, at its format's resolution.
bool LineConnection::isWatchdog(const LineTemplate& reply, double counts) const {
  const auto wanted = reply.match(reply.format({{"watchdog", line_.watchdogCounts()}}));
  return wanted && wanted->at("watchdog") == counts;
}

void LineConnection::takeValues(const LineTemplate& reply, const LineValues& values, int64_t now) {
  const auto reading = [&values](const std::string& name, double unit, double& value) {
    const auto found = values.find(name);
    if (found != values.end()) value = unit * found->second;
  };
  MotorTelemetry& told = telemetry_;
  reading("battery_voltage", line_.battery_voltage, told.battery_voltage);
  reading("temperature", line_.temperature, told.temperature);
  const auto ofMotor = [&](const std::string& name, bool invert, size_t channel) {
    reading("current_" + name, line_.current, told.current[channel]);
    reading("speed_" + name, invert ? -line_.speed : line_.speed, told.measured[channel]);
  };
  const std::vector<std::string> wheels = line_.wheels();
  for (size_t i = 0; i < wheels.size(); ++i) ofMotor(wheels[i], line_.invert_wheels[i], i);
  if (wheels.empty()) {
    ofMotor(line_.swapped ? "right" : "left", line_.invert_left, 0);
    ofMotor(line_.swapped ? "left" : "right", line_.invert_right, 1);
  }
  const auto faults = values.find("faults");
  if (faults != values.end() && faults->second >= 0.0 && faults->second <= 2147483647.0) {
    told.device_flags = static_cast<int32_t>(faults->second);
    faults_read_at_ = now;
    latched_ = std::any_of(line_.faults.begin(), line_.faults.end(), [&told](const LineFault& f) {
      return f.latched && (told.device_flags & f.mask) != 0;
    });
  }
  const auto watchdog = values.find("watchdog");
  if (watchdog == values.end()) return;
  // A single line may be corrupt; two in a row mean that the controller lost its setting.
  watchdog_mismatches_ = isWatchdog(reply, watchdog->second) ? 0 : watchdog_mismatches_ + 1;
  if (watchdog_mismatches_ >= 2) problem_ = "its watchdog setting was lost";
}

void LineConnection::sendCommand(const std::string& line, int64_t now) {
  output_ += line_.framed(line);
  if (!line_.acknowledge.empty()) pending_.commandSent(now);
}

void LineConnection::give(const Command& command, int64_t now) {
  given_ = command;
  repeat_ = false;
  const LineValues values = commandValues(command);
  const bool stop = !line_.stop.empty() && command == Command{};
  for (const LineTemplate& line : stop ? line_.stop : line_.command)
    sendCommand(line.format(values), now);
}

void LineConnection::holdStop(bool hold) {
  hold_stop_ = hold;
  if (hold) release_until_ = 0;
}

void LineConnection::releaseStop(int64_t now) {
  hold_stop_ = false;
  release_until_ = now + kReleaseSpan;
  stop_sent_at_ = now - kStopRepeat;
}

void LineConnection::pollStop(int64_t now) {
  if (line_.emergency_stop.empty() || now - stop_sent_at_ < kStopRepeat) return;
  if (hold_stop_ && !latched_) {
    sendCommand(line_.emergency_stop, now);
    stop_sent_at_ = now;
  } else if (!hold_stop_ && now < release_until_ && latched_) {
    sendCommand(line_.release_stop, now);
    give({}, now);
    stop_sent_at_ = now;
  }
}

void LineConnection::pollQuery(int64_t now) {
  if (line_.queries.empty() || now - queried_at_ < line_.query_interval_us) return;
  if (pending_.waitsForQuery(now, line_.times.reply_timeout_us / 2)) return;
  const LineExchange& query = line_.queries[next_query_];
  next_query_ = (next_query_ + 1) % line_.queries.size();
  output_ += line_.framed(query.send.format({{"watchdog", line_.watchdogCounts()}}));
  pending_.querySent(query.send.text(), now);
  queried_at_ = now;
}

std::string LineConnection::talk(int64_t now) {
  pending_.expire(now, line_.times.reply_timeout_us);
  if (repeat_) give(given_, now);
  pollStop(now);
  pollQuery(now);
  std::string output;
  output.swap(output_);
  return output;
}

std::string LineConnection::lost(int64_t now) const {
  const bool answers = !line_.acknowledge.empty() || !line_.queries.empty();
  if (answers && now - heard_at_ > line_.times.silence_limit_us)
    return line_.acknowledge.empty() ? "it does not answer queries"
                                     : "it does not acknowledge commands";
  return problem_;
}

DeviceReport LineConnection::reported(int64_t now) const {
  DeviceReport report;
  if (!readsFaults()) return report;
  if (!faults_read_at_) {
    report.link_fault = "controller's faults not read yet";
  } else if (now - *faults_read_at_ > kFaultsMaxAge) {
    report.link_fault = "controller's faults are out of date";
  } else {
    std::string& words = report.device_fault;
    for (const LineFault& fault : line_.faults) {
      if ((telemetry_.device_flags & fault.mask) == 0) continue;
      words += (words.empty() ? "controller: " : ", ") + fault.means;
      if (fault.voltage) report.fault_code = StopReason::kControllerVoltage;
    }
    report.stop_latched = latched_;
  }
  return report;
}

std::map<std::string, int64_t> LineConnection::counted() const {
  std::map<std::string, int64_t> counters = pending_.counters();
  counters["unreadable lines"] += unreadable_;
  counters["wrong checksums"] += bad_checksums_;
  counters["overlong lines"] += lines_.overlong();
  counters["garbage bytes"] += lines_.garbageBytes();
  return counters;
}

}  // namespace tread::motor

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/input_rates.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace tread::ins {
namespace {

/// Of the poses that lack an input: fewer are messages that the line lost.
constexpr double kTolerated = 0.1;
constexpr double kLongestHold = 0.5;  // [s] that the configuration allows

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

}  // namespace

std::string InputRates::remedy(const std::string& input, double rate, double needed,
                               const std::string& key, int64_t hold_us) const {
  // A fifth more than its period, so that a message that is late is still in time.
  const double hold = std::ceil(120.0 / rate) / 100.0;
  const std::string text =
      "let the device send " + input + " " + rounded(needed, 0) + " times a second";
  const std::string now = ", now " + rounded(static_cast<double>(hold_us) * 1e-6, 2) + " s, ";
  if (hold <= kLongestHold)
    return text + ", or set " + key + ": " + rounded(hold, 2) + now + "which carries one on";
  return text + "; " + key + now + "carries one on and may be set to " + rounded(kLongestHold, 1) +
         " s at most";
}

std::string InputRates::compare(const Counts& end) const {
  const AssemblerCounts& before = start_->epochs;
  const AssemblerCounts& after = end.epochs;
  const double seconds = static_cast<double>(end.utime - start_->utime) * 1e-6;
  const int64_t poses = after.published - before.published;
  const auto rateOf = [&](InputCount AssemblerCounts::*input) {
    return static_cast<double>((after.*input).came - (before.*input).came) / seconds;
  };
  const auto isSlow = [&](InputCount AssemblerCounts::*input) {
    const int64_t came = (after.*input).came - (before.*input).came;
    return came > 0 && 2 * ((after.*input).apart - (before.*input).apart) > came;
  };
  const auto manyLack = [&](int64_t without, int64_t all) {
    return static_cast<double>(without) > kTolerated * static_cast<double>(all);
  };
  const auto having = [&](const char* what, int64_t without) {
    return std::string(what) + " in " + std::to_string(poses - without) + " of " +
           std::to_string(poses) + " poses; ";
  };
  const double positions = rateOf(&AssemblerCounts::positions);
  const double headings = rateOf(&AssemblerCounts::headings);
  const double velocities = rateOf(&AssemblerCounts::velocities);
  const int64_t no_heading = after.without_heading - before.without_heading;
  const int64_t no_velocity = after.without_velocity - before.without_velocity;
  const int64_t left_out = after.attitude_only - before.attitude_only;
  if (isSlow(&AssemblerCounts::headings) && manyLack(no_heading, poses))
    return having("a heading", no_heading) + messages(end) +
           remedy("headings", headings, positions, "attitude_hold", config_.attitude_hold_us);
  if (isSlow(&AssemblerCounts::velocities) && manyLack(no_velocity, poses))
    return having("a velocity", no_velocity) + messages(end) +
           remedy("velocities", velocities, positions, "position_hold", config_.position_hold_us);
  // Attitudes to which no position could be carried.
  if (config_.attitude_epochs && isSlow(&AssemblerCounts::positions) &&
      manyLack(left_out, left_out + poses))
    return std::to_string(left_out) + " attitudes left out for want of a position near them; " +
           messages(end) +
           remedy("positions", positions, headings, "position_hold", config_.position_hold_us);
  return {};
}

/// "GGA 20.0 Hz, HDT 1.0 Hz; ".
std::string InputRates::messages(const Counts& end) const {
  const double seconds = static_cast<double>(end.utime - start_->utime) * 1e-6;
  std::string text;
  for (const auto& [name, count] : end.decoded) {
    const auto then = start_->decoded.find(name);
    const int64_t came = count - (then == start_->decoded.end() ? 0 : then->second);
    if (came == 0) continue;
    text += text.empty() ? "" : ", ";
    text += name + " " + rounded(static_cast<double>(came) / seconds, 1) + " Hz";
  }
  return text + "; ";
}

}  // namespace tread::ins

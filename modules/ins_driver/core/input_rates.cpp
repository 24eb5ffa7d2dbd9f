// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/input_rates.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace tread::ins {
namespace {

/// Share of poses without an input that is attributed to messages lost on the line.
constexpr double kTolerated = 0.1;
constexpr double kLongestHold = 0.5;  // [s] upper limit in the configuration

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// How often an input arrived in a window, and whether mostly too late to extrapolate the previous
/// one.
struct Pace {
  double rate = 0.0;  ///< [Hz]
  bool slow = false;
};

Pace paceOf(const InputCount& before, const InputCount& after, double seconds) {
  const int64_t came = after.came - before.came;
  return {static_cast<double>(came) / seconds, came > 0 && 2 * (after.apart - before.apart) > came};
}

bool manyOf(int64_t some, int64_t all) {
  return static_cast<double>(some) > kTolerated * static_cast<double>(all);
}

std::string having(const char* what, int64_t some, int64_t all) {
  return std::string(what) + " in " + std::to_string(some) + " of " + std::to_string(all) +
         " poses; ";
}

}  // namespace

std::string InputRates::remedy(const std::string& input, double rate, double needed,
                               const std::string& key, int64_t hold_us) const {
  // A fifth more than its period, so that a late message is still in time.
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
  const Pace positions = paceOf(before.positions, after.positions, seconds);
  const Pace headings = paceOf(before.headings, after.headings, seconds);
  const Pace velocities = paceOf(before.velocities, after.velocities, seconds);
  const int64_t poses = after.published - before.published;
  const int64_t no_heading = after.without_heading - before.without_heading;
  const int64_t no_velocity = after.without_velocity - before.without_velocity;
  const int64_t left_out = after.attitude_only - before.attitude_only;
  if (headings.slow && manyOf(no_heading, poses))
    return having("a heading", poses - no_heading, poses) + messages(end) +
           remedy("headings", headings.rate, positions.rate, "attitude_hold",
                  config_.attitude_hold_us);
  if (velocities.slow && manyOf(no_velocity, poses))
    return having("a velocity", poses - no_velocity, poses) + messages(end) +
           remedy("velocities", velocities.rate, positions.rate, "position_hold",
                  config_.position_hold_us);
  // Attitudes to which no position could be extrapolated.
  if (config_.attitude_epochs && positions.slow && manyOf(left_out, left_out + poses))
    return having("a position near the attitude", poses, left_out + poses) + messages(end) +
           remedy("positions", positions.rate, headings.rate, "position_hold",
                  config_.position_hold_us);
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

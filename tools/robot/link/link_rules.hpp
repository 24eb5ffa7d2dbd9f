// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace tread::link {

/// How much of a channel crosses the link.
struct LinkRule {
  std::string channel;
  double rate = 0.0;  ///< [Hz] limit for each part (tile of MAP, process of HEALTH); 0 = all
};

/// Joins the robot's own bus and the operator station's.
struct LinkConfig {
  std::string station_url;           ///< LCM provider of the link; ttl=1
  std::vector<LinkRule> to_station;  ///< channels of the robot
  std::vector<LinkRule> to_robot;    ///< channels of the station: all their messages cross
  double most = 500.0;               ///< [kB/s] to the station, for rate-limited channels
  std::string effective;             ///< as text, for CONFIG
};

/// Strict; throws ConfigError with file:line. A channel in both directions is refused: it would
/// loop for ever.
LinkConfig readLinkConfig(ConfigReader& reader);

/// Decides which messages of one direction pass.
/** Channels without a rate limit always pass: commands and above all stops. The others share a
 * budget of bytes, with bursts of up to half a second. */
class LinkFilter {
 public:
  LinkFilter(const std::vector<LinkRule>& rules, double most_kilobytes);

  /// Whether a message passes now [us]; `bytes` is the message without its seal, `size` with it.
  bool passes(const std::string& channel, const std::vector<uint8_t>& bytes, size_t size,
              int64_t now);
  bool carries(const std::string& channel) const { return intervals_.count(channel) > 0; }

  int64_t passed() const { return passed_; }
  int64_t thinned() const { return thinned_; }  ///< dropped for their channel's rate
  int64_t over_budget() const { return over_budget_; }

 private:
  std::map<std::string, int64_t> intervals_;  ///< [us] by channel; 0 = all
  /// [us] of the last one that passed, by part
  std::map<std::pair<std::string, uint64_t>, int64_t> last_;
  double most_;         ///< [bytes/s]
  double room_;         ///< [bytes]
  int64_t filled_ = 0;  ///< [us]
  int64_t passed_ = 0, thinned_ = 0, over_budget_ = 0;
};

}  // namespace tread::link

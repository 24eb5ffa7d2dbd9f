// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/link/link_rules.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/channels.hpp"
#include "common/log/message_part.hpp"

namespace tread::link {
namespace {

constexpr double kBurst = 0.5;  // [s] of the budget that a burst may use

/// A map from channel to rate.
std::vector<LinkRule> readRules(ConfigReader reader) {
  std::vector<LinkRule> rules;
  for (const ChannelSpec& spec : kChannels) {
    if (!reader.has(spec.name)) continue;
    LinkRule rule;
    rule.channel = spec.name;
    reader.number(spec.name, rule.rate, {0.0, 1000.0}, "Hz, 0 = all");
    rules.push_back(rule);
  }
  reader.finish();
  return rules;
}

}  // namespace

LinkConfig readLinkConfig(ConfigReader& reader) {
  LinkConfig config;
  reader.text("station_url", config.station_url, true);
  config.to_station = readRules(reader.section("to_station"));
  config.to_robot = readRules(reader.section("to_robot"));
  reader.number("most", config.most, {1.0, 100'000.0}, "kB/s");
  for (const LinkRule& there : config.to_station)
    for (const LinkRule& back : config.to_robot)
      if (there.channel == back.channel)
        throw reader.error("to_robot",
                           there.channel + " is also in to_station: it would loop for ever");
  reader.finish();
  config.effective = reader.effective();
  return config;
}

LinkFilter::LinkFilter(const std::vector<LinkRule>& rules, double most_kilobytes)
    : most_(1000.0 * most_kilobytes), room_(kBurst * most_) {
  for (const LinkRule& rule : rules)
    // A tenth less than the period: jitter must not halve a channel that comes at this very rate.
    intervals_[rule.channel] =
        rule.rate > 0.0 ? static_cast<int64_t>(0.9e6 / rule.rate) : int64_t{0};
}

bool LinkFilter::passes(const std::string& channel, const std::vector<uint8_t>& bytes, size_t size,
                        int64_t now) {
  const auto interval = intervals_.find(channel);
  if (interval == intervals_.end()) return false;
  if (interval->second == 0) {
    ++passed_;
    return true;
  }
  const std::pair part(channel, partOf({now, channel, bytes}));
  const auto last = last_.find(part);
  if (last != last_.end() && now - last->second < interval->second) {
    ++thinned_;
    return false;
  }
  room_ = std::min(kBurst * most_, room_ + most_ * static_cast<double>(now - filled_) * 1e-6);
  filled_ = now;
  if (room_ < static_cast<double>(size)) {
    ++over_budget_;
    return false;
  }
  room_ -= static_cast<double>(size);
  last_[part] = now;
  ++passed_;
  return true;
}

}  // namespace tread::link

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/recipe.hpp"

#include <map>
#include <set>

#include "common/bus/channels.hpp"

namespace tread::replay {
namespace {

/// What each process hears; a test compares it with what the nodes subscribe to.
const std::map<std::string, std::set<std::string>>& inputs() {
  static const std::map<std::string, std::set<std::string>> kInputs{
      {"learner", {"INS", "MOTOR", "EXECUTION"}},
      {"mapping", {"INS", "SCAN"}},
      {"planner", {"INS", "MAP", "GOAL", "PATTERN_SET", "MOTOR", "EXECUTION", "ARM", "ESTOP"}}};
  return kInputs;
}

}  // namespace

std::vector<std::string> playableProcesses() {
  std::vector<std::string> processes;
  for (const auto& [process, channels] : inputs()) processes.push_back(process);
  return processes;
}

std::vector<std::string> playedChannels(const std::string& process) {
  std::vector<std::string> played;
  for (const ChannelSpec& channel : kChannels) {
    const std::string publisher = channel.publisher;
    if (publisher != process && publisher != "every process" &&
        inputs().at(process).count(channel.name) > 0)
      played.push_back(channel.name);
  }
  return played;
}

std::string channelFilter(const std::string& process) {
  std::string filter;
  for (const std::string& channel : playedChannels(process))
    filter += (filter.empty() ? "^(" : "|") + channel;
  return filter + ")$";
}

std::string recipeFor(const std::string& process, const std::string& log) {
  std::string own;
  for (const ChannelSpec& channel : kChannels)
    if (channel.publisher == process) own += (own.empty() ? "" : ", ") + std::string(channel.name);
  const std::string url = "'udpm://239.255.76.67:7669?ttl=0'";
  return "# a bus of its own (LCM tells buses apart by port only), and a state of its own in "
         "--config\n"
         "tread-" +
         process + " --config FILE --lcm-url " + url +
         " &\n"
         "# what " +
         process + " hears; not " + own +
         " (its own past), HEALTH, CONFIG\n"
         "lcm-logplayer --lcm-url=" +
         url + " -s 1 -e '" + channelFilter(process) + "' " + log + "\n";
}

}  // namespace tread::replay

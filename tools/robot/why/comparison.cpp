// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "common/report/text.hpp"
#include "tools/robot/why/debrief.hpp"

namespace tread::why {
namespace {

/// The lines "section.key" with values of a YAML text written by programs.
std::map<std::string, std::string> keysOf(const std::string& process, const std::string& text) {
  std::map<std::string, std::string> keys;
  std::vector<std::pair<size_t, std::string>> sections;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos || line[indent] == '#') continue;
    while (!sections.empty() && sections.back().first >= indent) sections.pop_back();
    const size_t colon = line.find(": ");
    const bool opens = line.back() == ':';
    std::string path = process;
    for (const auto& [depth, name] : sections) path += "." + name;
    if (opens) {
      sections.emplace_back(indent, line.substr(indent, line.size() - indent - 1));
    } else if (colon != std::string::npos && line[indent] != '-') {
      keys[path + "." + line.substr(indent, colon - indent)] = line.substr(colon + 2);
    } else {
      std::string& list = keys[path];
      list += (list.empty() ? "" : ", ") + line.substr(indent);
    }
  }
  return keys;
}

void addFigure(std::vector<Difference>& differences, const char* what, double before, double now,
               double least, const char* format) {
  if (!std::isfinite(before) || !std::isfinite(now) || std::abs(now - before) < least) return;
  char one[32], two[32];
  std::snprintf(one, sizeof one, format, before);
  std::snprintf(two, sizeof two, format, now);
  differences.push_back({what, one, two});
}

std::map<std::string, int> causesOf(const Debrief& debrief) {
  std::map<std::string, int> causes;
  for (const Finding& finding : debrief.findings) ++causes[finding.cause];
  return causes;
}

}  // namespace

std::vector<Difference> configDifferences(const Debrief& before, const Debrief& now) {
  std::map<std::string, std::string> old_keys, new_keys;
  for (const auto& [process, text] : before.configs)
    if (now.configs.count(process) > 0) old_keys.merge(keysOf(process, text));
  for (const auto& [process, text] : now.configs)
    if (before.configs.count(process) > 0) new_keys.merge(keysOf(process, text));
  std::vector<Difference> differences;
  std::set<std::string> names;
  for (const auto& [key, value] : old_keys) names.insert(key);
  for (const auto& [key, value] : new_keys) names.insert(key);
  for (const std::string& key : names) {
    const auto a = old_keys.find(key), b = new_keys.find(key);
    const std::string one = a == old_keys.end() ? "-" : a->second;
    const std::string two = b == new_keys.end() ? "-" : b->second;
    if (one != two) differences.push_back({key, one, two});
  }
  for (const auto& [process, text] : before.configs)
    if (now.configs.count(process) == 0) differences.push_back({process, "ran", "-"});
  for (const auto& [process, text] : now.configs)
    if (before.configs.count(process) == 0) differences.push_back({process, "-", "ran"});
  return differences;
}

std::vector<Difference> driveDifferences(const Debrief& before, const Debrief& now) {
  std::vector<Difference> differences;
  const DriveFigures &a = before.figures, &b = now.figures;
  const auto share = [](const DriveFigures& figures) {
    return figures.patterns > 0 ? 100.0 * figures.measured / static_cast<double>(figures.patterns)
                                : std::nan("");
  };
  addFigure(differences, "goals reached", a.reached, b.reached, 1.0, "%.0f");
  addFigure(differences, "unplanned stops", a.stops, b.stops, 1.0, "%.0f");
  // The median varies by about a fifth between drives.
  addFigure(differences, "median error at a pattern's end [m]", a.error_position, b.error_position,
            0.2 * a.error_position + 0.01, "%.3f");
  addFigure(differences, "median error in yaw [deg]", a.error_yaw * 57.2957795,
            b.error_yaw * 57.2957795, 0.2 * a.error_yaw * 57.2957795 + 0.3, "%.2f");
  addFigure(differences, "patterns with fair measurements [%]", share(a), share(b), 10.0, "%.0f");
  addFigure(differences, "battery at the end [V]", a.battery_end, b.battery_end, 0.3, "%.1f");
  const std::map<std::string, int> old_causes = causesOf(before), new_causes = causesOf(now);
  for (const auto& [cause, count] : new_causes)
    if (old_causes.count(cause) == 0)
      differences.push_back({"cause " + cause, "-", std::to_string(count) + " times"});
  for (const auto& [cause, count] : old_causes)
    if (new_causes.count(cause) == 0)
      differences.push_back({"cause " + cause, std::to_string(count) + " times", "-"});
  return differences;
}

std::string textOfDifferences(const Debrief& before, const Debrief& now) {
  std::string text = "against " + before.name + ":\n";
  const auto lines = [&](const char* title, const std::vector<Difference>& differences) {
    text += std::string("  ") + title + (differences.empty() ? ": the same\n" : "\n");
    for (const Difference& difference : differences)
      text += "    " + difference.what + ": " + difference.before + " -> " + difference.now + "\n";
  };
  lines("drive", driveDifferences(before, now));
  lines("configuration", configDifferences(before, now));
  return text;
}

}  // namespace tread::why

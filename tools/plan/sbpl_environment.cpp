// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "common/config/scalars.hpp"
#include "tools/plan/map_file.hpp"
#include "tools/plan/tokenizer.hpp"

namespace tread::plan {
namespace {

/// What stands before the cells.
struct Header {
  int width = 0;
  int height = 0;
  double cell_size = 0.0;
};

/// Reads the value of a key of the header.
using Readers = std::map<std::string, std::function<void()>>;

Pose2 readPose(Tokenizer& tokens, const std::string& what) {
  const double x = tokens.number(what + "'s x", {-1e6, 1e6}, "m");
  const double y = tokens.number(what + "'s y", {-1e6, 1e6}, "m");
  return {x, y, tokens.number(what + "'s heading", {-100.0, 100.0}, "rad")};
}

Readers readersOf(Tokenizer& tokens, Header& header, MapFile& map) {
  const auto threshold = [&tokens](int& value, int64_t min) {
    value = static_cast<int>(tokens.integer("the threshold", min, 256));
  };
  return {
      {"discretization(cells):",
       [&] {
         header.width = static_cast<int>(tokens.integer("the width", 1, kLongestSide));
         header.height = static_cast<int>(tokens.integer("the height", 1, kLongestSide));
       }},
      {"obsthresh:", [&, threshold] { threshold(map.thresholds.obstacle, 1); }},
      {"cost_inscribed_thresh:", [&, threshold] { threshold(map.thresholds.inscribed, 1); }},
      {"cost_possibly_circumscribed_thresh:",
       [&, threshold] { threshold(map.thresholds.possibly_circumscribed, -1); }},
      {"cellsize(meters):",
       [&] {
         header.cell_size = tokens.number("the cell size", {1e-3, 100.0}, "m");
       }},
      {"nominalvel(mpersecs):",
       [&] {
         map.nominal_speed = tokens.number("the speed", {1e-3, 100.0}, "m/s");
       }},
      {"timetoturn45degsinplace(secs):",
       [&] {
         map.turn_time = tokens.number("the time to turn", {1e-3, 1e4}, "s");
       }},
      {"start(meters,rads):", [&] { map.T_map_start = readPose(tokens, "the start"); }},
      {"end(meters,rads):", [&] { map.T_map_goal = readPose(tokens, "the end"); }},
  };
}

std::string keysWithout(const Readers& readers, const std::set<std::string>& seen) {
  std::vector<std::string> keys;
  for (const auto& [key, read] : readers)
    if (seen.count(key) == 0) keys.push_back(key);
  return joinWords(keys);
}

/// Up to and with the word "environment:".
Header readHeader(Tokenizer& tokens, MapFile& map) {
  Header header;
  const Readers readers = readersOf(tokens, header, map);
  std::set<std::string> seen;
  for (;;) {
    const std::string key(tokens.next("environment:").substr(0, 60));
    if (key == "environment:") break;
    const auto reader = readers.find(key);
    if (reader == readers.end())
      throw tokens.error(formatText(key) + " is no key of an SBPL environment (x, y, theta); " +
                         "missing so far: " + keysWithout(readers, seen));
    if (!seen.insert(key).second) throw tokens.error(key + " stands there twice");
    reader->second();
  }
  if (seen.size() < readers.size())
    throw tokens.error("missing before environment: " + keysWithout(readers, seen));
  return header;
}

std::vector<uint8_t> readCosts(Tokenizer& tokens, const Header& header) {
  const auto count = static_cast<int64_t>(header.width) * header.height;
  const std::string size = std::to_string(header.width) + " x " + std::to_string(header.height);
  if (count > kMostCells)
    throw tokens.error(size + " are more than " + std::to_string(kMostCells) + " cells");
  // A cost is a digit and a blank at least: nothing is reserved for what cannot be there.
  if (static_cast<int64_t>(tokens.left()) + 1 < 2 * count)
    throw tokens.error("the file is too short for the costs of " + size +
                       " cells; it is truncated");
  std::vector<uint8_t> costs;
  costs.reserve(static_cast<size_t>(count));
  while (static_cast<int64_t>(costs.size()) < count)
    costs.push_back(static_cast<uint8_t>(tokens.integer("a cost", 0, 255)));
  if (!tokens.atEnd()) throw tokens.error("more costs than those of " + size + " cells follow");
  return costs;
}

}  // namespace

MapFile parseSbplEnvironment(std::string text, const std::string& name) {
  Tokenizer tokens(std::move(text), name);
  MapFile map;
  map.name = name;
  const Header header = readHeader(tokens, map);
  map.costs = readCosts(tokens, header);
  map.grid = Grid(header.cell_size, {0, 0}, header.width, header.height);
  map.grid = gridForFootprint(map);
  return map;
}

}  // namespace tread::plan

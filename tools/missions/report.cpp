// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <ostream>
#include <stdexcept>

#include "common/report/text.hpp"
#include "tools/missions/campaign_json.hpp"
#include "tools/missions/stop_report.hpp"

namespace tread::missions {
namespace {

void printShares(std::ostream& out, const Campaign& campaign) {
  const auto total = static_cast<double>(std::max<size_t>(1, campaign.results.size()));
  for (const Outcome outcome :
       {Outcome::kArrived, Outcome::kRefused, Outcome::kIdle, Outcome::kStopped}) {
    const int count = countOf(campaign, outcome);
    out << formatted("%-9s %4d  %5.1f %%\n", nameOf(outcome), count, 100.0 * count / total);
    std::map<std::string, int> reasons;
    for (const MissionResult& result : campaign.results)
      if (result.outcome == outcome && !result.reason.empty()) ++reasons[result.reason];
    for (const auto& [reason, times] : reasons)
      out << formatted("          %4d  %s\n", times, reason.c_str());
  }
}

void printErrors(std::ostream& out, const Campaign& campaign, int first, int last) {
  const auto errors = errorsAfterChange(campaign.results, first, last);
  if (errors.empty()) return;
  out << formatted("prediction error of patterns %d..%d after a change of surface, rule %s:\n",
                   first, last, campaign.rule.c_str());
  out << "  from     to        count  position [m]  yaw [rad]  position [m/m]  yaw [rad/rad]\n";
  ErrorAfterChange all;
  for (const ErrorAfterChange& error : errors) {
    if (error.from == "start") continue;
    all.count += error.count;
    all.position += error.count * error.position;
    all.yaw += error.count * error.yaw;
  }
  for (const ErrorAfterChange& error : errors)
    out << formatted("  %-8s %-8s %6d  %12.4f  %9.4f  %14.4f  %13.4f\n", error.from.c_str(),
                     error.to.c_str(), error.count, error.position, error.yaw, error.position_per_m,
                     error.yaw_per_rad);
  if (all.count > 0)
    out << formatted("  %-17s %6d  %12.4f  %9.4f\n", "all changes", all.count,
                     all.position / all.count, all.yaw / all.count);
}

/// Position and yaw error; a dash where nothing was measured.
std::string errorText(double position, double yaw) {
  if (!std::isfinite(position)) return "-";
  return formatted("%.3f m %.3f rad", position, yaw);
}

nlohmann::ordered_json errorsJson(const Campaign& campaign, int first, int last) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ErrorAfterChange& error : errorsAfterChange(campaign.results, first, last))
    rows.push_back({{"from", error.from},
                    {"to", error.to},
                    {"count", error.count},
                    {"position_m", error.position},
                    {"yaw_rad", error.yaw},
                    {"position_per_m", error.position_per_m},
                    {"yaw_per_rad", error.yaw_per_rad}});
  return rows;
}

nlohmann::ordered_json stopsJson(const MissionResult& result) {
  nlohmann::ordered_json stops = nlohmann::ordered_json::array();
  for (const Stop& stop : result.stops)
    stops.push_back(
        {{"time_s", stop.time}, {"duration_s", stop.duration}, {"reason", stop.reason}});
  return stops;
}

nlohmann::ordered_json flipsJson(const MissionResult& result) {
  nlohmann::ordered_json flips = nlohmann::ordered_json::array();
  for (const Flip& flip : result.flips)
    flips.push_back({{"time_s", flip.time}, {"from", flip.from}, {"to", flip.to}});
  return flips;
}

void addSteadiness(nlohmann::ordered_json& json, const Campaign& campaign) {
  const Steadiness steadiness = steadinessOf(campaign.results);
  json["driven_s"] = steadiness.driven;
  json["flips"] = steadiness.flips;
  json["flips_per_min"] = steadiness.flipsPerMinute();
  json["stops"] = steadiness.stops;
  json["stops_per_mission"] =
      steadiness.stops / static_cast<double>(std::max<size_t>(1, campaign.results.size()));
  json["stop_reasons"] = nlohmann::ordered_json::object();
  for (const auto& [reason, count] : steadiness.reasons) json["stop_reasons"][reason] = count;
}

nlohmann::ordered_json runJson(const MissionResult& result) {
  nlohmann::ordered_json crossings = nlohmann::ordered_json::array();
  for (size_t i = 0; i < result.crossings.size(); ++i) {
    const Crossing& crossing = result.crossings[i];
    const ErrorAroundChange errors = errorsAround(result, i);
    crossings.push_back({{"time_s", crossing.time},
                         {"from", crossing.from},
                         {"to", crossing.to},
                         {"before_m", errors.before_position},
                         {"before_rad", errors.before_yaw},
                         {"after_m", errors.after_position},
                         {"after_rad", errors.after_yaw},
                         {"settled_m", errors.settled_position},
                         {"settled_rad", errors.settled_yaw}});
  }
  nlohmann::ordered_json contacts = nlohmann::ordered_json::array();
  for (const Contact& contact : result.contacts)
    contacts.push_back({{"time_s", contact.time},
                        {"pattern", contact.pattern},
                        {"x_m", contact.T_map_body.x},
                        {"y_m", contact.T_map_body.y},
                        {"yaw_rad", contact.T_map_body.yaw},
                        {"penetration_m", contact.penetration}});
  return {{"seed", result.seed},
          {"result", nameOf(result.outcome)},
          {"reason", result.reason},
          {"collisions", result.collisions},
          {"time_s", result.time},
          {"begun_s", result.begun},
          {"driven_s", result.driven},
          {"distance_m", result.distance},
          {"straight_m", result.straight_line},
          {"detour", result.detour()},
          {"line_blocked", result.line_blocked},
          {"surface_changes", result.surface_changes},
          {"crossings", crossings},
          {"contacts", contacts},
          {"stops", stopsJson(result)},
          {"flips", flipsJson(result)},
          {"patterns", result.completed},
          {"aborted", result.aborted},
          {"rearmed", result.rearmed},
          {"set_versions", result.set_versions}};
}

}  // namespace

int countOf(const Campaign& campaign, Outcome outcome) {
  return static_cast<int>(
      std::count_if(campaign.results.begin(), campaign.results.end(),
                    [&](const MissionResult& r) { return r.outcome == outcome; }));
}

int collisionsOf(const Campaign& campaign) {
  int collisions = 0;
  for (const MissionResult& result : campaign.results) collisions += result.collisions;
  return collisions;
}

std::string lineOf(const MissionResult& result) {
  return formatted(
      "seed %-6llu %-8s %5.1f s  %5.1f m  detour %4.2f  patterns %3d  crossings %zu of %d  "
      "collisions %d  stops %zu  flips %zu%s%s",
      static_cast<unsigned long long>(result.seed), nameOf(result.outcome), result.time,
      result.distance, result.detour(), result.completed, result.crossings.size(),
      result.surface_changes, result.collisions, result.stops.size(), result.flips.size(),
      result.reason.empty() ? "" : "  ", result.reason.c_str());
}

std::string crossingsOf(const MissionResult& result) {
  std::string lines;
  for (size_t i = 0; i < result.crossings.size(); ++i) {
    const Crossing& crossing = result.crossings[i];
    const ErrorAroundChange errors = errorsAround(result, i);
    lines += formatted("  %6.1f s  %-6s to %-6s  error before / after / settled: ", crossing.time,
                       crossing.from.c_str(), crossing.to.c_str());
    lines += errorText(errors.before_position, errors.before_yaw) + " / " +
             errorText(errors.after_position, errors.after_yaw) + " / " +
             errorText(errors.settled_position, errors.settled_yaw) + '\n';
  }
  return lines;
}

void printSummary(std::ostream& out, const Campaign& campaign) {
  printShares(out, campaign);
  int blocked = 0;
  for (const MissionResult& result : campaign.results) blocked += result.line_blocked ? 1 : 0;
  out << formatted("collisions %d; straight line blocked in %d of %zu missions\n",
                   collisionsOf(campaign), blocked, campaign.results.size());
  printSteadiness(out, campaign.results);
  out << formatted("%.0f s of virtual time in %.0f s: %.1f times real time per core\n",
                   campaign.virtual_time, campaign.wall_time,
                   campaign.virtual_time / std::max(1e-9, campaign.cpu_time));
  printErrors(out, campaign, 1, 3);
  printErrors(out, campaign, 5, 15);
}

nlohmann::ordered_json campaignJson(const Campaign& campaign) {
  nlohmann::ordered_json json;
  json["missions"] = campaign.results.size();
  json["arrived"] = countOf(campaign, Outcome::kArrived);
  json["refused"] = countOf(campaign, Outcome::kRefused);
  json["idle"] = countOf(campaign, Outcome::kIdle);
  json["stopped"] = countOf(campaign, Outcome::kStopped);
  json["collisions"] = collisionsOf(campaign);
  addSteadiness(json, campaign);
  json["virtual_s"] = campaign.virtual_time;
  json["wall_s"] = campaign.wall_time;
  json["cpu_s"] = campaign.cpu_time;
  json["seed"] = campaign.seed;
  json["rule"] = campaign.rule;
  json["set"] = campaign.overrides;
  json["errors_1_to_3"] = errorsJson(campaign, 1, 3);
  json["errors_5_to_15"] = errorsJson(campaign, 5, 15);
  json["runs"] = nlohmann::ordered_json::array();
  for (const MissionResult& result : campaign.results) json["runs"].push_back(runJson(result));
  return json;
}

void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json) {
  std::ofstream file(path);
  // A reason comes from a message, which may have been broken: its bytes need not be UTF-8.
  file << json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot write the report");
}

void writeJson(const std::string& path, const Campaign& campaign) {
  writeJsonFile(path, campaignJson(campaign));
}

}  // namespace tread::missions

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/report.hpp"

#include <algorithm>
#include <cctype>
#include <ostream>
#include <stdexcept>

#include "common/report/text.hpp"
#include "common/store/store.hpp"
#include "tools/lab/missions/world_report.hpp"

namespace tread::missions {
namespace {

using Json = nlohmann::ordered_json;

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

void printShares(std::ostream& out, const MissionBatch& batch) {
  const auto total = static_cast<double>(std::max<size_t>(1, batch.results.size()));
  out << "outcome   missions  [%]\n";
  for (const MissionOutcome outcome :
       {MissionOutcome::kArrived, MissionOutcome::kRefused, MissionOutcome::kIdle,
        MissionOutcome::kStopped, MissionOutcome::kContact}) {
    if (outcome == MissionOutcome::kContact && countOf(batch, outcome) == 0) continue;
    const int count = countOf(batch, outcome);
    out << formatted("%-9s %4d  %5.1f %%\n", nameOf(outcome), count, 100.0 * count / total);
    std::map<std::string, int> reasons;
    for (const MissionResult& result : batch.results)
      if (result.outcome == outcome && !result.reason.empty()) ++reasons[result.reason];
    for (const auto& [reason, times] : reasons)
      out << formatted("          %4d  %s\n", times, reason.c_str());
  }
}

/// Prints the most frequent one first.
void printReasons(std::ostream& out, const std::map<std::string, int>& counts) {
  std::vector<std::pair<int, std::string>> reasons;
  for (const auto& [reason, count] : counts) reasons.emplace_back(-count, reason);
  std::sort(reasons.begin(), reasons.end());
  for (const auto& [count, reason] : reasons) {
    out << formatted("          %4d  ", -count)
        << (reason.empty() ? "(no reason published)" : reason) << '\n';
  }
}

void printSteadiness(std::ostream& out, const std::vector<MissionResult>& results) {
  const Steadiness steadiness = steadinessOf(results);
  const auto missions = static_cast<double>(std::max<size_t>(1, results.size()));
  out << formatted("flips %d: %.2f per minute driven (%.0f s)\n", steadiness.flips,
                   steadiness.flipsPerMinute(), steadiness.driven);
  out << formatted("stops %d: %.2f per mission, at most %d (seed %llu), %.0f s in all\n",
                   steadiness.stops, steadiness.stops / missions, steadiness.most_stops,
                   static_cast<unsigned long long>(steadiness.most_seed), steadiness.stood);
  printReasons(out, steadiness.reasons);
  int disarmed = 0;
  for (const auto& [reason, count] : steadiness.disarmed) disarmed += count;
  out << formatted("disarmed %d: %.2f per hour driven\n", disarmed,
                   disarmed / std::max(1e-9, steadiness.driven / 3600.0));
  printReasons(out, steadiness.disarmed);
  int refused = 0;
  for (const auto& [reason, count] : steadiness.refused) refused += count;
  out << formatted("executions %d, of which %d were not learned from\n", steadiness.executions,
                   refused);
  printReasons(out, steadiness.refused);
}

void printErrors(std::ostream& out, const MissionBatch& batch, int first, int last) {
  const auto errors = errorsAfterChange(batch.results, first, last);
  if (errors.empty()) return;
  out << formatted("prediction error of patterns %d..%d after a change of surface, rule %s:\n",
                   first, last, batch.rule.c_str());
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

/// For the headline: the error of predictions after changes of surface; empty if there were none.
std::string errorsInShort(const MissionBatch& batch) {
  const ErrorsAroundChanges errors = errorsAroundChanges(batch.results, errorAsDriven());
  if (errors.after.count == 0 || errors.settled.count == 0) return "";
  return formatted(
      "; prediction error after a change of surface %.3f m %.3f rad (patterns 1..3), then %.3f m "
      "%.3f rad (5..15)",
      errors.after.position, errors.after.yaw, errors.settled.position, errors.settled.yaw);
}

/// Position and yaw error; a dash if not measured.
std::string errorText(const MeanError& error) {
  return error.count == 0 ? "-" : formatted("%.3f m %.3f rad", error.position, error.yaw);
}

Json errorsJson(const MissionBatch& batch, int first, int last) {
  Json rows = Json::array();
  for (const ErrorAfterChange& error : errorsAfterChange(batch.results, first, last)) {
    rows.push_back({{"from", error.from}, {"to", error.to}});
    rows.back().update(errorJson(error));
  }
  return rows;
}

Json stopsJson(const MissionResult& result) {
  Json stops = Json::array();
  for (const Stop& stop : result.stops)
    stops.push_back(
        {{"time_s", stop.time}, {"duration_s", stop.duration}, {"reason", stop.reason}});
  return stops;
}

Json flipsJson(const MissionResult& result) {
  Json flips = Json::array();
  for (const Flip& flip : result.flips)
    flips.push_back({{"time_s", flip.time}, {"from", flip.from}, {"to", flip.to}});
  return flips;
}

void addSteadiness(Json& json, const MissionBatch& batch) {
  const Steadiness steadiness = steadinessOf(batch.results);
  json["driven_s"] = steadiness.driven;
  json["flips"] = steadiness.flips;
  json["flips_per_min"] = steadiness.flipsPerMinute();
  json["stops"] = steadiness.stops;
  json["stops_per_mission"] =
      steadiness.stops / static_cast<double>(std::max<size_t>(1, batch.results.size()));
  json["stop_reasons"] = Json::object();
  for (const auto& [reason, count] : steadiness.reasons) json["stop_reasons"][reason] = count;
  json["disarm_reasons"] = Json::object();
  for (const auto& [reason, count] : steadiness.disarmed) json["disarm_reasons"][reason] = count;
  json["executions"] = steadiness.executions;
  json["refusals"] = Json::object();
  for (const auto& [reason, count] : steadiness.refused) json["refusals"][reason] = count;
}

/// null if not measured.
void addError(Json& json, const std::string& when, const MeanError& error) {
  json[when + "_m"] = error.count > 0 ? Json(error.position) : Json(nullptr);
  json[when + "_rad"] = error.count > 0 ? Json(error.yaw) : Json(nullptr);
}

Json disarmingsJson(const MissionResult& result) {
  Json disarmings = Json::array();
  for (const Disarming& disarming : result.disarmings)
    disarmings.push_back({{"time_s", disarming.time}, {"reason", disarming.reason}});
  return disarmings;
}

Json runJson(const MissionResult& result) {
  Json crossings = Json::array();
  for (size_t i = 0; i < result.crossings.size(); ++i) {
    const Crossing& crossing = result.crossings[i];
    const ErrorsAroundChanges errors = errorsAroundChange(result, i);
    crossings.push_back({{"time_s", crossing.time}, {"from", crossing.from}, {"to", crossing.to}});
    addError(crossings.back(), "before", errors.before);
    addError(crossings.back(), "after", errors.after);
    addError(crossings.back(), "settled", errors.settled);
  }
  Json contacts = Json::array();
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
          {"collisions", result.collisions()},
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
          {"disarmings", disarmingsJson(result)},
          {"rearmed", result.rearmed},
          {"set_versions", result.set_versions}};
}

}  // namespace

std::string withoutNumbers(const std::string& reason) {
  std::string kind;
  for (size_t i = 0; i < reason.size(); ++i) {
    const bool after_number = !kind.empty() && kind.back() == '#';
    const bool point = reason[i] == '.' && i + 1 < reason.size() && isDigit(reason[i + 1]);
    if (after_number && (isDigit(reason[i]) || point)) continue;
    kind += isDigit(reason[i]) ? '#' : reason[i];
  }
  std::replace(kind.begin(), kind.end(), '#', 'N');
  return kind;
}

Steadiness steadinessOf(const std::vector<MissionResult>& results) {
  Steadiness steadiness;
  for (const MissionResult& result : results) {
    const auto stops = static_cast<int>(result.stops.size());
    steadiness.driven += result.driven;
    steadiness.flips += static_cast<int>(result.flips.size());
    steadiness.stops += stops;
    if (stops > steadiness.most_stops) steadiness.most_seed = result.seed;
    steadiness.most_stops = std::max(steadiness.most_stops, stops);
    for (const Disarming& disarming : result.disarmings)
      ++steadiness.disarmed[withoutNumbers(disarming.reason)];
    steadiness.executions += static_cast<int>(result.executions.size());
    for (const ScoredExecution& execution : result.executions)
      if (!execution.measured) ++steadiness.refused[withoutNumbers(execution.refusal)];
    for (const Stop& stop : result.stops) {
      steadiness.stood += stop.duration;
      ++steadiness.reasons[withoutNumbers(stop.reason)];
    }
  }
  return steadiness;
}

int countOf(const MissionBatch& batch, MissionOutcome outcome) {
  return static_cast<int>(
      std::count_if(batch.results.begin(), batch.results.end(),
                    [&](const MissionResult& r) { return r.outcome == outcome; }));
}

int collisionsOf(const MissionBatch& batch) {
  int collisions = 0;
  for (const MissionResult& result : batch.results) collisions += result.collisions();
  return collisions;
}

std::string resultOf(const MissionBatch& batch, uint64_t seed) {
  const auto found = std::find_if(batch.results.begin(), batch.results.end(),
                                  [&](const MissionResult& result) { return result.seed == seed; });
  if (found == batch.results.end())
    throw std::out_of_range("no mission with seed " + std::to_string(seed));
  const MissionResult& result = *found;
  const auto counted = [](size_t count, const char* what) {
    return formatted("%zu %s%s", count, what, count == 1 ? "" : "s");
  };
  std::string words = batch.rule + " " + nameOf(result.outcome) +
                      formatted(" after %.0f s, ", result.time) +
                      counted(result.stops.size(), "stop");
  if (!result.contacts.empty()) words += ", " + counted(result.contacts.size(), "contact");
  return words;
}

std::string outcomesOf(const std::vector<MissionBatch>& batches, const std::string& what) {
  const size_t count = batches.empty() ? 0 : batches.front().results.size();
  std::string arrived, contacts;
  for (const MissionBatch& batch : batches) {
    const std::string separator = arrived.empty() ? "" : ", ";
    const int arrivals = countOf(batch, MissionOutcome::kArrived);
    arrived += separator + batch.rule + formatted(" %d", arrivals);
    contacts += separator + batch.rule + formatted(" %d", collisionsOf(batch));
  }
  const std::string all = formatted("%zu %s%s", count, what.c_str(), count == 1 ? "" : "s");
  if (batches.size() != 1) return all + " each: arrived " + arrived + "; contacts " + contacts;
  return all + formatted(": %d arrived, contacts %d",
                         countOf(batches.front(), MissionOutcome::kArrived),
                         collisionsOf(batches.front()));
}

std::string lineOf(const MissionResult& result) {
  if (result.timed) return timedLineOf(result);
  return formatted(
      "seed %-6llu %-8s %5.1f s  %5.1f m  detour %4.2f  patterns %3d  crossings %zu of %d  "
      "collisions %d  stops %zu  flips %zu%s%s",
      static_cast<unsigned long long>(result.seed), nameOf(result.outcome), result.time,
      result.distance, result.detour(), result.completed, result.crossings.size(),
      result.surface_changes, result.collisions(), result.stops.size(), result.flips.size(),
      result.reason.empty() ? "" : "  ", result.reason.c_str());
}

std::string crossingsOf(const MissionResult& result) {
  std::string lines;
  for (size_t i = 0; i < result.crossings.size(); ++i) {
    const Crossing& crossing = result.crossings[i];
    const ErrorsAroundChanges errors = errorsAroundChange(result, i);
    lines += formatted("  %6.1f s  %-6s to %-6s  error before / after / settled: ", crossing.time,
                       crossing.from.c_str(), crossing.to.c_str());
    lines += errorText(errors.before) + " / " + errorText(errors.after) + " / " +
             errorText(errors.settled) + '\n';
  }
  return lines;
}

void printSummary(std::ostream& out, const MissionBatch& batch) {
  out << outcomesOf({batch}) << errorsInShort(batch) << '\n';
  printShares(out, batch);
  int blocked = 0;
  for (const MissionResult& result : batch.results) blocked += result.line_blocked ? 1 : 0;
  out << formatted("collisions %d; straight line blocked in %d of %zu missions\n",
                   collisionsOf(batch), blocked, batch.results.size());
  printSteadiness(out, batch.results);
  out << formatted("%.0f s of virtual time in %.0f s: %.1f times real time per core\n",
                   batch.virtual_time, batch.wall_time,
                   batch.virtual_time / std::max(1e-9, batch.cpu_time));
  printErrors(out, batch, 1, 3);
  printErrors(out, batch, 5, 15);
}

nlohmann::ordered_json errorJson(const MeanError& error) {
  return {{"count", error.count},
          {"position_m", error.position},
          {"yaw_rad", error.yaw},
          {"position_per_m", error.position_per_m},
          {"yaw_per_rad", error.yaw_per_rad}};
}

nlohmann::ordered_json batchJson(const MissionBatch& batch) {
  Json json;
  json["missions"] = batch.results.size();
  json["arrived"] = countOf(batch, MissionOutcome::kArrived);
  json["refused"] = countOf(batch, MissionOutcome::kRefused);
  json["idle"] = countOf(batch, MissionOutcome::kIdle);
  json["stopped"] = countOf(batch, MissionOutcome::kStopped);
  json["contact"] = countOf(batch, MissionOutcome::kContact);
  json["collisions"] = collisionsOf(batch);
  addSteadiness(json, batch);
  json["virtual_s"] = batch.virtual_time;
  json["wall_s"] = batch.wall_time;
  json["cpu_s"] = batch.cpu_time;
  json["seed"] = batch.seed;
  json["rule"] = batch.rule;
  json["set"] = batch.overrides;
  json["errors_1_to_3"] = errorsJson(batch, 1, 3);
  json["errors_5_to_15"] = errorsJson(batch, 5, 15);
  json["runs"] = Json::array();
  for (const MissionResult& result : batch.results) json["runs"].push_back(runJson(result));
  return json;
}

void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json) {
  // A reason may come from a corrupted message, so its bytes need not be UTF-8.
  writeText(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

void writeJson(const std::string& path, const MissionBatch& batch) {
  writeJsonFile(path, batchJson(batch));
}

}  // namespace tread::missions

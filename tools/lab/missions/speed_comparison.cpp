// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/speed_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ostream>

#include "common/report/text.hpp"

namespace tread::missions {
namespace {

using Json = nlohmann::ordered_json;

/// Slowest class of forward motion, with a margin for learning [m/s].
double slowSpeed(const PatternSet& set) {
  double slowest = 1e9;
  for (const MotionClass& motion : set.content().classes)
    if (motion.twist.v_x > 0.05) slowest = std::min(slowest, motion.twist.v_x);
  return 1.3 * slowest;
}

const std::map<std::string, std::function<void(RobotConfig&)>> kMethods{
    {"fast", [](RobotConfig& robot) { robot.planner.search.shock.weight = 0.0; }},
    {"slow",
     [](RobotConfig& robot) {
       robot.planner.search.shock.weight = 0.0;
       robot.planner.search.top_speed = slowSpeed(robot.learner.shipped);
     }},
    {"seen", [](RobotConfig& robot) { robot.learner.shock = false; }},
    {"felt", [](RobotConfig& robot) { robot.mapping.map.roughness.range_noise = 0.0; }},
    {"learned", [](RobotConfig&) {}}};

/// A mean over missions and half of its 95 % interval.
struct Mean {
  double value = 0.0;
  double half = 0.0;
};

Mean meanOf(const MissionBatch& batch, const std::function<double(const MissionResult&)>& of) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const MissionResult& result : batch.results) {
    const double value = of(result);
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  if (count < 2.0) return {count > 0.0 ? sum / count : std::nan(""), std::nan("")};
  const double mean = sum / count;
  const double variance = std::max(0.0, squares / count - mean * mean) * count / (count - 1.0);
  return {mean, 1.96 * std::sqrt(variance / count)};
}

/// A printed column: name with unit, and the value of a mission.
struct Column {
  const char* name;
  std::function<double(const MissionResult&)> of;
};

double speedOn(const sim::Shaking& ground) {
  return ground.time > 0.0 ? ground.distance / ground.time : std::nan("");
}

const std::vector<Column>& columns() {
  static const std::vector<Column> kColumns{
      {"time to goal s",
       [](const MissionResult& r) {
         return r.outcome == MissionOutcome::kArrived ? r.time - r.begun : std::nan("");
       }},
      {"smooth m/s", [](const MissionResult& r) { return speedOn(r.smooth); }},
      {"rough m/s", [](const MissionResult& r) { return speedOn(r.rough); }},
      {"rough RMS m/s2",
       [](const MissionResult& r) { return r.rough.rms(r.rough.acceleration_sum); }},
      {"rough peak m/s2", [](const MissionResult& r) { return r.rough.acceleration_peak; }},
      {"rough deg/s RMS",
       [](const MissionResult& r) { return 180.0 / kPi * r.rough.rms(r.rough.pitch_rate_sum); }},
      {"error cm", [](const MissionResult& r) {
         double sum = 0.0;
         int count = 0;
         for (const ScoredExecution& execution : r.executions)
           if (execution.measured) sum += 100.0 * execution.error_position, ++count;
         return count > 0 ? sum / count : std::nan("");
       }}};
  return kColumns;
}

}  // namespace

const std::vector<std::string>& speedMethods() {
  static const std::vector<std::string> kNames{"fast", "slow", "seen", "felt", "learned"};
  return kNames;
}

RobotConfig withSpeedBy(const std::string& method, RobotConfig robot) {
  kMethods.at(method)(robot);
  return robot;
}

void printSpeeds(std::ostream& out, const SpeedComparison& comparison) {
  out << '\n' << outcomesOf(comparison.batches) << '\n';
  out << formatted("%-8s %8s %9s", "speed", "arrived", "contacts");
  for (const Column& column : columns()) out << formatted(" %16s", column.name);
  out << '\n';
  for (const MissionBatch& batch : comparison.batches) {
    out << formatted("%-8s %4d/%-3zu %9d", batch.rule.c_str(),
                     countOf(batch, MissionOutcome::kArrived), batch.results.size(),
                     collisionsOf(batch));
    for (const Column& column : columns()) {
      const Mean mean = meanOf(batch, column.of);
      out << formatted(" %8.2f +- %4.2f", mean.value, mean.half);
    }
    out << '\n';
  }
  out << "means over missions with their 95 % intervals, from the true motion, not from the INS\n";
}

void writeSpeeds(const std::string& path, const SpeedComparison& comparison) {
  Json json = Json::array();
  for (const MissionBatch& batch : comparison.batches) {
    Json one{{"speed", batch.rule}};
    for (const Column& column : columns()) {
      const Mean mean = meanOf(batch, column.of);
      one[column.name] = {{"mean", mean.value}, {"half_interval", mean.half}};
    }
    one["batch"] = batchJson(batch);
    json.push_back(one);
  }
  writeJsonFile(path, json);
}

}  // namespace tread::missions

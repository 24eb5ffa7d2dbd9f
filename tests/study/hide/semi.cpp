// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/semi.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/noise.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/event_edit.hpp"
#include "tests/study/hide/rng.hpp"

namespace tread::blind {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = kPi / 180.0;

using Events = std::vector<LogEvent>;

Eigen::Quaterniond attitudeOf(const ins_t& ins) {
  return {ins.orientation[0], ins.orientation[1], ins.orientation[2], ins.orientation[3]};
}

/// Sorts all events by time again, and renumbers INS messages.
void putInOrder(Events& events) {
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
  int64_t seq = 0;
  editEach(events, kIns, [&](ins_t& ins) { ins.seq = seq++; });
}

void delayAll(double seconds, Events& events) {
  const auto late = static_cast<int64_t>(std::llround(seconds * 1e6));
  editEach(events, kIns, [&](ins_t& ins) { ins.utime += late; });
  for (LogEvent& event : events)
    if (event.channel == kIns.name) event.utime += late;
  putInOrder(events);
}

/// A message with only the gyro, because its pose is late.
ins_t withoutPose(ins_t ins) {
  std::fill_n(ins.position, 3, kUnknown);
  std::fill_n(ins.orientation, 4, kUnknown);
  ins.ins_status |=
      ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING | ins_t::STATUS_NO_ATTITUDE;
  ins.ins_status &= ~(ins_t::STATUS_JUMP | ins_t::STATUS_GAP);
  return ins;
}

bool hasPose(const ins_t& ins) {
  return (ins.ins_status & (ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING)) == 0;
}

/// Poses get later stamps, the gyro does not. A pose gets the gyro value of its new time if there
/// is one at exactly that time.
void delayPoses(double seconds, Events& events) {
  const auto late = static_cast<int64_t>(std::llround(seconds * 1e6));
  std::map<int64_t, ins_t> messages;
  std::vector<ins_t> poses;
  for (const ins_t& ins : messagesOf(events, kIns)) {
    if (std::isfinite(ins.rate[2])) messages[ins.utime] = withoutPose(ins);
    if (hasPose(ins)) poses.push_back(ins);
  }
  for (ins_t pose : poses) {
    pose.utime += late;
    const auto gyro = messages.find(pose.utime);
    pose.rate[2] = gyro == messages.end() ? kUnknown : gyro->second.rate[2];
    messages[pose.utime] = pose;
  }
  events.erase(std::remove_if(events.begin(), events.end(),
                              [](const LogEvent& event) { return event.channel == kIns.name; }),
               events.end());
  for (const auto& message : messages) events.push_back(eventOf(kIns, message.second));
  putInOrder(events);
}

void editPoses(Events& events, const std::function<void(ins_t&)>& change) {
  editEach(events, kIns, [&](ins_t& ins) {
    if (hasPose(ins)) change(ins);
  });
}

void turnHeading(double psi, Events& events) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-psi, Eigen::Vector3d::UnitZ()));
  editPoses(events, [&](ins_t& ins) {
    const Eigen::Quaterniond q = turn * attitudeOf(ins);
    ins.orientation[0] = q.w();
    ins.orientation[1] = q.x();
    ins.orientation[2] = q.y();
    ins.orientation[3] = q.z();
  });
}

void moveAntenna(const Eigen::Vector3d& arm, Events& events) {
  editPoses(events, [&](ins_t& ins) {
    const Eigen::Vector3d moved = attitudeOf(ins) * arm;
    for (int i = 0; i < 3; ++i) ins.position[i] += moved[i];
  });
}

/// Changes commands; `share` is the elapsed share of the drive, 0..1.
void editCommands(Events& events,
                  const std::function<void(double share, double& left, double& right)>& change) {
  const auto motors = messagesOf(events, kMotor);
  if (motors.empty()) throw std::runtime_error("the log has no MOTOR messages to change");
  const int64_t first = motors.front().utime;
  const auto span = static_cast<double>(std::max<int64_t>(1, motors.back().utime - first));
  editEach(events, kMotor, [&](motor_t& motor) {
    double left = static_cast<double>(motor.command[0]);
    double right = static_cast<double>(motor.command[1]);
    change(static_cast<double>(motor.utime - first) / span, left, right);
    motor.command[0] = static_cast<float>(left);
    motor.command[1] = static_cast<float>(right);
  });
}

/// More or less yaw from a time on: stores the difference of commands that would have been needed.
void changeYawGain(double gain, double when, Events& events) {
  editCommands(events, [=](double share, double& left, double& right) {
    if (share < when) return;
    const double mean = 0.5 * (left + right);
    const double half = 0.5 * (right - left) / (1.0 + gain);
    left = mean - half;
    right = mean + half;
  });
}

void hideInCommands(const std::string& effect, double value, Events& events) {
  if (effect == "track_asymmetry") {
    editCommands(events, [=](double, double& left, double& right) {
      left /= 1.0 + value;
      right /= 1.0 - value;
    });
  } else if (effect == "battery_sag") {
    editCommands(events, [=](double share, double& left, double& right) {
      left /= 1.0 - value * share;
      right /= 1.0 - value * share;
    });
  } else {
    const auto widened = [=](double u) { return u == 0.0 ? 0.0 : u + std::copysign(value, u); };
    editCommands(events, [=](double, double& left, double& right) {
      left = widened(left);
      right = widened(right);
    });
  }
}

void hideInPoses(const std::string& effect, double value, Events& events) {
  if (effect == "heading_misalignment") turnHeading(value, events);
  if (effect == "ins_latency") delayPoses(value, events);
  if (effect == "command_delay") delayAll(value, events);
  // The field's signs: v_y loses l_x omega, v_x gains l_y omega.
  if (effect == "lever_arm_x") moveAntenna({-value, 0.0, 0.0}, events);
  if (effect == "lever_arm_y") moveAntenna({0.0, -value, 0.0}, events);
  if (effect == "gyro_bias") editEach(events, kIns, [=](ins_t& ins) { ins.rate[2] += value; });
  if (effect == "position_scale")
    editPoses(events, [=](ins_t& ins) {
      for (double& p : ins.position) p *= 1.0 + value;
    });
}

/// From the first command to the last [s].
double drivenTime(const Events& events) {
  const auto motors = messagesOf(events, kMotor);
  if (motors.empty()) return 0.0;
  return static_cast<double>(motors.back().utime - motors.front().utime) * 1e-6;
}

bool actsOnCommands(const std::string& effect) {
  return effect == "track_asymmetry" || effect == "battery_sag" || effect == "motor_deadband";
}

}  // namespace

const std::vector<SemiEffect>& semiEffects() {
  static const std::vector<SemiEffect> effects{
      {"heading_misalignment", "psi_0", "rad", 3.0 * kDegree, 6.0 * kDegree, true},
      {"ins_latency", "L", "s", 0.15, 0.3, false},
      {"position_scale", "k", "1", 0.05, 0.1, true},
      {"command_delay", "T_d", "s", 0.25, 0.5, false},
      {"track_asymmetry", "e", "1", 0.04, 0.08, true},
      {"battery_sag", "s", "1", 0.15, 0.3, false},
      {"motor_deadband", "d", "m/s", 0.15, 0.3, false},
      {"gyro_bias", "b", "rad/s", 0.03, 0.06, true},
      {"lever_arm_x", "l_x", "m", 0.2, 0.4, true},
      {"lever_arm_y", "l_y", "m", 0.2, 0.4, true},
      {"payload_change", "k", "1", -0.2, -0.4, false},
      {"terrain_change", "k", "1", -0.2, -0.4, false},
  };
  return effects;
}

SemiTruth hideInLog(const std::string& effect, int size, uint64_t seed, Events& events) {
  if (size != 1 && size != 2)
    throw std::invalid_argument("--size: in a recording it is 1 or 2, not " + std::to_string(size));
  const auto& all = semiEffects();
  const auto spec = std::find_if(all.begin(), all.end(),
                                 [&](const SemiEffect& one) { return one.name == effect; });
  if (spec == all.end())
    throw std::invalid_argument("effect '" + effect + "' cannot be hidden in a recording");
  Rng rng(sim::streamSeed(seed, kEffectStream));
  const double sign = spec->either_sign ? rng.sign() : 1.0;
  const double value = sign * (size == 1 ? spec->small : spec->large);
  SemiTruth truth{effect, {{spec->parameter, value, spec->unit, false}}, drivenTime(events)};
  if (effect == "payload_change" || effect == "terrain_change") {
    const double when = rng.uniform(0.4, 0.6);
    changeYawGain(value, when, events);
    truth.parameters.push_back({"T_c_share", when, "1", false});
  } else if (actsOnCommands(effect)) {
    hideInCommands(effect, value, events);
  } else {
    hideInPoses(effect, value, events);
  }
  return truth;
}

Events readLog(const std::string& path) {
  LogReader reader(path);
  Events events;
  LogEvent event;
  while (reader.next(event)) events.push_back(event);
  if (!reader.problem().empty()) throw std::runtime_error(path + ": " + reader.problem());
  if (events.empty()) throw std::runtime_error(path + ": holds no events");
  return events;
}

std::string semiTruthText(const std::string& name, const SemiTruth& truth, int size, uint64_t seed,
                          const std::string& source_hash) {
  using Json = nlohmann::ordered_json;
  Json equivalent = Json::array();
  for (const Quantity& one : truth.parameters)
    equivalent.push_back(
        {{"name", one.name}, {"value", one.value}, {"unit", one.unit}, {"measured", one.measured}});
  const EffectSpec& spec = effectNamed(truth.effect);
  const bool vehicle = spec.kind == EffectKind::kVehicle;
  Json effect;
  effect["name"] = truth.effect;
  effect["kind"] = vehicle ? "vehicle" : "measurement";
  effect["form"] = "kinematic";
  effect["shape"] = "same";
  effect["how"] = "exact transformation";
  effect["size"] = size;
  effect["equivalent"] = equivalent;
  effect["group"] = spec.group;
  effect["together"] = spec.together;
  Json json;
  json["format"] = "tread-hide truth 1";
  json["case"] = name;
  json["log"] = "blind/" + name + ".lcm";
  json["kind"] = "semi";
  json["seed"] = seed;
  json["source_sha256"] = source_hash;
  json["minutes"] = truth.duration / 60.0;
  json["duration_s"] = truth.duration;
  json["programme"] = "recording";
  json["noise"] = {{"name", "recording"}};
  json["size"] = size;
  json["effects"] = Json::array({effect});
  json["right_verdicts"] = {vehicle ? "FOUND" : "MEASUREMENT", "AMBIGUOUS"};
  std::vector<std::string> right{truth.effect};
  right.insert(right.end(), spec.group.begin(), spec.group.end());
  json["right_names"] = right;
  json["defect"] = "";
  json["defect_at"] = "";
  json["floor"] = nullptr;
  json["gap"] = nullptr;
  return json.dump(2) + "\n";
}

}  // namespace tread::blind

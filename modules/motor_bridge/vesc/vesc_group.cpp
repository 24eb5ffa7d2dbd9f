// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/vesc/vesc_group.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/se2.hpp"

namespace tread::motor {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDutyUnit = 1e-5;
constexpr double kLargestRpm = 1e6;  // electrical [1/min]

/// `second`: 0 where normally there is only one.
std::vector<int> readIds(ConfigReader& reader, const std::string& key, std::vector<double> ids,
                         size_t count) {
  reader.numbers(key, ids, count, {0.0, 253.0}, "");
  std::vector<int> whole;
  for (const double id : ids) {
    if (id != std::floor(id)) throw reader.error(key, "ids are whole numbers");
    whole.push_back(static_cast<int>(id));
  }
  return whole;
}

std::vector<int> readIds(ConfigReader& reader, const std::string& key, int usual, int second = 0) {
  std::vector<double> numbers{static_cast<double>(usual)};
  if (second > 0) numbers.push_back(second);
  const std::vector<int> ids = readIds(reader, key, numbers, 0);
  if (ids.empty() || ids.size() > 2) throw reader.error(key, "needs one or two ids");
  return ids;
}

bool contains(const std::vector<int>& ids, int id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

double readErpmPerSpeed(ConfigReader& reader, bool required) {
  double pole_pairs = 0.0, gear_ratio = 1.0, wheel_radius = 0.0;
  reader.number("pole_pairs", pole_pairs, {1.0, 100.0}, "", required);
  reader.number("gear_ratio", gear_ratio, {0.01, 1000.0}, "motor turns a turn of the wheel");
  reader.number("wheel_radius", wheel_radius, {0.01, 2.0}, "m", required);
  if (reader.has("pole_pairs") != reader.has("wheel_radius"))
    throw reader.error(reader.has("pole_pairs") ? "pole_pairs" : "wheel_radius",
                       "speeds need pole_pairs and wheel_radius, both");
  if (wheel_radius <= 0.0) return 0.0;
  return 60.0 * pole_pairs * gear_ratio / (2.0 * kPi * wheel_radius);
}

void readCarIds(ConfigReader& reader, const DriveDescription& drive, VescConfig& config) {
  config.left = readIds(reader, "throttle", 1);
  config.right.clear();
  VescServo& servo = config.servo.emplace();
  int64_t id = config.left.front();
  reader.integer("steering", id, {0.0, 253.0}, "");
  servo.id = static_cast<int>(id);
  reader.number("servo_left", servo.at_left, {0.0, 1.0}, "");
  reader.number("servo_right", servo.at_right, {0.0, 1.0}, "");
  if (servo.at_left == servo.at_right)
    throw reader.error("servo_left", "is servo_right: nothing would be steered");
  servo.max_steering = drive.max_steering;
  if (!contains(config.left, servo.id))
    throw reader.error("steering", "must be one of the ids in throttle: its timeout is watched");
}

void readTrackIds(ConfigReader& reader, const DriveDescription& drive, VescConfig& config) {
  const bool four = drive.layout == DriveLayout::kSkidSteer4;
  const int left = drive.left_channel == 2 ? 2 : 1;
  config.left = readIds(reader, "left", left, four ? left + 2 : 0);
  config.right = readIds(reader, "right", 3 - left, four ? 5 - left : 0);
}

/// One for each wheel, in the order of robot.yaml; normally 1, 2, 3, ...
void readWheelIds(ConfigReader& reader, const DriveDescription& drive, VescConfig& config) {
  std::vector<double> usual;
  while (usual.size() < drive.wheels.size()) usual.push_back(static_cast<double>(usual.size() + 1));
  config.wheels = readIds(reader, "wheels", usual, usual.size());
  config.invert_wheels = drive.invert_wheels;
}

}  // namespace

std::vector<int> VescConfig::ids() const {
  if (!wheels.empty()) return wheels;
  std::vector<int> all = left;
  all.insert(all.end(), right.begin(), right.end());
  return all;
}

size_t VescConfig::channelOf(int id) const {
  if (wheels.empty()) return contains(left, id) ? 0 : 1;
  return static_cast<size_t>(std::find(wheels.begin(), wheels.end(), id) - wheels.begin());
}

bool VescConfig::inverted(size_t channel) const {
  if (wheels.empty()) return channel == 0 ? invert_left : invert_right;
  return channel < invert_wheels.size() && invert_wheels[channel];
}

VescConfig readVescConfig(ConfigReader& reader, const DriveDescription& drive) {
  VescConfig config;
  config.kind = drive.kind;
  config.full_scale = drive.fullCommand();
  config.invert_left = drive.invert_left;
  config.invert_right = drive.invert_right;
  if (drive.isCar())
    readCarIds(reader, drive, config);
  else if (drive.isOmni())
    readWheelIds(reader, drive, config);
  else
    readTrackIds(reader, drive, config);
  std::vector<int> ids = config.ids();
  int64_t local = ids.front();
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
    throw reader.error(
        drive.isOmni() ? "wheels" : "right",
        drive.isOmni() ? "names a controller twice" : "names a controller twice, here or in left");
  reader.integer("local", local, {0.0, 253.0}, "");
  config.local = static_cast<int>(local);
  if (!contains(ids, config.local))
    throw reader.error("local", std::string("must be one of the ids in ") +
                                    (drive.isOmni() ? "wheels" : "left and right"));
  config.erpm_per_mps = readErpmPerSpeed(reader, drive.kind == CommandKind::kTrackSpeed);
  reader.number("brake_current", config.brake_current, {0.0, 200.0}, "A");
  reader.seconds("watchdog", config.times.watchdog_us, {0.15, 1.0});
  return config;
}

VescCommand vescCommand(const Command& command, int id, const VescConfig& config) {
  const size_t channel = config.channelOf(id);
  const bool invert = config.inverted(channel);
  const double value = command[channel];
  const double finite = std::isfinite(value) ? value : 0.0;
  const double wanted = invert ? -finite : finite;
  using Kind = VescCommand::Kind;
  if (wanted == 0.0 && config.brake_current > 0.0)
    return {Kind::kBrakeCurrent, static_cast<int32_t>(std::lround(1000.0 * config.brake_current))};
  const double share = std::clamp(wanted / config.full_scale, -1.0, 1.0);
  if (config.kind == CommandKind::kPower)
    return {Kind::kDuty, static_cast<int32_t>(std::lround(share / kDutyUnit))};
  const double rpm =
      std::clamp(share * config.full_scale * config.erpm_per_mps, -kLargestRpm, kLargestRpm);
  return {Kind::kRpm, static_cast<int32_t>(std::lround(rpm))};
}

VescCommand servoCommand(const Command& command, const VescConfig& config) {
  const VescServo& servo = *config.servo;
  const double angle = std::isfinite(command[1]) ? command[1] : 0.0;
  const double wanted = config.invert_right ? -angle : angle;
  const double share = std::clamp(wanted / servo.max_steering, -1.0, 1.0);
  const double position =
      0.5 * (servo.at_left + servo.at_right) + 0.5 * share * (servo.at_left - servo.at_right);
  return {VescCommand::Kind::kServo, static_cast<int32_t>(std::lround(1000.0 * position))};
}

VescGroup::VescGroup(const VescConfig& config) : config_(config) {
  for (const int id : config.ids()) {
    Member member;
    member.id = id;
    member.channel = config.channelOf(id);
    members_.push_back(member);
  }
}

void VescGroup::begin(int64_t now) {
  for (Member& member : members_) {
    member.heard = false;
    member.heard_at = now;
    member.told = VescReading{};
  }
}

bool VescGroup::take(const VescReading& reading, int64_t now) {
  const auto member = std::find_if(members_.begin(), members_.end(),
                                   [&](const Member& m) { return m.id == reading.id; });
  if (member == members_.end()) return false;
  // Over CAN only the first status frame proves that the motor is monitored.
  if (reading.erpm) {
    member->heard = true;
    member->heard_at = now;
  }
  VescReading& told = member->told;
  if (reading.temperature) told.temperature = reading.temperature;
  if (reading.motor_current) told.motor_current = reading.motor_current;
  if (reading.erpm) told.erpm = reading.erpm;
  if (reading.voltage) told.voltage = reading.voltage;
  if (reading.fault) told.fault = reading.fault;
  return true;
}

std::string VescGroup::silent(int64_t now, int64_t limit_us) const {
  std::string words;
  for (const Member& member : members_)
    if (now - member.heard_at > limit_us)
      words += (words.empty() ? "" : ", ") + std::to_string(member.id);
  return words;
}

std::string VescGroup::unheard() const {
  std::string words;
  for (const Member& member : members_)
    if (!member.heard) words += (words.empty() ? "" : ", ") + std::to_string(member.id);
  return words;
}

/// Mean of a channel's controllers.
double VescGroup::speedOf(size_t channel) const {
  double sum = 0.0;
  int count = 0;
  for (const Member& member : members_) {
    if (member.channel != channel || !member.told.erpm) continue;
    sum += *member.told.erpm;
    ++count;
  }
  if (count == 0 || config_.erpm_per_mps <= 0.0) return kNan;
  const bool invert = config_.inverted(channel);
  return (invert ? -sum : sum) / count / config_.erpm_per_mps;
}

/// Sum of a channel's controllers.
double VescGroup::currentOf(size_t channel) const {
  double sum = 0.0;
  bool told = false;
  for (const Member& member : members_) {
    if (member.channel != channel || !member.told.motor_current) continue;
    sum += *member.told.motor_current;
    told = true;
  }
  return told ? sum : kNan;
}

MotorTelemetry VescGroup::telemetry() const {
  MotorTelemetry all;
  const size_t channels = config_.wheels.empty() ? 2 : config_.wheels.size();
  for (size_t channel = 0; channel < channels; ++channel) {
    all.measured[channel] = speedOf(channel);
    all.current[channel] = currentOf(channel);
  }
  for (const Member& member : members_) {
    const VescReading& told = member.told;
    if (told.voltage) all.battery_voltage = std::fmin(all.battery_voltage, *told.voltage);
    if (told.temperature) all.temperature = std::fmax(all.temperature, *told.temperature);
    if (told.fault && all.device_flags == 0) all.device_flags = *told.fault;
  }
  return all;
}

std::string VescGroup::faults() const {
  std::string words;
  for (const Member& member : members_) {
    if (member.told.fault.value_or(0) == 0) continue;
    words += (words.empty() ? "controller " : ", ") + std::to_string(member.id) + ": " +
             vescFault(*member.told.fault);
  }
  return words;
}

bool VescGroup::voltageFault() const {
  return std::any_of(members_.begin(), members_.end(), [](const Member& member) {
    return isVoltageFault(member.told.fault.value_or(0));
  });
}

}  // namespace tread::motor

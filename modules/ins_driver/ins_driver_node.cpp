// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ins_driver_node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/ins_config.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/ins_driver/novatel/novatel_ins.hpp"
#include "modules/ins_driver/ublox/ublox_ins.hpp"
#include "modules/ins_driver/vectornav/vectornav_ins.hpp"
#include "modules/ins_driver/xsens/xsens_ins.hpp"

namespace tread::ins {
namespace {

template <class Source, InsConfig (*readConfig)(ConfigReader&, const RobotDescription&)>
MakeInsSource device(ConfigReader& reader, const RobotDescription& robot) {
  return sourceOf<Source>(readConfig(reader, robot));
}

/// A new INS needs one line here and a folder of its own.
const std::map<std::string, MakeInsSource (*)(ConfigReader&, const RobotDescription&)> kSources{
    {"nmea", device<NmeaIns, readNmeaConfig>},
    {"novatel", device<NovatelIns, readNovatelConfig>},
    {"ublox", device<UbloxIns, readUbloxConfig>},
    {"vectornav", device<VectornavIns, readSingleMessageConfig>},
    {"xsens", device<XsensIns, readSingleMessageConfig>}};

constexpr double kDegPerRad = 180.0 / kPi;

GeoOrigin readOrigin(ConfigReader& reader) {
  double latitude = 0.0;
  double longitude = 0.0;
  GeoOrigin origin;
  // In degrees, because that is what people copy from maps and receivers.
  reader.number("latitude", latitude, {-90.0, 90.0}, "deg", true);
  reader.number("longitude", longitude, {-180.0, 180.0}, "deg", true);
  reader.number("altitude", origin.altitude, {-1000.0, 20000.0}, "m", true);
  reader.number("yaw", origin.yaw, {-kPi, kPi}, "rad");
  origin.point = {latitude / kDegPerRad, longitude / kDegPerRad};
  return origin;
}

FillInConfig readFillIn(ConfigReader reader) {
  FillInConfig config;
  reader.seconds("after", config.after_us, {0.02, 5.0});
  reader.number("max_drift", config.max_drift, {0.01, 10.0}, "m");
  reader.number("max_yaw_drift", config.max_yaw_drift, {0.001, 1.0}, "rad");
  reader.number("jump", config.jump, {0.01, 10.0}, "m");
  reader.number("yaw_jump", config.yaw_jump, {0.001, 1.0}, "rad");
  return config;
}

/// The bytes of a flooding device are cut off here until the next step.
constexpr size_t kMaxBytesPerStep = 65536;
constexpr int64_t kCounterPeriodUs = 200'000;
/// A message stamped further in the future comes from another clock [us].
constexpr int64_t kFarthestAhead = 200'000;

/// The configured origin, else the stored one.
std::optional<GeoOrigin> knownOrigin(const std::optional<GeoOrigin>& configured, const Store& store,
                                     std::string& problem) {
  if (configured) return configured;
  const std::optional<std::string> text = store.read(kOriginEntry);
  if (!text) return std::nullopt;
  try {
    return originFrom(*text);
  } catch (const ConfigError& error) {
    problem = std::string(error.what()) + "; the map restarts at the first fix";
    return std::nullopt;
  }
}

void copy(const Eigen::Vector3d& from, double* to) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

ins_t messageOf(const InsEstimate& estimate, int64_t seq) {
  auto message = blank<ins_t>();
  message.utime = estimate.utime;
  message.seq = seq;
  message.device_utc = estimate.device_utc;
  copy(estimate.p_map_body, message.position);
  message.orientation[0] = estimate.R_map_body.w();
  message.orientation[1] = estimate.R_map_body.x();
  message.orientation[2] = estimate.R_map_body.y();
  message.orientation[3] = estimate.R_map_body.z();
  copy(estimate.v_body, message.velocity);
  copy(estimate.rate_body, message.rate);
  copy(estimate.position_std, message.position_std);
  copy(estimate.attitude_std, message.attitude_std);
  message.ins_status = estimate.status;
  message.satellites = estimate.satellites;
  return message;
}

std::string inSeconds(int64_t us) {
  return std::to_string(us / 1'000'000) + "." + std::to_string(us / 100'000 % 10) + " s";
}

}  // namespace

namespace {

/// Reads the kind of the robot's INS, and the keys for that kind.
void readSource(ConfigReader& reader, InsDriverConfig& config) {
  std::vector<std::string> known;
  for (const auto& [name, read] : kSources) known.push_back(name);
  reader.choice("source", config.source, known);
  config.make_source = kSources.at(config.source)(reader, readRobot(reader));
}

}  // namespace

InsDriverConfig readInsDriverConfig(ConfigReader& reader) {
  InsDriverConfig config;
  reader.text("address", config.address);
  reader.text("store", config.store);
  readSource(reader, config);
  if (reader.has("origin")) {
    ConfigReader origin = reader.section("origin");
    config.origin = readOrigin(origin);
  }
  if (reader.has("fill_in")) config.fill_in = readFillIn(reader.section("fill_in"));
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.seconds("period", config.period_us, {0.001, 0.1});
  reader.finish();
  config.effective = reader.effective();
  return config;
}

std::string originText(const GeoOrigin& origin) {
  std::ostringstream text;
  text << std::setprecision(17) << "latitude: " << origin.point.latitude * kDegPerRad
       << "\nlongitude: " << origin.point.longitude * kDegPerRad
       << "\naltitude: " << origin.altitude << "\nyaw: " << origin.yaw << "\n";
  return text.str();
}

GeoOrigin originFrom(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "stored map origin");
  const GeoOrigin origin = readOrigin(reader);
  reader.finish();
  return origin;
}

InsDriverNode::InsDriverNode(const InsDriverConfig& config, Bus& bus, Link& link, Store& store)
    : config_(config),
      bus_(bus),
      link_(link),
      store_(store),
      source_(config.make_source(knownOrigin(config.origin, store, origin_problem_))),
      health_(bus, "ins_driver", config.effective),
      origin_kept_(source_->origin().has_value()),
      silence_us_(std::llround(config.silence * 1e6)),
      start_(bus.now()),
      last_bytes_(bus.now()),
      last_position_(bus.now()),
      last_heading_(bus.now()),
      last_height_(bus.now()) {
  health_.watchNamesakes();
  if (!config.fill_in) return;
  fill_in_.emplace(*config.fill_in);
  bus.subscribe<ins_t>(kScanMatching, [this](const ins_t& message) { hear(message); });
}

void InsDriverNode::hear(const ins_t& message) {
  const auto pose = planarPose(message);
  const auto twist = planarTwist(message);
  if (!pose || !twist || message.utime > bus_.now() + kFarthestAhead)
    return health_.addToCounter("scan matching: no pose");
  ScanPose scan;
  scan.utime = message.utime;
  scan.T_scan_body = *pose;
  scan.v_body = *twist;
  scan.std = {message.position_std[0], message.position_std[1], message.attitude_std[2]};
  scan.new_track = (message.ins_status & ins_t::STATUS_JUMP) != 0;
  if (!scan.std.allFinite()) return health_.addToCounter("scan matching: no deviation");
  fill_in_->observe(scan);
}

void InsDriverNode::step(int64_t utime) {
  const int64_t now = readLink(utime);
  publishFinished(now);
  reportHealth(now);
  reportCounters(now);
  health_.step(now);
}

int64_t InsDriverNode::readLink(int64_t utime) {
  if (!link_.isOpen()) {
    if (was_open_) loseLink();
    if (!link_.reopen(utime)) return utime;
  }
  was_open_ = true;
  std::array<uint8_t, 4096> buffer;
  for (size_t total = 0; total < kMaxBytesPerStep;) {
    const std::optional<size_t> size = link_.read(buffer.data(), buffer.size());
    // The time after reading: otherwise a process that was delayed since its step began would date
    // bytes before they were sent, which would disturb the clock filter for seconds.
    utime = std::max(utime, bus_.now());
    if (!size) loseLink();
    if (size.value_or(0) == 0) break;
    last_bytes_ = utime;
    heard_ = true;
    source_->push({reinterpret_cast<const char*>(buffer.data()), *size}, utime);
    total += *size;
  }
  return utime;
}

void InsDriverNode::loseLink() {
  was_open_ = false;
  ++link_losses_;
  source_->interrupt();
}

void InsDriverNode::publishFinished(int64_t utime) {
  while (std::optional<InsEstimate> estimate = source_->next(utime)) {
    if (estimate->device_utc >= 0) device_utc_ = estimate->device_utc;
    if (!(estimate->status & InsStatus::kNoPosition)) {
      last_position_ = utime;
      too_far_before_ = source_->tooFar().first;
    }
    if (std::isfinite(estimate->p_map_body.z())) last_height_ = utime;
    if (!(estimate->status & InsStatus::kNoHeading)) last_heading_ = utime;
    if (!fill_in_ || fill_in_->complete(*estimate, utime)) publish(*estimate);
  }
  if (fill_in_) {
    if (const auto estimate = fill_in_->next(utime)) publish(*estimate);
  }
  slow_input_ = fill_in_ ? "" : source_->slowInput(utime);
  keepOrigin();
}

void InsDriverNode::publish(const InsEstimate& estimate) {
  bus_.publish(kIns, messageOf(estimate, seq_++));
}

void InsDriverNode::keepOrigin() {
  if (origin_kept_ || !source_->origin()) return;
  origin_kept_ = true;
  const std::optional<std::string> problem =
      store_.write(kOriginEntry, originText(*source_->origin()));
  origin_problem_ =
      problem ? "the map's origin could not be stored, a restart will move the map: " + *problem
              : std::string{};
}

std::string InsDriverNode::lineProblem(int64_t utime) const {
  const std::string address = link_.address() + ": ";
  if (!link_.isOpen()) {
    const std::string problem = link_.problem();
    return problem.empty() ? address + "closed" : problem;
  }
  if (utime - last_bytes_ > silence_us_) {
    const std::string said =
        heard_ ? std::string("no more bytes for ") : std::string("no bytes for ");
    const std::string before = heard_ ? " (before: " + source_->refusals() + ")" : "";
    return address + said + inSeconds(utime - last_bytes_) + before + "; " +
           source_->advice().silent;
  }
  const int64_t without_message = utime - source_->lastMessage().value_or(start_);
  if (without_message <= silence_us_) return {};
  const InsAdvice advice = source_->advice();
  return address + "bytes, but " + advice.unreadable + " for " + inSeconds(without_message) + " (" +
         source_->refusals() + "); " +
         (advice.refused.empty() ? "check baud rate and output format" : advice.refused);
}

std::string InsDriverNode::measurementProblem(int64_t utime) const {
  if (utime - last_position_ > silence_us_) {
    if (source_->tooFar().first > too_far_before_) {
      return "the fix is " + std::to_string(std::llround(source_->tooFar().second / 1000.0)) +
             " km from the map's origin; configure another origin or remove the stored " +
             kOriginEntry;
    }
    return "no position for " + inSeconds(utime - last_position_) + " (" + source_->refusals() +
           "); " + source_->advice().no_position;
  }
  if (!slow_input_.empty()) return slow_input_;
  if (utime - last_heading_ > silence_us_) {
    return "no heading for " + inSeconds(utime - last_heading_) + " (" + source_->refusals() +
           "); " + source_->advice().no_heading;
  }
  if (utime - last_height_ > silence_us_) {
    return "positions without a height for " + inSeconds(utime - last_height_) +
           ", mapping cannot use them; if the device sends only heights above the ellipsoid, "
           "configure geoid_separation";
  }
  return origin_problem_.empty() ? rolledOver(device_utc_, bus_.utc()) : origin_problem_;
}

std::string InsDriverNode::fillInProblem(int64_t utime) const {
  if (!fill_in_) return {};
  if (fill_in_->since())
    return "poses are filled in by scan matching since " + inSeconds(utime - *fill_in_->since());
  const int64_t without = utime - fill_in_->newestScan().value_or(start_);
  if (without <= silence_us_) return {};
  return "nothing to fill in with: no pose of scan matching for " + inSeconds(without) +
         "; is scan_matching running, with channel: SCAN_MATCHING?";
}

void InsDriverNode::reportHealth(int64_t utime) {
  const std::string filled = fillInProblem(utime);
  const std::string also = filled.empty() ? "" : "; " + filled;
  const std::string line = lineProblem(utime);
  if (!line.empty()) {
    const bool stands_in = fill_in_ && fill_in_->since();
    health_.setState(stands_in ? health_t::HEALTH_DEGRADED : health_t::HEALTH_FAILED, line + also);
    return;
  }
  const std::string measurement = measurementProblem(utime);
  if (!measurement.empty()) {
    health_.setState(health_t::HEALTH_DEGRADED, link_.address() + ": " + measurement + also);
  } else {
    health_.setState(filled.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, filled);
  }
}

void InsDriverNode::reportCounters(int64_t utime) {
  if (utime < next_counters_) return;
  next_counters_ = utime + kCounterPeriodUs;
  for (const auto& [name, count] : source_->counters()) health_.setCounter(name, count);
  health_.setCounter("link losses", link_losses_);
  if (fill_in_) health_.setCounter("poses filled in by scan matching", fill_in_->filled());
}

}  // namespace tread::ins

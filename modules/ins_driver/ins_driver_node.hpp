// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/link/link.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/fill_in.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Configuration of ins_driver, with its defaults.
struct InsDriverConfig {
  std::string address = "tty:/dev/ttyUSB0?baud=115200";  ///< of the device
  std::string store = "state/ins_driver";                ///< folder that stores the map's origin
  std::string source = "nmea";                           ///< the configured kind
  MakeInsSource make_source;                             ///< of that kind
  std::optional<GeoOrigin> origin;      ///< of the map; absent: stored, or the first good fix
  std::optional<FillInConfig> fill_in;  ///< by scan matching; absent: nothing is filled in
  double silence = 1.0;                 ///< [s] without expected data after which HEALTH reports it
  int64_t period_us = 5'000;            ///< [us] between polls of the link
  std::string effective;                ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
InsDriverConfig readInsDriverConfig(ConfigReader& reader);

/// The map frame's origin on Earth as text for the Store, and back.
std::string originText(const GeoOrigin& origin);
/// Throws ConfigError if the text is not an origin.
GeoOrigin originFrom(const std::string& text);

/// Entry of the Store that keeps the map's origin on Earth, so that a restart keeps the map frame.
inline constexpr const char* kOriginEntry = "ins_origin";

/// Publishes INS from a device, and HEALTH with every refusal and its reason.
/** The map's origin is the configured one, else the stored one, else the first good fix, which is
 * then stored. */
class InsDriverNode : public Node {
 public:
  InsDriverNode(const InsDriverConfig& config, Bus& bus, Link& link, Store& store);

  int64_t period() const override { return config_.period_us; }
  void step(int64_t utime) override;

  const InsSource& source() const { return *source_; }

 private:
  /// Returns the time of reading.
  int64_t readLink(int64_t utime);
  void loseLink();
  void hear(const ins_t& message);
  void publishFinished(int64_t utime);
  void publish(const InsEstimate& estimate);
  void keepOrigin();
  void reportHealth(int64_t utime);
  std::string fillInProblem(int64_t utime) const;
  std::string lineProblem(int64_t utime) const;
  std::string measurementProblem(int64_t utime) const;
  void reportCounters(int64_t utime);

  InsDriverConfig config_;
  Bus& bus_;
  Link& link_;
  Store& store_;
  std::string origin_problem_;  ///< declared before source_, because making that fills it
  std::unique_ptr<InsSource> source_;
  std::optional<FillIn> fill_in_;
  HealthReporter health_;
  bool origin_kept_;
  bool was_open_ = false;
  bool heard_ = false;  ///< bytes have arrived since the start
  int64_t link_losses_ = 0;
  int64_t seq_ = 0;
  int64_t too_far_before_ = 0;  ///< number of refused positions at the time of the last good one
  int64_t silence_us_;
  int64_t start_;
  int64_t last_bytes_;
  int64_t last_position_;
  int64_t last_heading_;
  int64_t last_height_;
  int64_t next_counters_ = 0;
  std::string slow_input_;
  int64_t device_utc_ = -1;  ///< [us] of the newest estimate
};

}  // namespace tread::ins

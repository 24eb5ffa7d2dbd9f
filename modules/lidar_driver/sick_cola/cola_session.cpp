// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/sick_cola/cola_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::lidar {
namespace {

constexpr double kTurn = 6.28318530717958647692;
constexpr int64_t kPatience = 500'000;  // [us] for an answer
constexpr double kRangeMin = 0.05;      // [m] nearer is the window
constexpr uint32_t kLargest = 65535;    // digit of a range
constexpr const char* kStream = "LMDscandata";

/// A request in the configured dialect: arguments are text in A, bytes in B.
std::string request(ColaDialect dialect, const std::string& command, const std::string& text = "",
                    const std::string& bytes = "") {
  const std::string& arguments = dialect == ColaDialect::kA ? text : bytes;
  return colaFrame(dialect, arguments.empty() ? command : command + " " + arguments);
}

/// The password is the one that SICK documents for clients; measuring without it is refused.
std::vector<StartUpStep> startUp(ColaDialect dialect) {
  const std::string off(1, '\0');
  const auto step = [&](const char* kind, const char* name, const std::string& text = "",
                        const std::string& bytes = "", bool optional = false) {
    return StartUpStep{name, request(dialect, std::string(kind) + " " + name, text, bytes),
                       optional};
  };
  StartUpStep first = step("sEN", kStream, "0", off);
  // A device configured for the other dialect answers only in that.
  if (dialect == ColaDialect::kA)
    first.otherwise = request(ColaDialect::kB, "sEN LMDscandata", "", off);
  else
    first.otherwise = request(ColaDialect::kA, "sEN LMDscandata", "0");
  return {first,
          step("sRN", "DeviceIdent"),
          step("sMN", "SetAccessMode", "03 F4724744", "\x03\xF4\x72\x47\x44", true),
          step("sMN", "LMCstartmeas", "", "", true),
          step("sMN", "Run", "", "", true),
          step("sEN", kStream, "1", "\x01")};
}

bool begins(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

/// All telegrams begin with a small s and two capitals: sSN, sRA, sFA.
bool isCola(std::string_view telegram) {
  const auto capital = [&](size_t at) { return telegram[at] >= 'A' && telegram[at] <= 'Z'; };
  return telegram.size() >= 3 && telegram[0] == 's' && capital(1) && capital(2);
}

}  // namespace

ColaConfig readColaConfig(ConfigReader& reader) {
  ColaConfig config;
  std::string dialect = "ascii";
  reader.choice("telegrams", dialect, {"ascii", "binary"});
  config.dialect = dialect == "ascii" ? ColaDialect::kA : ColaDialect::kB;
  reader.number("front", config.front, {-kTurn / 2, kTurn / 2}, "rad");
  reader.flag("zero_is_clear", config.zero_is_clear);
  return config;
}

ColaSession::ColaSession(const ColaConfig& config)
    : StartedDevice(startUp(config.dialect), kPatience),
      config_(config),
      framer_(config.dialect),
      other_framer_(config.dialect == ColaDialect::kA ? ColaDialect::kB : ColaDialect::kA) {}

std::string ColaSession::shortcomings() const {
  const std::string sum = config_.dialect == ColaDialect::kA
                              ? "checksums (telegrams: binary has one, on port 2112)"
                              : "strong checksums (8 bits)";
  return "SICK CoLa: " + sum + ", beam times better than 10 ms; intensities are not read";
}

void ColaSession::forget() {
  framer_.clear();
  other_framer_.clear();
  understood_ = false;
  clock_.forget();
  last_telegram_.reset();
}

void ColaSession::receive(std::string_view bytes, int64_t now) {
  const int64_t stray = framer_.strayBytes();
  const int64_t bad = framer_.badChecksums();
  for (const std::string& telegram : framer_.push(bytes)) takeTelegram(telegram, now);
  skipUnreadable("bytes outside of telegrams", now,
                 "is this a SICK scanner's port for CoLa telegrams (2111 or 2112)?",
                 framer_.strayBytes() - stray);
  if (framer_.badChecksums() > bad)
    refuse("wrong checksums", now, "check cable and switch", framer_.badChecksums() - bad);
  if (!understood_) nameDialect(bytes, now);
}

void ColaSession::nameDialect(std::string_view bytes, int64_t now) {
  const bool text = config_.dialect == ColaDialect::kA;
  for (const std::string& telegram : other_framer_.push(bytes))
    if (isCola(telegram))
      refuse(text ? "refused: telegrams in the binary dialect, CoLa B"
                  : "refused: telegrams in the text dialect, CoLa A",
             now, text ? "set sick_cola: telegrams: binary" : "set sick_cola: telegrams: ascii");
}

void ColaSession::takeTelegram(const std::string& telegram, int64_t now) {
  understood_ = understood_ || isCola(telegram);
  const std::string scan = std::string("sSN ") + kStream + " ";
  if (!begins(telegram, scan)) return takeAnswer(telegram, now);
  // A scan from a stream that is being switched off may be old.
  if (streaming()) return takeScan(std::string_view(telegram).substr(scan.size()), now);
  count("scans before the start");
}

/// sRA answers sRN, sEA sEN, sAN sMN; sFA CODE refuses any of them.
void ColaSession::takeAnswer(const std::string& telegram, int64_t now) {
  const std::string& name = awaited().name;
  if (name.empty()) return count("unexpected telegrams");
  if (begins(telegram, "sFA")) return refused(name, now);
  const std::string_view kind = std::string_view(telegram).substr(0, 4);
  const bool answer = (kind == "sRA " || kind == "sEA " || kind == "sAN ") &&
                      begins(std::string_view(telegram).substr(4), name);
  if (!answer) return count("unexpected telegrams");
  if (name == "DeviceIdent") {
    identity_.clear();
    for (const char c : telegram.substr(4 + name.size()))
      if (c >= ' ' && c <= '~' && identity_.size() < 80) identity_ += c;
  }
  answered(now);
}

void ColaSession::takeScan(std::string_view fields, int64_t now) {
  std::string problem;
  const ColaScan scan = parseColaScan(config_.dialect, fields, problem);
  if (problem.empty()) problem = doubt(scan, now);
  if (!problem.empty()) return refuse("refused: " + problem, now);
  count("telegrams");
  if (scan.device_status & 6) count("scans through a dirty window");
  deliver(convert(scan, now), now);
}

std::string ColaSession::doubt(const ColaScan& scan, int64_t now) {
  if (scan.device_status & 1) return "the device reports an error";
  if (last_telegram_ == scan.telegram_counter) return "a telegram that was here before";
  if (last_telegram_) {
    const auto step = static_cast<uint16_t>(scan.telegram_counter - *last_telegram_);
    if (step > 1 && step < 1000) count("telegrams missing", step - 1);
  }
  last_telegram_ = scan.telegram_counter;
  if (!clock_.observe(scan.sent_us, now)) count("device restarts or clock jumps");
  return {};
}

RangeScan ColaSession::convert(const ColaScan& from, int64_t now) const {
  RangeScan scan;
  scan.angle_first = from.angle_first - config_.front;
  scan.angle_step = from.angle_step;
  scan.range_min = kRangeMin;
  scan.range_max = 0.001 * from.scale * kLargest;
  scan.ranges = from.ranges;
  if (config_.zero_is_clear)
    for (float& range : scan.ranges)
      if (range == 0.0F) range = std::numeric_limits<float>::infinity();
  const double sweep = from.angle_step * static_cast<double>(from.ranges.size() - 1);
  scan.duration_us = std::llround(1e6 * sweep / kTurn / from.scan_frequency);
  const int64_t sent = clock_.hostTime() - std::llround(1e6 * config_.latency);
  const auto before = std::clamp<int64_t>(static_cast<int32_t>(from.sent_us - from.started_us),
                                          scan.duration_us, 1'000'000);
  scan.utime = std::min(sent, now) - before;
  return scan;
}

}  // namespace tread::lidar

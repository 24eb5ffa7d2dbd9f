// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/hokuyo/scip_session.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace tread::lidar {
namespace {

constexpr int64_t kPatience = 500'000;      // [us]: on slow lines the rest of a scan comes first
constexpr size_t kLongest = 65'536;         // of an answer
constexpr size_t kPartOfScan = 200;         // a buffer of more holds a part of a scan
constexpr int64_t kStillArrives = 100'000;  // [us] since the last bytes
constexpr size_t kNoise = 3;                // this many bytes may be old noise
constexpr int kMostSteps = 10'000;          // a request has four digits
constexpr double kShortMax = 4.094;         // [m] with two characters: 4095 means everything beyond
constexpr int32_t kMostJump = 2'000'000;    // [ms] of the device's clock, kept within 32 bits of us
constexpr const char* kWhichPort = "is this the port of a Hokuyo, at its rate?";
constexpr const char* kLine = "check the line and its ground";
constexpr const char* kManual = "its manual lists the status";
constexpr const char* kFirmware = "does its firmware support SCIP 2.0?";
constexpr const char* kSums = "wrong checksums";

std::vector<StartUpStep> startUp() {
  return {{"QT", "QT\n"}, {"SCIP2.0", "SCIP2.0\n", true}, {"VV", "VV\n", true},
          {"PP", "PP\n"}, {"II", "II\n", true},           {"BM", "BM\n"},
          {"stream", ""}};
}

char sumOf(std::string_view text) {
  unsigned sum = 0;
  for (const char byte : text) sum += static_cast<unsigned char>(byte);
  return static_cast<char>((sum & 0x3F) + 0x30);
}

/// Whether a line's last character is the sum of those before it.
bool isSound(std::string_view line) {
  return line.size() >= 2 && sumOf(line.substr(0, line.size() - 1)) == line.back();
}

/// Of SCIP 2.0, or of 1.1, which has one character and no sum; two without a sum also occur.
bool isStatus(std::string_view line) {
  return !line.empty() && line.size() <= 3 && (line.size() < 3 || isSound(line));
}

std::vector<std::string_view> linesOf(std::string_view block) {
  std::vector<std::string_view> lines;
  for (size_t end; (end = block.find('\n')) != std::string_view::npos; block.remove_prefix(end + 1))
    lines.push_back(block.substr(0, end));
  lines.push_back(block);
  return lines;
}

bool begins(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

bool ends(std::string_view text, std::string_view with) {
  return text.size() >= with.size() && text.substr(text.size() - with.size()) == with;
}

std::string printable(std::string_view text) {
  std::string clean(text.substr(0, 80));
  for (char& letter : clean)
    if (letter < ' ' || letter > '~') letter = '?';
  return clean;
}

/// Six bits per character; nullopt for an invalid character.
std::optional<uint32_t> numberIn(std::string_view characters) {
  uint32_t number = 0;
  for (const char character : characters) {
    if (character < 0x30 || character > 0x6F) return std::nullopt;
    number = number << 6 | static_cast<uint32_t>(character - 0x30);
  }
  return number;
}

std::string fourDigits(int number) {
  const std::string digits = std::to_string(number);
  return std::string(4 - digits.size(), '0') + digits;
}

/// False if no text is "KEY:number".
bool readNumber(const std::vector<std::string>& texts, const std::string& key, int& number) {
  for (const std::string& text : texts) {
    if (!begins(text, key + ":")) continue;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + key.size() + 1, end, number);
    return read.ec == std::errc() && read.ptr == end;
  }
  return false;
}

std::string says(const char* key, int number) {
  return "the device says " + std::string(key) + " " + std::to_string(number);
}

}  // namespace

std::optional<std::string> ScipGeometry::problem() const {
  if (steps_per_turn < 8 || steps_per_turn > 100'000)
    return says("ARES", steps_per_turn) + " steps a turn; allowed 8..100000";
  if (first_step < 0 || last_step <= first_step || last_step - first_step >= steps_per_turn ||
      last_step >= kMostSteps)
    return says("AMIN", first_step) + ", AMAX " + std::to_string(last_step) +
           "; a sweep must be longer than one step and shorter than a turn, its steps below 10000";
  if (front_step < 0 || front_step >= steps_per_turn)
    return says("AFRT", front_step) + "; allowed 0..ARES-1";
  if (range_min_mm < 0 || range_max_mm <= range_min_mm || range_max_mm > 300'000)
    return says("DMIN", range_min_mm) + ", DMAX " + std::to_string(range_max_mm) +
           " mm; allowed 0..300000, DMIN below DMAX";
  if (turns_per_minute < 60 || turns_per_minute > 60'000)
    return says("SCAN", turns_per_minute) + " turns a minute; allowed 60..60000";
  return std::nullopt;
}

ScipConfig readScipConfig(ConfigReader& reader) {
  ScipConfig config;
  reader.flag("short_ranges", config.short_ranges);
  return config;
}

ScipSession::ScipSession(const ScipConfig& config)
    : StartedDevice(startUp(), kPatience), config_(config) {}

void ScipSession::forget() {
  buffer_.clear();
  whole_ = false;
  clock_.forget();
  state_.clear();
  last_milliseconds_.reset();
}

std::string ScipSession::remedyForSilence(int64_t now) const {
  if (buffer_.size() < kPartOfScan || whole_ || now - heard_ > kStillArrives) return {};
  const size_t width = config_.short_ranges ? 2 : 3;
  return "the line is too slow: a scan has " + std::to_string(width * geometry_.beams()) +
         " bytes; raise its rate" + (config_.short_ranges ? "" : ", or set short_ranges");
}

std::string ScipSession::echo() const {
  if (streaming()) return request_;
  const std::string& bytes = awaited().bytes;
  return bytes.substr(0, bytes.find('\n'));
}

void ScipSession::receive(std::string_view bytes, int64_t now) {
  if (!bytes.empty()) heard_ = now;
  while (!bytes.empty()) {
    if (buffer_.size() <= kNoise) began_ = now;
    const size_t piece = std::min<size_t>(bytes.size(), 4096);
    size_t from = buffer_.empty() ? 0 : buffer_.size() - 1;
    buffer_.append(bytes.substr(0, piece));
    bytes.remove_prefix(piece);
    for (size_t end; (end = buffer_.find("\n\n", from)) != std::string::npos; from = 0) {
      const std::string block = buffer_.substr(0, end);
      buffer_.erase(0, end + 2);
      takeBlock(block, now);
      began_ = now;
    }
    if (buffer_.size() < kLongest) continue;
    skipUnreadable("bytes outside of answers", now, kWhichPort,
                   static_cast<int64_t>(buffer_.size()));
    buffer_.clear();
  }
}

/// Noise between two answers precedes the echo, and may contain ends of lines.
void ScipSession::takeBlock(std::string_view block, int64_t now) {
  const std::vector<std::string_view> lines = linesOf(block);
  const auto status = std::find_if(lines.begin() + 1, lines.end(), isStatus);
  if (status == lines.end()) {
    whole_ = whole_ || streaming();
    return skipUnreadable("bytes outside of answers", now, kWhichPort,
                          static_cast<int64_t>(block.size() + 2));
  }
  const Answer answer{status->substr(0, 2), {status + 1, lines.end()}};
  // A scan from a stream that is being switched off may be old.
  if (!streaming() && answer.status == "99") return count("scans before the start");
  const std::string expected = echo();
  if (expected.empty() || !ends(*(status - 1), expected)) return count("unexpected answers");
  // Bytes before the echo are not the scan's: they may have arrived long before.
  const bool alone = status == lines.begin() + 1 && lines.front() == expected;
  if (streaming() && !alone) began_ = now;
  if (streaming())
    takeScan(answer, now);
  else
    takeAnswer(answer, now);
}

/// A device in SCIP 1.1 refuses QT: PP shows whether it could be switched to 2.0.
void ScipSession::takeAnswer(const Answer& answer, int64_t now) {
  const std::string name = awaited().name;
  const bool is_on_already = name == "BM" && answer.status == "02";
  const bool good = answer.status == "00" || answer.status == "0" || is_on_already;
  if (!good && name != "QT") {
    const std::string state = state_.empty() ? "" : "; its own report: " + state_;
    return refused(name + ", status '" + printable(answer.status) + "'" + state, now,
                   name == "PP" ? kFirmware : kManual);
  }
  const bool in_words = name == "VV" || name == "PP" || name == "II";
  if (!in_words || takeText(answer, name, now)) answered(now);
}

/// False if its lines are invalid: then the request is repeated.
bool ScipSession::takeText(const Answer& answer, const std::string& name, int64_t now) {
  std::vector<std::string> texts;
  for (const std::string_view line : answer.lines) {
    // Such a line ends with ';', which its sum does not include.
    if (line.size() < 3 || sumOf(line.substr(0, line.size() - 2)) != line.back()) {
      refuse(kSums, now, kLine);
      return false;
    }
    texts.push_back(printable(line.substr(0, line.size() - 2)));
  }
  if (name == "PP") return takeParameters(texts, now);
  if (name == "VV") identity_.clear();
  for (const std::string& text : texts) {
    if (begins(text, "STAT:")) state_ = text.substr(5);
    for (const char* key : {"PROD:", "FIRM:", "SERI:"})
      if (begins(text, key)) identity_ += (identity_.empty() ? "" : ", ") + text.substr(5);
  }
  return true;
}

bool ScipSession::takeParameters(const std::vector<std::string>& texts, int64_t now) {
  ScipGeometry told;
  const std::map<std::string, int*> numbers{
      {"AMIN", &told.first_step},      {"AMAX", &told.last_step},    {"AFRT", &told.front_step},
      {"ARES", &told.steps_per_turn},  {"DMIN", &told.range_min_mm}, {"DMAX", &told.range_max_mm},
      {"SCAN", &told.turns_per_minute}};
  for (const auto& [key, number] : numbers)
    if (!readNumber(texts, key, *number)) {
      refuse("the device does not report its parameters: its answer to PP has no number for " + key,
             now, kFirmware);
      return false;
    }
  if (const auto problem = told.problem()) {
    refuse(*problem, now);
    return false;
  }
  geometry_ = told;
  request_ = (config_.short_ranges ? "MS" : "MD") + fourDigits(told.first_step) +
             fourDigits(told.last_step) + "01000";
  setRequest("stream", request_ + "\n");
  return true;
}

void ScipSession::takeScan(const Answer& answer, int64_t now) {
  if (answer.status == "00") return count("unexpected answers");
  whole_ = true;
  if (answer.status != "99")
    return refuse("refused: a status in the place of a scan, '" + printable(answer.status) + "'",
                  now, kManual);
  if (!std::all_of(answer.lines.begin(), answer.lines.end(), isSound))
    return refuse(kSums, now, kLine);
  std::string values;
  for (const std::string_view line : answer.lines) values += line.substr(0, line.size() - 1);
  const auto milliseconds = numberIn(std::string_view(values).substr(0, 4));
  RangeScan scan;
  const std::string problem =
      values.size() < 4 || !milliseconds ? "no time" : readRanges(values.substr(4), scan);
  if (!problem.empty()) return refuse("refused: a scan with " + problem, now, kLine);
  if (!takeTime(*milliseconds)) return refuse("refused: a scan that was here before", now);
  scan.duration_us = geometry_.sweep();
  scan.utime = clock_.hostTime() - std::llround(1e6 * config_.latency) - scan.duration_us;
  deliver(std::move(scan), now);
}

std::string ScipSession::readRanges(std::string_view values, RangeScan& scan) const {
  const size_t width = config_.short_ranges ? 2 : 3;
  if (values.size() != width * geometry_.beams())
    return "another number of beams than AMIN and AMAX give";
  for (size_t at = 0; at < values.size(); at += width) {
    const auto range = numberIn(values.substr(at, width));
    if (!range) return "characters that are no ranges";
    scan.ranges.push_back(1e-3F * static_cast<float>(*range));
  }
  scan.angle_first = geometry_.angleFirst();
  scan.angle_step = geometry_.angleStep();
  scan.range_min = 1e-3 * geometry_.range_min_mm;
  scan.range_max = 1e-3 * geometry_.range_max_mm;
  if (config_.short_ranges) scan.range_max = std::min(scan.range_max, kShortMax);
  return {};
}

bool ScipSession::takeTime(uint32_t milliseconds) {
  const uint32_t before = last_milliseconds_.value_or(milliseconds - 1);
  // 24 bits, which wrap after 4 h 39 min, as a signed number.
  const int32_t step = static_cast<int32_t>((milliseconds - before) << 8) / 256;
  if (step == 0) return false;
  last_milliseconds_ = milliseconds;
  ticks_ += static_cast<uint32_t>(1000 * std::clamp(step, -kMostJump, kMostJump));
  if (!clock_.observe(ticks_, began_)) count("device restarts or clock jumps");
  return true;
}

}  // namespace tread::lidar

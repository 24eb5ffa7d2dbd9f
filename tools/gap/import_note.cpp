// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/import_note.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/config/scalars.hpp"

namespace tread::gap {
namespace {

constexpr double kSameGauge = 0.02;  // relative: tape measures and data sheets agree that well

/// What stands behind "key: " at the beginning of a line; empty if there is no such line.
std::string valueOf(const std::string& text, const std::string& key) {
  const std::string begin = "\n" + key + ": ";
  const size_t at = ("\n" + text).find(begin);
  if (at == std::string::npos) return "";
  const size_t from = at + begin.size() - 1;
  std::string value = text.substr(from, text.find('\n', from) - from);
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
    value = value.substr(1, value.size() - 2);
  return value;
}

/// What two imports note, if both do and it differs.
std::optional<std::pair<std::string, std::string>> otherwise(const Drive& first,
                                                             const Drive& second,
                                                             std::string ImportNote::*what) {
  if (!first.imported || !second.imported) return std::nullopt;
  const std::string& one = (*first.imported).*what;
  const std::string& two = (*second.imported).*what;
  if (one.empty() || two.empty() || one == two) return std::nullopt;
  return std::pair{one, two};
}

}  // namespace

std::optional<ImportNote> importNoteOf(const config_t& config) {
  if (config.config_process != "tread-import") return std::nullopt;
  const std::string& text = config.config_text;
  ImportNote note;
  note.robot = valueOf(text, "robot");
  const double baseline = parseNumber(valueOf(text, "baseline")).value_or(0.0);
  if (baseline > 0.05 && baseline < 10.0) note.baseline = baseline;
  const std::string poses = valueOf(text, "poses");
  const std::string gyro = valueOf(text, "gyro");
  if (!poses.empty() && !gyro.empty())
    note.options = "--format " + valueOf(text, "format") + ", poses " + poses + ", gyro " + gyro;
  return note;
}

void requireSameGauge(const Drive& drive, double gauge) {
  if (!drive.imported || drive.imported->baseline <= 0.0) return;
  const double recorded = drive.imported->baseline;
  if (std::abs(recorded - gauge) <= kSameGauge * gauge) return;
  throw std::runtime_error(
      drive.name + ": its commands were made for tracks " + formatNumber(recorded) +
      " m apart, the model says gauge: " + formatNumber(gauge) + "; give a model of this robot");
}

void requireSameImport(const Drive& first, const Drive& second) {
  if (const auto other = otherwise(first, second, &ImportNote::options))
    throw std::runtime_error(second.name + ": imported with " + other->second + ", but " +
                             first.name + " with " + other->first +
                             "; import both in the same way");
}

void requireSameRobot(const Drive& first, const Drive& second) {
  if (const auto other = otherwise(first, second, &ImportNote::robot))
    throw std::runtime_error(second.name + ": of the robot " + other->second + ", but " +
                             first.name + " of the robot " + other->first +
                             "; give logs of one robot");
}

}  // namespace tread::gap

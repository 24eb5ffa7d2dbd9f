// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/recorded_baseline.hpp"

#include <cstdlib>

#include "common/log/event_log.hpp"

namespace tread::gap {
namespace {

/// The number behind "baseline: " at the beginning of a line.
std::optional<double> baselineIn(const std::string& text) {
  const std::string key = "\nbaseline: ";
  const size_t at = text.find(key);
  if (at == std::string::npos) return std::nullopt;
  const double value = std::strtod(text.c_str() + at + key.size(), nullptr);
  if (!(value > 0.05 && value < 10.0)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> recordedBaseline(const std::string& log) {
  LogReader reader(log);
  config_t config;
  for (LogEvent event; reader.next(event);) {
    if (event.channel != kConfig.name || !decode(event, kConfig, config)) continue;
    if (config.config_process == "tread-import") return baselineIn(config.config_text);
  }
  return std::nullopt;
}

}  // namespace tread::gap

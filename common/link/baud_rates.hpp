// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <termios.h>

#include <optional>
#include <utility>

namespace tread {

/// The termios constant of a line rate [1/s]; nothing if serial lines do not have it.
inline std::optional<speed_t> speedOf(int baud) {
  static constexpr std::pair<int, speed_t> kRates[] = {
      {1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},
      {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
      {230400, B230400},   {460800, B460800},   {500000, B500000},   {921600, B921600},
      {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000}, {3000000, B3000000},
      {4000000, B4000000}};
  for (const auto& [rate, speed] : kRates)
    if (rate == baud) return speed;
  return std::nullopt;
}

}  // namespace tread

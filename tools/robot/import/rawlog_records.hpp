// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include <tread/scan_t.hpp>

#include "common/geometry/track.hpp"

namespace tread::import {

/// One sweep of a range finder, or a slice of one.
struct RawlogScan {
  double time = 0.0;  ///< [s] since 1970
  scan_t message;     ///< without utime and seq
};

/// A skipped object and the reason.
struct LeftOut {
  std::string what;
  bool lost = false;  ///< belongs to the drive but is unusable
};

/// Reading stopped here.
struct RawlogProblem {
  std::string what;
};

using RawlogRecord = std::variant<PoseSample, RawlogScan, LeftOut, RawlogProblem>;

/// Reads an MRPT rawlog in a child process and passes each record on.
/** MRPT's reader checks neither lengths nor counts: on a damaged file it writes out of bounds,
 * allocates without limit or hangs. The child process may crash; the last record then reports
 * that. Throws RecordingError if the file cannot be opened or no process can be started. */
void readRawlogRecords(const std::string& path, const std::function<void(RawlogRecord)>& take);

}  // namespace tread::import

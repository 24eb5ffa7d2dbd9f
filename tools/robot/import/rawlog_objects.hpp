// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>

#include "tools/robot/import/rawlog_records.hpp"

namespace tread::import {

/// Reads a rawlog's objects in order with MRPT. It may crash on a damaged file, so
/// readRawlogRecords() runs it in a child process. Throws nothing.
void readRawlogObjects(const std::string& path,
                       const std::function<void(const RawlogRecord&)>& take);

}  // namespace tread::import

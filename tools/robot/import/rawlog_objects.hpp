// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>

#include "tools/robot/import/rawlog_records.hpp"

namespace tread::import {

/// The objects of a rawlog in their order, by MRPT; may crash on a damaged file, so that it runs in
/// a process of its own (see readRawlogRecords). Throws nothing.
void readRawlogObjects(const std::string& path,
                       const std::function<void(const RawlogRecord&)>& take);

}  // namespace tread::import

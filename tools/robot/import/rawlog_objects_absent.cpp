// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Replaces rawlog_objects.cpp in a build without MRPT.
#include "tools/robot/import/rawlog_objects.hpp"

namespace tread::import {

void readRawlogObjects(const std::string& /*path*/,
                       const std::function<void(const RawlogRecord&)>& take) {
  take(RawlogProblem{
      "this program was built without MRPT, which reads rawlogs; run tools/setup import and "
      "build it again"});
}

}  // namespace tread::import

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/setup/setup.hpp"

namespace tread::setup {

/// One page with pictures, as HTML.
std::string reportOf(const SetupResult& result);

}  // namespace tread::setup

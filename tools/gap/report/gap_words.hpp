// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// "2 s end-pose error on driving it has not seen: 0.64 -> 0.45 m, heading 20.5 -> 10.7 deg ...".
std::string gainOf(const Gap& gap);

/// Which of position and heading got worse on driving it has not seen; empty if neither did.
std::string worseOf(const Gap& gap);

/// "the yaw rate residual depends on speed and elapsed time; the along residual on ...".
std::string remainsOf(const std::vector<Unexplained>& rests);

}  // namespace tread::gap

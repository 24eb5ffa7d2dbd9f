// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/gap/core/finding.hpp"
#include "tools/gap/report/page.hpp"

namespace tread::gap {

/// The headline of a report, for instance "Found: Limit of turning power".
std::string headlineOf(const Finding& finding);

/// One sentence in the words of the workshop with the effect's numbers and its direction.
std::string sentenceOf(const FoundEffect& effect);

/// One sentence for each term of the model that is another one now.
std::vector<std::string> movedSentences(const Finding& finding);

/// "2 s end-pose error on driving it has not seen: 0.64 -> 0.45 m, heading 20.5 -> 10.7 deg ...".
std::string gainOf(const Gap& gap);

/// "the yaw rate residual depends on speed and elapsed time; the along residual on ...".
std::string remainsOf(const std::vector<Unexplained>& rests);

/// What stands on the first screen: sentences, gain, what to do next.
std::vector<Block> firstBlocks(const Finding& finding);

/// good, change or doubt.
std::string moodOf(Verdict verdict);

}  // namespace tread::gap

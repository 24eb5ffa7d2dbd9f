// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

const char* verdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoDiscrepancy:
      return "NO_DISCREPANCY";
    case Verdict::kFound:
      return "FOUND";
    case Verdict::kAmbiguous:
      return "AMBIGUOUS";
    case Verdict::kPartial:
      return "PARTIAL";
    case Verdict::kNotInCatalogue:
      return "NOT_IN_CATALOGUE";
    case Verdict::kMeasurement:
      return "MEASUREMENT";
    case Verdict::kCannotTell:
      return "CANNOT_TELL";
  }
  return "";
}

}  // namespace tread::gap

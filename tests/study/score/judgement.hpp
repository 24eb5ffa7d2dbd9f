// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/case_record.hpp"

namespace tread::blindtest {

/// How well one parameter was found.
struct ParameterError {
  std::string path;
  std::string shape;      ///< same, other
  double relative = 0.0;  ///< |estimate - truth| / |size of what was hidden|
  bool inside = false;    ///< the truth lies in the 95 % interval
};

/// What an answer is worth.
struct Judgement {
  bool right_verdict = false;
  bool refused = false;  ///< CANNOT_TELL, or an error, with a reason
  bool flagged = false;  ///< something unexplained is left, and said
  bool alarm = false;    ///< something is named, or a term of the model called another one
  bool nothing = false;  ///< no effect is named and none has moved
  size_t found = 0;      ///< hidden effects that are named, or moved where they were on already
  size_t moved = 0;      ///< of these, those that the nominal model had on already
  /// The first name is a hidden effect's, or nothing is named and a hidden effect's number moved.
  bool first_right = false;
  bool listed = false;          ///< every hidden effect is found, a runner-up or said to be alike
  bool only_wrong = false;      ///< something is named, and nothing that was hidden
  bool exact = false;           ///< all that was hidden, and nothing else
  bool grouped = false;         ///< says that it cannot tell: AMBIGUOUS, or a group with the truth
  bool right_variable = false;  ///< what is left depends on what the truth depends on
  bool excited = true;          ///< the drive shows what was hidden at all
  double closed = kUnknown;     ///< share of the gap to the oracle that was closed; NaN = no gap
  double closed_median = kUnknown;  ///< the same by medians of the end errors instead of rms
  std::vector<ParameterError> parameters;
};

/// Whether a name is that of a hidden effect, or of one that no drive can tell from it.
bool covers(const std::string& name, const HiddenEffect& hidden);

/// Whether a name is part of what an answer says of a hidden effect: it covers it, or is of several
/// effects that are the same together and are all named.
bool belongs(const std::string& name, const HiddenEffect& hidden, const Answer& answer);

/// Whether a hidden effect's number, or that of one of its group, is on in the nominal model and
/// moved by more than three standard deviations.
bool moved(const Answer& answer, const HiddenEffect& hidden);

Judgement judge(const CaseRecord& record);

/// Where a number of the truth stands in a model file.
struct SameQuantity {
  std::string parameter;
  double factor = 1.0;  ///< from the truth's unit to the model's
  bool limit = false;   ///< the value itself; else a change against the nominal model
};

/// The model's parameter for a symbol of the truth file; nothing where there is no equivalent.
/** `duration` [s] of the log: the truth tells a battery's loss by its end. */
std::optional<SameQuantity> sameQuantity(const std::string& effect, const std::string& symbol,
                                         double duration);

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/case_record.hpp"

namespace tread::blindtest {

/// Accuracy of one estimated parameter.
struct ParameterError {
  std::string path;
  std::string shape;      ///< same, other
  double relative = 0.0;  ///< |estimate - truth| / |hidden size|
  bool inside = false;    ///< the truth is in the 95 % interval
};

/// Score of an answer.
struct Judgement {
  bool right_verdict = false;
  bool refused = false;  ///< CANNOT_TELL, or an error, with a reason
  bool flagged = false;  ///< something unexplained is left and reported
  bool alarm = false;    ///< something is named, or a term of the model is reported as changed
  bool nothing = false;  ///< no effect is named and none has changed
  /// hidden effects that are named, or reported as changed if they were on already
  size_t found = 0;
  size_t moved = 0;  ///< of these, those that the nominal model had already
  /// The first name is a hidden effect's, or nothing is named and a hidden effect's number changed.
  bool first_right = false;
  bool listed = false;      ///< every hidden effect is found, a runner-up or listed as equivalent
  bool only_wrong = false;  ///< names are given, but none is hidden
  bool exact = false;       ///< all hidden effects and no others
  bool grouped = false;     ///< undecided: AMBIGUOUS, or a group with the truth
  bool right_variable = false;  ///< the residual depends on the truth's variables
  bool excited = true;          ///< the drive shows the hidden effect at all
  double closed = kUnknown;     ///< share of the gap to the oracle that was closed; NaN = no gap
  double closed_median = kUnknown;  ///< the same with medians of the end errors instead of rms
  std::vector<ParameterError> parameters;
};

/// Whether a name is a hidden effect's, or an indistinguishable one's.
bool covers(const std::string& name, const HiddenEffect& hidden);

/// Whether a name is part of a correct answer for a hidden effect: it covers it, or belongs to an
/// equivalent combination that is completely named.
bool belongs(const std::string& name, const HiddenEffect& hidden, const Answer& answer);

/// Whether the number of a hidden effect, or of one of its group, is in the nominal model and
/// changed by more than three standard deviations.
bool moved(const Answer& answer, const HiddenEffect& hidden);

Judgement judge(const CaseRecord& record);

/// A number of the truth in a model file.
struct SameQuantity {
  std::string parameter;
  double factor = 1.0;  ///< from the truth's unit to the model's
  bool limit = false;   ///< the value itself; else a change relative to the nominal model
};

/// The model's parameter for a symbol of the truth file; nullopt if there is no equivalent.
/** `duration` [s] of the log: the truth gives a battery's loss at its end. */
std::optional<SameQuantity> sameQuantity(const std::string& effect, const std::string& symbol,
                                         double duration);

}  // namespace tread::blindtest

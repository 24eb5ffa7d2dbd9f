// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/tables.hpp"

namespace tread::experiment {

/// A cell of the paper's Tables I and II for one transition and quantity, as printed.
struct PaperCell {
  const char* from;
  const char* to;
  const char* quantity;
  std::array<double, 4> errors;  ///< columns a, b, c, d per driven metre or radian
  double reduction;              ///< [%] of c against b
};

/// All 24 cells.
const std::vector<PaperCell>& paperCells();
/// The cell, if the paper has these surfaces.
const PaperCell* paperCell(const std::string& from, const std::string& to,
                           const std::string& quantity);
/// The rules of columns a, b, c, d.
const std::array<std::string, 4>& paperRules();

/// Why a printed number is probably a misprint; empty if nothing speaks against it.
std::string doubtOfError(const PaperCell& cell, size_t column);
std::string doubtOfReduction(const PaperCell& cell);

/// How near a table comes to the paper's.
struct Agreement {
  /// Root of the mean squared difference in columns a, b, c, d; the transition cinder -> tarmac is
  /// left out of the orientation. NaN where nothing can be compared.
  std::array<double, 4> position_rms;
  std::array<double, 4> orientation_rms;
  int cells = 0;  ///< compared reductions of each quantity
  int position_signs = 0;
  int orientation_signs = 0;
};

/// Nothing if no transition of the tables is the paper's.
std::optional<Agreement> agreementWithPaper(const Tables& tables);

}  // namespace tread::experiment

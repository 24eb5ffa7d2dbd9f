// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/paper_numbers.hpp"

#include <cmath>

namespace tread::experiment {
namespace {

bool is(const PaperCell& cell, const char* from, const char* to, const char* quantity) {
  return std::string(cell.from) == from && std::string(cell.to) == to &&
         std::string(cell.quantity) == quantity;
}

bool isLeftOut(const PaperCell& cell) {
  return is(cell, "cinder", "tarmac", kOrientation);
}

/// Squared differences of one column.
struct Squares {
  double sum = 0.0;
  int count = 0;
  double rms() const { return count > 0 ? std::sqrt(sum / count) : Estimate{}.value; }
};

}  // namespace

const std::vector<PaperCell>& paperCells() {
  static const std::vector<PaperCell> cells{
      {"cinder", "tarmac", kPosition, {0.043, 0.043, 0.042, 0.035}, 1.5},
      {"cinder", "tarmac", kOrientation, {0.041, 0.043, 0.042, 0.037}, 18.5},
      {"cinder", "grass", kPosition, {0.087, 0.077, 0.063, 0.039}, 17.8},
      {"cinder", "grass", kOrientation, {0.271, 0.226, 0.162, 0.067}, 27.9},
      {"cinder", "gravel", kPosition, {0.063, 0.061, 0.058, 0.046}, 3.4},
      {"cinder", "gravel", kOrientation, {0.164, 0.147, 0.126, 0.099}, 13.5},
      {"tarmac", "cinder", kPosition, {0.059, 0.055, 0.056, 0.041}, -0.5},
      {"tarmac", "cinder", kOrientation, {0.107, 0.100, 0.091, 0.030}, 8.5},
      {"tarmac", "grass", kPosition, {0.060, 0.057, 0.051, 0.039}, 10.3},
      {"tarmac", "grass", kOrientation, {0.204, 0.172, 0.129, 0.067}, 24.9},
      {"tarmac", "gravel", kPosition, {0.054, 0.054, 0.057, 0.046}, -4.9},
      {"tarmac", "gravel", kOrientation, {0.113, 0.111, 0.109, 0.099}, 1.2},
      {"grass", "cinder", kPosition, {0.108, 0.093, 0.085, 0.041}, 9.1},
      {"grass", "cinder", kOrientation, {0.372, 0.313, 0.231, 0.030}, 26.0},
      {"grass", "tarmac", kPosition, {0.071, 0.064, 0.060, 0.035}, 5.0},
      {"grass", "tarmac", kOrientation, {0.256, 0.214, 0.154, 0.037}, 27.8},
      {"grass", "gravel", kPosition, {0.063, 0.060, 0.059, 0.046}, -1.1},
      {"grass", "gravel", kOrientation, {0.165, 0.151, 0.133, 0.099}, 7.3},
      {"gravel", "cinder", kPosition, {0.060, 0.056, 0.055, 0.041}, 0.3},
      {"gravel", "cinder", kOrientation, {0.191, 0.166, 0.134, 0.030}, 18.4},
      {"gravel", "tarmac", kPosition, {0.045, 0.044, 0.046, 0.035}, -5.4},
      {"gravel", "tarmac", kOrientation, {0.090, 0.079, 0.066, 0.037}, 15.6},
      {"gravel", "grass", kPosition, {0.064, 0.060, 0.057, 0.039}, 4.5},
      {"gravel", "grass", kOrientation, {0.136, 0.119, 0.098, 0.067}, 17.2},
  };
  return cells;
}

const PaperCell* paperCell(const std::string& from, const std::string& to,
                           const std::string& quantity) {
  for (const PaperCell& cell : paperCells())
    if (cell.from == from && cell.to == to && cell.quantity == quantity) return &cell;
  return nullptr;
}

const std::array<std::string, 4>& paperRules() {
  static const std::array<std::string, 4> rules{"off", "single", "collective", kOmniscient};
  return rules;
}

std::string doubtOfError(const PaperCell& cell, size_t column) {
  if (isLeftOut(cell))
    return "probably a misprint: all other cells speak for about .092 .081 .066 .038, which gives "
           "the 18.5 % of Table II";
  if (is(cell, "tarmac", "cinder", kOrientation) && column == 1)
    return "column b probably a misprint: it does not fit its neighbours a and c, nor Table II";
  return "";
}

std::string doubtOfReduction(const PaperCell& cell) {
  if (is(cell, "grass", "gravel", kOrientation)) return "Table I gives 11.9";
  if (is(cell, "grass", "gravel", kPosition)) return "Table I gives +1.7: the sign is doubtful";
  return "";
}

std::optional<Agreement> agreementWithPaper(const Tables& tables) {
  Agreement agreement;
  std::array<Squares, 4> position, orientation;
  for (const PaperCell& cell : paperCells()) {
    const bool is_position = std::string(cell.quantity) == kPosition;
    for (size_t column = 0; column < 4; ++column) {
      const Row* row = find(tables.errors, cell.from, cell.to, cell.quantity, paperRules()[column]);
      if (row == nullptr || isLeftOut(cell)) continue;
      Squares& squares = (is_position ? position : orientation)[column];
      squares.sum += std::pow(row->estimate.value - cell.errors[column], 2);
      ++squares.count;
    }
    const Row* row =
        find(tables.reductions, cell.from, cell.to, cell.quantity, "collective", "single");
    if (row == nullptr) continue;
    if (is_position) ++agreement.cells;
    if ((row->estimate.value > 0.0) == (cell.reduction > 0.0))
      ++(is_position ? agreement.position_signs : agreement.orientation_signs);
  }
  int compared = 0;
  for (size_t column = 0; column < 4; ++column) {
    agreement.position_rms[column] = position[column].rms();
    agreement.orientation_rms[column] = orientation[column].rms();
    compared += position[column].count;
  }
  if (compared == 0) return std::nullopt;
  return agreement;
}

}  // namespace tread::experiment

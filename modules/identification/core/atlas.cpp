// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/student.hpp"

namespace tread::gap {
namespace {

constexpr int kCells = 9;
constexpr size_t kLeastRows = 12;
constexpr size_t kLeastBlocks = 4;
constexpr double kMarked = 3.9;  // normal quantile: 5 % over some 500 cells

/// Cells of equal numbers of rows over one variable.
std::vector<double> edgesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> edges;
  for (int i = 0; i <= kCells; ++i) {
    const size_t at = (values.size() - 1) * static_cast<size_t>(i) / kCells;
    if (edges.empty() || values[at] > edges.back() + 1e-9) edges.push_back(values[at]);
  }
  return edges;
}

AtlasCell cellOf(const Rows& rows, const std::vector<size_t>& members,
                 const Eigen::VectorXd& residuals) {
  AtlasCell cell;
  cell.rows = members.size();
  std::map<int, std::pair<double, double>> blocks;  // sum, number
  for (size_t i : members) {
    auto& block = blocks[rows.rows()[i].block];
    block.first += residuals[static_cast<Eigen::Index>(i)];
    block.second += 1.0;
    cell.mean += residuals[static_cast<Eigen::Index>(i)];
  }
  if (members.size() < kLeastRows || blocks.size() < kLeastBlocks) {
    cell.low = -std::numeric_limits<double>::infinity();
    cell.high = std::numeric_limits<double>::infinity();
    if (!members.empty()) cell.mean /= static_cast<double>(members.size());
    return cell;
  }
  const auto count = static_cast<double>(members.size());
  cell.mean /= count;
  double scatter = 0.0;
  for (const auto& [block, sum] : blocks)
    scatter += std::pow(sum.first - sum.second * cell.mean, 2);
  const auto number = static_cast<double>(blocks.size());
  const double error = std::sqrt(scatter * number / (number - 1.0)) / count;
  const double half = studentQuantile(number - 1.0) * error;
  cell.low = cell.mean - half;
  cell.high = cell.mean + half;
  cell.marked = std::abs(cell.mean) > studentQuantile(number - 1.0, kMarked) * error;
  return cell;
}

std::vector<AtlasCell> cellsOf(const Rows& rows, const std::vector<size_t>& members,
                               const Eigen::VectorXd& variable, const std::vector<double>& edges,
                               const Eigen::VectorXd& residuals) {
  std::vector<std::vector<size_t>> in_cell(edges.size() - 1);
  for (size_t i : members) {
    const double value = variable[static_cast<Eigen::Index>(i)];
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
    in_cell[static_cast<size_t>(std::distance(edges.begin() + 1, above))].push_back(i);
  }
  std::vector<AtlasCell> cells;
  for (size_t c = 0; c < in_cell.size(); ++c) {
    cells.push_back(cellOf(rows, in_cell[c], residuals));
    cells.back().from = edges[c];
    cells.back().to = edges[c + 1];
  }
  return cells;
}

/// Variables that a person looks at; the others are combinations of them.
bool isShown(const std::string& variable) {
  static const std::set<std::string> kShown{"v",           "yaw rate",           "v x yaw rate",
                                            "change of v", "change of yaw rate", "pitch",
                                            "roll",        "elapsed time"};
  return kShown.count(variable) != 0;
}

Variable elapsedTime(const Rows& rows) {
  Variable time{"elapsed time", "s", Eigen::VectorXd(rows.rows().size())};
  for (size_t i = 0; i < rows.rows().size(); ++i)
    time.values[static_cast<Eigen::Index>(i)] = rows.rows()[i].begin;
  return time;
}

}  // namespace

std::vector<AtlasCurve> residualAtlas(const Rows& rows, const ModelDocument& before,
                                      const ModelDocument& after) {
  std::vector<Variable> variables = variablesOf(rows, before);
  variables.push_back(elapsedTime(rows));
  const Eigen::VectorXd old_residuals = rows.residuals(rows.predict(before));
  const Eigen::VectorXd new_residuals = rows.residuals(rows.predict(after));
  std::vector<AtlasCurve> atlas;
  for (size_t c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<Channel>(c);
    std::vector<size_t> members;
    for (size_t i = 0; i < rows.rows().size(); ++i)
      if (rows.rows()[i].channel == channel) members.push_back(i);
    if (members.empty()) continue;
    for (const Variable& variable : variables) {
      if (!isShown(variable.name)) continue;
      std::vector<double> values;
      for (size_t i : members) values.push_back(variable.values[static_cast<Eigen::Index>(i)]);
      const std::vector<double> edges = edgesOf(std::move(values));
      if (edges.size() < 3) continue;
      AtlasCurve curve;
      curve.channel = channelName(channel);
      curve.unit = channelUnit(channel);
      curve.variable = variable.name;
      curve.variable_unit = variable.unit;
      curve.before = cellsOf(rows, members, variable.values, edges, old_residuals);
      curve.after = cellsOf(rows, members, variable.values, edges, new_residuals);
      atlas.push_back(std::move(curve));
    }
  }
  return atlas;
}

}  // namespace tread::gap

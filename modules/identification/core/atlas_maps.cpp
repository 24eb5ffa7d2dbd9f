// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/atlas_maps.hpp"

#include <algorithm>

#include "modules/identification/core/adequacy.hpp"

namespace tread::gap {
namespace {

constexpr size_t kFields = 10;    // along each axis
constexpr size_t kLeastRows = 4;  // a mean of fewer is not shown

/// Equal fields over what is common: one reading in a hundred at either end is left out.
std::vector<double> edgesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t margin = values.size() / 100;
  const double low = values[margin];
  const double high = values[values.size() - 1 - margin];
  if (!(high - low > 1e-9)) return {};
  std::vector<double> edges(kFields + 1);
  for (size_t i = 0; i <= kFields; ++i)
    edges[i] = low + (high - low) * static_cast<double>(i) / static_cast<double>(kFields);
  return edges;
}

/// The field in which a value lies; nothing outside.
std::optional<size_t> fieldOf(const std::vector<double>& edges, double value) {
  if (value < edges.front() || value > edges.back()) return std::nullopt;
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
  return static_cast<size_t>(std::distance(edges.begin() + 1, above));
}

std::vector<double> meansOf(const AtlasMap& map, const std::vector<size_t>& members,
                            const Eigen::VectorXd& v, const Eigen::VectorXd& omega,
                            const Eigen::VectorXd& residuals) {
  std::vector<double> sums(kFields * kFields, 0.0);
  std::vector<size_t> numbers(kFields * kFields, 0);
  for (const size_t i : members) {
    const auto at = static_cast<Eigen::Index>(i);
    const auto column = fieldOf(map.v_edges, v[at]);
    const auto row = fieldOf(map.omega_edges, omega[at]);
    if (!column || !row) continue;
    sums[*row * kFields + *column] += residuals[at];
    ++numbers[*row * kFields + *column];
  }
  for (size_t i = 0; i < sums.size(); ++i)
    sums[i] = numbers[i] < kLeastRows ? kNotMeasured : sums[i] / static_cast<double>(numbers[i]);
  return sums;
}

std::vector<double> pick(const Eigen::VectorXd& values, const std::vector<size_t>& members) {
  std::vector<double> picked;
  picked.reserve(members.size());
  for (const size_t i : members) picked.push_back(values[static_cast<Eigen::Index>(i)]);
  return picked;
}

const Variable* named(const std::vector<Variable>& variables, const std::string& name) {
  for (const Variable& variable : variables)
    if (variable.name == name) return &variable;
  return nullptr;
}

}  // namespace

std::vector<AtlasMap> residualMaps(const Rows& rows, const ModelDocument& before,
                                   const ModelDocument& after) {
  const std::vector<Variable> variables = variablesOf(rows, before);
  const Variable* v = named(variables, "v");
  const Variable* omega = named(variables, "yaw rate");
  if (v == nullptr || omega == nullptr) return {};
  const Eigen::VectorXd old_residuals = rows.residuals(rows.predict(before));
  const Eigen::VectorXd new_residuals = rows.residuals(rows.predict(after));
  std::vector<AtlasMap> maps;
  for (size_t c = 0; c < kChannels; ++c) {
    std::vector<size_t> members;
    for (size_t i = 0; i < rows.rows().size(); ++i)
      if (rows.rows()[i].channel == static_cast<Channel>(c)) members.push_back(i);
    if (members.empty()) continue;
    AtlasMap map;
    map.channel = channelName(static_cast<Channel>(c));
    map.unit = channelUnit(static_cast<Channel>(c));
    map.v_edges = edgesOf(pick(v->values, members));
    map.omega_edges = edgesOf(pick(omega->values, members));
    if (map.v_edges.empty() || map.omega_edges.empty()) continue;
    map.before = meansOf(map, members, v->values, omega->values, old_residuals);
    map.after = meansOf(map, members, v->values, omega->values, new_residuals);
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace tread::gap

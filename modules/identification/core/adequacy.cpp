// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/adequacy.hpp"

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "modules/identification/core/observations.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/smooth_test.hpp"

namespace tread::gap {
namespace {

constexpr int kDraws = 1999;  // of the bootstrap over the variables

constexpr int kCells = 9;
constexpr size_t kLeastRows = 12;
constexpr size_t kLeastResidualBlocks = 4;
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

AtlasCell cellOf(const Observations& data, const std::vector<size_t>& members,
                 const Eigen::VectorXd& residuals) {
  AtlasCell cell;
  cell.rows = members.size();
  std::map<int, std::pair<double, double>> blocks;  // sum, number
  for (size_t i : members) {
    auto& block = blocks[data.all()[i].block];
    block.first += residuals[static_cast<Eigen::Index>(i)];
    block.second += 1.0;
    cell.mean += residuals[static_cast<Eigen::Index>(i)];
  }
  if (members.size() < kLeastRows || blocks.size() < kLeastResidualBlocks) {
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

std::vector<AtlasCell> cellsOf(const Observations& data, const std::vector<size_t>& members,
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
    cells.push_back(cellOf(data, in_cell[c], residuals));
    cells.back().from = edges[c];
    cells.back().to = edges[c + 1];
  }
  return cells;
}

/// Variables of the standard view; the others are combinations of them.
bool isShownVariable(const std::string& variable) {
  static const std::set<std::string> kShown{"v",           "yaw rate",           "v x yaw rate",
                                            "change of v", "change of yaw rate", "pitch",
                                            "roll",        "elapsed time"};
  return kShown.count(variable) != 0;
}

Variable elapsedTime(const Observations& data) {
  Variable time{"elapsed time", "s", Eigen::VectorXd(data.all().size())};
  for (size_t i = 0; i < data.all().size(); ++i)
    time.values[static_cast<Eigen::Index>(i)] = data.all()[i].begin;
  return time;
}

constexpr size_t kFields = 10;       // along each axis
constexpr size_t kLeastInField = 4;  // means of fewer rows are not shown

/// Equal cells over the common range: one value in a hundred at either end is left out.
std::vector<double> fieldEdges(std::vector<double> values) {
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

/// The cell that contains a value; nullopt outside.
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
    sums[i] = numbers[i] < kLeastInField ? kNotMeasured : sums[i] / static_cast<double>(numbers[i]);
  return sums;
}

std::vector<double> pick(const Eigen::VectorXd& values, const std::vector<size_t>& members) {
  std::vector<double> picked;
  picked.reserve(members.size());
  for (const size_t i : members) picked.push_back(values[static_cast<Eigen::Index>(i)]);
  return picked;
}

const Variable& named(const std::vector<Variable>& variables, const std::string& name) {
  return *std::find_if(variables.begin(), variables.end(),
                       [&name](const Variable& variable) { return variable.name == name; });
}

/// Variables and the residuals of both models in every row.
struct AtlasRows {
  std::vector<Variable> variables;
  Eigen::VectorXd before;
  Eigen::VectorXd after;
};

/// Rank of a channel and variable among the unexplained ones; at the end if they are not among
/// them.
size_t placeAmong(const std::vector<Unexplained>& unexplained, const std::string& channel,
                  const std::string& variable) {
  const auto at = std::find_if(unexplained.begin(), unexplained.end(), [&](const Unexplained& one) {
    return one.channel == channel && one.variable == variable;
  });
  return static_cast<size_t>(std::distance(unexplained.begin(), at));
}

void addCurves(const Observations& data, const AtlasRows& of, ObservedRate channel,
               const std::vector<size_t>& members, const std::vector<Unexplained>& unexplained,
               std::vector<AtlasCurve>& curves) {
  for (const Variable& variable : of.variables) {
    const bool is_rest =
        placeAmong(unexplained, channelName(channel), variable.name) < unexplained.size();
    if (!isShownVariable(variable.name) && !is_rest) continue;
    const std::vector<double> edges = edgesOf(pick(variable.values, members));
    if (edges.size() < 3) continue;
    curves.push_back({channelName(channel), channelUnit(channel), variable.name, variable.unit,
                      cellsOf(data, members, variable.values, edges, of.before),
                      cellsOf(data, members, variable.values, edges, of.after), is_rest});
  }
}

void addMap(const AtlasRows& of, ObservedRate channel, const std::vector<size_t>& members,
            std::vector<AtlasMap>& maps) {
  const Eigen::VectorXd& v = named(of.variables, "v").values;
  const Eigen::VectorXd& omega = named(of.variables, "yaw rate").values;
  AtlasMap map{channelName(channel),
               channelUnit(channel),
               fieldEdges(pick(v, members)),
               fieldEdges(pick(omega, members)),
               {},
               {}};
  if (map.v_edges.empty() || map.omega_edges.empty()) return;
  map.before = meansOf(map, members, v, omega, of.before);
  map.after = meansOf(map, members, v, omega, of.after);
  maps.push_back(std::move(map));
}

constexpr size_t kLikened = 3;     // rests, the strongest ones
constexpr double kLikeness = 0.5;  // correlation from which two directions are similar

/// Directions in which the effects of the catalogue act or could act, with their names.
struct EffectDirections {
  std::vector<std::string> effects;
  Eigen::MatrixXd columns;  ///< rows x effects
};

EffectDirections effectDirections(const Fitter& fitter, const FitState& state) {
  EffectDirections all;
  const std::vector<Candidate> candidates =
      candidatesFor(state.model, excitationOf(fitter.data(), state.model));
  all.columns.resize(state.predicted.size(),
                     static_cast<Eigen::Index>(candidates.size() + state.free.size()));
  all.columns.leftCols(static_cast<Eigen::Index>(candidates.size())) =
      directionsOf(fitter, state, candidates);
  all.columns.rightCols(static_cast<Eigen::Index>(state.free.size())) = state.jacobian;
  for (const Candidate& candidate : candidates) all.effects.push_back(candidate.effect);
  for (const FreeParameter& parameter : state.free)
    all.effects.push_back(restTermOf(parameter.path) ||
                                  termOfPath(state.model, parameter.path) != nullptr
                              ? ""
                              : effectOfPath(parameter.path));
  return all;
}

/// The effect whose direction is most similar to another one where that is not 0; empty if none is.
std::string mostLike(const EffectDirections& all, const Eigen::VectorXd& direction,
                     const Eigen::VectorXd& scales) {
  const Eigen::VectorXd own = direction.cwiseQuotient(scales);
  std::string like;
  double most = kLikeness;
  for (Eigen::Index i = 0; i < all.columns.cols(); ++i) {
    Eigen::VectorXd other = all.columns.col(i).cwiseQuotient(scales);
    for (Eigen::Index row = 0; row < own.size(); ++row)
      if (direction[row] == 0.0) other[row] = 0.0;
    const double size = own.norm() * other.norm();
    const double likeness = size > 0.0 ? std::abs(own.dot(other)) / size : 0.0;
    if (likeness <= most) continue;
    most = likeness;
    like = all.effects[static_cast<size_t>(i)];
  }
  return like;
}

/// An unexplained dependence, and its direction.
struct Rest {
  Unexplained told;
  Eigen::VectorXd direction;  ///< rows x 1
};

/// Adds the variables on which residuals depend; returns the least p-value of all.
double restsOnVariables(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed,
                        std::vector<Rest>& rests) {
  const std::vector<Variable> variables = variablesOf(fitter.data(), state.model);
  const Eigen::MatrixXd directions = perChannel(fitter.data(), variables);
  const ScoreTest test(fitter, state, directions);
  const std::vector<double> chance = test.largestByChance(kDraws, seed);
  double least = 1.0;
  for (size_t channel = 0; channel < kChannels; ++channel)
    for (size_t v = 0; v < variables.size(); ++v) {
      const auto at = static_cast<Eigen::Index>(channel * variables.size() + v);
      const double p = familyWise(chance, test.score(at));
      least = std::min(least, p);
      if (p > alpha) continue;
      rests.push_back({{channelName(static_cast<ObservedRate>(channel)), variables[v].name,
                        test.score(at), p, ""},
                       directions.col(at)});
    }
  return least;
}

constexpr double kSmoothShare =
    0.5;  // of the error probability, in addition to that of the variables

/// Adds channels whose residuals are a function of all conditions together and that have no rest so
/// far; returns the least p-value, scaled to a test at `alpha`.
double restsOnAll(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed,
                  std::vector<Rest>& rests) {
  double least = 1.0;
  const std::vector<RestTerm> known =
      fitter.rest().cols() > 0 ? *state.model.rest : std::vector<RestTerm>{};
  for (SmoothRest& rest : smoothRests(fitter, state, inputsOf(fitter.data(), state.model), known,
                                      kSmoothShare * alpha, seed)) {
    const double p = std::min(1.0, rest.p_value / kSmoothShare);
    least = std::min(least, p);
    const bool told = std::any_of(rests.begin(), rests.end(), [&rest](const Rest& other) {
      return std::any_of(
          rest.channels.begin(), rest.channels.end(),
          [&other](ObservedRate channel) { return other.told.channel == channelName(channel); });
    });
    if (p <= alpha && !told)
      rests.push_back({{channelName(rest.channels.front()), rest.variable, rest.score, p, ""},
                       std::move(rest.function)});
  }
  return least;
}

}  // namespace

Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed) {
  std::vector<Rest> rests;
  Adequacy adequacy;
  adequacy.p_value = restsOnVariables(fitter, state, alpha, seed, rests);
  adequacy.p_value = std::min(adequacy.p_value, restsOnAll(fitter, state, alpha, seed, rests));
  if (rests.empty()) return adequacy;
  std::stable_sort(rests.begin(), rests.end(), [](const Rest& a, const Rest& b) {
    return std::abs(a.told.score) > std::abs(b.told.score);
  });
  const EffectDirections effects = effectDirections(fitter, state);
  for (Rest& rest : rests) {
    if (adequacy.unexplained.size() < kLikened)
      rest.told.like = mostLike(effects, rest.direction, state.scales);
    adequacy.unexplained.push_back(std::move(rest.told));
  }
  return adequacy;
}

ResidualAtlas residualAtlas(const Observations& data, const ModelDocument& before,
                            const ModelDocument& after,
                            const std::vector<Unexplained>& unexplained) {
  AtlasRows of{variablesOf(data, before), data.residuals(data.predict(before)),
               data.residuals(data.predict(after))};
  of.variables.push_back(elapsedTime(data));
  for (Variable& input : inputsOf(data, before))
    if (std::none_of(of.variables.begin(), of.variables.end(),
                     [&input](const Variable& other) { return other.name == input.name; }))
      of.variables.push_back(std::move(input));
  ResidualAtlas atlas;
  for (size_t c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<ObservedRate>(c);
    std::vector<size_t> members;
    for (size_t i = 0; i < data.all().size(); ++i)
      if (data.all()[i].channel == channel) members.push_back(i);
    if (members.empty()) continue;
    addCurves(data, of, channel, members, unexplained, atlas.curves);
    addMap(of, channel, members, atlas.maps);
  }
  std::stable_sort(atlas.curves.begin(), atlas.curves.end(),
                   [&](const AtlasCurve& a, const AtlasCurve& b) {
                     return placeAmong(unexplained, a.channel, a.variable) <
                            placeAmong(unexplained, b.channel, b.variable);
                   });
  return atlas;
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/rest.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "modules/identification/core/screening.hpp"
#include "modules/identification/core/smooth_test.hpp"

namespace tread::gap {
namespace {

constexpr double kRestAlpha = 0.05;  // larger than the adequacy test's: a dependence that was
                                     // nearly significant is no news either
constexpr size_t kMostTerms = 12;
/// Number of functions that conditions distinguish, see restVariation(). Chosen on vehicles with
/// different physics: with 5, two of 17 hidden effects lost their names; with 10, one got a false
/// one in addition.
constexpr double kFunctions = 20.0;
constexpr int kRestDraws = 1999;
constexpr double kAnySize = 1e9;           // bound of a size, in any unit
constexpr double kLeastDeviation = 1e-12;  // so that no prior is absolute

ObservedRate channelNamed(const std::string& name) {
  for (size_t i = 0; i < kChannels; ++i)
    if (name == channelName(static_cast<ObservedRate>(i))) return static_cast<ObservedRate>(i);
  throw std::invalid_argument("rest: '" + name +
                              "' is no channel of the residuals; take the term out of the model");
}

/// The channel whose function of all conditions includes a channel, see smoothRests().
const char* channelOfFunction(ObservedRate channel) {
  return channelName(channel == ObservedRate::kHeading ? ObservedRate::kYawRate : channel);
}

FreeParameter sizeOf(size_t term, double expected, double deviation) {
  return {restPath(term), -kAnySize, kAnySize, 1.0, expected, deviation};
}

/// A fit of a rest: its terms are free in a state, the numbers of the model are fixed.
class RestFit {
 public:
  RestFit(const Fitter& fitter, const FitState& state)
      : found_(state), held_(state), fitter_(fitter) {
    held_.free = restParameters(fitter, state.model);
    for (size_t i = 0; i < found_.free.size();)
      if (restTermOf(found_.free[i].path))
        fitter.release(found_, i);
      else
        ++i;
    if (fitter.rest().cols() == 0) held_.model.rest.emplace();
    found_.predicted = fitter.data().predict(state.model);
    fit();
  }

  /// The state without a rest.
  const FitState& found() const { return found_; }

  std::vector<RestTerm>& terms() { return *held_.model.rest; }

  void add(const RestTerm& term, const Eigen::VectorXd& direction) {
    terms().push_back(term);
    held_.free.push_back(sizeOf(terms().size() - 1, 0.0, std::numeric_limits<double>::infinity()));
    Eigen::MatrixXd conditions = fitter_->rest();
    conditions.conservativeResize(held_.predicted.size(), conditions.cols() + 1);
    conditions.rightCols(1) = direction;
    const Fitter with(fitter_->data(), fitter_->parallel(), std::move(conditions));
    fitter_.emplace(with);
    fit();
  }

  /// The state with the rest: everything is free.
  FitState state() const {
    FitState all = found_;
    all.model = held_.model;
    all.predicted = held_.predicted;
    all.free.insert(all.free.end(), held_.free.begin(), held_.free.end());
    all.jacobian.conservativeResize(all.predicted.size(),
                                    all.jacobian.cols() + held_.jacobian.cols());
    all.jacobian.rightCols(held_.jacobian.cols()) = held_.jacobian;
    return all;
  }

  const Fitter& fitter() const { return *fitter_; }

  void measureDeviations() {
    const Eigen::MatrixXd covariance = parameterCovariance(*fitter_, held_);
    for (size_t i = 0; i < held_.free.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      terms()[*restTermOf(held_.free[i].path)].deviation = std::sqrt(covariance(at, at));
    }
  }

 private:
  void fit() {
    fitter_->renewJacobian(held_);  // columns without simulation
    held_.predicted = fitter_->predict(held_.model);
    fitter_->fitRoughly(held_);
  }

  FitState found_;  ///< without a rest
  FitState held_;   ///< the rest alone
  std::optional<Fitter> fitter_;
};

}  // namespace

Eigen::VectorXd inChannel(const Observations& data, const Variable& variable,
                          ObservedRate channel) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(variable.values.size());
  for (Eigen::Index row = 0; row < values.size(); ++row)
    if (data.all()[static_cast<size_t>(row)].channel == channel) values[row] = variable.values[row];
  return values;
}

Eigen::MatrixXd perChannel(const Observations& data, const std::vector<Variable>& variables) {
  const size_t count = variables.size();
  Eigen::MatrixXd directions(static_cast<Eigen::Index>(data.all().size()),
                             static_cast<Eigen::Index>(count * kChannels));
  for (size_t i = 0; i < count * kChannels; ++i)
    directions.col(static_cast<Eigen::Index>(i)) =
        inChannel(data, variables[i % count], static_cast<ObservedRate>(i / count));
  return directions;
}

Eigen::MatrixXd restConditions(const Observations& data, const ModelDocument& model) {
  const std::vector<RestTerm> rest = model.rest.value_or(std::vector<RestTerm>{});
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(data.all().size()),
                                                     static_cast<Eigen::Index>(rest.size()));
  if (rest.empty()) return conditions;
  const std::vector<Variable> variables = variablesOf(data, model);
  for (size_t i = 0; i < rest.size(); ++i) {
    const std::string& name = rest[i].condition;
    const ObservedRate channel = channelNamed(rest[i].channel);
    const auto variable = std::find_if(variables.begin(), variables.end(),
                                       [&name](const Variable& one) { return one.name == name; });
    if (variable != variables.end())
      conditions.col(static_cast<Eigen::Index>(i)) = inChannel(data, *variable, channel);
    else if (name != kAllConditions)
      throw std::invalid_argument("rest: '" + name +
                                  "' is no condition that is tested; take it out of the model");
  }
  return conditions;
}

std::vector<FreeParameter> restParameters(const Fitter& fitter, const ModelDocument& model) {
  std::vector<FreeParameter> sizes;
  for (size_t i = 0; i < static_cast<size_t>(fitter.rest().cols()); ++i) {
    const RestTerm& term = (*model.rest)[i];
    const double varies = std::hypot(term.deviation, kRestVaries * term.size);
    if (term.condition != kAllConditions)
      sizes.push_back(sizeOf(i, term.size, std::max(kLeastDeviation, varies)));
  }
  return sizes;
}

Eigen::VectorXd restVariation(const Fitter& fitter, const FitState& state) {
  Eigen::VectorXd variation = Eigen::VectorXd::Zero(state.scales.size());
  if (!state.model.rest) return variation;
  const std::vector<Observation>& rows = fitter.data().all();
  for (const RestTerm& term : *state.model.rest) {
    if (term.condition != kAllConditions) continue;
    double sum = 0.0;
    for (const bool assigns : {false, true})
      for (size_t i = 0; i < rows.size(); ++i) {
        if (!fitter.mask()[i] || channelOfFunction(rows[i].channel) != term.channel) continue;
        const auto at = static_cast<Eigen::Index>(i);
        const double metric = 1.0 / (state.scales[at] * state.scales[at]);
        if (assigns)
          variation[at] = std::pow(kRestVaries * term.size, 2) / kFunctions * sum * metric;
        else
          sum += metric;
      }
  }
  return variation;
}

std::vector<RestTerm> restOf(const Fitter& fitter, const FitState& state, uint64_t seed) {
  const std::vector<Variable> variables = variablesOf(fitter.data(), state.model);
  const Eigen::MatrixXd directions = perChannel(fitter.data(), variables);
  RestFit rest(fitter, state);
  const std::vector<SmoothRest> smooth =
      smoothRests(fitter, rest.found(), inputsOf(fitter.data(), state.model), {}, kRestAlpha, seed);
  double least = 1.0;
  while (rest.terms().size() < kMostTerms) {
    const ScoreTest test(rest.fitter(), rest.state(), directions);
    Eigen::Index best = 0;
    for (Eigen::Index i = 1; i < test.candidates(); ++i)
      if (std::abs(test.score(i)) > std::abs(test.score(best))) best = i;
    const double p = familyWise(test.largestByChance(kRestDraws, seed), test.score(best));
    least = std::min(least, p);
    if (p > kRestAlpha) break;
    const auto at = static_cast<size_t>(best);
    rest.add({channelName(static_cast<ObservedRate>(at / variables.size())),
              variables[at % variables.size()].name, 0.0, 0.0},
             directions.col(best));
  }
  rest.measureDeviations();
  for (const SmoothRest& one : smooth) least = std::min(least, one.p_value);
  std::vector<RestTerm>& terms = rest.terms();
  if (least > kRestAlpha && terms.empty()) return {};
  terms.erase(std::remove_if(terms.begin(), terms.end(),
                             [](const RestTerm& term) { return term.condition == kAllConditions; }),
              terms.end());
  for (const SmoothRest& one : smooth)
    terms.push_back({channelName(one.channels.front()), kAllConditions, one.size, one.deviation});
  return terms;
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/unnamed.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>

#include "common/soundness/core/log_validation.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/search.hpp"
#include "modules/identification/core/search_steps.hpp"

namespace tread::gap {
namespace {

constexpr double kBeyondKnots = 0.01;  // share of the rows beyond the outer knots, to either side
constexpr double kLeastSide = 0.05;    // share of the range by which 0 must be inside to be a knot
constexpr size_t kTermsRefitted = 4;   // forms simulated by the kernel
/// [rad/s or m/s] prior of a value: keeps values small that the drive cannot distinguish from other
/// free parameters.
constexpr double kWide = 0.15;
constexpr size_t kTermCells = 12;
constexpr double kLeastFactor =
    0.1;  // of the largest factor: rows with less are not used for a curve

/// Tested factors; nullptr = 1.
std::vector<const TermCondition*> factors() {
  std::vector<const TermCondition*> all{nullptr};
  for (const char* name : {"sign of v", "sign of yaw rate", "v", "|v|", "yaw rate", "|yaw rate|"})
    all.push_back(findTermCondition(name));
  return all;
}

/// The name without its sign.
std::string unsignedName(const TermCondition& condition) {
  std::string name = condition.name;
  for (const char* part : {"sign of ", "|"})
    for (size_t at = name.find(part); at != std::string::npos; at = name.find(part))
      name.erase(at, std::string(part).size());
  return name;
}

/// Whether a factor adds nothing to the curve over a condition.
bool isSame(const TermCondition& condition, const TermCondition* times) {
  return times != nullptr && unsignedName(condition) == unsignedName(*times);
}

bool isOf(ObservedRate channel, TermChannel term) {
  if (channel == ObservedRate::kAlong) return term == TermChannel::kSpeed;
  if (channel == ObservedRate::kAcross) return term == TermChannel::kSideways;
  return term == TermChannel::kYawRate;
}

/// The range of most rows.
std::pair<double, double> mostOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto edge = static_cast<size_t>(kBeyondKnots * static_cast<double>(values.size()));
  return {values[edge], values[values.size() - 1 - edge]};
}

std::vector<double> equalSteps(double from, double to, int steps) {
  std::vector<double> all;
  for (int i = 0; i <= steps; ++i) all.push_back(from + (to - from) * i / steps);
  return all;
}

/// Knots of a curve: this many to either side of 0, or twice as many overall.
std::vector<double> knots(double low, double high, int to_either_side) {
  const double side = kLeastSide * (high - low);
  if (!(low < -side && high > side)) return equalSteps(low, high, 2 * to_either_side);
  std::vector<double> at = equalSteps(low, 0.0, to_either_side);
  const std::vector<double> above = equalSteps(0.0, high, to_either_side);
  at.insert(at.end(), above.begin() + 1, above.end());
  return at;
}

/// A term with values of 0; nullopt if the drive hardly varies its condition.
std::optional<UnnamedTerm> emptyTerm(const std::vector<TermInputs>& rows, TermChannel channel,
                                     const TermCondition& condition, const TermCondition* times,
                                     int to_either_side) {
  const auto rangeOver = [&rows](const TermCondition& of) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const TermInputs& row : rows) values.push_back(of.value(row));
    return mostOf(std::move(values));
  };
  UnnamedTerm term;
  term.channel = channel;
  term.condition = &condition;
  term.times = times;
  const auto [low, high] = rangeOver(condition);
  if (!(high - low > 1e-3)) return std::nullopt;
  term.at = knots(low, high, to_either_side);
  term.values.assign(term.at.size(), 0.0);
  if (times == nullptr) return term;
  std::tie(term.times_low, term.times_high) = rangeOver(*times);
  if (!(term.times_high - term.times_low > 1e-3)) return std::nullopt;
  return term;
}

/// The value that is fixed at 0: where the condition is closest to 0. A part common to all values
/// is the factor alone, which is left to named effects and gains of the model.
size_t pinned(const UnnamedTerm& term) {
  const auto nearest = std::min_element(
      term.at.begin(), term.at.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<size_t>(std::distance(term.at.begin(), nearest));
}

double largestFactor(const UnnamedTerm& term) {
  return term.times == nullptr ? 1.0
                               : std::max(std::abs(term.times_low), std::abs(term.times_high));
}

double priorDeviation(const UnnamedTerm& term) {
  return kWide / std::max(1e-3, largestFactor(term));
}

/// The conditions of every row: one simulation, in which a term with values of 0 records the
/// conditions.
std::vector<TermInputs> rowInputs(const Observations& data, const VehicleModel& vehicle) {
  VehicleModel keeps = vehicle;
  UnnamedTerm nothing;
  nothing.condition = &termConditions().front();
  nothing.at = {0.0, 1.0};
  nothing.values = {0.0, 0.0};
  keeps.unnamed.push_back(nothing);
  return data.termInputs(keeps);
}

/// Derivatives of the rows with respect to a term's values, without a simulation; 0 for the fixed
/// one.
Eigen::MatrixXd columnsOf(const Fitter& fitter, const std::vector<TermInputs>& rows,
                          const UnnamedTerm& term) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()),
                                                  static_cast<Eigen::Index>(term.at.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!fitter.mask()[i] || !isOf(fitter.data().all()[i].channel, term.channel)) continue;
    const auto [lower, share] = placeOnCurve(term.at, term.condition->value(rows[i]));
    const double factor = term.factor(rows[i]);
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, static_cast<Eigen::Index>(lower)) = factor * (1.0 - share);
    columns(row, static_cast<Eigen::Index>(lower + 1)) = factor * share;
  }
  columns.col(static_cast<Eigen::Index>(pinned(term))).setZero();
  return columns;
}

/// First-order data of a state, for many terms.
struct Pull {
  Eigen::VectorXd weights;              ///< rows x 1, 0 for rows that do not count
  Eigen::VectorXd pulls;                ///< rows x 1: weight times residual
  Eigen::MatrixXd weighted;             ///< rows x free
  Eigen::LDLT<Eigen::MatrixXd> normal;  ///< of the free parameters
};

Pull pullOfAll(const Fitter& fitter, const FitState& state) {
  const Eigen::VectorXd residuals = fitter.data().residuals(state.predicted);
  Pull pull;
  pull.weights = Eigen::VectorXd::Zero(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    if (fitter.mask()[static_cast<size_t>(i)])
      pull.weights[i] = weightOf(residuals[i], state.scales[i]);
  pull.pulls = pull.weights.cwiseProduct(residuals);
  pull.weighted = pull.weights.asDiagonal() * state.jacobian;
  Eigen::MatrixXd normal = state.jacobian.transpose() * pull.weighted + priorPrecision(state);
  normal.diagonal() *= 1.0 + 1e-9;
  normal.diagonal().array() += 1e-9;
  pull.normal = normal.ldlt();
  return pull;
}

/// First-order gain of a term in addition to all free parameters [nats].
double promiseOf(const Pull& pull, const Eigen::MatrixXd& columns, double deviation) {
  const Eigen::MatrixXd shared = pull.weighted.transpose() * columns;
  Eigen::MatrixXd own = columns.transpose() * pull.weights.asDiagonal() * columns;
  if (shared.rows() > 0) own -= shared.transpose() * pull.normal.solve(shared);
  own.diagonal().array() += 1.0 / (deviation * deviation);
  const Eigen::VectorXd pulled = columns.transpose() * pull.pulls;
  return 0.5 * pulled.dot(own.ldlt().solve(pulled));
}

/// Terms by their estimated gain, the most promising first.
std::vector<UnnamedTerm> promisingTerms(const Fitter& fitter, const FitState& state,
                                        const std::vector<TermInputs>& rows,
                                        const std::vector<TermChannel>& channels) {
  std::vector<UnnamedTerm> terms;
  for (const TermChannel channel : channels)
    for (const TermCondition& condition : termConditions())
      for (const TermCondition* times : factors()) {
        // A sign has only two values: it can be a factor, but not the condition of a curve.
        if (std::string(condition.name).find("sign") == 0 || isSame(condition, times)) continue;
        if (auto term = emptyTerm(rows, channel, condition, times, 1))
          terms.push_back(std::move(*term));
      }
  const Pull pull = pullOfAll(fitter, state);
  std::vector<std::pair<double, size_t>> order(terms.size());
  fitter.parallel()(terms.size(), [&](size_t i) {
    order[i] = {-promiseOf(pull, columnsOf(fitter, rows, terms[i]), priorDeviation(terms[i])), i};
  });
  std::sort(order.begin(), order.end());
  std::vector<UnnamedTerm> best;
  for (size_t i = 0; i < std::min(kTermsRefitted, order.size()); ++i)
    best.push_back(std::move(terms[order[i].second]));
  return best;
}

std::string freeName(const ModelDocument& model) {
  for (size_t number = 1;; ++number) {
    const std::string name = "unnamed_" + std::to_string(number);
    if (problemWithTermName(model, name).empty()) return name;
  }
}

/// The state with a term, simulated by the kernel and roughly fitted.
FitState withTerm(const Fitter& fitter, const FitState& state, const UnnamedTerm& term) {
  FitState with = state;
  with.model.vehicle.unnamed.push_back(term);
  const double deviation = priorDeviation(term);
  for (size_t i = 0; i < term.values.size(); ++i)
    if (i != pinned(term))
      fitter.add(
          with, {termPath(term, i), -kAnyTermValue, kAnyTermValue, kTermStep, 0.0, deviation}, 0.0);
  fitter.fitRoughly(with);
  return with;
}

/// A tested term, and its gain on held-out blocks.
struct Tried {
  FitState state;
  Eigen::VectorXd loss;
  UnnamedTerm term;
};

Tried tryTerm(const Fitter& fitter, const FitState& state, UnnamedTerm term) {
  term.name = freeName(state.model);
  Tried tried{withTerm(fitter, state, term), {}, term};
  tried.loss = heldOutLoss(fitter, tried.state);
  return tried;
}

}  // namespace

double largestValue(const UnnamedTerm& term) {
  double largest = 0.0;
  for (const double value : term.values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::vector<FreeParameter> termParameters(const ModelDocument& model, bool calibrate) {
  std::vector<FreeParameter> all;
  for (const UnnamedTerm& term : model.vehicle.unnamed)
    for (size_t i = 0; i < term.values.size(); ++i) {
      const std::string path = termPath(term, i);
      const double known = knownDeviation(model, path);
      if (term.values[i] == 0.0 && !std::isfinite(known)) continue;  // pinned
      FreeParameter value = freeParameter(model, path);
      value.expected = calibrate ? 0.0 : term.values[i];
      value.deviation = calibrate ? priorDeviation(term)
                                  : std::hypot(std::isfinite(known) ? known : 0.0,
                                               std::max(1e-6, kTermVaries * largestValue(term)));
      all.push_back(value);
    }
  return all;
}

std::vector<TermChannel> termChannels(const std::vector<Unexplained>& unexplained) {
  std::vector<TermChannel> channels;
  for (const Unexplained& one : unexplained)
    for (size_t c = 0; c < kChannels; ++c)
      for (const TermChannel term :
           {TermChannel::kYawRate, TermChannel::kSpeed, TermChannel::kSideways})
        if (one.channel == channelName(static_cast<ObservedRate>(c)) &&
            isOf(static_cast<ObservedRate>(c), term) &&
            std::find(channels.begin(), channels.end(), term) == channels.end())
          channels.push_back(term);
  return channels;
}

std::optional<UnnamedFinding> addTerm(const Fitter& fitter, FitState& state,
                                      const std::vector<TermChannel>& channels, double sure) {
  const std::vector<TermInputs> rows = rowInputs(fitter.data(), state.model.vehicle);
  const Eigen::VectorXd now = heldOutLoss(fitter, state);
  std::optional<Tried> best;
  for (const UnnamedTerm& term : promisingTerms(fitter, state, rows, channels)) {
    Tried tried = tryTerm(fitter, state, term);
    if (!best || gainOf(fitter, best->loss, tried.loss).value > 0.0) best = std::move(tried);
  }
  if (!best) return std::nullopt;
  if (auto finer =
          emptyTerm(rows, best->term.channel, *best->term.condition, best->term.times, 2)) {
    Tried tried = tryTerm(fitter, state, *finer);
    const Gain more = gainOf(fitter, best->loss, tried.loss);
    if (more.value > more.error) best = std::move(tried);
  }
  const Gain gain = gainOf(fitter, now, best->loss);
  if (!(gain.value > sure * gain.error && gain.value > kTermNats)) return std::nullopt;
  state = std::move(best->state);
  fitter.renewNoise(state);
  fitter.fit(state);
  return UnnamedFinding{best->term.name, gain.value, gain.error, {}, {}};
}

bool lessensEndError(const Fitter& fitter, const FitState& with, const FitState& without,
                     double least_gain) {
  const Eigen::MatrixXd missed_with = missedOnOtherHalves(fitter, with, with.scales);
  const Eigen::MatrixXd missed_without = missedOnOtherHalves(fitter, without, with.scales);
  const std::vector<char> every(static_cast<size_t>(missed_with.rows()), 1);
  bool less = false;
  for (Eigen::Index i : {0, 1}) {
    const Gain gain = gainOf(missed_without.col(i), missed_with.col(i), every);
    if (gain.value < -gain.error) return false;
    less = less || (gain.value > kEndSure * gain.error &&
                    gain.value > least_gain * missed_without.col(i).sum());
  }
  return less;
}

void addUnnamedTerms(const SearchState& search, double adequacy_alpha, Adequacy& adequacy,
                     std::vector<UnnamedFinding>& found) {
  FoundTerms& result = search.result;
  while (found.size() < kMostUnnamed && adequacy.p_value <= adequacy_alpha &&
         !search.isCutShort()) {
    FitState with = result.state;
    const auto added = addTerm(search.fitter, with, termChannels(adequacy.unexplained), kTermSure);
    if (!added || search.isCutShort()) return;
    if (!lessensEndError(search.fitter, with, result.state, search.settings.least_gain)) {
      search.say("  - " + added->name +
                 ": does not lessen the end error on driving it was not fitted to");
      return;
    }
    search.say("  + " + added->name + ": held-out gain " + fixed(added->gain, 1) + " +- " +
               fixed(added->gain_error, 1));
    result.state = std::move(with);
    found.push_back(*added);
    adequacy = testAdequacy(search.fitter, result.state, adequacy_alpha, search.settings.seed);
  }
}

void countTermsToRest(const Observations& data, ModelDocument& model) {
  if (model.vehicle.unnamed.empty()) return;
  const std::vector<TermInputs> rows = data.termInputs(model.vehicle);
  if (!model.rest) model.rest.emplace();
  for (const ObservedRate channel :
       {ObservedRate::kYawRate, ObservedRate::kAlong, ObservedRate::kAcross}) {
    double squares = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < rows.size(); ++i) {
      if (data.all()[i].channel != channel) continue;
      double sum = 0.0;
      for (const UnnamedTerm& term : model.vehicle.unnamed)
        if (isOf(channel, term.channel)) sum += term.value(rows[i]);
      squares += sum * sum;
      ++count;
    }
    if (squares <= 0.0) continue;
    const double size = kTermForm * std::sqrt(squares / static_cast<double>(count));
    const auto whole =
        std::find_if(model.rest->begin(), model.rest->end(), [channel](const RestTerm& term) {
          return term.condition == kAllConditions && term.channel == channelName(channel);
        });
    if (whole != model.rest->end())
      whole->size = std::hypot(whole->size, size);
    else
      model.rest->push_back({channelName(channel), kAllConditions, size, 0.0});
  }
}

std::vector<AtlasCell> termCells(const Fitter& fitter, const ModelDocument& model,
                                 const UnnamedTerm& term) {
  const Observations& data = fitter.data();
  const std::vector<TermInputs> rows = rowInputs(data, model.vehicle);
  const Eigen::VectorXd residuals = data.residuals(fitter.predict(model));
  const double low = term.at.front();
  const double width = (term.at.back() - low) / static_cast<double>(kTermCells);
  std::vector<AtlasCell> cells(kTermCells);
  std::vector<double> squares(kTermCells, 0.0);
  for (size_t c = 0; c < kTermCells; ++c) {
    cells[c].from = low + width * static_cast<double>(c);
    cells[c].to = cells[c].from + width;
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    const double factor = term.factor(rows[i]);
    const double place = (term.condition->value(rows[i]) - low) / width;
    if (!isOf(data.all()[i].channel, term.channel) || !(place >= 0.0) ||
        place >= static_cast<double>(kTermCells) ||
        std::abs(factor) < kLeastFactor * largestFactor(term))
      continue;
    const auto c = static_cast<size_t>(place);
    const double left = residuals[static_cast<Eigen::Index>(i)] + term.value(rows[i]);
    cells[c].mean += factor * left;
    squares[c] += factor * factor;
    ++cells[c].rows;
  }
  for (size_t c = 0; c < kTermCells; ++c) {
    if (squares[c] > 0.0) cells[c].mean /= squares[c];
    cells[c].low = cells[c].high = cells[c].mean;
  }
  return cells;
}

}  // namespace tread::gap

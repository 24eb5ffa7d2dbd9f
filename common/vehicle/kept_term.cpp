// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// An unnamed term that a person keeps as an effect of a catalogue of his own.
#include "common/vehicle/kept_term.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/config/scalars.hpp"
#include "common/vehicle/added_effects.hpp"

namespace tread {
namespace {

constexpr const char* kShare = "share";

LawTarget targetOf(TermChannel channel) {
  if (channel == TermChannel::kYawRate) return LawTarget::kYawRate;
  return channel == TermChannel::kSpeed ? LawTarget::kSpeed : LawTarget::kSideways;
}

std::string formulaOf(const UnnamedTerm& term) {
  std::string text = lawTargetNames()[static_cast<size_t>(targetOf(term.channel))] +
                     " + share * moving * curve(" + term.condition->formula;
  for (size_t i = 0; i < term.at.size(); ++i)
    text += ", " + formatNumber(term.at[i]) + ", " + formatNumber(term.values[i]);
  text += ")";
  if (term.times == nullptr) return text;
  return text + " * max(" + formatNumber(term.times_low) + ", min(" +
         formatNumber(term.times_high) + ", " + term.times->formula + "))";
}

EffectParameter shareOfTerm() {
  EffectParameter share;
  share.name = kShare;
  share.unit = "1";
  share.min = -2.0;
  share.max = 4.0;
  share.typical = 1.0;
  return share;
}

/// Standard deviation of the share s for which s values fit best, from the covariance of the
/// values; 0 if it is unknown.
double shareDeviation(const ParameterCovariance& covariance, const UnnamedTerm& term) {
  std::vector<size_t> rows;
  std::vector<double> values;
  for (size_t i = 0; i < term.values.size(); ++i) {
    const auto at =
        std::find(covariance.parameters.begin(), covariance.parameters.end(), termPath(term, i));
    if (at == covariance.parameters.end()) continue;
    rows.push_back(static_cast<size_t>(std::distance(covariance.parameters.begin(), at)));
    values.push_back(term.values[i]);
  }
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix(size, size);
  Eigen::VectorXd direction(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    direction[i] = values[static_cast<size_t>(i)];
    for (Eigen::Index j = 0; j < size; ++j)
      matrix(i, j) = covariance.matrix[rows[static_cast<size_t>(i)]][rows[static_cast<size_t>(j)]];
  }
  const double information = size > 0 ? direction.dot(matrix.ldlt().solve(direction)) : 0.0;
  return information > 0.0 ? 1.0 / std::sqrt(information) : 0.0;
}

/// Replaces the values of a term by the share.
void replaceKnown(ParameterCovariance& covariance, const UnnamedTerm& term,
                  const std::string& share) {
  const double deviation = shareDeviation(covariance, term);
  for (size_t i = covariance.parameters.size(); i-- > 0;) {
    if (covariance.parameters[i].rfind(term.name + ".", 0) != 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    covariance.parameters.erase(covariance.parameters.begin() + at);
    covariance.matrix.erase(covariance.matrix.begin() + at);
    for (std::vector<double>& row : covariance.matrix) row.erase(row.begin() + at);
  }
  if (deviation <= 0.0) return;
  for (std::vector<double>& row : covariance.matrix) row.push_back(0.0);
  covariance.parameters.push_back(share);
  covariance.matrix.emplace_back(covariance.parameters.size(), 0.0);
  covariance.matrix.back().back() = deviation * deviation;
}

}  // namespace

EffectEntry effectOf(const UnnamedTerm& term, const std::string& name) {
  EffectEntry entry;
  Effect& effect = entry.effect;
  effect.name = name;
  effect.title = name;
  std::replace(effect.title.begin(), effect.title.end(), '_', ' ');
  effect.title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(effect.title[0])));
  const std::string by = std::string(term.condition->name) +
                         (term.times == nullptr ? "" : std::string(", times ") + term.times->name);
  effect.sentence = std::string("Beside the model, ") + termChannelName(term.channel) +
                    " changes with " + by + ", as a drive has shown";
  const char* const channels[] = {"w", "x", "y"};
  effect.channels = channels[static_cast<size_t>(term.channel)];
  effect.parameters = {shareOfTerm()};
  auto law = std::make_shared<AddedLaw>();
  law->changes = targetOf(term.channel);
  std::vector<std::string> names = quantitiesOf(law->changes);
  names.emplace_back(kShare);
  law->formula = std::make_shared<const Formula>(formulaOf(term), std::move(names));
  effect.law = std::move(law);
  effect.looks_like =
      std::string("The residual of ") + termChannelName(term.channel) + " depends on " + by + ".";
  effect.separates = "Drive much of that, and little of it, at the same speed and yaw rate.";
  effect.check = "Repeat the drive that showed it, and see whether its share is the same.";
  return entry;
}

void replaceTerm(ModelDocument& document, const std::string& term, const Effect& effect) {
  std::vector<UnnamedTerm>& terms = document.vehicle.unnamed;
  const auto at = std::find_if(terms.begin(), terms.end(),
                               [&term](const UnnamedTerm& one) { return one.name == term; });
  if (at == terms.end()) return;
  const std::string share = effect.name + "." + kShare;
  replaceKnown(document.covariance, *at, share);
  const std::string values = at->name + ".";
  std::vector<ParameterBounds>& bounds = document.bounds;
  bounds.erase(std::remove_if(bounds.begin(), bounds.end(),
                              [&values](const ParameterBounds& one) {
                                return one.parameter.rfind(values, 0) == 0;
                              }),
               bounds.end());
  terms.erase(at);
  *findParameter(document, share) = 1.0;
}

}  // namespace tread

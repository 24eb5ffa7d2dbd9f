// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/twist_dictionary.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

using P = DrivenPiece;

/// Signed excess over a threshold.
double beyond(double value, double threshold) {
  return std::copysign(std::max(0.0, std::abs(value) - threshold), value);
}

/// 1 at a change of the command, decaying.
double fresh(const P& piece, double time) {
  return std::exp(-std::max(0.0, piece.since) / time);
}

/// 0 at a change of the command, 1 from 6 s on.
double settled(const P& piece) {
  return std::clamp(piece.since / 6.0, 0.0, 1.0);
}

struct Dependence {
  const char* name;
  double (*value)(const P&);
};

constexpr Dependence kDictionary[] = {
    {"1", [](const P&) { return 1.0; }},
    {"v", [](const P& p) { return p.v; }},
    {"omega", [](const P& p) { return p.omega; }},
    {"|v|", [](const P& p) { return std::abs(p.v); }},
    {"|omega|", [](const P& p) { return std::abs(p.omega); }},
    {"v^2", [](const P& p) { return p.v * p.v; }},
    {"omega^2", [](const P& p) { return p.omega * p.omega; }},
    {"v |v|", [](const P& p) { return p.v * std::abs(p.v); }},
    {"omega |omega|", [](const P& p) { return p.omega * std::abs(p.omega); }},
    {"v omega", [](const P& p) { return p.v * p.omega; }},
    {"v |omega|", [](const P& p) { return p.v * std::abs(p.omega); }},
    {"omega |v|", [](const P& p) { return p.omega * std::abs(p.v); }},
    {"v^2 omega", [](const P& p) { return p.v * p.v * p.omega; }},
    {"v omega^2", [](const P& p) { return p.v * p.omega * p.omega; }},
    {"tanh 4 v", [](const P& p) { return std::tanh(4.0 * p.v); }},
    {"tanh 4 omega", [](const P& p) { return std::tanh(4.0 * p.omega); }},
    {"v beyond 0.5", [](const P& p) { return beyond(p.v, 0.5); }},
    {"v beyond 1", [](const P& p) { return beyond(p.v, 1.0); }},
    {"omega beyond 0.5", [](const P& p) { return beyond(p.omega, 0.5); }},
    {"omega beyond 1", [](const P& p) { return beyond(p.omega, 1.0); }},
    {"asked v", [](const P& p) { return p.asked_v; }},
    {"asked turn", [](const P& p) { return p.asked_turn; }},
    {"asked turn, squared", [](const P& p) { return p.asked_turn * std::abs(p.asked_turn); }},
    {"asked v |asked turn|", [](const P& p) { return p.asked_v * std::abs(p.asked_turn); }},
    {"asked turn beyond 0.5", [](const P& p) { return beyond(p.asked_turn, 0.5); }},
    {"asked turn beyond 1", [](const P& p) { return beyond(p.asked_turn, 1.0); }},
    {"tanh 4 asked turn", [](const P& p) { return std::tanh(4.0 * p.asked_turn); }},
    {"|left|", [](const P& p) { return std::abs(p.asked_v - p.asked_turn); }},
    {"|right|", [](const P& p) { return std::abs(p.asked_v + p.asked_turn); }},
    {"change of v, 0.3 s", [](const P& p) { return (p.old_v - p.asked_v) * fresh(p, 0.3); }},
    {"change of v, 1 s", [](const P& p) { return (p.old_v - p.asked_v) * fresh(p, 1.0); }},
    {"change of turn, 0.3 s",
     [](const P& p) { return (p.old_turn - p.asked_turn) * fresh(p, 0.3); }},
    {"change of turn, 1 s", [](const P& p) { return (p.old_turn - p.asked_turn) * fresh(p, 1.0); }},
    {"v, 1 s after a change", [](const P& p) { return p.v * fresh(p, 1.0); }},
    {"omega, 1 s after a change", [](const P& p) { return p.omega * fresh(p, 1.0); }},
    {"v, long after a change", [](const P& p) { return p.v * settled(p); }},
    {"omega, long after a change", [](const P& p) { return p.omega * settled(p); }},
};

}  // namespace

std::vector<TwistTerm> slipTerms() {
  const auto v = [](const P& p) { return p.v; };
  const auto omega = [](const P& p) { return p.omega; };
  const auto both = [](const P& p) { return p.v * p.omega; };
  return {{TwistPart::kForward, "v", v},
          {TwistPart::kSideways, "v omega", both},
          {TwistPart::kTurning, "v omega", both},
          {TwistPart::kTurning, "v", v},
          {TwistPart::kTurning, "omega", omega}};
}

std::vector<TwistTerm> blackBoxTerms() {
  std::vector<TwistTerm> terms;
  for (TwistPart part : {TwistPart::kForward, TwistPart::kSideways, TwistPart::kTurning})
    for (const Dependence& dependence : kDictionary)
      terms.push_back({part, dependence.name, dependence.value});
  return terms;
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/decisions.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/gap/explain.hpp"

namespace tread::gap {
namespace {

void add(std::vector<Decision>& decisions, const std::string& name, bool accepted,
         const std::string& by) {
  const Effect& effect = effectOrGuess(name);
  for (const Decision& other : decisions)
    if (other.effect == effect.name)
      throw std::runtime_error(effect.name + (other.accepted == accepted
                                                  ? " is named twice; once is enough"
                                                  : " is accepted and rejected; decide on one"));
  decisions.push_back({effect.name, accepted, by});
}

}  // namespace

std::vector<Decision> decisionsOf(const DecisionWords& words, const ModelDocument& model) {
  std::vector<Decision> decisions;
  for (const std::string& name : words.accepted) add(decisions, name, true, words.by);
  for (const std::string& name : words.rejected) {
    add(decisions, name, false, words.by);
    if (isOn(effectNamed(name), model.vehicle.effects, model.measurement))
      throw std::runtime_error("--reject " + name +
                               ": the model has this effect; take it out of the model file first");
  }
  if (decisions.empty() && !words.by.empty())
    throw std::runtime_error("--by " + words.by + ": nothing is decided; --accept or --reject");
  return decisions;
}

}  // namespace tread::gap

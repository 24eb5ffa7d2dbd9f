// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/model_document.hpp"
#include "tools/gap/manoeuvres.hpp"
#include "tools/gap/plan_rival.hpp"

namespace tread::gap {

/// What a design is asked.
struct DesignTask {
  ModelDocument model;
  std::string truth;  ///< effect A: at its size in the model, else at its typical one
  std::string rival;  ///< effect B: refitted to look most like A
  std::vector<Manoeuvre> manoeuvres;
  InsNoise noise;
  double enough = 6.0;     ///< [nats] expected difference of the log likelihoods
  double longest = 120.0;  ///< [s] of driving
};

/// A drive that tells two effects apart, or the reason why there is none.
struct Design {
  std::vector<size_t> counts;  ///< how often to drive each manoeuvre
  double difference = 0.0;     ///< [nats] expected, however B is refitted
  double duration = 0.0;       ///< [s]
  ModelDocument truth;
  ModelDocument rival;   ///< that looks most like the truth on these manoeuvres
  double visible = 0.0;  ///< [nats] of A against its absence, all manoeuvres once
  bool separates = false;
};

/// The shortest sequence found of manoeuvres on which A and B differ enough whatever size B has.
/** T-optimal: in turn B (with what is calibrated free within its uncertainty) is fitted to what A
 * would do on the manoeuvres chosen so far, and the manoeuvre is added on which that B is worst per
 * second; then whatever can be left out is. Half an hour into a session, on level ground.
 * Deterministic. */
Design designDrive(const DesignTask& task);

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/model_document.hpp"
#include "tools/gap/manoeuvres.hpp"

namespace tread::gap {

/// How exactly a drive is measured.
struct InsNoise {
  double fix = 0.01;       ///< [m] of a position
  double heading = 0.003;  ///< [rad]
  double gyro = 0.01;      ///< [rad/s] of its mean over half a second
};

/// What a design is asked: whether one effect or the other is there.
struct DesignTask {
  ModelDocument model;
  std::string first;   ///< effect: at its size in the model, else at its typical one
  std::string second;  ///< the same; which one is first makes no difference
  std::vector<Manoeuvre> manoeuvres;
  InsNoise noise;
  double enough = 6.0;     ///< [nats] expected difference of the log likelihoods
  double longest = 120.0;  ///< [s] of driving
};

/// What is expected if one of the two effects is there and the other one is refitted.
struct DesignSide {
  std::string truth;  ///< the effect that is there
  std::string rival;  ///< the one that is refitted
  ModelDocument true_model;
  ModelDocument rival_model;  ///< that looks most like it on the manoeuvres chosen
  double difference = 0.0;    ///< [nats] that remains, however the rival is refitted
  double visible = 0.0;       ///< [nats] of the truth against its absence, all manoeuvres once
};

/// A drive that tells two effects apart, or the reason why there is none.
struct Design {
  std::vector<size_t> counts;     ///< how often to drive each manoeuvre
  double duration = 0.0;          ///< [s]
  std::vector<DesignSide> sides;  ///< first or second true, in the order of the names
  bool separates = false;         ///< whichever of the two is true

  /// The side on which the two are harder to tell apart.
  const DesignSide& harder() const;
};

/// Chooses the shortest drive on which the two differ enough, whichever of them is true.
/** T-optimal: in turn the rival (with what is calibrated free within its uncertainty) is fitted to
 * what the truth would do on the manoeuvres chosen so far, and the manoeuvre is added on which the
 * harder side's rival is worst per second; then whatever can be left out is. Half an hour into a
 * session, on level ground. Deterministic. */
Design designDrive(const DesignTask& task);

}  // namespace tread::gap

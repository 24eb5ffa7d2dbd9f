// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/questions.hpp"

namespace tread::gap {

/// Measurement noise of a drive.
struct InsNoise {
  double fix = 0.01;       ///< [m] of a position
  double heading = 0.003;  ///< [rad]
  double gyro = 0.01;      ///< [rad/s] of its mean over half a second
};

/// The question for a design: which of two effects is present.
struct DesignTask {
  ModelDocument model;
  std::string first;   ///< effect: at its size in the model, else at its typical size
  std::string second;  ///< the same; the order of the two does not matter
  std::vector<Manoeuvre> manoeuvres;
  InsNoise noise;
  double enough = 6.0;     ///< [nats] expected difference of the log likelihoods
  double longest = 120.0;  ///< [s] of driving
};

/// Result for one effect being present while the other is refitted.
struct DesignSide {
  std::string truth;  ///< the present effect
  std::string rival;  ///< the refitted effect
  ModelDocument true_model;
  ModelDocument rival_model;  ///< the best imitation on the chosen manoeuvres
  double difference = 0.0;    ///< [nats] remaining difference of the best imitation
  double visible = 0.0;       ///< [nats] of the truth against its absence, on all manoeuvres once
};

/// A drive that separates two effects, or the reason why there is none.
struct Design {
  std::vector<size_t> counts;     ///< repetitions of each manoeuvre
  double duration = 0.0;          ///< [s]
  std::vector<DesignSide> sides;  ///< first or second effect present, in the order of the names
  bool separates = false;         ///< whichever of the two is present

  /// The side with the smaller difference.
  const DesignSide& harder() const;
};

/// Chooses the shortest drive on which the two differ enough, whichever of them is present.
/** T-optimal design, iterated: fit the rival (calibrated parameters free within their uncertainty)
 * to the truth on the manoeuvres chosen so far, then add the manoeuvre with the harder side's
 * largest difference per second. At the end remove superfluous manoeuvres. Half an hour into a
 * session, on level ground. Deterministic. */
Design designDrive(const DesignTask& task);

}  // namespace tread::gap

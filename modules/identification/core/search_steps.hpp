// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Includes an effect of the catalogue in a state and fits everything, whatever tests give.
/** If it can act in several ways (thresholds, change points), uses the most promising one. Returns
 * why the drive cannot determine its size, with the state unchanged; empty on success. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect);

/// Replaces two effects by one that explains as much.
/** A step-by-step search may imitate one effect by two others: a scale of positions by slip and
 * track width together. Only effects whose signature the found ones can imitate are tried; the
 * pair is replaced unless it is better on held-out blocks by more than a standard error. */
void replacePairs(const SearchState& search);

/// Replaces effects of the INS by effects of the vehicle that together have the same influence,
/// unless they explain less: a step-by-step search takes whichever comes first. True if it did.
bool putVehicleFirst(const SearchState& search);

/// A given term that moved and was freed of its prior, with that prior's certainty.
struct MovedTerm {
  std::string path;
  double deviation = 0.0;
};

/// Replaces two changes, at least one of them a moved term, by one effect that explains as much,
/// and removes that term from the list. True if it did.
bool replaceMoved(const SearchState& search, std::vector<MovedTerm>& moved);

/// Notes for found effects which confounded ones cannot replace them: those that the model has and
/// that explain less at any size.
void noteToldFrom(const SearchState& search);

/// Tries every other effect in the place of each found one and of each changed term, takes the best
/// and notes those that are level as its runners-up. For a brief drive, in which the right one may
/// be the less visible one.
void weighOthers(const SearchState& search);

/// Rows of alternate blocks: those of `half` (0 or 1) count.
std::vector<char> halfMask(const Observations& data, int half);

/// Errors of a state on one half of the driving when fitted to the other, summed block by block:
/// position [m] and yaw [rad] at the ends of executions, yaw rate, nats (blocks x 4).
Eigen::MatrixXd missedOnOtherHalves(const Fitter& fitter, const FitState& state,
                                    const Eigen::VectorXd& scales);

/// Removes effects, except accepted ones, from a result unless the end error falls with them by
/// more than its standard error over blocks, on halves of the driving that were not used for their
/// sizes.
/** INS effects, which may not change any pose, may reduce the yaw rate residual instead; and an
 * effect that the rows show by more than 2.5 standard errors need not improve the ends. The model
 * without them is fitted to the same halves. */
void dropUnconfirmed(const SearchState& search);

}  // namespace tread::gap

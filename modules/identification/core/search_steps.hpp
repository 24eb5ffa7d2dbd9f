// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Switches an effect of the catalogue on in a state and fits all, whatever tests would say.
/** Of several ways in which it could act (thresholds, change points) the most promising one.
 * Returns why the drive cannot size it, and leaves the state as it was; empty if it can. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect);

/// Puts one effect in the place of two where it explains as much.
/** Search goes step by step and may reach what one effect does by two others: a scale of positions
 * is slip and track width together. Only effects whose signature the found ones can imitate are
 * tried; the pair goes if it is not better on blocks left out by more than a standard error. */
void replacePairs(const SearchState& search);

/// Puts effects of the vehicle in the place of those of the INS that do the same together, unless
/// they explain less: a search that goes step by step takes whichever comes first. True if it did.
bool putVehicleFirst(const SearchState& search);

/// A given term that moved and is free of what was known of it, with how well that was known.
struct MovedTerm {
  std::string path;
  double deviation = 0.0;
};

/// Puts one effect in the place of two changes, of which one at least is a term that moved, where
/// it explains as much; takes that term from the list. True if it did.
bool replaceMoved(const SearchState& search, std::vector<MovedTerm>& moved);

/// Notes of effects that were found which of those that they are confounded with cannot stand in
/// their place: the model has these, and they explain less, whatever size they are given.
void noteToldFrom(const SearchState& search);

/// Rows of every other block: those of `half` (0 or 1) count.
std::vector<char> halfMask(const Observations& data, int half);

/// What a state misses on the other half of the driving when it is fitted to one, summed block by
/// block: position [m] and yaw [rad] at the ends of executions, yaw rate, nats (blocks x 4).
Eigen::MatrixXd missedOnOtherHalves(const Fitter& fitter, const FitState& state,
                                    const Eigen::VectorXd& scales);

/// Takes the effects that were not accepted out of a result unless the end error falls with them,
/// by more than its standard error over blocks, on halves of the driving that the sizes of the
/// effects were not fitted to.
/** Effects of the INS, which may move no pose, may lessen what is left of the yaw rate instead; and
 * where rows show an effect by more than 2.5 standard errors, the ends need not. What is without
 * them is fitted to the same halves. */
void dropUnconfirmed(const SearchState& search);

}  // namespace tread::gap

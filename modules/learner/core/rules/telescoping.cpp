// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/telescoping.hpp"

namespace tread::learner {

void Telescoping::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  if (!ScalingGuards::possible(boundingBox(measured))) return;
  const bool gives = guards_.allow(executed, measured, table_.end(executed), note);
  const Axes old_box = boundingBox(table_.of(executed));
  smooth(measured, memory_, table_.change(executed));  // equation (2)
  if (!gives) return;
  note.scaling =
      scalingVector(boundingBox(table_.of(executed)), old_box, guards_.role(executed), limits_);
  for (size_t p = 0; p < table_.patterns(); ++p)
    if (p != executed) scale(note.scaling, guards_.role(p), table_.change(p));
}

}  // namespace tread::learner

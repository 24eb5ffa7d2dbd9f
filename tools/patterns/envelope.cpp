// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/envelope.hpp"

#include <algorithm>
#include <iostream>

#include "tools/patterns/model_recording.hpp"

namespace tread::patterns {

Envelope envelopeOf(const VehicleModel& model, const PatternSet& set) {
  Envelope all;
  for (const MotionPattern& pattern : set.patterns()) {
    const EntryState entry = steadyEntry(model, set.classNamed(pattern.entry_class).steady);
    const Envelope one = tread::envelopeOf(model, pattern.commands, set.periodSeconds(), entry);
    all.v = std::max(all.v, one.v);
    all.omega = std::max(all.omega, one.omega);
    all.v_omega = std::max(all.v_omega, one.v_omega);
  }
  return all;
}

void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set) {
  requireSameKind(set, document.vehicle);
  if (!document.envelope) return;
  for (const std::string& line :
       warningsOutside(*document.envelope, envelopeOf(document.vehicle, set)))
    std::cerr << model_file << ": warning: " << line << '\n';
}

}  // namespace tread::patterns

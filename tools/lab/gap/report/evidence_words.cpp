// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What wheel speeds, motor currents and battery voltage show about an effect.
#include "tools/lab/gap/report/evidence_words.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "common/soundness/core/log_validation.hpp"
#include "tools/lab/gap/report/report.hpp"

namespace tread::gap {
namespace {

std::string percent(double share) {
  return fixed(100.0 * std::clamp(share, -9.99, 9.99), 0);
}

std::string percents(double low, double high) {
  return " (" + percent(low) + " to " + percent(high) + " %)";
}

std::string wheelSentence(const FoundEffect& effect) {
  const MeasuredEvidence* evidence = effect.evidenceBy(EvidenceSource::kWheels);
  if (evidence == nullptr) return "";
  const MeasuredEvidence& wheels = *evidence;
  const std::string whole = wheels.of_lags ? "the lags together" : "it";
  const std::string text = " The wheel speeds show " +
                           (wheels.low > 1.0 ? "all of " + whole + " and more"
                                             : percent(wheels.value) + " % of " + whole) +
                           percents(wheels.low, wheels.high);
  // A load also slows the wheels.
  const MeasuredEvidence* currents = effect.evidenceBy(EvidenceSource::kCurrents);
  const bool by_load = currents != nullptr && currents->confirms();
  if (wheels.confirms())
    return text + (by_load ? ": the wheels turn slower." : ": it is in the drive.");
  if (wheels.refutes()) return text + ": it is under the wheels, not in the drive.";
  return text + ": that does not show whether it is in the drive.";
}

std::string currentSentence(const FoundEffect& effect) {
  const MeasuredEvidence* evidence = effect.evidenceBy(EvidenceSource::kCurrents);
  if (evidence == nullptr) return "";
  const MeasuredEvidence& currents = *evidence;
  const std::string size = " by " + fixed(currents.value, 1) + " % per percent (" +
                           fixed(currents.low, 1) + " to " + fixed(currents.high, 1) + ")";
  if (currents.confirms())
    return " Where it reduces speed, the motor currents rise" + size +
           ": it is load, on the ground or in the running gear.";
  if (!currents.refutes())
    return " The motor currents do not show whether it is load or in the drive.";
  const std::string text =
      " Where it reduces speed, the motor currents do not rise as with a load, but" + size;
  const MeasuredEvidence* wheels = effect.evidenceBy(EvidenceSource::kWheels);
  if (wheels != nullptr && wheels->confirms()) return text + ": the drive gives less.";
  if (wheels != nullptr && wheels->refutes()) return text + ": the tracks slip.";
  return text + ": the drive gives less, or the tracks slip.";
}

/// Whether the effect's name says that it is the battery's.
bool isOfBattery(const FoundEffect& effect) {
  const std::vector<EffectParameter>& parameters = effectNamed(effect.name).parameters;
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const EffectParameter& parameter) { return parameter.needs_voltage; });
}

std::string voltageSentence(const FoundEffect& effect) {
  const MeasuredEvidence* evidence = effect.evidenceBy(EvidenceSource::kVoltage);
  if (evidence == nullptr) return "";
  const MeasuredEvidence& voltage = *evidence;
  const std::string size =
      percent(voltage.value) + " % as much" + percents(voltage.low, voltage.high);
  if (voltage.confirms())
    return " The battery voltage falls with it, " + size +
           (isOfBattery(effect) ? ": it is the battery." : ": it may be the battery.");
  if (voltage.refutes())
    return " The battery voltage does not fall with it, " + size + ": it is not the battery.";
  return " The battery voltage falls with it, " + size +
         ": that does not show whether it is the battery.";
}

}  // namespace

std::string evidenceSentences(const FoundEffect& effect) {
  return wheelSentence(effect) + currentSentence(effect) + voltageSentence(effect);
}

}  // namespace tread::gap

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/epoch.hpp"

namespace tread::ins {
namespace {

/// The place of a sentence's type in an epoch, const or not.
template <class EpochRef>
auto& placeOf(const Gga&, EpochRef& epoch) {
  return epoch.gga;
}
template <class EpochRef>
auto& placeOf(const Rmc&, EpochRef& epoch) {
  return epoch.rmc;
}
template <class EpochRef>
auto& placeOf(const Vtg&, EpochRef& epoch) {
  return epoch.vtg;
}
template <class EpochRef>
auto& placeOf(const Hdt&, EpochRef& epoch) {
  return epoch.hdt;
}
template <class EpochRef>
auto& placeOf(const Pashr&, EpochRef& epoch) {
  return epoch.pashr;
}
template <class EpochRef>
auto& placeOf(const Rot&, EpochRef& epoch) {
  return epoch.rot;
}
template <class EpochRef>
auto& placeOf(const Zda&, EpochRef& epoch) {
  return epoch.zda;
}

}  // namespace

bool Epoch::holds(const NmeaSentence& sentence) const {
  return std::visit([this](const auto& s) { return placeOf(s, *this).has_value(); }, sentence);
}

void Epoch::take(const NmeaSentence& sentence) {
  std::visit([this](const auto& s) { placeOf(s, *this) = s; }, sentence);
}

}  // namespace tread::ins

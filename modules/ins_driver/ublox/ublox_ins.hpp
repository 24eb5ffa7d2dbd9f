// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string_view>

#include "modules/ins_driver/core/binary_ins.hpp"

namespace tread::ins {

/// Checks bytes for a UBX frame: B5 62, class, id, length, payload, Fletcher checksum over class to
/// payload (u-blox F9 Interface Description, "UBX Protocol").
FrameLook lookForUbx(std::string_view bytes);

/// The supported messages, numbered as in InsConfig::last_type.
enum class UbxKind : uint8_t { kNavPvt, kNavRelposned, kNavAtt, kEsfIns };
inline constexpr const char* kUbxKindNames[] = {"NAV-PVT", "NAV-RELPOSNED", "NAV-ATT", "ESF-INS"};

/// A u-blox receiver: NAV-PVT, NAV-RELPOSNED (heading of a moving base), NAV-ATT, ESF-INS.
/** Times are milliseconds of the GPS week; NAV-PVT contains UTC. Axes of the vehicle frame are
 * forward, right, down. A heading of NAV-RELPOSNED is used only with all required flags: fix,
 * relative position valid, moving base, ambiguities fixed, heading valid. */
class UbloxIns : public BinaryIns {
 public:
  explicit UbloxIns(const InsConfig& config);

  InsAdvice advice() const override;

 protected:
  Reading read(std::string_view frame, int64_t arrival) override;

 private:
  const char* readPvt(std::string_view payload, DeviceEpoch& part) const;
  const char* readRelposned(std::string_view payload, DeviceEpoch& part) const;
};

}  // namespace tread::ins

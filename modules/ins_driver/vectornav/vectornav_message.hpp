// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "modules/ins_driver/core/binary_framer.hpp"

namespace tread::ins {

/// Groups of a VectorNav binary output message, and their supported fields (VN-300 User Manual,
/// "User Configurable Binary Output Messages").
enum class VnGroup : size_t { kCommon, kTime, kImu, kGnss, kAttitude, kIns, kGnss2 };
inline constexpr size_t kVnGroups = 7;

/// Checks bytes for such a message: FA, groups, field masks, payload, CRC16.
/** The length follows from the masks. A message with a field of unknown length is refused. */
FrameLook lookForVectornav(std::string_view bytes);

/// CRC16, polynomial 1021, start value 0; over a message with its checksum it is 0.
uint16_t vectornavCrc(std::string_view bytes);

/// Finds the fields of a message with a good checksum.
class VectornavFields {
 public:
  explicit VectornavFields(std::string_view frame);

  /// The bytes of a field; empty if it is not in the message.
  std::string_view field(VnGroup group, size_t bit) const {
    return fields_[static_cast<size_t>(group)][bit];
  }

 private:
  std::array<std::array<std::string_view, 16>, kVnGroups> fields_{};
};

}  // namespace tread::ins

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "modules/ins_driver/core/binary_framer.hpp"

namespace tread::ins {

/// Checks bytes for a frame of NovAtel's OEM binary format, long or short header (OEM7 Commands and
/// Logs Reference Manual, "Binary" and "Short Binary" message formats).
/** CRC32, reflected polynomial EDB88320, start value 0, not inverted, over header and body. */
FrameLook lookForNovatel(std::string_view bytes);

/// CRC32 as computed by NovAtel.
uint32_t novatelCrc(std::string_view bytes);

/// The supported messages, numbered as in InsConfig::last_type.
enum class NovatelKind : uint8_t {
  kBestpos,
  kBestvel,
  kInspva,
  kInspvax,
  kInsatt,
  kHeading,
  kCorrimu
};
inline constexpr const char* kNovatelKindNames[] = {"BESTPOS", "BESTVEL", "INSPVA",     "INSPVAX",
                                                    "INSATT",  "HEADING", "CORRIMUDATA"};

/// A parsed frame.
struct NovatelFrame {
  uint16_t id = 0;
  std::string_view body;
  int week = 0;              ///< GPS week as reported
  int64_t time_of_week = 0;  ///< GPS time in it [us]
  int time_status = -1;      ///< -1: a short header has none
};

/// Parses a frame with a good checksum.
NovatelFrame frameOf(std::string_view frame);

/// A supported message: its id, length and name.
struct NovatelType {
  uint16_t id;
  size_t length;  ///< of the body [bytes]
  const char* name;
  NovatelKind kind;
};

/// The type of an id; null if it is not supported.
const NovatelType* typeOfId(uint16_t id);

}  // namespace tread::ins

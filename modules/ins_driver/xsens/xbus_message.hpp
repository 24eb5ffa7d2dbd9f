// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "modules/ins_driver/core/binary_framer.hpp"

namespace tread::ins {

/// Supported data of an MTData2 message (MT Low Level Communication Protocol): their identifiers
/// without number format and coordinate system.
enum class XbusData : uint16_t {
  kUtcTime = 0x1010,
  kSampleTimeFine = 0x1060,
  kQuaternion = 0x2010,
  kEulerAngles = 0x2030,
  kAltitudeEllipsoid = 0x5020,
  kLatLon = 0x5040,
  kGnssPvt = 0x7010,
  kRateOfTurn = 0x8020,
  kVelocity = 0xD010,
  kStatusByte = 0xE010,
  kStatusWord = 0xE020
};

/// Checks bytes for an Xbus message: FA, FF, identifier, length, data, checksum.
FrameLook lookForXbus(std::string_view bytes);

/// The data of an MTData2 message with a good checksum, as views into it: it must outlive them.
class XbusFields {
 public:
  /// nullopt for another message, or if the lengths of its data do not match the message.
  static std::optional<XbusFields> of(std::string_view frame);

  bool holds(XbusData data) const { return fields_.count(data) != 0; }
  /// The numbers of a field, in any of the four formats; empty if it is absent or has another count
  /// of them.
  std::vector<double> numbers(XbusData data, size_t count) const;
  /// Bytes of a field without a number format; empty if it is absent or has another length.
  std::string_view bytes(XbusData data, size_t length) const;
  /// Whether orientation and velocity, if present, are relative to east, north, up.
  bool eastNorthUp() const;

 private:
  struct Field {
    unsigned format;  ///< the identifier's last four bits
    std::string_view bytes;
  };
  std::map<XbusData, Field> fields_;
};

/// The big-endian whole number at an offset; 0 beyond the end.
template <class Number>
Number bigEndianAt(std::string_view bytes, size_t offset) {
  if (offset + sizeof(Number) > bytes.size()) return 0;
  uint64_t number = 0;
  for (size_t i = 0; i < sizeof(Number); ++i)
    number = number << 8U | static_cast<uint8_t>(bytes[offset + i]);
  return static_cast<Number>(number);
}

}  // namespace tread::ins

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string_view>
#include <variant>

#include "modules/ins_driver/nmea/nmea_sentence.hpp"

namespace tread::ins {

/// A sentence in SI units and the house's frames, or why it is none.
using ParseResult = std::variant<NmeaSentence, SentenceRefusal>;

/// Reads what stands between '$' and '*' (checksum already verified).
/** GGA, RMC, VTG, HDT, ROT and ZDA of any two-letter talker, and PASHR (field lists: NMEA 0183
   v4.11; PASHR: manuals of OxTS, NovAtel and Trimble). Empty fields are absent. One malformed or
   impossible field refuses the sentence. */
ParseResult parseNmea(std::string_view body);

}  // namespace tread::ins

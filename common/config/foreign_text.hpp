// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tread {

/// A number as other people's programs write it: also .5, +1.5 and 007; inf and nan are none.
/** Whatever the locale is: the decimal sign is a point. */
std::optional<double> parseForeignNumber(std::string_view text);

/// Takes the byte order mark of UTF-8 off a text; tells what makes it another encoding, or nothing.
std::string takeByteOrderMark(std::string& text);

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tread {

/// A number as third-party programs write it: also .5, +1.5 and 007; not inf or nan.
/** Independent of the locale: the decimal sign is a point. */
std::optional<double> parseForeignNumber(std::string_view text);

/// Removes a UTF-8 byte order mark from a text. Returns the name of another encoding that the text
/// begins with; else empty.
std::string takeByteOrderMark(std::string& text);

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/pattern/pattern.hpp"

namespace tread {

/// FNV-1a (64 bit), word by word and folded, over a canonical form of the content, cut to 63 bits
/// so that it is never negative.
/** In it: name, version, parent, kind, period, classes by name, patterns in their order; numbers by
 * their bit patterns, little end first, every NaN the same. Not in it: utime, which is a time stamp
 * of the content. */
int64_t checksumOf(const PatternSetContent& content);

}  // namespace tread

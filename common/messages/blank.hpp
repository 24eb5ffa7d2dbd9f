// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <tread/mark_unknown.hpp>

namespace tread {

/// A message in which every field is "unknown" or "none", as its .lcm file defines it. Publishers
/// begin with it, so that a new field is never a 0 that looks measured.
template <class Message>
Message blank() {
  Message message{};
  detail::markUnknown(message);
  return message;
}

}  // namespace tread

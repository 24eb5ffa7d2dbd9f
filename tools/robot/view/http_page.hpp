// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <string_view>

#include "tools/robot/view/admission.hpp"

struct lws;

namespace tread::view {

/// The page as one HTML file; made by the build.
std::string_view pageText();

/// What the request of a socket says of who asks.
Visitor visitorOf(lws* socket);

/// Answers a request by HTTP: the page, or why not. `sent` [bytes] of the page so far. What these
/// return is for libwebsockets: not zero = close.
int answerRequest(lws* socket, const ServerSettings& settings, size_t* sent);
/// Sends the next piece of the page.
int continuePage(lws* socket, size_t* sent);

}  // namespace tread::view

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <string_view>

#include "tools/robot/view/admission.hpp"

struct lws;

namespace tread::view {

/// The page as one HTML file, made by the build.
std::string_view pageText();

/// Identity of a socket's request.
Visitor visitorOf(lws* socket);

/// Answers an HTTP request with the page or an error. `sent` [bytes] of the page so far. The
/// results are for libwebsockets: non-zero = close.
int answerRequest(lws* socket, const ServerSettings& settings, size_t* sent);
/// Sends the next piece of the page.
int continuePage(lws* socket, size_t* sent);

}  // namespace tread::view

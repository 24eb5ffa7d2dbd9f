// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/http_page.hpp"

#include <libwebsockets.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace tread::view {
namespace {

constexpr size_t kHttpPiece = 16384;  // [bytes]

std::string headerOf(lws* socket, lws_token_indexes token) {
  std::string text(static_cast<size_t>(lws_hdr_total_length(socket, token)) + 1, '\0');
  const int size = lws_hdr_copy(socket, text.data(), static_cast<int>(text.size()), token);
  text.resize(static_cast<size_t>(std::max(0, size)));
  return text;
}

/// Value of an argument of the address: "?token=...".
std::string argumentOf(lws* socket, const char* name) {
  char buffer[256] = {};
  const char* const value =
      lws_get_urlarg_by_name(socket, (std::string(name) + "=").c_str(), buffer, sizeof buffer);
  return value != nullptr ? value : "";
}

int addHeader(lws* socket, const char* name, const std::string& value, unsigned char** at,
              unsigned char* end) {
  return lws_add_http_header_by_name(socket, reinterpret_cast<const unsigned char*>(name),
                                     reinterpret_cast<const unsigned char*>(value.data()),
                                     static_cast<int>(value.size()), at, end);
}

/// Answers with the reason why there is no page.
int refuseRequest(lws* socket, unsigned int status, const char* why) {
  lws_return_http_status(socket, status, why);
  return lws_http_transaction_completed(socket) != 0 ? -1 : 0;
}

/// Sends the headers; false on failure.
bool writeHead(lws* socket) {
  unsigned char head[LWS_PRE + 1024];
  unsigned char *at = head + LWS_PRE, *const end = head + sizeof head;
  unsigned char* const begin = at;
  return lws_add_http_common_headers(socket, HTTP_STATUS_OK, "text/html; charset=utf-8",
                                     pageText().size(), &at, end) == 0 &&
         // Inside a foreign frame a click could be redirected (clickjacking).
         addHeader(socket, "x-frame-options:", "DENY", &at, end) == 0 &&
         addHeader(socket, "content-security-policy:", "frame-ancestors 'none'", &at, end) == 0 &&
         lws_finalize_write_http_header(socket, begin, &at, end) == 0;
}

}  // namespace

Visitor visitorOf(lws* socket) {
  return {headerOf(socket, WSI_TOKEN_HOST), headerOf(socket, WSI_TOKEN_ORIGIN),
          argumentOf(socket, "token")};
}

int answerRequest(lws* socket, const ServerSettings& settings, size_t* sent) {
  const std::string path = headerOf(socket, WSI_TOKEN_GET_URI);
  if (!mayLook(visitorOf(socket), settings))
    return refuseRequest(socket, HTTP_STATUS_FORBIDDEN,
                         "the address must end with ?token=..., as printed by tread-view");
  if (path != "/" && path != "/index.html" && settings.paths.count(path) == 0)
    return refuseRequest(socket, HTTP_STATUS_NOT_FOUND, "there is only the page at /");
  if (!writeHead(socket)) return 1;
  *sent = 0;
  lws_callback_on_writable(socket);
  return 0;
}

int continuePage(lws* socket, size_t* sent) {
  const std::string_view page = pageText();
  const size_t size = std::min(kHttpPiece, page.size() - *sent);
  std::vector<unsigned char> piece(LWS_PRE + size);
  std::memcpy(piece.data() + LWS_PRE, page.data() + *sent, size);
  const bool last = *sent + size == page.size();
  if (lws_write(socket, piece.data() + LWS_PRE, size,
                last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) != static_cast<int>(size))
    return 1;
  *sent += size;
  if (!last) {
    lws_callback_on_writable(socket);
    return 0;
  }
  return lws_http_transaction_completed(socket) != 0 ? -1 : 0;
}

}  // namespace tread::view

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/admission.hpp"

#include <algorithm>
#include <cctype>

namespace tread::view {
namespace {

/// Compares in constant time, so that timing reveals nothing about the token.
bool sameText(const std::string& a, const std::string& b) {
  unsigned char different = a.size() == b.size() ? 0 : 1;
  for (size_t i = 0; i < a.size(); ++i)
    different = static_cast<unsigned char>(different | (a[i] ^ b[b.empty() ? 0 : i % b.size()]));
  return different == 0;
}

/// Host of an address "http://host:port", without its scheme.
std::string hostOf(const std::string& origin) {
  const size_t scheme = origin.find("://");
  return scheme == std::string::npos ? origin : origin.substr(scheme + 3);
}

bool isLoopbackName(const std::string& host) {
  const size_t port = host.find_first_of(':', host.front() == '[' ? host.find(']') : 0);
  const std::string name = host.substr(0, port);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace

std::string addOrigin(const std::string& url, ServerSettings& settings) {
  const size_t scheme = url.find("://");
  const std::string name = url.substr(0, scheme);
  const size_t host = scheme == std::string::npos ? url.size() : scheme + 3;
  const size_t path = std::min(url.find_first_of("/?#", host), url.size());
  if ((name != "http" && name != "https") || path == host ||
      url.find_first_of("?#@ ", host) != std::string::npos)
    return "'" + url + "' is not the address of a page; give https://HOST[:PORT][/PATH/]";
  // Normalized as in browsers: lower case, without the default port.
  std::string origin = url.substr(0, path);
  std::transform(origin.begin(), origin.end(), origin.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  const std::string usual = name == "https" ? ":443" : ":80";
  if (origin.size() > usual.size() &&
      origin.compare(origin.size() - usual.size(), usual.size(), usual) == 0)
    origin.resize(origin.size() - usual.size());
  settings.origins.push_back(origin);
  if (path + 1 < url.size()) settings.paths.insert(url.substr(path));
  return "";
}

bool isOurs(const Visitor& visitor, const ServerSettings& settings) {
  const std::vector<std::string>& named = settings.origins;
  return visitor.origin.empty() || hostOf(visitor.origin) == visitor.host ||
         std::find(named.begin(), named.end(), visitor.origin) != named.end();
}

bool mayLook(const Visitor& visitor, const ServerSettings& settings) {
  if (!settings.token.empty()) return sameText(visitor.token, settings.token);
  return !visitor.host.empty() && isLoopbackName(visitor.host) && isOurs(visitor, settings);
}

}  // namespace tread::view

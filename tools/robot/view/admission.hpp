// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <set>
#include <string>
#include <vector>

namespace tread::view {

/// Settings of the server.
struct ServerSettings {
  std::string address = "127.0.0.1";
  int port = 8765;    ///< 0 = any free one
  std::string token;  ///< required from every viewer; empty = none, then only for this machine
  bool may_command = true;  ///< pages may operate the robot
  /// Further origins of our pages ("https://host"), and the paths under which a proxy requests
  /// them; see addOrigin().
  std::vector<std::string> origins;
  std::set<std::string> paths;
  /// PEM file with its key; empty = not encrypted, then only for this machine
  std::string certificate;
};

/// Adds the address of the page behind a proxy, "https://host:8443/robot/"; returns the error,
/// empty = none.
std::string addOrigin(const std::string& url, ServerSettings& settings);

/// Identity of a viewer's request.
struct Visitor {
  std::string host;    ///< name and port that it requests
  std::string origin;  ///< origin of the requesting page; empty: not a page
  std::string token;
};

/// Whether the request comes from our own page or from no page.
bool isOurs(const Visitor& visitor, const ServerSettings& settings);

/// A foreign page in the same browser must not even read. Without a token only requests to this
/// machine's own names pass, and only from pages served here.
bool mayLook(const Visitor& visitor, const ServerSettings& settings);

}  // namespace tread::view

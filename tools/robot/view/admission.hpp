// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <set>
#include <string>
#include <vector>

namespace tread::view {

/// Where viewers come in.
struct ServerSettings {
  std::string address = "127.0.0.1";
  int port = 8765;          ///< 0 = any that is free
  std::string token;        ///< asked of everybody; empty = none, for this machine alone
  bool may_command = true;  ///< pages may operate the robot
  /// Where else pages of ours come from ("https://host"), and under which paths a proxy asks for
  /// them; see addOrigin().
  std::vector<std::string> origins;
  std::set<std::string> paths;
  std::string
      certificate;  ///< PEM file with its key; empty = not encrypted, for this machine alone
};

/// Takes the address of the page behind a proxy, "https://host:8443/robot/"; returns what is wrong
/// with it, empty = nothing.
std::string addOrigin(const std::string& url, ServerSettings& settings);

/// What a viewer's request says of itself.
struct Visitor {
  std::string host;    ///< the name by which it asks, with the port
  std::string origin;  ///< where the page that asks came from; empty: no page asks
  std::string token;
};

/// Whether no page asks, or one that was fetched from here.
bool isOurs(const Visitor& visitor, const ServerSettings& settings);

/// A stranger's page in the same browser must not even listen: without a token only those who name
/// this machine are let in, and only pages that came from here.
bool mayLook(const Visitor& visitor, const ServerSettings& settings);

}  // namespace tread::view

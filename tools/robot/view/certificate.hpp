// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::view {

/// Certificate for browsers on other machines, so that nobody on the network can read the token.
struct Certificate {
  std::string path;         ///< certificate and private key in one PEM file
  std::string fingerprint;  ///< SHA-256, as browsers show it: "3F:2A:..."
  bool made = false;        ///< created just now
};

/// This machine's self-signed certificate, kept in a folder; created at the first start.
/** Throws std::runtime_error, one line, if it cannot be made or read, or if others may read it. */
Certificate ownCertificate(const std::string& folder);

}  // namespace tread::view

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/key_option.hpp"

#include <cstdlib>

namespace tread {

void addKeyOption(CLI::App& app, std::string& path) {
  app.add_option("--key", path,
                 "key of the robot (tread-key new FILE): messages are sealed, and others refused")
      ->envname("TREAD_KEY")
      ->check([](const std::string& given) {
        return given.empty() ? std::string("--key: a file is missing") : std::string();
      });
  // CLI11 takes an empty variable for none; whoever set it does not want a robot without a key.
  app.final_callback([&path] {
    const char* const named = std::getenv("TREAD_KEY");
    if (path.empty() && named != nullptr && *named == '\0')
      throw CLI::ValidationError("TREAD_KEY", "is set, but names no file; unset it to have no key");
  });
}

}  // namespace tread

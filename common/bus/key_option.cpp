// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/key_option.hpp"

#include <cstdlib>

namespace tread {

void addKeyOption(CLI::App& app, std::string& path, EmptyKey empty) {
  const CLI::Option* const option =
      app.add_option(
             "--key", path,
             "key of the robot (tread-key new FILE): messages are sealed, and others refused")
          ->envname("TREAD_KEY")
          ->check([](const std::string& given) {
            return given.empty() ? std::string("--key: a file is missing") : std::string();
          });
  if (empty == EmptyKey::kIsNone) return;
  // CLI11 treats an empty variable as unset: a script that lost its path would start unsealed.
  app.parse_complete_callback([option] {
    const char* const named = std::getenv("TREAD_KEY");
    if (option->count() == 0 && named != nullptr && *named == '\0')
      throw CLI::ValidationError("TREAD_KEY",
                                 "is set but empty; unset it, or name the file of the key");
  });
}

}  // namespace tread

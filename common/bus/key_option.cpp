// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/key_option.hpp"

namespace tread {

void addKeyOption(CLI::App& app, std::string& path) {
  app.add_option("--key", path,
                 "key of the robot (tread-key new FILE): messages are sealed, and others refused")
      ->envname("TREAD_KEY")
      ->check([](const std::string& given) {
        return given.empty() ? std::string("--key: a file is missing") : std::string();
      });
}

}  // namespace tread

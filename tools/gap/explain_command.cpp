// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <memory>
#include <string>

#include "common/vehicle/model_file.hpp"
#include "tools/gap/commands.hpp"
#include "tools/gap/explain.hpp"

namespace tread::gap {

CLI::App* addExplain(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "explain", "what an effect is, what it looks like and how to check it in two minutes");
  command->add_option("EFFECT", *name,
                      "name of an effect, or start, verdicts or words; without it, a list");
  command->callback([name] {
    const auto about = topic(*name);
    std::cout << (name->empty() ? listOfEffects() + listOfTopics()
                  : about       ? *about
                                : explanation(effectOrGuess(*name)))
              << std::flush;
  });
  return command;
}

}  // namespace tread::gap

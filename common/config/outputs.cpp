// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/outputs.hpp"

#include <algorithm>
#include <utility>

#include "common/config/command_line.hpp"
#include "common/store/output_file.hpp"

namespace tread {

struct Outputs::Declared {
  struct Named {
    const CLI::Option* option;
    const std::string* path;
    PlannedOutput::Kind kind;
  };
  std::vector<Named> named;
  std::vector<std::function<std::vector<std::string>()>> derived;
  bool force = false;

  CLI::Option* add(CLI::App& command, const std::string& names, std::string& path,
                   const std::string& what, PlannedOutput::Kind kind) {
    CLI::Option* const option = command.add_option(names, path, what);
    named.push_back({option, &path, kind});
    return option;
  }

  /// Every word of the command line that does not name an output.
  void addInputs(const CLI::App& app, std::vector<std::string>& inputs) const {
    for (const CLI::Option* option : app.get_options()) {
      const bool output = std::any_of(named.begin(), named.end(),
                                      [&](const Named& one) { return one.option == option; });
      if (!output)
        for (const std::string& word : option->results()) inputs.push_back(word);
    }
    for (const CLI::App* group : app.get_subcommands({}))
      if (group->get_name().empty()) addInputs(*group, inputs);
  }

  void check(const CLI::App& command) const {
    std::vector<std::string> inputs;
    for (const CLI::App* app = &command; app != nullptr; app = app->get_parent())
      addInputs(*app, inputs);
    std::vector<PlannedOutput> outputs;
    for (const Named& one : named) {
      if (one.option->count() > 0 && one.path->empty())
        throw CLI::ValidationError(one.option->get_name(), "its name is empty");
      outputs.push_back({*one.path, one.kind});
    }
    for (const auto& paths : derived)
      for (const std::string& path : paths()) outputs.push_back({path});
    try {
      checkOutputs(outputs, inputs, force);
    } catch (const std::runtime_error& refused) {
      throw CLI::Error("OutputRefused", refused.what(), kBadInput);
    }
  }
};

Outputs::Outputs(CLI::App& command) : command_(command), declared_(std::make_shared<Declared>()) {
  command.add_flag("--force", declared_->force, "replace existing files");
  command.parse_complete_callback([declared = declared_, &command] { declared->check(command); });
}

CLI::Option* Outputs::file(const std::string& names, std::string& path, const std::string& what) {
  return declared_->add(command_, names, path, what, PlannedOutput::Kind::kFile);
}

CLI::Option* Outputs::folder(const std::string& names, std::string& path, const std::string& what) {
  return declared_->add(command_, names, path, what, PlannedOutput::Kind::kFolder);
}

CLI::Option* Outputs::fileOrFolder(const std::string& names, std::string& path,
                                   const std::string& what) {
  return declared_->add(command_, names, path, what, PlannedOutput::Kind::kEither);
}

void Outputs::derived(std::function<std::vector<std::string>()> paths) {
  declared_->derived.push_back(std::move(paths));
}

}  // namespace tread

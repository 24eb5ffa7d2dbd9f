// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/logged_learner.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern_file.hpp"

namespace tread::report {
namespace {

/// The set with the numbers of a shipped one, as in a pattern file.
std::optional<PatternSet> asShipped(const PatternSet& set, int64_t version) {
  PatternSetContent content = set.content();
  content.version = version;
  content.parent_version = 0;
  std::string why;
  return PatternSet::make(std::move(content), why);
}

std::optional<PatternSet> shippedInLog(const RobotLog& log, int64_t checksum) {
  PatternSetAssembler assembler;
  for (const LogEvent& event : log.events) {
    pattern_set_part_t part;
    if (!decode(event, kPatternSet, part)) continue;
    const auto set = assembler.add(part);
    if (!set) continue;
    for (const int64_t version : {int64_t{1}, set->content().parent_version}) {
      const auto shipped = version < 1 ? std::nullopt : asShipped(*set, version);
      if (shipped && shipped->checksum() == checksum) return shipped;
    }
    return std::nullopt;  // changed by later learning
  }
  return std::nullopt;
}

std::optional<PatternSet> shippedInFolder(const std::string& folder, int64_t checksum) {
  std::set<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".yaml") files.insert(entry.path());
  for (const std::filesystem::path& file : files) {
    PatternSet set = readPatternFile(file.string());
    if (set.checksum() == checksum) return set;
  }
  return std::nullopt;
}

}  // namespace

learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log, const std::string& patterns_folder,
                                           const std::vector<std::string>& overrides) {
  const auto text = log.configs.find("learner");
  if (text == log.configs.end())
    throw std::runtime_error(log.name +
                             ": no CONFIG of the learner; give its configuration with --config, or "
                             "--model or --patterns for a log without a learner");
  ConfigReader reader = loggedConfig(log, "learner", overrides);
  std::string name;
  int64_t checksum = 0;
  reader.text("shipped_set", name, true);
  reader.integer("shipped_checksum", checksum, {0.0, 9.3e18}, "1", true);
  auto shipped = shippedInLog(log, checksum);
  if (!shipped) shipped = shippedInFolder(patterns_folder, checksum);
  if (!shipped)
    throw std::runtime_error(log.name + ": the shipped set '" + name + "' (checksum " +
                             std::to_string(checksum) + ") is neither its first version nor in " +
                             patterns_folder + "; give the learner's configuration with --config");
  learner::LearnerNodeConfig config(*shipped);
  learner::readLearnerSettings(reader, config);
  reader.finish();
  return config;
}

}  // namespace tread::report

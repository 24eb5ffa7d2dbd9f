// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/state_text.hpp"

#include <algorithm>
#include <sstream>

#include "modules/learner/core/sealed_text.hpp"

namespace tread::learner {
namespace {

constexpr const char* kHeader = "tread-learner-state 2";
/// No state of a thousand patterns has more executions in its list than this.
constexpr int64_t kMaxHandled = 10'000;
/// No rule remembers more numbers than this.
constexpr int64_t kMaxMemory = 100'000'000;

void writeNumbers(std::ostringstream& out, const PoseCovariance& numbers) {
  for (const double value : numbers) out << ' ' << number(value);
}

void writePattern(std::ostringstream& out, const MotionPattern& pattern,
                  const EndResiduals& residuals) {
  out << "pattern " << pattern.id << " learned " << pattern.times_learned << " poses "
      << pattern.trajectory.size() << '\n';
  out << "covariance";
  writeNumbers(out, pattern.end_covariance);
  out << "\nresiduals " << residuals.count;
  writeNumbers(out, residuals.mean);
  out << '\n';
  for (const Pose2& pose : pattern.trajectory)
    out << number(pose.x) << ' ' << number(pose.y) << ' ' << number(pose.yaw) << '\n';
}

std::string body(const LearnerState& state, const PatternSet& shipped, const RuleConfig& config) {
  std::ostringstream out;
  const PatternSetContent& content = state.set.content();
  out << kHeader << '\n';
  out << "shipped " << shipped.checksum() << '\n';
  out << "rule " << ruleName(config.rule) << " memory " << number(config.memory) << '\n';
  out << "version " << content.version << " parent " << content.parent_version << " utime "
      << content.utime << '\n';
  out << "handled " << state.handled.size() << '\n';
  for (const auto& [run, execution] : state.handled) out << run << ' ' << execution << '\n';
  out << "patterns " << content.patterns.size() << '\n';
  for (const MotionPattern& pattern : content.patterns)
    writePattern(out, pattern, state.residuals.at(pattern.id));
  out << "memory " << state.memory.size() << '\n';
  for (const double value : state.memory) out << number(value) << '\n';
  return out.str();
}

PoseCovariance readNumbers(Words& words) {
  PoseCovariance values{};
  for (double& value : values) value = words.real();
  return values;
}

/// One pattern's learned part, into the pattern of the shipped set.
void readPattern(Words& words, MotionPattern& pattern, ResidualTable& residuals) {
  words.expect("pattern");
  words.require(words.integer() == pattern.id);
  words.expect("learned");
  pattern.times_learned = static_cast<int>(words.integer());
  words.expect("poses");
  words.require(words.integer() == static_cast<int64_t>(pattern.trajectory.size()));
  words.expect("covariance");
  pattern.end_covariance = readNumbers(words);
  words.expect("residuals");
  EndResiduals& entry = residuals[pattern.id];
  entry.count = words.integer();
  entry.mean = readNumbers(words);
  for (Pose2& pose : pattern.trajectory) pose = {words.real(), words.real(), words.real()};
}

}  // namespace

std::string formatState(const LearnerState& state, const PatternSet& shipped,
                        const RuleConfig& config) {
  const std::string content = body(state, shipped, config);
  return sealed(content);
}

std::optional<LearnerState> parseState(const std::string& text, const PatternSet& shipped,
                                       std::string& why) {
  const auto checked = unsealed(text);
  if (!checked || checked->compare(0, std::string(kHeader).size(), kHeader) != 0) {
    why = "is damaged";
    return std::nullopt;
  }
  Words words(checked->substr(std::string(kHeader).size()));
  words.expect("shipped");
  if (words.integer() != shipped.checksum()) {
    why = "belongs to another shipped pattern set";
    return std::nullopt;
  }
  PatternSetContent content = shipped.content();
  words.expect("rule");
  const auto rule = ruleNamed(words.word());
  words.require(rule.has_value());
  words.expect("memory");
  words.real();
  words.expect("version");
  content.version = words.integer();
  words.expect("parent");
  content.parent_version = words.integer();
  words.expect("utime");
  content.utime = words.integer();
  words.expect("handled");
  std::vector<ExecutionKey> handled;
  const int64_t listed = std::min(words.integer(), kMaxHandled);
  for (int64_t i = 0; i < listed && words.good(); ++i) {
    const int64_t run = words.integer();
    handled.emplace_back(run, words.integer());
  }
  ResidualTable residuals;
  words.expect("patterns");
  words.require(words.integer() == static_cast<int64_t>(content.patterns.size()));
  for (MotionPattern& pattern : content.patterns) readPattern(words, pattern, residuals);
  words.expect("memory");
  const int64_t numbers = words.integer();
  words.require(numbers >= 0 && numbers <= kMaxMemory);
  std::vector<double> memory;
  for (int64_t i = 0; i < numbers && words.good(); ++i) memory.push_back(words.real());
  if (!words.good()) {
    why = "is damaged";
    return std::nullopt;
  }
  auto set = PatternSet::make(std::move(content), why);
  if (!set) {
    why = "holds a wrong set: " + why;
    return std::nullopt;
  }
  return LearnerState{std::move(*set), std::move(residuals), std::move(memory), *rule,
                      std::move(handled)};
}

}  // namespace tread::learner

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "modules/learner/core/state_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <system_error>

#include "modules/learner/core/rules/make_rule.hpp"

namespace tread::learner {
namespace {

/// FNV-1a, 64 bits: detects a damaged text.
uint64_t fingerprint(const std::string& text) {
  uint64_t hash = 14695981039346656037ULL;
  for (const char letter : text) {
    hash ^= static_cast<unsigned char>(letter);
    hash *= 1099511628211ULL;
  }
  return hash;
}

std::string lastLine(const std::string& content) {
  std::ostringstream line;
  line << "end " << std::hex << fingerprint(content) << '\n';
  return line.str();
}

/// The shortest text that reads back as the same number, in any locale.
std::string number(double value) {
  std::array<char, 40> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

/// The text with its last line, "end" and a fingerprint of the text before it.
std::string sealed(const std::string& content) {
  return content + lastLine(content);
}

/// The text without that line; nullopt if it does not match the text.
std::optional<std::string> unsealed(const std::string& text) {
  const size_t end = text.rfind("end ");
  if (end == std::string::npos || end == 0 || text[end - 1] != '\n') return std::nullopt;
  std::string content = text.substr(0, end);
  if (text.substr(end) != lastLine(content)) return std::nullopt;
  return content;
}

/// Reads words and numbers; after the first failure everything fails.
class Words {
 public:
  explicit Words(const std::string& text) : in_(text) {}

  bool good() const { return good_; }
  void require(bool condition) { good_ = good_ && condition; }
  void expect(const char* expected) { require(word() == expected); }
  std::string word() {
    std::string found;
    good_ = good_ && (in_ >> found);
    return found;
  }
  int64_t integer() {
    int64_t value = 0;
    good_ = good_ && (in_ >> value);
    return good_ ? value : 0;
  }
  double real() {
    const std::string text = word();
    double value = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    require(result.ec == std::errc() && result.ptr == text.data() + text.size());
    return value;
  }

 private:
  std::istringstream in_;
  bool good_ = true;
};

constexpr const char* kStateKind = "tread-learner-state ";
constexpr const char* kStateHeader = "tread-learner-state 4";
/// Upper limit of the list of executions in a state.
constexpr int64_t kMaxHandled = 10'000;
/// Upper limit of the numbers in a rule's memory.
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
  out << kStateHeader << '\n';
  out << "shipped " << shipped.checksum() << '\n';
  out << "rule " << config.rule << " memory " << number(config.memory) << '\n';
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

/// Reads one pattern's learned part into the pattern of the shipped set.
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
  if (!checked || checked->rfind(kStateKind, 0) != 0) {
    why = "is damaged";
    return std::nullopt;
  }
  if (checked->rfind(std::string(kStateHeader) + "\n", 0) != 0) {
    why = "was written by another release";
    return std::nullopt;
  }
  Words words(checked->substr(std::string(kStateHeader).size()));
  words.expect("shipped");
  if (words.integer() != shipped.checksum()) {
    why = "belongs to another shipped pattern set";
    return std::nullopt;
  }
  PatternSetContent content = shipped.content();
  words.expect("rule");
  const Rule rule = words.word();
  const std::vector<std::string> known = ruleNames();
  words.require(std::find(known.begin(), known.end(), rule) != known.end());
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
    why = "contains a wrong set: " + why;
    return std::nullopt;
  }
  return LearnerState{std::move(*set), std::move(residuals), std::move(memory), rule,
                      std::move(handled)};
}

}  // namespace tread::learner

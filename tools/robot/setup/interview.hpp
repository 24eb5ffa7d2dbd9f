// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace tread::setup {

/// A question that no instrument can answer.
struct Question {
  std::string key;    ///< in the file of answers
  std::string words;  ///< text for a person
  std::optional<std::string> usual;
};

/// All questions in order; the keys are those of a file of answers.
const std::vector<Question>& questions();

/// The person at the robot, or a file of answers.
class Interview {
 public:
  virtual ~Interview() = default;
  /// The answer to this question; throws ConfigError if there is none.
  virtual std::string ask(const std::string& key) = 0;
  /// Reports progress.
  virtual void say(const std::string& line) = 0;

  /// Throws ConfigError if an answer is out of range.
  double number(const std::string& key, Range range);
  /// One of a list of words.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed);
  /// Throws ConfigError unless the answer is yes: the next step moves the robot.
  void confirm(const std::string& key);

 protected:
  /// Source of an answer, for messages.
  virtual std::string place(const std::string& key) const = 0;
};

/// Answers from a YAML file, without asking.
class AnswersFile : public Interview {
 public:
  using Say = std::function<void(const std::string& line)>;
  /// Throws ConfigError for unknown keys.
  AnswersFile(ConfigReader reader, Say say);

  std::string ask(const std::string& key) override;
  void say(const std::string& line) override { say_(line); }

 protected:
  std::string place(const std::string& key) const override { return "answers: " + key; }

 private:
  std::map<std::string, std::string> answers_;
  Say say_;
};

/// A person at a terminal.
class Terminal : public Interview {
 public:
  Terminal(std::istream& in, std::ostream& out) : in_(in), out_(out) {}

  std::string ask(const std::string& key) override;
  void say(const std::string& line) override;

 protected:
  std::string place(const std::string& key) const override { return key; }

 private:
  std::istream& in_;
  std::ostream& out_;
};

}  // namespace tread::setup

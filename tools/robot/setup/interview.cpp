// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/interview.hpp"

#include <algorithm>
#include <istream>
#include <ostream>

#include "common/config/scalars.hpp"
#include "common/report/text.hpp"

namespace tread::setup {
namespace {

const Question& questionOf(const std::string& key) {
  const auto& all = questions();
  return *std::find_if(all.begin(), all.end(),
                       [&](const Question& question) { return question.key == key; });
}

}  // namespace

const std::vector<Question>& questions() {
  static const std::vector<Question> kQuestions{
      {"name", "What is the robot's name (one word, used for its folder)?", {}},
      {"front", "How far does it extend forward of the midpoint between its tracks [m]?", {}},
      {"rear", "How far backward [m]?", {}},
      {"half_width", "What is half of its width [m]?", {}},
      {"height", "How high is it [m]?", {}},
      {"wheelbase",
       "If it steers like a car: what is its wheelbase [m]? The midpoint is then that of the rear "
       "axle. 0 for a left and a right side",
       "0"},
      {"range_finder_x", "How far forward of the midpoint is the range finder [m]?", {}},
      {"range_finder_y", "How far to the left [m]?", "0"},
      {"range_finder_z", "How high above the ground [m]?", {}},
      {"range_finder_yaw", "Turned to the left by how much [deg]?", "0"},
      {"ins_x",
       "How far forward of the midpoint is the point that the INS measures (its antenna) [m]?",
       "0"},
      {"ins_y", "How far to the left [m]?", "0"},
      {"ins_z", "How high above the ground [m]?", "0"},
      {"line_protocols",
       "Which files describe a controller's line protocol (separated by commas, or none)?", "none"},
      {"silent_controller",
       "At which address is a controller that never replies (Sabertooth), or none?", "none"},
      {"hokuyo",
       "No range finder was found. At which address is a Hokuyo (tcp:HOST:10940), or none?",
       "none"},
      {"wheels_up",
       "Lift it so that its tracks turn freely, and keep clear of them. May they turn now (yes)?",
       {}},
      {"first_track", "Which track turned first: left or right?", {}},
      {"first_direction", "Which way did it turn: forward or backward?", {}},
      {"first_steering", "Where did the front wheels turn first: left or right?", {}},
      {"watchdog_stopped",
       "Both tracks ran, then nothing was sent for a second. Did they stop by themselves: yes or "
       "no?",
       {}},
      {"wheels_down",
       "Put it on level ground in the middle of a free circle of 5 m, emergency stop at hand. May "
       "it drive for about a minute (yes)?",
       {}},
      {"record", "May it drive its patterns in the same circle, for some minutes (yes)?", {}},
      {"go", "Are 10 m ahead of it free, and may it drive there (yes)?", {}}};
  return kQuestions;
}

double Interview::number(const std::string& key, Range range) {
  const std::string answer = ask(key);
  const std::optional<double> value = parseNumber(answer);
  if (!value || *value < range.min || *value > range.max)
    throw ConfigError(place(key) + ": '" + answer + "'; give a number from " +
                      formatNumber(range.min) + " to " + formatNumber(range.max));
  return *value;
}

std::string Interview::choice(const std::string& key, const std::vector<std::string>& allowed) {
  const std::string answer = ask(key);
  if (std::find(allowed.begin(), allowed.end(), answer) == allowed.end())
    throw ConfigError(place(key) + ": '" + answer + "'; give one of " + joinWords(allowed));
  return answer;
}

void Interview::confirm(const std::string& key) {
  const std::string answer = ask(key);
  if (answer != "yes" && answer != "true")
    throw ConfigError(place(key) + ": '" + answer + "' is not yes: nothing is moved");
}

AnswersFile::AnswersFile(ConfigReader reader, Say say) : say_(std::move(say)) {
  for (const Question& question : questions())
    if (reader.has(question.key)) reader.text(question.key, answers_[question.key]);
  reader.finish();
}

std::string AnswersFile::ask(const std::string& key) {
  const Question& question = questionOf(key);
  const auto at = answers_.find(key);
  if (at != answers_.end()) return at->second;
  if (question.usual) return *question.usual;
  throw ConfigError(place(key) + " is missing: " + question.words);
}

std::string Terminal::ask(const std::string& key) {
  const Question& question = questionOf(key);
  out_ << question.words << (question.usual ? " [" + *question.usual + "] " : " ") << std::flush;
  std::string line;
  if (!std::getline(in_, line)) throw ConfigError(key + ": no answer");
  const size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t\r");
  if (begin != std::string::npos) return line.substr(begin, end - begin + 1);
  return question.usual.value_or("");
}

void Terminal::say(const std::string& line) {
  out_ << line << std::endl;
}

}  // namespace tread::setup

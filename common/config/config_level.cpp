// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/config_level.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/config/foreign_text.hpp"
#include "common/config/scalars.hpp"

namespace tread {
namespace {

int lineFrom(const YAML::Mark& mark, int otherwise) {
  return mark.is_null() ? otherwise : mark.line + 1;
}

/// A scalar as quoted in a message: one short line.
std::string shown(const std::string& text) {
  constexpr size_t kLongest = 40;
  const std::string quoted = formatText(text.substr(0, kLongest));
  return text.size() > kLongest ? quoted + "..." : quoted;
}

const char* kindOf(const YAML::Node& node) {
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a map";
  return node.IsScalar() ? "a single value" : "empty";
}

/// Whether the quoted scalar that begins here is closed before the text ends.
bool isClosed(const std::string& text, size_t open) {
  const char quote = text[open];
  for (size_t at = open + 1; at < text.size(); ++at) {
    if (text[at] == quote) return true;
    if (quote == '"' && text[at] == '\\') ++at;
  }
  return false;
}

/// The number of a valid item: the fast path, without texts for messages.
std::optional<double> goodNumber(const YAML::Node& node, Range range) {
  if (!node.IsScalar() || node.Tag() != "?") return std::nullopt;
  const auto value = parseNumber(node.Scalar());
  return value && *value >= range.min && *value <= range.max ? value : std::nullopt;
}

}  // namespace

ConfigSource::ConfigSource(std::string file_name, std::string file_text)
    : name(std::move(file_name)), text(std::move(file_text)), line_starts{0} {
  for (size_t at = 0; at < text.size(); ++at)
    if (text[at] == '\n') line_starts.push_back(at + 1);
}

size_t ConfigSource::offsetOf(const YAML::Mark& mark) const {
  const auto line = static_cast<size_t>(mark.line);
  if (mark.is_null() || line >= line_starts.size()) return text.size();
  return line_starts[line] + static_cast<size_t>(mark.column);
}

std::string formatQuantity(double value, const std::string& unit) {
  return formatNumber(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

std::string formatRange(Range range, const std::string& unit) {
  const bool low = std::isfinite(range.min);
  const bool high = std::isfinite(range.max);
  if (low && high) return formatNumber(range.min) + ".." + formatQuantity(range.max, unit);
  if (low) return "at least " + formatQuantity(range.min, unit);
  if (high) return "at most " + formatQuantity(range.max, unit);
  return "any finite number" + (unit.empty() || unit == "1" ? "" : " [" + unit + "]");
}

std::shared_ptr<ConfigReader::Level> ConfigReader::Level::parse(
    std::string text, const std::string& name, const std::vector<std::string>& overrides) {
  // yaml-cpp strips a byte order mark; without it, offsets in this copy match its marks.
  if (const std::string problem = takeByteOrderMark(text); !problem.empty())
    throw ConfigError(name + ": " + problem);
  const auto source = std::make_shared<ConfigSource>(name, std::move(text));
  YAML::Node root = loadOneDocument(source->text, name);
  for (const std::string& words : overrides) applyOverride(*source, words, root);
  return of(source, "", root, 1);
}

std::shared_ptr<ConfigReader::Level> ConfigReader::Level::of(
    std::shared_ptr<const ConfigSource> source, const std::string& prefix, const YAML::Node& map,
    int line) {
  auto level = std::make_shared<Level>();
  level->source = std::move(source);
  level->prefix = prefix;
  level->line = line;
  if (map.IsNull()) return level;
  if (!map.IsMap()) {
    const std::string name = prefix.empty() ? "the file" : prefix.substr(0, prefix.size() - 1);
    throw level->errorAt(line, name + " is " + kindOf(map) + "; a map of keys is needed");
  }
  level->collect(map);
  return level;
}

void ConfigReader::Level::collect(const YAML::Node& map) {
  for (const auto& pair : map) {
    const int key_line = lineFrom(pair.first.Mark(), line);
    if (!pair.first.IsScalar())
      throw errorAt(key_line, std::string("a key is ") + kindOf(pair.first) + "; a word is needed");
    const std::string key = pair.first.Scalar();
    if (const Entry* first = find(key))
      throw errorAt(key_line, path(key) + " is there twice; it was in line " +
                                  std::to_string(first->line) + " already");
    entries.push_back({key, key_line, pair.second, false});
  }
}

ConfigReader::Level::Entry* ConfigReader::Level::find(const std::string& key) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::optional<ConfigReader::Level::Found> ConfigReader::Level::ask(const std::string& key,
                                                                   bool required) {
  know(key);
  Entry* entry = find(key);
  if (entry == nullptr && required) throw missing(key);
  if (entry == nullptr) return std::nullopt;
  entry->asked = true;
  return Found{entry->value, path(key), lineOf(*entry)};
}

std::vector<ConfigReader::Level::Found> ConfigReader::Level::items(
    const Found& list, const std::string& wanted) const {
  if (!list.value.IsSequence()) throw errorAt(list, " is not a list; " + wanted + " is needed");
  std::vector<Found> items;
  for (const auto& item : list.value)
    items.push_back({item, list.name + "[" + std::to_string(items.size()) + "]",
                     lineFrom(item.Mark(), list.line)});
  return items;
}

void ConfigReader::Level::know(const std::string& key) {
  if (answered(key) == nullptr) answers.push_back({key, "", false, {}});
}

const ConfigReader::Level::Answer* ConfigReader::Level::answered(const std::string& key) const {
  const auto found = std::find_if(answers.begin(), answers.end(),
                                  [&](const Answer& answer) { return answer.key == key; });
  return found == answers.end() ? nullptr : &*found;
}

ConfigReader::Level::Answer& ConfigReader::Level::answer(const std::string& key,
                                                         const std::string& value) {
  know(key);
  const auto found = std::find_if(answers.begin(), answers.end(),
                                  [&](const Answer& answer) { return answer.key == key; });
  found->value = value;
  return *found;
}

std::string ConfigReader::Level::path(const std::string& key) const {
  // A key may come from the file, with any content; a message stays one line.
  return prefix + formatText(key);
}

ConfigError ConfigReader::Level::errorAt(int at, const std::string& problem) const {
  return ConfigError(source->place(at) + ": " + problem);
}

ConfigError ConfigReader::Level::missing(const std::string& key) const {
  std::vector<std::string> unasked;
  for (const Entry& entry : entries)
    if (!entry.asked) unasked.push_back(entry.key);
  const auto meant = nearestSpelling(key, unasked);
  return errorAt(line, "required key '" + path(key) + "' is missing" +
                           (meant ? "; is " + shown(*meant) + " meant?" : ""));
}

ConfigError ConfigReader::Level::unknown(const Entry& entry) const {
  std::vector<std::string> known;
  for (const Answer& answer : answers) known.push_back(answer.key);
  const auto meant = nearestSpelling(entry.key, known);
  std::string problem = "unknown key " + prefix + shown(entry.key);
  if (meant) problem += "; is " + *meant + " meant?";
  return errorAt(entry.line, problem + "; known here: " + joinWords(known));
}

int ConfigReader::Level::lineOf(const Entry& entry) {
  return entry.value.IsScalar() ? lineFrom(entry.value.Mark(), entry.line) : entry.line;
}

std::string ConfigReader::Level::scalar(const Found& found, const std::string& wanted,
                                        bool quotes_allowed) const {
  if (!found.value.IsScalar())
    throw errorAt(found, std::string(" is ") + kindOf(found.value) + "; " + wanted + " is needed");
  const std::string& tag = found.value.Tag();
  const bool quoted = tag == "!";
  if (!quoted && tag != "?" && !tag.empty())
    throw errorAt(found, " has the tag " + shown(tag) + "; " + wanted + " is needed");
  if (quoted) refuseOpenQuote(found);
  if (quoted && !quotes_allowed)
    throw errorAt(found, " is text in quotes; " + wanted + " is needed");
  return found.value.Scalar();
}

void ConfigReader::Level::refuseOpenQuote(const Found& found) const {
  // yaml-cpp reads an unclosed quote as text up to the end of the file, including all keys after
  // it.
  const std::string& text = source->text;
  const size_t open = source->offsetOf(found.value.Mark());
  if (open >= text.size() || (text[open] != '"' && text[open] != '\'')) return;
  if (!isClosed(text, open))
    throw errorAt(found, " begins with a quote that is never closed; close it");
}

double ConfigReader::Level::number(const Found& found, Range range, const std::string& unit) const {
  if (const auto good = goodNumber(found.value, range)) return *good;
  const std::string allowed = "; allowed " + formatRange(range, unit);
  const std::string text = scalar(found, "a number, " + formatRange(range, unit), false);
  const auto value = parseNumber(text);
  if (!value) throw errorAt(found, " is " + shown(text) + ", not a decimal number" + allowed);
  if (!(*value >= range.min && *value <= range.max))
    throw errorAt(found, " is " + formatQuantity(*value, unit) + allowed);
  return *value;
}

std::vector<double> ConfigReader::Level::numberList(const Found& list, size_t size, Range range,
                                                    const std::string& unit) const {
  if (!list.value.IsSequence())
    throw errorAt(list, std::string(" is ") + kindOf(list.value) + "; a list of numbers is needed");
  if (size != 0 && list.value.size() != size)
    throw errorAt(list, " has " + std::to_string(list.value.size()) + " numbers; " +
                            std::to_string(size) + " needed");
  std::vector<double> values;
  for (const auto& item : list.value) {
    if (const auto good = goodNumber(item, range)) {
      values.push_back(*good);
      continue;
    }
    const int item_line = item.IsScalar() ? lineFrom(item.Mark(), list.line) : list.line;
    values.push_back(number(
        {item, list.name + "[" + std::to_string(values.size()) + "]", item_line}, range, unit));
  }
  return values;
}

void ConfigReader::Level::finish() const {
  for (const Entry& entry : entries)
    if (!entry.asked) throw unknown(entry);
  for (const Answer& answer : answers)
    for (const auto& child : answer.children) child->finish();
}

std::string ConfigReader::Level::effective(const std::string& indent) const {
  std::string text;
  for (const Answer& answer : answers) {
    const std::string key = indent + formatText(answer.key) + ":";
    if (!answer.value.empty()) text += key + " " + answer.value + "\n";
    if (!answer.value.empty() || (answer.children.empty() && !answer.is_list)) continue;
    if (answer.children.empty()) text += key + " []\n";
    if (!answer.children.empty()) text += key + "\n";
    for (const auto& child : answer.children) {
      std::string body = child->effective(indent + (answer.is_list ? "    " : "  "));
      if (body.empty()) body = indent + (answer.is_list ? "    {}\n" : "  {}\n");
      if (answer.is_list) body[indent.size() + 2] = '-';
      text += body;
    }
  }
  return text;
}

}  // namespace tread

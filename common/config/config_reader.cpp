// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/config_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "common/config/config_level.hpp"
#include "common/config/scalars.hpp"

namespace tread {
namespace {

/// An unset value (NaN) has no YAML that could be read back: it is left out.
std::string numberAnswer(double value) {
  return std::isfinite(value) ? formatNumber(value) : "";
}

std::string listAnswer(const std::vector<double>& values) {
  std::vector<std::string> words;
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    return "";
  words.reserve(values.size());
  for (const double value : values) words.push_back(formatNumber(value));
  return "[" + joinWords(words) + "]";
}

std::string textOf(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    throw ConfigError(path + ": is a folder; a YAML file is needed");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw ConfigError(path + ": cannot be read (" + std::strerror(errno) + "); check the path");
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw ConfigError(path + ": reading failed (" + std::strerror(errno) + ")");
  return text.str();
}

}  // namespace

ConfigReader::ConfigReader(std::shared_ptr<Level> level) : level_(std::move(level)) {}
ConfigReader::ConfigReader(ConfigReader&&) noexcept = default;
ConfigReader& ConfigReader::operator=(ConfigReader&&) noexcept = default;
ConfigReader::~ConfigReader() = default;

ConfigReader ConfigReader::fromFile(const std::string& path,
                                    const std::vector<std::string>& overrides) {
  return fromText(textOf(path), path, overrides);
}

ConfigReader ConfigReader::fromText(const std::string& text, const std::string& name,
                                    const std::vector<std::string>& overrides) {
  return ConfigReader(Level::parse(text, name, overrides));
}

bool ConfigReader::has(const std::string& key) const {
  level_->know(key);
  return level_->find(key) != nullptr;
}

bool ConfigReader::retired(const std::string& key) {
  Level::Entry* entry = level_->find(key);
  if (entry != nullptr) entry->asked = true;
  return entry != nullptr;
}

void ConfigReader::number(const std::string& key, double& value, Range range,
                          const std::string& unit, bool required) {
  if (const auto found = level_->ask(key, required)) value = level_->number(*found, range, unit);
  level_->answer(key, numberAnswer(value));
}

void ConfigReader::seconds(const std::string& key, int64_t& value_us, Range range, bool required) {
  double value = static_cast<double>(value_us) * 1e-6;
  number(key, value, range, "s", required);
  value_us = std::llround(value * 1e6);
}

void ConfigReader::integer(const std::string& key, int64_t& value, Range range,
                           const std::string& unit, bool required) {
  if (const auto found = level_->ask(key, required)) {
    const std::string allowed = formatRange(range, unit);
    const std::string text = level_->scalar(*found, "a whole number, " + allowed, false);
    const auto parsed = parseInteger(text);
    if (!parsed)
      throw level_->errorAt(*found, " is " + formatText(text) +
                                        ", not a plain decimal whole number; allowed " + allowed);
    const auto as_number = static_cast<double>(*parsed);
    if (!(as_number >= range.min && as_number <= range.max))
      throw level_->errorAt(*found,
                            " is " + formatQuantity(as_number, unit) + "; allowed " + allowed);
    value = *parsed;
  }
  level_->answer(key, std::to_string(value));
}

void ConfigReader::flag(const std::string& key, bool& value, bool required) {
  if (const auto found = level_->ask(key, required)) {
    const std::string text = level_->scalar(*found, "true or false", false);
    if (text != "true" && text != "false")
      throw level_->errorAt(*found, " is " + formatText(text) + "; allowed true, false");
    value = text == "true";
  }
  level_->answer(key, value ? "true" : "false");
}

void ConfigReader::text(const std::string& key, std::string& value, bool required) {
  if (const auto found = level_->ask(key, required)) value = level_->scalar(*found, "text", true);
  level_->answer(key, formatText(value));
}

void ConfigReader::path(const std::string& key, std::string& value, bool required) {
  if (const auto found = level_->ask(key, required)) {
    value = level_->scalar(*found, "a path", true);
    const size_t slash = level_->source->name.rfind('/');
    if (slash != std::string::npos && value.compare(0, 1, "/") != 0 &&
        !level_->source->isOverride(found->line))
      value = level_->source->name.substr(0, slash + 1) + value;
  }
  level_->answer(key, formatText(value));
}

void ConfigReader::choice(const std::string& key, std::string& value,
                          const std::vector<std::string>& allowed, bool required) {
  if (const auto found = level_->ask(key, required)) {
    const std::string text = level_->scalar(*found, "one of " + joinWords(allowed), true);
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      const auto meant = nearestSpelling(text, allowed);
      throw level_->errorAt(*found, " is " + formatText(text) +
                                        (meant ? "; is " + *meant + " meant?" : "") + "; allowed " +
                                        joinWords(allowed));
    }
    value = text;
  }
  level_->answer(key, formatText(value));
}

void ConfigReader::numbers(const std::string& key, std::vector<double>& values, size_t size,
                           Range range, const std::string& unit, bool required) {
  if (const auto found = level_->ask(key, required))
    values = level_->numberList(*found, size, range, unit);
  level_->answer(key, listAnswer(values));
}

void ConfigReader::table(const std::string& key, std::vector<std::vector<double>>& rows,
                         size_t columns, Range range, const std::string& unit, bool required) {
  if (const auto found = level_->ask(key, required)) {
    std::vector<std::vector<double>> read;
    const std::string wanted = "a list of rows of " + std::to_string(columns) + " numbers";
    for (const Level::Found& row : level_->items(*found, wanted))
      read.push_back(level_->numberList(row, columns, range, unit));
    rows = std::move(read);
  }
  std::vector<std::string> written;
  for (const auto& row : rows) written.push_back(listAnswer(row));
  level_->answer(key, "[" + joinWords(written) + "]");
}

void ConfigReader::texts(const std::string& key, std::vector<std::string>& values, bool required) {
  if (const auto found = level_->ask(key, required)) {
    std::vector<std::string> read;
    for (const Level::Found& item : level_->items(*found, "a list of texts"))
      read.push_back(level_->scalar(item, "text", true));
    values = std::move(read);
  }
  std::vector<std::string> words;
  for (const std::string& value : values) words.push_back(formatText(value));
  level_->answer(key, "[" + joinWords(words) + "]");
}

ConfigReader ConfigReader::section(const std::string& key, bool required) {
  const auto found = level_->ask(key, required);
  auto& answer = level_->answer(key, "");
  if (answer.children.empty())
    answer.children = {Level::of(level_->source, level_->path(key) + ".",
                                 found ? found->value : YAML::Node(),
                                 found ? level_->find(key)->line : level_->line)};
  return ConfigReader(answer.children.front());
}

ConfigReader ConfigReader::file(const std::string& key, const std::string& usual_name) {
  const auto* entry = level_->find(key);
  if (entry != nullptr && entry->value.IsMap()) return section(key);
  const std::string& own = level_->source->name;
  std::string name = own.substr(0, own.rfind('/') + 1) + usual_name;
  path(key, name);
  if (entry == nullptr && !std::filesystem::exists(name))
    throw ConfigError(own + ": " + name + " is needed and not there; write it, or name another " +
                      "file with " + key + ":");
  auto& answer = level_->answer(key, "");
  if (answer.children.empty()) answer.children = {Level::parse(textOf(name), name, {})};
  return ConfigReader(answer.children.front());
}

std::vector<ConfigReader> ConfigReader::sections(const std::string& key, bool required) {
  const auto found = level_->ask(key, required);
  auto& answer = level_->answer(key, "");
  answer.is_list = true;
  if (found && answer.children.empty())
    for (const Level::Found& item : level_->items(*found, "a list of maps"))
      answer.children.push_back(Level::of(level_->source, item.name + ".", item.value, item.line));
  std::vector<ConfigReader> readers;
  for (const auto& child : answer.children) readers.push_back(ConfigReader(child));
  return readers;
}

std::vector<std::string> ConfigReader::keys() const {
  std::vector<std::string> names;
  names.reserve(level_->entries.size());
  for (const auto& entry : level_->entries) names.push_back(entry.key);
  return names;
}

void ConfigReader::finish() const {
  level_->finish();
}

std::string ConfigReader::effective() const {
  return level_->effective("");
}

ConfigError ConfigReader::error(const std::string& key, const std::string& problem) const {
  const auto* entry = level_->find(key);
  return level_->errorAt(entry != nullptr ? Level::lineOf(*entry) : level_->line,
                         level_->path(key) + ": " + problem);
}

}  // namespace tread

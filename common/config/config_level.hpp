// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

// Inner part of config_reader.cpp, which alone includes it: yaml-cpp stays out of other headers.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "common/config/config_document.hpp"
#include "common/config/config_reader.hpp"

namespace tread {

/// One map of the file with the keys that were asked for.
struct ConfigReader::Level {
  /// A key that is in the file.
  struct Entry {
    std::string key;
    int line = 0;  ///< 1-based, of the key
    YAML::Node value;
    bool asked = false;
  };
  /// A key that the program knows.
  struct Answer {
    std::string key;
    std::string value;  ///< effective value as YAML; empty = none, or held in children
    bool is_list = false;
    std::vector<std::shared_ptr<Level>> children;
  };

  /// The value of a key, or an item of its list.
  struct Found {
    YAML::Node value;
    std::string name;  ///< including its sections, for messages
    /// 1-based: its own for scalars, that of its key for lists, maps and empty values
    int line = 0;
  };

  /// Parses a whole text: one document, a map (or empty).
  static std::shared_ptr<Level> parse(std::string text, const std::string& name,
                                      const std::vector<std::string>& overrides);
  /// The level of a map node; null counts as an empty map.
  static std::shared_ptr<Level> of(std::shared_ptr<const ConfigSource> source,
                                   const std::string& prefix, const YAML::Node& map, int line);

  Entry* find(const std::string& key);
  /// The value of a key, which counts as asked for from now on; nullopt if it is absent.
  /** Throws if it is required and absent. */
  std::optional<Found> ask(const std::string& key, bool required);
  /// The items of a list; `wanted` describes what is expected, for the error message.
  std::vector<Found> items(const Found& list, const std::string& wanted) const;
  /// Sets the value that the program uses for a key; replaces an earlier one.
  Answer& answer(const std::string& key, const std::string& value);
  const Answer* answered(const std::string& key) const;
  void know(const std::string& key);

  /// Name of a key with its sections, for messages.
  std::string path(const std::string& key) const;
  ConfigError errorAt(int line, const std::string& problem) const;
  ConfigError errorAt(const Found& found, const std::string& problem) const {
    return errorAt(found.line, found.name + problem);
  }
  ConfigError missing(const std::string& key) const;
  ConfigError unknown(const Entry& entry) const;
  /// Line of a value: its own for scalars, that of its key for lists, maps and empty values.
  static int lineOf(const Entry& entry);

  /// The scalar's text; throws if it is a list, a map, empty, tagged, or quoted where that is not
  /// allowed.
  std::string scalar(const Found& found, const std::string& wanted, bool quotes_allowed) const;
  double number(const Found& found, Range range, const std::string& unit) const;
  /// `size` 0 = any.
  std::vector<double> numberList(const Found& list, size_t size, Range range,
                                 const std::string& unit) const;
  void finish() const;
  std::string effective(const std::string& indent) const;

  std::shared_ptr<const ConfigSource> source;
  std::string prefix;  ///< "gate." for the section gate; empty at the top
  int line = 1;        ///< 1-based, where the map begins
  std::vector<Entry> entries;
  std::vector<Answer> answers;

 private:
  void collect(const YAML::Node& map);
  void refuseOpenQuote(const Found& found) const;
};

/// "0.05..1 s", "at least 0 m" and the like.
std::string formatRange(Range range, const std::string& unit);
/// "9 s".
std::string formatQuantity(double value, const std::string& unit);

}  // namespace tread

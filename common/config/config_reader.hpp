// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace tread {

/// A configuration is wrong: what() is one line "file:line: what is wrong; what is allowed".
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Allowed values of a number, both ends included.
struct Range {
  double min;
  double max;
};

/// Reads one YAML map strictly into structs with defaults.
/** Every key in the file must be asked for before finish(); unknown keys, duplicates, wrong types,
 * non-finite and out-of-range numbers, a second document and syntax errors throw ConfigError with
 * file:line. An absent key leaves the default, unless it is `required`. Usage:
 *
 *      ConfigReader reader = ConfigReader::fromFile("robot.yaml");
 *      reader.number("lease", config.lease, {0.05, 1.0}, "s");
 *      ConfigReader gate = reader.section("gate");
 *      gate.number("max_gap", config.max_gap, {0.0, 1.0}, "s");
 *      reader.finish();  // checks the sections, too */
class ConfigReader {
 public:
  /** An override is "key=value" or "section.key=value", with the value as in the file. It replaces
   * the file's value and appears as "--set key=value" in messages. A relative path in it is
   * resolved against the working directory. */
  static ConfigReader fromFile(const std::string& path,
                               const std::vector<std::string>& overrides = {});
  /// `name` stands for the file in messages.
  static ConfigReader fromText(const std::string& text, const std::string& name,
                               const std::vector<std::string>& overrides = {});

  ConfigReader(ConfigReader&&) noexcept;
  ConfigReader& operator=(ConfigReader&&) noexcept;
  ~ConfigReader();

  bool has(const std::string& key) const;
  /// Whether the file has this obsolete key. It is accepted without effect and never suggested in
  /// messages.
  bool retired(const std::string& key);
  void number(const std::string& key, double& value, Range range, const std::string& unit,
              bool required = false);
  /// A time: `range` and the file use seconds, the value is in whole microseconds.
  void seconds(const std::string& key, int64_t& value_us, Range range, bool required = false);
  void integer(const std::string& key, int64_t& value, Range range, const std::string& unit,
               bool required = false);
  void flag(const std::string& key, bool& value, bool required = false);
  void text(const std::string& key, std::string& value, bool required = false);
  /// A file's path; a relative one is resolved against the folder of the file that names it.
  void path(const std::string& key, std::string& value, bool required = false);
  void choice(const std::string& key, std::string& value, const std::vector<std::string>& allowed,
              bool required = false);
  /// A list of numbers; `size` 0 = any length.
  void numbers(const std::string& key, std::vector<double>& values, size_t size, Range range,
               const std::string& unit, bool required = false);
  /// A list of lists of numbers, each of `columns` (for trajectories, commands, polygons).
  void table(const std::string& key, std::vector<std::vector<double>>& rows, size_t columns,
             Range range, const std::string& unit, bool required = false);
  void texts(const std::string& key, std::vector<std::string>& values, bool required = false);
  /// A map under this key; an empty reader if it is absent.
  ConfigReader section(const std::string& key, bool required = false);
  /// A section that may have its own file: the map under this key, or the file that the key names,
  /// else the file `usual_name` beside this one. It is part of this configuration.
  ConfigReader file(const std::string& key, const std::string& usual_name);
  /// A list of maps under this key; empty if it is absent.
  std::vector<ConfigReader> sections(const std::string& key, bool required = false);
  /// The keys of this map in file order (for maps whose keys are names).
  std::vector<std::string> keys() const;

  /// Throws for the first unused key, here or in any section, and lists the known keys.
  void finish() const;
  /// The effective configuration, defaults included, as YAML text; for CONFIG and for people.
  std::string effective() const;
  /// ConfigError that points at a key of this map, for checks across keys.
  ConfigError error(const std::string& key, const std::string& problem) const;

 private:
  struct Level;
  explicit ConfigReader(std::shared_ptr<Level> level);
  std::shared_ptr<Level> level_;
};

}  // namespace tread

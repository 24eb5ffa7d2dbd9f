// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/config_document.hpp"

#include <algorithm>
#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "common/config/config_level.hpp"
#include "common/config/scalars.hpp"

namespace tread {
namespace {

/// Records where YAML documents begin.
class DocumentStarts : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { last = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  YAML::Mark last = YAML::Mark::null_mark();
};

/// "a.b=value" as a YAML document, one line per word.
std::string documentOf(const std::string& words) {
  const size_t equals = words.find('=');
  const bool printable = std::none_of(words.begin(), words.end(),
                                      [](char c) { return c >= 0 && (c < ' ' || c == 127); });
  std::string document;
  std::string indent;
  for (size_t begin = 0; printable && equals != std::string::npos && begin <= equals;) {
    const size_t end = std::min(words.find('.', begin), equals);
    if (end == begin) break;
    document += indent + formatText(words.substr(begin, end - begin)) + ":";
    if (end == equals) return document + " " + words.substr(equals + 1) + "\n";
    document += "\n";
    indent += "  ";
    begin = end + 1;
  }
  throw ConfigError("--set " + formatText(words) + ": write key=value or section.key=value");
}

/// The value of a key; undefined if it is absent.
YAML::Node valueOf(const YAML::Node& map, const std::string& key) {
  for (const auto& pair : map)
    if (pair.first.IsScalar() && pair.first.Scalar() == key) return pair.second;
  return YAML::Node(YAML::NodeType::Undefined);
}

void merge(YAML::Node into, const YAML::Node& from) {
  for (const auto& pair : from) {
    const std::string key = pair.first.Scalar();
    YAML::Node there = valueOf(into, key);
    if (!there.IsDefined())
      into.force_insert(pair.first, pair.second);
    else if (there.IsMap() && pair.second.IsMap())
      merge(there, pair.second);
    else
      into[key] = pair.second;
  }
}

}  // namespace

// Not YAML::LoadAll: after some malformed texts it returns empty documents until memory is full.
// And YAML::Load alone ignores everything after the first document.
YAML::Node loadOneDocument(const std::string& text, const std::string& name) {
  const auto refuse = [&](const YAML::Mark& mark, const std::string& problem) {
    const std::string where = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
    throw ConfigError(name + where + ": " + problem);
  };
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentStarts starts;
    const bool any = parser.HandleNextDocument(starts);
    if (any && parser.HandleNextDocument(starts))
      refuse(starts.last,
             "a second document begins here; one is allowed, without --- or brackets "
             "between");
    return any ? YAML::Load(text) : YAML::Node();
  } catch (const YAML::Exception& e) {
    refuse(e.mark, e.msg + "; check indentation, quotes and brackets at and above this line");
  }
  return {};
}

int ConfigSource::append(const std::string& lines, const std::string& override_words) {
  if (file_lines == 0) {
    file_lines = static_cast<int>(line_starts.size());
    text += "\n";
    line_starts.push_back(text.size());
  }
  const auto first = static_cast<int>(line_starts.size());
  for (const char byte : lines) {
    text += byte;
    if (byte == '\n') line_starts.push_back(text.size());
  }
  overrides[static_cast<int>(line_starts.size()) - 1] = "--set " + override_words;
  return first;
}

std::string ConfigSource::place(int line) const {
  const auto found = isOverride(line) ? overrides.lower_bound(line) : overrides.end();
  return found == overrides.end() ? name + ":" + std::to_string(line) : found->second;
}

void applyOverride(ConfigSource& source, const std::string& words, YAML::Node& root) {
  const std::string document = documentOf(words);
  const int first = source.append(document, words);
  // Preceded by as many lines as the source has, so that the marks of both agree.
  const std::string padding(static_cast<size_t>(first) - 1, '\n');
  YAML::Node added;
  try {
    added = loadOneDocument(padding + document, source.name);
  } catch (const ConfigError&) {
    throw ConfigError("--set " + words + ": the value is no YAML; put it in quotes");
  }
  if (root.IsNull()) root = YAML::Node(YAML::NodeType::Map);
  if (root.IsMap()) merge(root, added);
}

}  // namespace tread

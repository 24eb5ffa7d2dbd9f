// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/one_document.hpp"

#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "common/config/config_reader.hpp"

namespace tread {
namespace {

/// Hears where documents begin and nothing else.
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

}  // namespace

// Not YAML::LoadAll: after some broken texts it finds empty documents until memory is full. And
// YAML::Load alone passes over what follows the first document.
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

}  // namespace tread

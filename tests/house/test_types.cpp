// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A type that is defined twice in one namespace, with different members, is undefined behaviour in
// every program that links both, and no compiler says so.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/helpers.hpp"

namespace fs = std::filesystem;

namespace {

/// The text without comments, literals and preprocessor lines.
std::string codeOf(const std::string& text) {
  static const std::regex kNoise(
      R"re(//[^\n]*|/\*[^]*?\*/|R"([a-z]*)\([^]*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')re");
  static const std::regex kDirective(R"re((^|\n)[ \t]*#(?:[^\n]*\\\n)*[^\n]*)re");
  return std::regex_replace(std::regex_replace(text, kDirective, "$1"), kNoise, " ");
}

/// Names of the types that a source defines in a named namespace, with that namespace.
std::vector<std::string> typesIn(const std::string& text) {
  static const std::regex kNamespace(R"re((?:inline\s+)?namespace(?:\s+([\w:]+))?\s*)re");
  static const std::regex kType(
      R"re((?:template\s*<[^{}]*>\s*)?(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?:\w+\s*\([^)]*\)\s*)?(\w+)(?:\s+final)?\s*(?::[^:][^]*)?)re");
  std::vector<std::string> types;
  std::vector<std::string> scopes;  // of each open brace: its namespace, "" if it is none
  std::string head;                 // what stands before a brace
  for (const char c : codeOf(text)) {
    if (c != '{' && c != '}' && c != ';') {
      if (!head.empty() || !std::isspace(static_cast<unsigned char>(c))) head += c;
      continue;
    }
    if (c == '}' && !scopes.empty()) scopes.pop_back();
    if (c == '{') {
      std::smatch match;
      std::string scope;
      for (const std::string& part : scopes) scope += part.empty() ? "{}" : part + "::";
      const bool named = scope.find("{}") == std::string::npos;
      if (std::regex_match(head, match, kNamespace)) {
        scopes.push_back(match[1]);
      } else {
        if (named && std::regex_match(head, match, kType)) types.push_back(scope + match[1].str());
        scopes.emplace_back();
      }
    }
    head.clear();
  }
  return types;
}

using tread::testing::contentOf;

}  // namespace

TEST_CASE("the search for types finds structs, classes and enums, and tells namespaces apart") {
  const std::string text = R"(
    #define OPEN {
    namespace tread { struct A { int x; };  // struct Comment {};
    namespace gap { class B final : public A { struct Inside {}; }; }
    template <typename T> struct C {}; enum class D : int { kOne };
    namespace { struct Hidden {}; }
    struct A* pointer(); const char* kText = "struct Text {"; })";
  CHECK(typesIn(text) ==
        std::vector<std::string>{"tread::A", "tread::gap::B", "tread::C", "tread::D"});
}

TEST_CASE("no type is defined twice in one namespace") {
  std::map<std::string, std::set<std::string>> places;
  for (const char* folder : {"common", "modules", "tools", "tests"})
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(TREAD_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const std::string file = fs::relative(entry.path(), TREAD_SOURCE_DIR).string();
      for (const std::string& type : typesIn(contentOf(entry.path()))) places[type].insert(file);
    }
  CHECK(places.size() > 300);  // the check itself looks at something
  for (const auto& [type, files] : places) {
    CAPTURE(type, files);
    CHECK(files.size() == 1);
  }
}

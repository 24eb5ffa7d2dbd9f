// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A type that is defined twice in one namespace, with different members, is undefined behaviour in
// every program that links both, and no compiler says so.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/sources.hpp"

namespace fs = std::filesystem;

using tread::testing::codeOf;
using tread::testing::contentOf;
using tread::testing::foldersOf;
using tread::testing::sourcesUnder;
using tread::testing::startsWith;
using tread::testing::typesIn;

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
    for (const fs::path& path : sourcesUnder(folder))
      for (const std::string& type : typesIn(contentOf(path))) places[type].insert(path);
  CHECK(places.size() > 300);  // the check itself looks at something
  for (const auto& [type, files] : places) {
    CAPTURE(type, files);
    CHECK(files.size() == 1);
  }
}

// A name has one meaning. Types in the unnamed namespace of one source do not count.
TEST_CASE("the name of a type stands once in the product, whatever its namespace") {
  constexpr size_t kMost = 0;  // falls only
  std::map<std::string, std::set<std::string>> types;
  for (const char* folder : {"common", "modules", "tools"})
    for (const fs::path& path : sourcesUnder(folder))
      for (const std::string& type : typesIn(contentOf(path)))
        types[type.substr(type.rfind(':') + 1)].insert(type);
  CHECK(types.size() > 800);
  std::vector<std::string> twice;
  for (const auto& [name, full] : types)
    if (full.size() > 1) twice.push_back(name);
  CAPTURE(twice);
  CHECK(twice.size() <= kMost);
}

TEST_CASE("a source has the header of its own name") {
  constexpr size_t kMost = 10;  // falls only
  std::vector<std::string> without;
  for (const char* folder : {"common", "modules", "tools"})
    for (fs::path path : sourcesUnder(folder)) {
      const std::string stem = path.stem();
      const bool is_main = stem == "main" || stem.find("_main") != std::string::npos;
      if (path.extension() == ".hpp" || is_main || path.filename() == "headers.cpp") continue;
      const std::string file = fs::relative(path, TREAD_SOURCE_DIR);
      // What stands in another source's place has that one's header.
      const std::string own = stem.substr(0, stem.rfind("_absent")) + ".hpp";
      if (!fs::exists(path.replace_filename(own))) without.push_back(file);
    }
  CAPTURE(without);
  CHECK(without.size() <= kMost);
}

// common/ is tread itself, but for folders that others would take for something else. Where the
// name is a keyword the namespace has another form of it.
TEST_CASE("a folder and its namespace have one name") {
  const std::set<std::string> keywords{"export: exporting", "operator: operators"};
  constexpr size_t kMost = 7;  // falls only
  const std::regex opens(R"((?:^|\n)namespace tread(?:::(\w+))?)");
  std::set<std::string> others;
  for (const char* folder : {"modules", "tools/robot", "tools/lab"})
    for (const std::string& name : foldersOf(folder)) {
      const std::vector<std::string> parts = foldersOf(std::string(folder) + "/" + name);
      for (const fs::path& path : sourcesUnder(std::string(folder) + "/" + name)) {
        const std::string text = contentOf(path);
        for (std::sregex_iterator found(text.begin(), text.end(), opens), end; found != end;
             ++found) {
          const std::string space = (*found)[1];
          const bool is_part = std::find(parts.begin(), parts.end(), space) != parts.end();
          if (space != name && !is_part && keywords.count(name + ": " + space) == 0)
            others.insert(name + ": " + space);
        }
      }
    }
  CAPTURE(others);
  CHECK(others.size() <= kMost);
}

// Each exists once: median and quantile in common/statistics, a pose with its time in
// common/geometry, a command with its time in common/pattern.
TEST_CASE("what has a place in common is not made again") {
  struct Place {
    const char* file;
    std::regex marks;
    size_t most;  // files beside it; falls only
  };
  const std::string start = R"(struct\s+\w+\s*\{\s+(?:int64_t\s+utime|double\s+time)[^;]*;)";
  const std::vector<Place> places{
      {"common/statistics/", std::regex("nth_element"), 0},
      {"common/geometry/track.hpp", std::regex(start + R"(\s+Pose2\s+\w+[^;]*;\s*\};)"), 0},
      {"common/pattern/command.hpp", std::regex(start + R"(\s+(?:Track)?Command\s+command[^;]*;)"),
       1}};
  std::map<std::string, std::set<std::string>> beside;
  for (const char* folder : {"common", "modules", "tools"})
    for (const fs::path& path : sourcesUnder(folder)) {
      const std::string file = fs::relative(path, TREAD_SOURCE_DIR);
      const std::string code = codeOf(contentOf(path));
      for (const Place& place : places)
        if (!startsWith(file, place.file) && std::regex_search(code, place.marks))
          beside[place.file].insert(file);
    }
  for (const Place& place : places) {
    CAPTURE(place.file, beside[place.file]);
    CHECK(beside[place.file].size() <= place.most);
  }
}

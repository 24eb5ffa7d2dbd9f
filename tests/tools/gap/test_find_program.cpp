// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/vehicle/model_file.hpp"
#include "tests/tools/gap/arc_drive.hpp"
#include "tests/tools/gap/gap_program.hpp"

namespace tread::gap {
namespace {

using samples::Folder;
using samples::kModels;
using samples::run;
using samples::Run;
using samples::writeDrive;

constexpr const char* kFiles[] = {"verdict.json", "model.yaml", "report.md", "report.html"};

}  // namespace

TEST_CASE("what find writes is the same to the byte with any number of threads, and once more") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 204.0, 0.40);
  const std::string find = "find --model " + kModels + "warthog_asphalt.yaml --train " +
                           folder.path("drive.lcmlog") + " --out ";
  const Run first = run(find + folder.path("first") + " --threads 1");
  INFO(first.printed);
  // With nothing found, half of the work would not be done.
  REQUIRE(first.says("held-out gain"));
  const std::pair<std::string, std::string> kOthers[] = {
      {"again", " --threads 1"}, {"two", " --threads 2"}, {"three", " --threads 3"}};
  for (const auto& [name, threads] : kOthers) {
    CHECK(run(find + folder.path(name) + threads).status == first.status);
    for (const char* file : kFiles) {
      INFO(name << "/" << file);
      const std::string expected = folder.text(std::string("first/") + file);
      CHECK_FALSE(expected.empty());
      // Not CHECK(a == b): a report of a megabyte helps nobody.
      CHECK((folder.text(name + "/" + file) == expected));
    }
  }
}

}  // namespace tread::gap

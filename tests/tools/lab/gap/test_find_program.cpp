// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/vehicle/model_document.hpp"
#include "tests/tools/lab/gap/arc_drive.hpp"
#include "tests/tools/lab/gap/gap_program.hpp"

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
  // Without a finding half of the work would be skipped.
  REQUIRE(first.says("held-out gain"));
  const std::pair<std::string, std::string> kOthers[] = {
      {"again", " --threads 1"}, {"two", " --threads 2"}, {"three", " --threads 3"}};
  for (const auto& [name, threads] : kOthers) {
    CHECK(run(find + folder.path(name) + threads).status == first.status);
    for (const char* file : kFiles) {
      INFO(name << "/" << file);
      const std::string expected = folder.text(std::string("first/") + file);
      CHECK_FALSE(expected.empty());
      // Not CHECK(a == b), which would print a report of a megabyte.
      CHECK((folder.text(name + "/" + file) == expected));
    }
  }
}

TEST_CASE("what a person accepts or rejects stands in all four files, with the name") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 204.0, 0.40);
  const std::string find =
      "find --model " + kModels + "warthog_asphalt.yaml --train " + folder.path("drive.lcmlog");
  const Run decided = run(find + " --accept yaw_pull --reject yaw_inertia --reject body_inertia" +
                          " --by 'Anna Berg' --out " + folder.path("a"));
  INFO(decided.printed);
  const auto json = nlohmann::json::parse(folder.text("a/verdict.json"));
  REQUIRE(json["decisions"].size() == 3);
  CHECK(json["decisions"][0] ==
        nlohmann::json{{"effect", "yaw_pull"}, {"decision", "accepted"}, {"by", "Anna Berg"}});
  CHECK(json["decisions"][2]["decision"] == "rejected");
  CHECK(json["effects"][0]["name"] == "yaw_pull");
  CHECK(json["effects"][0]["accepted"] == true);
  for (const char* report : {"a/report.md", "a/report.html"}) {
    CHECK(folder.text(report).find("; it was not considered (Anna Berg)") != std::string::npos);
  }
  const ModelDocument model = readModelDocument(folder.path("a/model.yaml"));
  CHECK(model.vehicle.effects.yaw_pull != 0.0);
  REQUIRE(model.provenance.decisions.size() == 3);
  CHECK(model.provenance.decisions[1].effect == "yaw_inertia");
  CHECK_FALSE(model.provenance.decisions[1].accepted);
  CHECK(model.provenance.decisions[1].by == "Anna Berg");
  SECTION("the record goes on from model to model, and decides nothing by itself") {
    const Run next =
        run("find --model " + folder.path("a/model.yaml") + " --train " +
            folder.path("drive.lcmlog") + " --accept body_inertia --out " + folder.path("b"));
    INFO(next.printed);
    const std::vector<EffectDecision> record =
        readModelDocument(folder.path("b/model.yaml")).provenance.decisions;
    REQUIRE(record.size() == 3);
    CHECK(record[0].effect == "body_inertia");
    CHECK(record[0].accepted);
    CHECK(record[1].effect == "yaw_pull");
    CHECK(nlohmann::json::parse(folder.text("b/verdict.json"))["decisions"].size() == 1);
  }
}

TEST_CASE("a decision that makes no sense ends with 2 and one line, before a log is read") {
  const Folder folder;
  folder.write("on.yaml",
               "name: a\nkind: track_speed\ngauge: 1\neffects:\n  slip_ratio:\n    slip: 0.1\n");
  const std::string find = "find --train none.lcmlog --out " + folder.path("out") + " --model ";
  const std::string asphalt = kModels + "warthog_asphalt.yaml";
  const std::pair<std::string, std::string> kBad[] = {
      {asphalt + " --accept yaw_pul", "did you mean yaw_pull?"},
      {asphalt + " --reject grip", "'grip' is no effect of the catalogue"},
      {asphalt + " --accept yaw_pull --reject yaw_pull", "yaw_pull is both accepted and rejected"},
      {asphalt + " --accept yaw_pull yaw_pull", "yaw_pull is named twice"},
      {folder.path("on.yaml") + " --reject slip_ratio", "the model has this effect"},
      {asphalt + " --by Anna", "no decision is given"}};
  for (const auto& [arguments, words] : kBad) {
    const Run bad = run(find + arguments);
    INFO(arguments << "\n" << bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("find with a time limit ends when that is over, and says so") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 204.0, 0.40);
  const std::string find = "find --model " + kModels + "warthog_asphalt.yaml --train " +
                           folder.path("drive.lcmlog") + " --out " + folder.path("out");
  const Run over = run(find + " --limit 0.001");
  INFO(over.printed);
  CHECK(over.status == 15);
  CHECK(over.says("The search had no time left (--limit)"));
  CHECK(nlohmann::json::parse(folder.text("out/verdict.json"))["cut_short"] == true);
  CHECK(run(find + " --limit 0").says("--limit"));
  run(find + " --force --limit 1000");
  CHECK(nlohmann::json::parse(folder.text("out/verdict.json"))["cut_short"] == false);
}

}  // namespace tread::gap

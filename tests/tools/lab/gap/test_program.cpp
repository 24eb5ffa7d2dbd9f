// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/store/store.hpp"
#include "common/vehicle/effects.hpp"
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

}  // namespace

TEST_CASE("every effect of the catalogue is explained, with a check of two minutes") {
  const Run list = run("explain");
  CHECK(list.status == 0);
  for (const Effect& effect : effectCatalogue()) {
    INFO(effect.name);
    CHECK(list.says("  " + effect.name + " "));
    const Run one = run("explain " + effect.name);
    CHECK(one.status == 0);
    for (const char* heading : {"what it is", "equation", "parameters", "changes", "looks like",
                                "tell it apart", "in two minutes"})
      CHECK(one.says(heading));
    CHECK(one.says(effect.title));
  }
  CHECK(run("explain icr_offset").says("lever_arm_x"));
}

TEST_CASE("explain says how to begin, what to do after each verdict, and what words mean") {
  const Run list = run("explain");
  for (const char* topic : {"start", "verdicts", "words"})
    CHECK(list.says(std::string("\n  ") + topic + " "));
  CHECK(run("explain start").says("tread-import --format steps --keep-lag --gyro all"));
  const Run verdicts = run("explain verdicts");
  for (const char* verdict :
       {"0 NO_DISCREPANCY", "0 NOTHING_NEW", "10 FOUND", "11 AMBIGUOUS", "12 PARTIAL",
        "13 NOT_IN_CATALOGUE", "14 MEASUREMENT", "15 CANNOT_TELL"})
    CHECK(verdicts.says(verdict));
  for (const char* word : {"block ", "nats ", "adequacy ", "held-out ", "floor ", "group "})
    CHECK(run("explain words").says(word));
}

TEST_CASE("bad input ends with 2 and one line that says what and where") {
  const Folder folder;
  folder.write(
      "typo.yaml",
      "name: a\nkind: power\nfull_speed: 1\ngauge: 0.6\neffects:\n  slip_ratoi:\n    slip: 0.1\n");
  folder.write("power.yaml", "name: a\nkind: power\nfull_speed: 1\ngauge: 0.6\n");
  folder.write("no.lcmlog", "this is no log\n");
  writeDrive(folder.path("speeds.lcmlog"), 10.0);
  const std::string grass = "--model " + kModels + "teodor_grass.yaml ";
  const std::string out = " --out " + folder.path("out");
  const std::pair<std::string, std::string> kBad[] = {
      {"", "a command is missing; one of find, explain"},
      {"fnd", "'fnd' is no command; did you mean find?"},
      {"find --train a.lcmlog" + out, "tread-gap find: --model is required"},
      {"find " + grass + "--train a.lcmlog --modle b" + out, "did you mean --model?"},
      {"explain slip_ratoi", "did you mean slip_ratio?"},
      {"find --model none.yaml --train x.lcmlog" + out, "none.yaml: cannot be read"},
      {"find --model " + folder.path("typo.yaml") + " --train x.lcmlog" + out, "typo.yaml:6"},
      {"find " + grass + "--train none.lcmlog" + out, "none.lcmlog"},
      {"find " + grass + "--train " + folder.path("no.lcmlog") + out, "no.lcmlog"},
      {"find " + grass + "--train " + folder.path("speeds.lcmlog") + out,
       "its commands are track speeds"},
      {"what-if " + grass, "nothing to change"},
      {"what-if " + grass + "--remove slip_ratio", "it is off in this model"},
      {"what-if " + grass + "--add slip_ratio --set slip=3", "not plausible"},
      {"what-if " + grass + "--add slip_ratio --set slop=0.3", "not a parameter of slip_ratio"},
      {"what-if " + grass + "--add icr_offset",
       "it is already on in this model; another size: --set icr_offset.offset=NUMBER"},
      {"what-if " + grass + "--add slip", "did you mean "},
      {"what-if " + grass + "--add slip", "slip_ratio"},
      {"plan slip_ratio slip_ratio " + grass, "name two effects"},
      {"plan slip_ratio grip " + grass, "'grip' is no effect"}};
  for (const auto& [arguments, words] : kBad) {
    const Run bad = run(arguments);
    INFO(arguments << "\n" << bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("a folder that cannot be written is told before anything is read") {
  const Folder folder;
  folder.write("file", "");
  std::filesystem::create_directories(folder.path("taken/model.yaml"));
  const std::string find = "find --model none.yaml --train none.lcmlog --out ";
  const std::pair<std::string, std::string> kBad[] = {
      {"file", "is no folder"}, {"file/out", "is no folder"}, {"taken", "is not empty"}};
  for (const auto& [out, words] : kBad) {
    const Run bad = run(find + folder.path(out));
    INFO(bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(folder.path(out) + ": "));
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
  CHECK(run(find + "''").says("its name is empty"));
}

TEST_CASE("a log that is too short cannot tell: status 15, the reason, and no model") {
  const Folder folder;
  writeDrive(folder.path("short.lcmlog"), 40.0);
  const std::string find = "find --model " + kModels + "warthog_nominal.yaml --train " +
                           folder.path("short.lcmlog") + " --seed 3";
  const Run first = run(find + " --threads 1 --out " + folder.path("a"));
  INFO(first.printed);
  CHECK(first.status == 15);
  CHECK(first.says("CANNOT_TELL"));
  const auto json = nlohmann::json::parse(folder.text("a/verdict.json"));
  CHECK(json["verdict"] == "CANNOT_TELL");
  CHECK_FALSE(json["reason"].get<std::string>().empty());
  CHECK(json["seed"] == 3);
  CHECK(json["inputs"]["train"][0]["sha256"].get<std::string>().size() == 64);
  CHECK_FALSE(std::filesystem::exists(folder.path("a/model.yaml")));
  CHECK(first.says("No model was written.\n"));
  CHECK(first.says("Report: " + folder.path("a/report.html")));
  SECTION("a model of an earlier run stays as it is, and is said to be one") {
    folder.write("a/model.yaml", "earlier");
    CHECK(run(find + " --force --out " + folder.path("a"))
              .says("a/model.yaml is left from an earlier run"));
    CHECK(folder.text("a/model.yaml") == "earlier");
  }
  SECTION("the same files and seed give the same bytes, whatever the number of threads") {
    CHECK(run(find + " --threads 2 --out " + folder.path("b")).status == 15);
    for (const char* file : {"verdict.json", "report.md", "report.html"}) {
      CHECK_FALSE(folder.text(std::string("a/") + file).empty());
      CHECK(folder.text(std::string("a/") + file) == folder.text(std::string("b/") + file));
    }
  }
}

namespace {

/// A model with a term, as find writes it.
ModelDocument withTerm() {
  ModelDocument model = readModelDocument(kModels + "warthog_asphalt.yaml");
  UnnamedTerm term;
  term.name = "unnamed_1";
  term.condition = findTermCondition("change of |yaw rate|");
  term.at = {-1.0, 0.0, 1.0};
  term.values = {-0.1, 0.0, 0.02};
  model.vehicle.unnamed = {term};
  return model;
}

}  // namespace

TEST_CASE("a term becomes an effect of a catalogue of one's own") {
  const Folder folder;
  const std::string model = folder.path("model.yaml");
  const std::string file = folder.path("steering_hysteresis.yaml");
  writeText(model, formatModelDocument(withTerm()));
  const std::string name = "name " + model + " unnamed_1 steering_hysteresis --effect " + file;
  const Run kept = run(name);
  INFO(kept.printed);
  CHECK(kept.status == 0);
  CHECK(run("explain steering_hysteresis").status == 2);
  // The model contains the effect; the folder is for other models.
  const Run what_if = run("what-if --model " + model + " --remove steering_hysteresis");
  INFO(what_if.printed);
  CHECK(what_if.status == 0);
  CHECK(what_if.says("What if: without steering hysteresis?"));
  std::filesystem::create_directories(folder.path("own"));
  std::filesystem::rename(file, folder.path("own/steering_hysteresis.yaml"));
  const Run explained = run("explain steering_hysteresis --effects " + folder.path("own"));
  INFO(explained.printed);
  CHECK(explained.status == 0);
  CHECK(explained.says("yaw_rate + share * moving * curve(smooth_sign(yaw_rate)"));
  const Run added = run("what-if --model " + kModels + "teodor_grass.yaml --effects " +
                        folder.path("own") + " --add steering_hysteresis");
  INFO(added.printed);
  CHECK(added.status == 0);
  // Nothing is overwritten, and a refused name leaves no file.
  writeText(model, formatModelDocument(withTerm()));
  writeText(file, "mine");
  CHECK(run(name).says("is there already; choose another file"));
  CHECK(folder.text("steering_hysteresis.yaml") == "mine");
  CHECK(run("name " + model + " unnamed_1 yaw_pull --effect " + folder.path("x.yaml")).status == 2);
  CHECK_FALSE(std::filesystem::exists(folder.path("x.yaml")));
}

TEST_CASE("effects that are none end the program with one line that names file and entry") {
  const Folder folder;
  std::filesystem::create_directories(folder.path("own"));
  writeText(folder.path("own/bad.yaml"),
            "name: bad\ntitle: T\nsentence: S\nchannels: x\nchanges: v\nto: v + p * spede\n"
            "parameters: [{name: p, unit: '1', min: 0, max: 1, typical: 0.1}]\n"
            "looks_like: L\nseparates: S\ncheck: C\n");
  for (const char* command : {"explain", "find --model M --train L --out O"}) {
    const Run refused = run(std::string(command) + " --effects " + folder.path("own"));
    INFO(refused.printed);
    CHECK(refused.status == 2);
    CHECK(refused.says("bad.yaml:6: to: 'v + p * spede' is no formula: 'spede' is unknown"));
  }
  CHECK(run("explain --effects " + folder.path("nowhere")).says("is no folder with effects"));
}

TEST_CASE("a term that find has added gets the name that a person gives it") {
  const Folder folder;
  const ModelDocument model = withTerm();
  writeText(folder.path("model.yaml"), formatModelDocument(model));
  const Run named = run("name " + folder.path("model.yaml") + " unnamed_1 steering_hysteresis");
  INFO(named.printed);
  CHECK(named.status == 0);
  const ModelDocument now = readModelDocument(folder.path("model.yaml"));
  REQUIRE(now.vehicle.unnamed.size() == 1);
  CHECK(now.vehicle.unnamed[0].name == "steering_hysteresis");
  CHECK(now.vehicle.unnamed[0].values == model.vehicle.unnamed[0].values);
  const Run what_if = run("what-if --model " + folder.path("model.yaml") +
                          " --remove steering_hysteresis --out " + folder.path("what_if.html"));
  INFO(what_if.printed);
  CHECK(what_if.status == 0);
  const std::string before = folder.text("model.yaml");
  for (const char* wrong : {"unnamed_1 other", "steering_hysteresis yaw_pull",
                            "steering_hysteresis 'No Name'", "steering_hysteresis lag"}) {
    const Run refused = run("name " + folder.path("model.yaml") + " " + wrong);
    INFO(refused.printed);
    CHECK(refused.status == 2);
    CHECK((folder.text("model.yaml") == before));
  }
}

}  // namespace tread::gap

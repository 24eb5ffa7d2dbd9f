// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The effects of config/effects from the generator to the verdict, with the command-line
// programs.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace fs = std::filesystem;

namespace {

class AddedFolder {
 public:
  AddedFolder() { fs::create_directories(path); }
  ~AddedFolder() { fs::remove_all(path); }
  const std::string path =
      (fs::temp_directory_path() / ("tread-added-" + std::to_string(getpid()))).string();
};

int called(const std::string& program) {
  const std::string command = std::string(TREAD_BIN_DIR) + "/" + program + " > /dev/null";
  return std::system(command.c_str());
}

nlohmann::json jsonOf(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

/// Answer of find for a log with a hidden effect, and the truth.
struct AddedCase {
  nlohmann::json verdict;
  nlohmann::json truth;
  std::string model;
};

AddedCase findHidden(const std::string& folder, const std::string& effect,
                     const std::string& how = "") {
  const std::string out = folder + "/" + effect;
  const std::string source = TREAD_SOURCE_DIR;
  REQUIRE(called("tread-hide --effect " + effect + how +
                 " --size 4 --seed 2 --minutes 6 --name one --out " + out) == 0);
  called("tread-gap find --model " + source + "/tests/data/blind/nominal_mid.yaml --train " + out +
         "/blind/one.lcm --effects " + source + "/config/effects --out " + out + "/gap");
  return {jsonOf(out + "/gap/verdict.json"), jsonOf(out + "/truth/one.json"),
          out + "/gap/model.yaml"};
}

}  // namespace

TEST_CASE("effects of files that are hidden in the ground truth are found and named") {
  const AddedFolder folder;
  for (const char* effect : {"motor_limit", "yaw_windup", "centre_to_side"}) {
    INFO(effect);
    const AddedCase one = findHidden(folder.path, effect);
    INFO(one.verdict.dump());
    bool named = false;
    for (const auto& found : one.verdict["effects"]) {
      const std::string name = found["name"];
      const auto group = found["group"].get<std::vector<std::string>>();
      if (name != effect && std::find(group.begin(), group.end(), effect) == group.end()) continue;
      named = true;
      const auto& truth = one.truth["effects"][0]["equivalent"][0];
      const std::string parameter = truth["name"];
      REQUIRE(found["parameters"].contains(parameter));
      CHECK(found["parameters"][parameter]["value"].get<double>() ==
            Approx(truth["value"].get<double>()).epsilon(0.2));
    }
    CHECK(named);
    // The model also works without the effect's file.
    CHECK(called("tread-gap what-if --add slip_ratio --model " + one.model) == 0);
  }
}

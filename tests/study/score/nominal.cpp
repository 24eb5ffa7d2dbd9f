// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <set>
#include <stdexcept>

#include "common/report/page.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/study/score/child.hpp"
#include "tests/study/score/study.hpp"
#include "tests/study/score/suites.hpp"

namespace fs = std::filesystem;

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRounds = 4;
constexpr int kLimit = 3600;  // [s] for a calibration that does not end
constexpr int kFound = 10;
constexpr int kCannotTell = 15;
constexpr const char* kStory = "story.json";

/// Held by one process at a time.
class Lock {
 public:
  explicit Lock(const std::string& path)
      : descriptor_(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) != 0)
      throw std::runtime_error(path + ": cannot be locked");
  }
  ~Lock() { close(descriptor_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int descriptor_;
};

/// These seeds occur in no suite: they are drawn from the suite's seed.
uint64_t hourSeed(const Study& study, const std::string& noise, int round) {
  return 100 * study.seed + 10 * static_cast<uint64_t>(round) +
         (noise == "low"   ? 1
          : noise == "mid" ? 2
                           : 3);
}

Json readJson(const fs::path& path) {
  std::ifstream file(path);
  return Json::parse(file);
}

/// A log of the plain vehicle, and the start model of its calibration.
struct Plain {
  std::string log;
  std::string model;
};

/// One round of calibration; returns its verdict.
Json calibrate(const Study& study, const fs::path& folder, const Plain& plain,
               const std::string& model, int round) {
  const std::string out = "round" + std::to_string(round);
  const Ended ended =
      run({{study.programs + "/tread-gap", "find", "--force", "--calibrate", "--keep-small",
            "--threads", "1", "--model", model, "--train", plain.log, "--out", out},
           folder.string(),
           out + ".log",
           kLimit});
  if (ended.status != 0 && (ended.status < kFound || ended.status >= kCannotTell))
    throw std::runtime_error("calibration ended with " + std::to_string(ended.status) + ": " +
                             lastLine((folder / (out + ".log")).string()));
  return readJson(folder / out / "verdict.json");
}

/// An hour of the plain vehicle with the noise of a level; a different one in each round.
Plain hideHour(const Study& study, const fs::path& folder, const std::string& noise, int round) {
  fs::remove_all(folder / "hour");
  std::ofstream(folder / "base.yaml") << kBaseModel;
  runOrThrow({{study.programs + "/tread-hide", "--null", "--minutes", std::to_string(study.hour),
               "--noise", noise, "--seed", std::to_string(hourSeed(study, noise, round)), "--name",
               "hour", "--out", "hour"},
              folder.string(),
              "hide.log"});
  return {"hour/blind/hour.lcm", "base.yaml"};
}

void make(const Study& study, const fs::path& folder, const std::string& name) {
  const auto recording = recordingNamed(study, name);
  std::string model;
  Json verdict;
  int round = 0;
  bool may_change = true;
  do {
    ++round;
    const Plain plain =
        recording ? Plain{recording->log, recording->model} : hideHour(study, folder, name, round);
    verdict = calibrate(study, folder, plain, model.empty() ? plain.model : model, round);
    model = "round" + std::to_string(round) + "/model.yaml";
    // The same log gives the same result for an unchanged model; another hour may not.
    may_change = !recording || !verdict.at("effects").empty();
  } while (!verdict.at("unexplained").empty() && may_change && round < kRounds);
  Json story = {{"rounds", round}, {"verdict", verdict.at("verdict")}, {"named", Json::array()}};
  for (const Json& effect : verdict.at("effects")) story["named"].push_back(effect.at("name"));
  story["unexplained"] = verdict.at("unexplained");
  std::ofstream(folder / kStory) << story.dump(2) << "\n";
  std::cout << "nominal model " << name << " after " << round << " round(s): "
            << (verdict.at("unexplained").empty()
                    ? "the adequacy test passes"
                    : "the adequacy test does not pass: " + verdict.at("unexplained").dump())
            << std::endl;
  fs::copy_file(folder / model, folder / "model.part", fs::copy_options::overwrite_existing);
  fs::remove_all(folder / "hour");
  fs::rename(folder / "model.part", folder / "model.yaml");
}

/// The model with wrong numbers, as if taken from a data sheet.
/** All active terms, gains and lags are wrong by a third or more; limits are set where the drive
 * does not reach them; no uncertainties are given. */
ModelDocument withWrongNumbers(ModelDocument model, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  VehicleModel& vehicle = model.vehicle;
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters) {
      if (parameter.role != ParameterRole::kStrength) continue;
      double& value = valueOf(model, parameter);
      value = std::clamp(value * between(0.7, 1.4), parameter.min, parameter.max);
    }
  vehicle.lag *= between(0.5, 2.0);
  vehicle.delay += between(0.0, 0.1);
  vehicle.forward_gain *= between(0.85, 1.15);
  vehicle.yaw_gain *= between(0.85, 1.15);
  const double turn = 2.0 * vehicle.full_speed / vehicle.gauge * vehicle.yaw_gain;
  *findParameter(model, "speed_saturation.inverse_limit") =
      1.0 / (between(1.05, 1.5) * vehicle.full_speed);
  *findParameter(model, "turn_power_limit.inverse_limit") = 1.0 / (between(1.05, 1.5) * turn);
  model.covariance = {};
  return model;
}

}  // namespace

std::string nominalModel(const Study& study, const std::string& name) {
  if (startsWrong(name)) {
    const size_t mark = name.find('~');
    const std::string right = nominalModel(study, name.substr(0, mark));
    const fs::path path = fs::absolute(study.out) / "nominal" / (name + ".yaml");
    fs::create_directories(path.parent_path());
    std::ofstream(path) << formatModelDocument(withWrongNumbers(
        readModelDocument(right), 1000 * study.seed + std::stoull(name.substr(mark + 1))));
    return path.string();
  }
  if (!study.nominal.empty() && !recordingNamed(study, name))
    return fs::absolute(study.nominal).string();
  const fs::path folder = fs::absolute(study.out) / "nominal" / name;
  fs::create_directories(folder);
  const Lock lock((folder / "lock").string());
  if (!fs::exists(folder / "model.yaml")) make(study, folder, name);
  return (folder / "model.yaml").string();
}

Json nominalStory(const Study& study, const std::vector<HiddenCase>& cases) {
  std::set<std::string> names;
  for (const HiddenCase& one : cases) names.insert(one.nominal.substr(0, one.nominal.find('~')));
  Json all = Json::object();
  for (const std::string& name : names) {
    const std::string model = nominalModel(study, name);
    Json story = {{"sha256", sha256(readText(model))}};
    const fs::path told = fs::path(model).parent_path() / kStory;
    if (study.nominal.empty() || recordingNamed(study, name)) {
      const Json told_story = readJson(told);
      for (const auto& [key, value] : told_story.items()) story[key] = value;
    }
    all[name] = story;
  }
  return all;
}

}  // namespace tread::blindtest

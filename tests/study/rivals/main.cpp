// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/study/rivals/rivals.hpp"

namespace {

using namespace tread;
using Json = nlohmann::ordered_json;

constexpr int kFound = 10;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// In tread-gap's format, so that the same program scores it.
Json verdictOf(const rivals::Answer& answer) {
  Json effects = Json::array();
  std::map<std::string, size_t> places;
  for (const gap::ParameterEstimate& one : answer.parameters) {
    const size_t dot = one.parameter.find('.');
    const std::string effect = one.parameter.substr(0, dot);
    if (places.try_emplace(effect, effects.size()).second)
      effects.push_back({{"name", effect},
                         {"parameters", Json::object()},
                         {"group", Json::array()},
                         {"runner_up", Json::array()}});
    effects[places.at(effect)]["parameters"][one.parameter.substr(dot + 1)] = {
        {"value", number(one.value)}, {"low", number(one.low)}, {"high", number(one.high)}};
  }
  return {{"verdict", effects.empty() ? "NO_DISCREPANCY" : "FOUND"},
          {"reason", ""},
          {"effects", effects},
          {"calibrated", Json::object()},
          {"gap", {{"before", nullptr}, {"after", nullptr}}},
          {"unexplained", Json::array()}};
}

int run(int argc, char** argv) {
  std::string method, model_file, log, out;
  bool calibrate = false;
  CLI::App app{"Runs a rival method; its answer has the format of tread-gap's verdict.json.",
               "tread-rival"};
  app.add_option("method", method, "all: least squares over all parameters; sparse: as SINDy")
      ->required()
      ->check(CLI::IsMember({"all", "sparse"}));
  app.add_option("--model", model_file, "model file (YAML)")->required();
  app.add_option("--train", log, "log to learn from")->required();
  app.add_option("--out", out, "folder for verdict.json")->required();
  app.add_flag("--calibrate", calibrate, "also fit lag, delay and gains of the nominal model");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  const ModelDocument model = readModelDocument(model_file);
  const std::vector<gap::Drive> drives{gap::readDriveFor(model, log)};
  const gap::Observations data(drives, {});
  const gap::Fitter fitter(data);
  const rivals::Answer answer = method == "all"
                                    ? rivals::allParameters(fitter, model, calibrate)
                                    : rivals::sparseRegression(fitter, model, calibrate);
  std::filesystem::create_directories(out);
  std::ofstream(out + "/verdict.json") << verdictOf(answer).dump(2) << "\n";
  return answer.parameters.empty() ? 0 : kFound;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "tread-rival: %s\n", tread::wordsOf(problem).c_str());
    return 2;
  }
}

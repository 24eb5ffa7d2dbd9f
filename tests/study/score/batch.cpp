// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/batch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "common/vehicle/model_file.hpp"
#include "tests/study/score/child.hpp"

namespace fs = std::filesystem;

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFindLimit = 900;  // [s] a hundred times the usual
constexpr int kBadInput = 2;     // exit status of tread-gap after its one line

std::string foundFile(const HiddenCase& one, const std::string& name) {
  return "found/" + one.name + "/" + name;
}

Json sigmaOf(const ParameterCovariance& covariance, const std::string& path) {
  for (size_t i = 0; i < covariance.parameters.size(); ++i)
    if (covariance.parameters[i] == path) return std::sqrt(covariance.matrix[i][i]);
  return nullptr;
}

/// The nominal value of each parameter in a verdict, with its standard deviation if the model file
/// has one (else null): {path: {value, sigma}}.
Json nominalNumbers(const std::string& model, const Json& verdict) {
  Json numbers = Json::object();
  if (verdict.is_null()) return numbers;
  const ModelDocument document = readModelDocument(model);
  const auto add = [&](const std::string& path) {
    if (const double* value = findParameter(document, path))
      numbers[path] = {{"value", *value}, {"sigma", sigmaOf(document.covariance, path)}};
  };
  for (const auto& [path, estimate] : verdict.at("calibrated").items()) add(path);
  for (const Json& effect : verdict.at("effects"))
    for (const auto& [name, estimate] : effect.at("parameters").items())
      add(effect.at("name").get<std::string>() + "." + name);
  return numbers;
}

/// Runs a batch step by step.
class Runner {
 public:
  Runner(const Study& study, const Batch& batch, const std::map<std::string, std::string>& models)
      : study_(study), batch_(batch), models_(models), folder_(batch.folder) {}

  void run() {
    clear();
    hide();
    findAll();
    writeRecords();
    if (!study_.keep) tidy();
  }

 private:
  std::string program(const char* name) const { return study_.programs + "/" + name; }

  /// Files of an interrupted run.
  void clear() const {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "found");
  }

  void hide() const {
    const std::string log = "hide.log";
    const auto of_suite = [](const HiddenCase& one) { return one.arguments.empty(); };
    if (std::any_of(batch_.cases.begin(), batch_.cases.end(), of_suite)) {
      const std::string shard =
          std::to_string(batch_.first + 1) + "/" + std::to_string(batch_.stride);
      runOrThrow({{program("tread-hide"), "--suite", study_.suite, "--minutes",
                   std::to_string(study_.minutes), "--seed", std::to_string(study_.seed), "--shard",
                   shard, "--out", "."},
                  batch_.folder,
                  log});
    }
    for (const HiddenCase& one : batch_.cases) {
      if (of_suite(one)) continue;
      std::vector<std::string> command{program("tread-hide")};
      command.insert(command.end(), one.arguments.begin(), one.arguments.end());
      command.insert(command.end(), {"--out", "."});
      runOrThrow({command, batch_.folder, log});
    }
  }

  void findAll() {
    std::vector<std::thread> workers;
    for (size_t i = 0; i < std::min(study_.jobs, batch_.cases.size()); ++i)
      workers.emplace_back([this] { work(); });
    for (std::thread& worker : workers) worker.join();
    if (problem_) std::rethrow_exception(problem_);
  }

  void work() {
    try {
      for (size_t i; !stop_ && (i = next_++) < batch_.cases.size();) find(batch_.cases[i]);
    } catch (...) {
      const std::lock_guard<std::mutex> guard(mutex_);
      if (!problem_) problem_ = std::current_exception();
      stop_ = true;
    }
  }

  void find(const HiddenCase& one) {
    fs::create_directories(folder_ / "found" / one.name);
    std::vector<std::string> command{program("tread-gap"), "find", "--force", "--threads", "1"};
    if (!study_.rival.empty()) command = {program("tread-rival"), study_.rival};
    command.insert(command.end(), {"--model", models_.at(one.nominal), "--train",
                                   "blind/" + one.name + ".lcm", "--out", "found/" + one.name});
    if (startsWrong(one.nominal)) command.push_back("--calibrate");
    const Ended ended =
        blindtest::run({command, batch_.folder, foundFile(one, "log.txt"), kFindLimit});
    const std::lock_guard<std::mutex> guard(mutex_);
    ended_[one.name] = ended;
  }

  bool hasVerdict(const HiddenCase& one) const {
    return fs::exists(folder_ / foundFile(one, "verdict.json"));
  }

  static Json readJson(const fs::path& path) {
    std::ifstream file(path);
    return Json::parse(file);
  }

  Json recordOf(const HiddenCase& one) const {
    Json record = {{"case", one.name}};
    record["truth"] = readJson(folder_ / "truth" / (one.name + ".json"));
    if (startsWrong(one.nominal)) record["truth"]["kind"] = "wrong_start";
    Json answer = {{"exit", ended_.at(one.name).status}, {"message", ""}, {"verdict", nullptr}};
    if (hasVerdict(one))
      answer["verdict"] = readJson(folder_ / foundFile(one, "verdict.json"));
    else if (ended_.at(one.name).status == kBadInput)
      answer["message"] = lastLine((folder_ / foundFile(one, "log.txt")).string());
    record["nominal"] = nominalNumbers(models_.at(one.nominal), answer["verdict"]);
    record["answer"] = std::move(answer);
    return record;
  }

  void writeRecords() const {
    const fs::path part = folder_ / "cases.part";
    std::ofstream times(folder_ / "times.csv");
    times << "case,cpu_s\n";
    {
      std::ofstream lines(part, std::ios::binary);
      for (const HiddenCase& one : batch_.cases) {
        lines << recordOf(one).dump() << "\n";
        times << one.name << "," << ended_.at(one.name).cpu_seconds << "\n";
      }
      lines << std::flush;
      if (!lines) throw std::runtime_error(part.string() + ": cannot be written");
    }
    fs::rename(part, folder_ / kBatchRecords);
  }

  /// The command can generate the logs again; verdicts and models are kept.
  void tidy() const {
    for (const HiddenCase& one : batch_.cases) {
      fs::remove(folder_ / "blind" / (one.name + ".lcm"));
      fs::remove(folder_ / foundFile(one, "report.html"));
    }
  }

  const Study& study_;
  const Batch& batch_;
  const std::map<std::string, std::string>& models_;
  const fs::path folder_;
  std::atomic<size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr problem_;
  std::map<std::string, Ended> ended_;
};

}  // namespace

void runBatch(const Study& study, const Batch& batch,
              const std::map<std::string, std::string>& models) {
  Runner(study, batch, models).run();
}

}  // namespace tread::blindtest

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/find_output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "common/recordings/text_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/gap/report/sections.hpp"

namespace fs = std::filesystem;

namespace tread::gap {
namespace {

/// Both halves of a covariance equal to the bit: rounding has made them differ, a file must not.
void makeSymmetric(std::vector<std::vector<double>>& matrix) {
  for (size_t i = 0; i < matrix.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      matrix[i][j] = matrix[j][i] = 0.5 * (matrix[i][j] + matrix[j][i]);
}

[[noreturn]] void refuse(const std::string& folder, const std::string& why) {
  throw std::runtime_error(folder + ": cannot be made or written (" + why +
                           "); give another folder with --out");
}

}  // namespace

ModelDocument newModel(const Finding& finding, const std::vector<InputFile>& inputs) {
  ModelDocument model = finding.after;
  makeSymmetric(model.covariance.matrix);
  const Provenance& old = finding.before.provenance;
  Provenance provenance;
  provenance.tool = toolVersion();
  provenance.seed = static_cast<int64_t>(finding.seed);
  provenance.runs = 1;
  for (const InputFile& input : inputs) {
    if (input.role != InputFile::Role::kTrain) continue;
    provenance.logs.push_back({input.name, input.sha256});
    if (std::any_of(old.logs.begin(), old.logs.end(),
                    [&](const SourceLog& log) { return log.sha256 == input.sha256; }))
      provenance.runs = old.runs + 1;
  }
  provenance.decisions = finding.decisions;
  for (const Decision& earlier : old.decisions)
    if (std::none_of(finding.decisions.begin(), finding.decisions.end(),
                     [&](const Decision& now) { return now.effect == earlier.effect; }))
      provenance.decisions.push_back(earlier);
  model.provenance = provenance;
  return model;
}

bool hasNewModel(const Finding& finding) {
  return finding.verdict != Verdict::kCannotTell;
}

void tryFolder(const std::string& folder) {
  if (folder.empty()) refuse("--out", "its name is empty");
  fs::path there = fs::absolute(folder);
  std::error_code failure;
  while (!fs::exists(there, failure) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, failure)) refuse(folder, there.string() + " is no folder");
  // Permissions alone do not tell: a file system may be full or read-only.
  std::string trial = (there / "tread-gap-XXXXXX").string();
  const int file = mkstemp(trial.data());
  if (file < 0) refuse(folder, std::strerror(errno));
  close(file);
  unlink(trial.c_str());
  for (const char* name : {"model.yaml", "report.md", "report.html", "verdict.json"})
    if (fs::is_directory(fs::path(folder) / name, failure))
      refuse(folder, std::string(name) + " in it is a folder");
}

void makeFolder(const std::string& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) refuse(folder, failure.message());
  if (access(folder.c_str(), W_OK) != 0) refuse(folder, std::strerror(errno));
}

void writeFinding(const std::string& folder, const Finding& finding,
                  const std::vector<InputFile>& inputs) {
  makeFolder(folder);
  const Page page = reportPage(finding, inputs);
  if (hasNewModel(finding)) {
    const std::string model = formatModelDocument(newModel(finding, inputs));
    parseModelDocument(model, folder + "/model.yaml");  // a file that nobody can read is none
    recordings::writeText(folder + "/model.yaml", model);
  }
  recordings::writeText(folder + "/report.md", markdownOf(page));
  recordings::writeText(folder + "/report.html", htmlOf(page));
  // Last: whoever finds the verdict finds the rest, too.
  recordings::writeText(folder + "/verdict.json", verdictJson(finding, inputs).dump(2) + "\n");
}

}  // namespace tread::gap

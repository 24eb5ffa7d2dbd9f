// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <set>

#include "common/config/command_line.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/lab/overlay/drive_pieces.hpp"

namespace {

using namespace tread;
using namespace tread::overlay;

struct Arguments {
  std::vector<std::string> logs;
  std::vector<std::string> models;
  std::string picture;
  std::string title = "The same drive, measured and simulated";
  double length = 8.0;  // [s]
};

void describe(CLI::App& app, Arguments& arguments) {
  app.add_option("logs", arguments.logs, "LCM log; several are parts of one recording, in order")
      ->required();
  app.add_option("--model", arguments.models, "model file; repeatable")
      ->required()
      ->expected(1)
      ->take_all();
  app.add_option("--length", arguments.length, "time predicted from each measured pose [s]")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  Outputs(app).file("--picture", arguments.picture, "file of the picture (PNG)");
  app.add_option("--title", arguments.title, "title of the picture");
}

void tell(const std::string& file, const std::vector<ComparedPiece>& pieces, size_t model,
          double length) {
  for (const double horizon : std::set<double>{2.0, length}) {
    if (horizon > length) continue;
    const MedianErrors errors =
        medianErrors(pieces, model, static_cast<size_t>(std::round(horizon / kSample)));
    std::printf("%s: after %g s %.3f m, %.2f deg\n", file.c_str(), horizon, errors.position,
                errors.yaw * 180.0 / kPi);
  }
}

int run(const Arguments& arguments) {
  std::string problem;
  const gap::Drive drive = readLoggedDrive(arguments.logs, problem);
  if (!problem.empty()) std::printf("%s\n", problem.c_str());
  std::vector<ModelDocument> models;
  std::vector<std::string> names;
  for (const std::string& file : arguments.models) {
    models.push_back(readTrackModelDocument(file));
    const size_t slash = file.rfind('/');
    names.push_back(slash == std::string::npos ? file : file.substr(slash + 1));
  }
  const std::vector<ComparedPiece> pieces = replay(drive, models, arguments.length);
  if (pieces.empty())
    throw std::runtime_error(arguments.logs.front() + ": no " + std::to_string(arguments.length) +
                             " s of driving with INS in one piece; try a smaller --length");
  std::printf("median errors of %zu pieces of the drive, each predicted from its measured start:\n",
              pieces.size());
  for (size_t m = 0; m < models.size(); ++m) tell(arguments.models[m], pieces, m, arguments.length);
  if (!arguments.picture.empty()) {
    drawOverlay(arguments.picture, arguments.title, pieces, names);
    std::printf("picture: %s\n", arguments.picture.c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("tread-overlay", [&] {
    CLI::App app{
        "Simulates a log's commands with model files and compares the result with the INS "
        "measured.",
        "tread-overlay"};
    Arguments arguments;
    describe(app, arguments);
    if (const auto code = parseCommandLine(app, argc, argv)) return *code;
    return run(arguments);
  });
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/command.hpp"
#include "tools/robot/operator/fence_call.hpp"

int main(int argc, char** argv) {
  using namespace tread::operators;
  tread::FenceRequest request;
  std::vector<double> stay_in, keep_out;
  const auto addOptions = [&](CLI::App& app) {
    app.add_option("name", request.fence.name, "name of the fence")->required();
    auto* in =
        app.add_option("--stay-in", stay_in,
                       "X Y of each corner in order, in the map frame [m]: the robot stays inside");
    auto* out =
        app.add_option("--keep-out", keep_out, "corners as for --stay-in: the robot stays outside");
    auto* gone = app.add_flag("--remove", request.removes,
                              "remove all fences of this name, except those of robot.yaml");
    in->excludes(out)->excludes(gone);
    out->excludes(gone);
  };
  return runPermissionCommand(
      argc, argv,
      {"tread-fence",
       "Adds a fence that the robot stays in or keeps out of. It stays in force until it is "
       "removed, also over "
       "restarts in the same run folder. Anybody may add one; only the operator who holds the "
       "robot may remove it.",
       "asks", addOptions, [&](tread::Bus& bus, const Requester& requester, double patience) {
         if (!request.removes)
           request.fence = fenceFrom(request.fence.name, !keep_out.empty(),
                                     keep_out.empty() ? stay_in : keep_out);
         return std::make_unique<FenceCall>(bus, requester, request, patience);
       }});
}

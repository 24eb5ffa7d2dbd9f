// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/why/reasons.hpp"

namespace tread::why {

const std::vector<ReasonWords>& reasonTable() {
  static const std::vector<ReasonWords> table{
      {"E-stop", Topic::kEstop},
      {"range finder at ", Topic::kFinder},
      {"disarmed by ", Topic::kPerson},
      {"controller lost: ", Topic::kController},
      {"controller is being started up", Topic::kController},
      {"controller: ", Topic::kController},
      {"motor_bridge was held up", Topic::kBridge},
      {"the robot's clock went back", Topic::kBridge},
      {"the operator is lost", Topic::kOperator},
      {"no operator's program is heard", Topic::kOperator},
      {" has let go", Topic::kOperator},
      {"the operator who gave the goal is gone", Topic::kOperator},
      {"no operator who holds the robot", Topic::kOperator},
      {"no good PROGRAM within its lease", Topic::kProgram},
      {"no PROGRAM yet", Topic::kProgram},
      {"another run of the planner", Topic::kProgram},
      {"PROGRAM with ", Topic::kProgram},
      {"series ended without a next", Topic::kProgram},
      {"nothing was handed over in time", Topic::kProgram},
      {"INS is stale", Topic::kInsStale},
      {"the INS driver has been restarted", Topic::kInsStale},
      {"no INS yet", Topic::kInsStale},
      {"INS knows no position or no heading", Topic::kInsBlind},
      {"no usable INS yet", Topic::kInsBlind},
      {"INS measures no roll and pitch", Topic::kTilt},
      {"pitched", Topic::kTilt},
      {"rolled", Topic::kTilt},
      {"pitching", Topic::kTilt},
      {"rolling", Topic::kTilt},
      {"fence", Topic::kFence},
      {"pose frozen", Topic::kMotion},
      {"pose jumps", Topic::kMotion},
      {"heading jumps", Topic::kMotion},
      {"heading and gyro differ", Topic::kMotion},
      {"position and INS velocity differ", Topic::kMotion},
      {"commands explain", Topic::kMotion},
      {"though zero is commanded", Topic::kMotion},
      {"is the least", Topic::kMotion},
      {"sideways in", Topic::kMotion},
      {"track dead", Topic::kMotion},
      {"tracks blocked", Topic::kMotion},
      {"the wrong way", Topic::kMotion},
      {"no MAP yet", Topic::kMap},
      {"MAP is ", Topic::kMap, "\"MAP\""},
      {"INS is ", Topic::kInsStale, "\"INS\""},
      {"MOTOR is ", Topic::kBridge, "\"MOTOR\""},
      {"the learner is lost", Topic::kPatterns},
      {"no PATTERN_SET yet", Topic::kPatterns},
      {"the running pattern is gone from the set", Topic::kPatterns},
      {"something is in the way", Topic::kObstacle},
      {"boxed in", Topic::kPlan},
      {"trying to get out", Topic::kPlan},
      {"no pattern is free from here", Topic::kPlan},
      {"no free sequence of patterns", Topic::kPlan},
      {"obstacles enclose", Topic::kPlan},
      {"the goal", Topic::kGoal},
  };
  return table;
}

Topic topicOf(const std::string& reason) {
  for (const ReasonWords& row : reasonTable())
    if (reason.find(row.words) != std::string::npos) return row.topic;
  return Topic::kOther;
}

bool isOrdinary(const std::string& reason) {
  for (const char* words :
       {"not armed yet", "stopping to", "stopping at the goal", "stopping for", "not armed since",
        "stopping: the plan ends there", "no goal", "by the end of motor_bridge"})
    if (reason.find(words) != std::string::npos) return true;
  return reason.empty() || reason.rfind("armed by", 0) == 0;
}

}  // namespace tread::why

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"
#include "tools/robot/setup/first_patterns.hpp"

namespace tread::setup {
namespace {

constexpr double kPatternPeriod = 0.05;  // [s]
constexpr double kMarkingShare = 0.6;
constexpr double kSlowShare = 0.5;  // of the cruising speed, also backward

/// Patterns of a car: throttle and steering, straight again at their ends.
class CarRecipe {
 public:
  explicit CarRecipe(const RobotFindings& findings) : steering_(findings.robot.drive.max_steering) {
    const VehicleModel model = modelOf(findings).vehicle;
    const WiringReport& wiring = findings.wiring;
    dead_ = wiring.dead_power.value;
    hold_ = whole(3.0 * model.settlingLag() + model.commandDelay());
    align_ = std::max(hold_, whole(3.0 * wiring.steering_lag.value + model.commandDelay()));
    // From standstill through the longest curve to standstill, at full speed.
    const double longest = wiring.fullSpeed() * (2.0 * hold_ + align_ + 1.2);
    cruise_ = std::min(1.0, kMarkingShare * findings.marking_range / longest);
    text_ =
        "# Made by tread-setup-robot from what it measured: throttle, steering [rad], seconds.\n"
        "name: " +
        model.name + "\nperiod: 0.05\nclasses:\n" + classText("rest", 0.0) +
        classText("cruise", 1.0) + classText("slow", kSlowShare) +
        classText("reverse", -kSlowShare) + "patterns:\n";
  }

  std::string text() {
    const double slow = kSlowShare;
    pattern("straight", "cruise", "cruise", {{1, 0, std::max(1.0, hold_)}});
    pattern("short_straight", "cruise", "cruise", {{1, 0, hold_}});
    curve("nudge", "cruise", 1, 0.25, 0.4);
    curve("bend", "cruise", 1, 0.5, 0.8);
    curve("hard", "cruise", 1, 0.9, 0.9);
    pattern("start", "rest", "cruise", {{slow, 0, 0.2}, {1, 0, hold_ + 0.1}});
    pattern("stop", "cruise", "rest", {{0, 0, hold_ + 0.2}});
    pattern("slow_down", "cruise", "slow", {{slow, 0, hold_ + 0.1}});
    pattern("speed_up", "slow", "cruise", {{1, 0, hold_ + 0.1}});
    pattern("slow_start", "rest", "slow", {{slow, 0, hold_ + 0.1}});
    pattern("slow_straight", "slow", "slow", {{slow, 0, hold_}});
    pattern("slow_stop", "slow", "rest", {{0, 0, hold_ + 0.1}});
    curve("slow_nudge", "slow", slow, 0.4, 0.6);
    curve("slow_hard", "slow", slow, 1.0, 1.2);
    pattern("step_forward", "rest", "rest", {{slow, 0, 0.6}, {0, 0, hold_ + 0.1}});
    pattern("step_back", "rest", "rest", {{-slow, 0, 0.7}, {0, 0, hold_ + 0.1}});
    for (const int side : {1, -1}) {
      const std::string name = side > 0 ? "left" : "right";
      const double full = side * 1.0;
      pattern("start_" + name, "rest", "slow", {{slow, full, 1.2}, {slow, 0, align_}});
      pattern("step_" + name, "rest", "rest",
              {{slow, full, 1.0}, {0, full, hold_}, {0, 0, align_}});
      pattern("reverse_" + name, "reverse", "reverse", {{-slow, full, 1.2}, {-slow, 0, align_}});
    }
    pattern("reverse_start", "rest", "reverse", {{-slow, 0, hold_ + 0.1}});
    pattern("reverse", "reverse", "reverse", {{-slow, 0, std::max(0.8, hold_)}});
    pattern("reverse_stop", "reverse", "rest", {{0, 0, hold_ + 0.1}});
    return text_;
  }

 private:
  /// Shares of the cruising speed and of the full steering.
  struct Held {
    double speed, steering, seconds;
  };

  static double whole(double seconds) {
    return kPatternPeriod * std::ceil(seconds / kPatternPeriod - 1e-6);
  }
  std::string command(double speed, double steering) const {
    const double beyond = std::abs(cruise_ * speed) * (1.0 - dead_) + dead_;
    const double throttle = speed == 0.0 ? 0.0 : std::copysign(std::min(1.0, beyond), speed);
    return fixed(throttle, 3) + ", " + fixed(steering * steering_, 3);
  }
  std::string classText(const std::string& name, double speed) const {
    return "  - name: " + name + "\n    steady: [" + command(speed, 0.0) + "]\n";
  }
  void pattern(const std::string& name, const std::string& entry, const std::string& exit,
               const std::vector<Held>& commands) {
    text_ +=
        "  - name: " + name + "\n    entry: " + entry + "\n    exit: " + exit + "\n    commands: [";
    for (size_t i = 0; i < commands.size(); ++i)
      text_ += (i > 0 ? ", [" : "[") + command(commands[i].speed, commands[i].steering) + ", " +
               fixed(whole(commands[i].seconds), 2) + "]";
    text_ += "]\n";
  }
  void curve(const std::string& name, const std::string& in, double speed, double steering,
             double seconds) {
    for (const int side : {1, -1})
      pattern(name + (side > 0 ? "_left" : "_right"), in, in,
              {{speed, side * steering, seconds}, {speed, 0, align_}});
  }

  double steering_;      // [rad] full
  double dead_ = 0.0;    // [1]
  double hold_ = 0.0;    // [s] until a speed is reached
  double align_ = 0.0;   // [s] until the wheels stand straight, too
  double cruise_ = 1.0;  // share of the full speed
  std::string text_;
};

}  // namespace

std::string carRecipeFor(const RobotFindings& findings) {
  return CarRecipe(findings).text();
}

}  // namespace tread::setup

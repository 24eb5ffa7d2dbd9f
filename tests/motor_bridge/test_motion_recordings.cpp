// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What the monitor says of real drives, and of the same drives with something wrong in them.
// Limits were chosen on every other session; delays are measured on the rest. -s shows the figures.
#include <cstdlib>
#include <functional>
#include <optional>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/recorded_sessions.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using Sample = RecordedRun::Sample;

/// All sessions; none where the recordings are not there.
const std::vector<RecordedSession>& sessions() {
  static const std::vector<RecordedSession> kSessions = [] {
    const char* recordings = std::getenv("TREAD_RECORDINGS");
    const std::string folder = std::string(recordings == nullptr ? "" : recordings) + "/drive";
    if (!std::filesystem::exists(folder + "/sessions.csv")) return std::vector<RecordedSession>{};
    return SessionReader(folder).read();
  }();
  return kSessions;
}

bool absent() {
  if (sessions().empty()) WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
  return sessions().empty();
}

struct Verdict {
  int64_t utime = 0;
  std::string words;
};

/// All verdicts on the samples of a run.
std::vector<Verdict> verdictsOn(const MotionLimits& limits, const std::vector<Sample>& samples) {
  MotionMonitor monitor(limits);
  std::vector<Verdict> verdicts;
  std::string last;
  for (const Sample& sample : samples) {
    monitor.command(sample.command, sample.utime);
    monitor.receive(sample.ins);
    const std::string words = monitor.fault(sample.utime);
    // The bridge would be disarmed: what follows at once is the same event.
    const bool same = !verdicts.empty() && sample.utime - verdicts.back().utime < 5'000'000;
    if (!words.empty() && words != last && !same) verdicts.push_back({sample.utime, words});
    last = words;
  }
  return verdicts;
}

struct Count {
  int sound = 0;   ///< verdicts where the recording's own checks found nothing
  int failed = 0;  ///< where they did
  double hours = 0.0;
};

Count countVerdicts(size_t first) {
  Count count;
  for (size_t i = first; i < sessions().size(); i += 2) {
    for (const RecordedRun& run : sessions()[i].runs) {
      const auto verdicts = verdictsOn(sessions()[i].limits, run.samples);
      (run.sound ? count.sound : count.failed) += static_cast<int>(verdicts.size());
      for (const Verdict& verdict : verdicts)
        UNSCOPED_INFO(run.session << " step " << run.step << ": " << verdict.words);
      count.hours += run.hours();
    }
  }
  UNSCOPED_INFO(count.sound << " verdicts in sound steps, " << count.failed << " in failed ones, "
                            << count.hours << " h");
  return count;
}

/// Something wrong from a moment on; `since` [s] counts from it, `before` is the last good sample.
using Spoil = std::function<void(Sample& sample, double since, const Sample& before)>;

/// Delays of the verdicts on spoiled drives [s].
struct Delays {
  std::vector<double> seconds;  ///< sorted
  int missed = 0;               ///< nothing within 3 s

  double quantile(double q) const {
    const size_t all = seconds.size() + static_cast<size_t>(missed);
    const auto i = static_cast<size_t>(q * static_cast<double>(all - 1) + 0.5);
    return i < seconds.size() ? seconds[i] : 99.0;
  }
  double within(double limit) const {
    const auto in = std::count_if(seconds.begin(), seconds.end(),
                                  [limit](double delay) { return delay <= limit; });
    return static_cast<double>(in) / (static_cast<double>(seconds.size()) + missed);
  }
};

/// Where a fault may begin: the robot has driven with a pose for 1.2 s and goes on for 2.5 s, at
/// 0.5 m/s or more (or as the filter says).
using Moment = std::function<bool(const std::vector<Sample>& samples, size_t i)>;

double speedAt(const std::vector<Sample>& samples, size_t i) {
  const InsMotion &a = samples[i - 10].ins, &b = samples[i + 10].ins;
  return std::hypot(b.x - a.x, b.y - a.y);
}

bool measuredAround(const std::vector<Sample>& samples, size_t i) {
  if (i < 25 || i + 50 >= samples.size()) return false;
  for (size_t k = i - 24; k <= i + 50; ++k)
    if (!std::isfinite(samples[k].ins.x)) return false;
  return true;
}

bool drives(const std::vector<Sample>& samples, size_t i) {
  const double speed = speedAt(samples, i);
  const double later = speedAt(samples, i + 20);
  return speed >= 0.5 && later >= 0.5;
}

Delays delaysOf(const Spoil& spoil, const Moment& moment = drives) {
  Delays delays;
  for (size_t s = 1; s < sessions().size(); s += 2) {
    for (const RecordedRun& run : sessions()[s].runs) {
      if (!run.sound) continue;
      for (size_t i = 25; i + 50 < run.samples.size(); i += 40) {
        if (!measuredAround(run.samples, i) || !moment(run.samples, i)) continue;
        const size_t end = std::min(i + 61, run.samples.size());
        std::vector<Sample> samples(run.samples.begin() + static_cast<long>(i) - 24,
                                    run.samples.begin() + static_cast<long>(end));
        Sample before = run.samples[std::max<size_t>(i, 26) - 25];
        for (size_t k = 24; k < samples.size(); ++k)
          spoil(samples[k], 0.05 * static_cast<double>(k - 24), run.samples[i - 1]);
        before.utime -= 2'000'000;
        before.ins = InsMotion{};
        samples.insert(samples.begin(), before);
        const auto verdicts = verdictsOn(sessions()[s].limits, samples);
        const int64_t onset = run.samples[i].utime;
        if (!verdicts.empty() && verdicts.front().utime < onset) continue;
        if (verdicts.empty()) {
          ++delays.missed;
        } else {
          delays.seconds.push_back(1e-6 * static_cast<double>(verdicts.front().utime - onset));
        }
      }
    }
  }
  std::sort(delays.seconds.begin(), delays.seconds.end());
  return delays;
}

/// The same, with its figures for -s.
Delays told(const std::string& what, Delays delays) {
  char figures[160];
  snprintf(figures, sizeof figures,
           "%s: %zu times, median %.2f s, 90 %% in %.2f s, %.0f %% in 1.5 s, "
           "%d not within 3 s",
           what.c_str(), delays.seconds.size() + static_cast<size_t>(delays.missed),
           delays.quantile(0.5), delays.quantile(0.9), 100.0 * delays.within(1.5), delays.missed);
  UNSCOPED_INFO(figures);
  return delays;
}

Pose2 poseOf(const Sample& sample) {
  return {sample.ins.x, sample.ins.y, sample.ins.yaw};
}

void place(Sample& sample, const Pose2& T_map_body) {
  sample.ins.x = T_map_body.x;
  sample.ins.y = T_map_body.y;
}

bool turns(const std::vector<Sample>& samples, size_t i) {
  const double soon = samples[i + 20].ins.yaw - samples[i].ins.yaw;
  const double later = samples[i + 30].ins.yaw - samples[i + 10].ins.yaw;
  return std::abs(soon) > 0.4 && std::abs(later) > 0.4;
}

bool stands(const std::vector<Sample>& samples, size_t i) {
  return speedAt(samples, i) < 0.02 && speedAt(samples, i + 20) < 0.02 &&
         speedAt(samples, i + 40) < 0.02 && samples[i + 50].command == TrackCommand{};
}

/// Steps in which one track was told to stand, told to the monitor as both driving alike: delays
/// from the step's beginning, the time to settle included.
Delays deadTrackDelays() {
  Delays delays;
  for (size_t s = 0; s < sessions().size(); ++s) {
    for (const RecordedRun& run : sessions()[s].runs) {
      const TrackCommand command = run.samples.back().command;
      const double most =
          std::abs(command.left) > std::abs(command.right) ? command.left : command.right;
      const double other = command.left + command.right - most;
      if (run.step < 0 || !run.sound || std::abs(most) < 0.5 ||
          std::abs(other) > 0.15 * std::abs(most) || run.hours() * 3600.0 < 3.0)
        continue;
      std::vector<Sample> samples = run.samples;
      for (Sample& sample : samples) sample.command = {most, most};
      const auto verdicts = verdictsOn(sessions()[s].limits, samples);
      if (verdicts.empty()) {
        ++delays.missed;
      } else {
        delays.seconds.push_back(1e-6 * static_cast<double>(verdicts.front().utime) - 100.0);
      }
    }
  }
  std::sort(delays.seconds.begin(), delays.seconds.end());
  return delays;
}

}  // namespace

TEST_CASE("real drives: at most one false alarm an hour") {
  if (absent()) return;
  const Count tuned = countVerdicts(0);
  CHECK(tuned.hours > 0.8);
  // One of a robot that really stands while 1.7 rad/s are commanded.
  CHECK(tuned.sound <= 1);
  const Count held_out = countVerdicts(1);
  CHECK(held_out.hours > 0.75);
  CHECK(held_out.sound <= 1);
  CHECK(tuned.failed + held_out.failed <= 3);
}

TEST_CASE("real drives: a frozen, jumping or mirrored pose is told within 1.5 s") {
  if (absent()) return;
  const auto repeat = [](Sample& sample, double, const Sample& before) {
    const int64_t utime = sample.ins.utime;
    sample.ins = before.ins;
    sample.ins.utime = utime;
  };
  CHECK(told("pose and gyro repeat", delaysOf(repeat)).within(1.5) >= 0.98);
  const auto jump = [](Sample& sample, double, const Sample&) { sample.ins.x += 3.0; };
  CHECK(told("3 m jump", delaysOf(jump)).within(0.1) == 1.0);
  const auto off = [](Sample& sample, double, const Sample&) { sample.ins.yaw += 0.349; };
  CHECK(told("heading +20 deg", delaysOf(off)).within(1.5) >= 0.95);
  const auto mirror = [](Sample& sample, double, const Sample& before) {
    sample.ins.x -= 2.0 * (sample.ins.x - before.ins.x);
    sample.ins.y -= 2.0 * (sample.ins.y - before.ins.y);
  };
  CHECK(told("travel mirrored", delaysOf(mirror)).within(1.5) >= 0.98);
  const auto turn = [](Sample& sample, double, const Sample& before) {
    const double turned = sample.ins.yaw - before.ins.yaw;
    const Pose2 moved = between(poseOf(before), poseOf(sample));
    sample.ins.yaw -= 2.0 * turned;
    sample.ins.yaw_rate *= -1.0;
    place(sample, poseOf(before) * Pose2{moved.x, -moved.y, 0.0});
  };
  CHECK(told("turns mirrored, gyro too", delaysOf(turn, turns)).within(1.5) >= 0.97);
}

TEST_CASE("real drives: drifts are told once they are larger than slip") {
  if (absent()) return;
  for (const double rate : {0.1, 0.2, 0.3, 0.5}) {
    const auto turn = [rate](Sample& sample, double since, const Sample&) {
      sample.ins.yaw += rate * since;
    };
    const Delays delays =
        told("heading drifts at " + std::to_string(rate) + " rad/s", delaysOf(turn));
    CHECK(delays.within(1.5) >= (rate < 0.3 ? 0.0 : 0.9));
  }
  for (const double speed : {0.5, 1.0, 2.0}) {
    for (const double angle : {0.0, 0.5 * kPi}) {
      const auto drift = [&](Sample& sample, double since, const Sample& before) {
        sample.ins.x += speed * since * std::cos(before.ins.yaw + angle);
        sample.ins.y += speed * since * std::sin(before.ins.yaw + angle);
      };
      const Delays delays = told("position drifts " + std::string(angle > 0.0 ? "aside" : "ahead") +
                                     " at " + std::to_string(speed) + " m/s, no velocity",
                                 delaysOf(drift));
      CHECK(delays.within(1.5) >= (speed < 2.0 ? 0.0 : 0.9));
    }
  }
}

TEST_CASE("real drives: blocked, rolling, and one track dead") {
  if (absent()) return;
  for (const double speed : {0.7, 1.0, 1.5}) {
    for (const double left : {speed, -speed}) {
      const auto block = [&](Sample& sample, double, const Sample&) {
        sample.command = {left, speed};
      };
      const Delays delays =
          told("blocked at " + std::to_string(left) + ", " + std::to_string(speed) + " m/s",
               delaysOf(block, stands));
      CHECK(delays.within(speed < 1.0 ? 2.5 : 1.6) == 1.0);
    }
  }
  for (const double speed : {0.05, 0.1, 0.2, 0.5}) {
    const auto roll = [speed](Sample& sample, double since, const Sample&) {
      sample.ins.x += speed * since;
    };
    const Delays delays =
        told("rolls at " + std::to_string(speed) + " m/s", delaysOf(roll, stands));
    CHECK(delays.within(1.5) >= (speed < 0.2 ? 0.0 : 0.9));
  }
  CHECK(told("one track dead, from the step's begin", deadTrackDelays()).within(4.5) >= 0.75);
}

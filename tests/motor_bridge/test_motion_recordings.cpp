// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The monitor on real drives, and on the same drives with simulated faults. Limits were tuned on
// every second session ("tuned", up to 5 m/s), the others are held out. -s prints the figures; -c
// tuned those of one half.
#include <cstdlib>
#include <functional>
#include <optional>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/motor_bridge/recorded_sessions.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using Sample = RecordedRun::Sample;

/// All sessions; empty if the recordings are absent.
const std::vector<RecordedSession>& sessions() {
  static const std::vector<RecordedSession> kSessions = [] {
    const std::string folder = tread::testing::recorded("drive");
    if (folder.empty()) return std::vector<RecordedSession>{};
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
    const std::string words = monitor.fault(sample.utime).words;
    // The bridge would be disarmed: an immediate successor is the same event.
    const bool same = !verdicts.empty() && sample.utime - verdicts.back().utime < 5'000'000;
    if (!words.empty() && words != last && !same) verdicts.push_back({sample.utime, words});
    last = words;
  }
  return verdicts;
}

struct Count {
  int sound = 0;   ///< verdicts in steps that the recording's own checks passed
  int failed = 0;  ///< verdicts in the others
  double hours = 0.0;
};

/// The runs of a session in sequence: learning in one is used in the next.
std::vector<Sample> joined(const RecordedSession& session) {
  std::vector<Sample> samples;
  for (const RecordedRun& run : session.runs)
    samples.insert(samples.end(), run.samples.begin(), run.samples.end());
  return samples;
}

const RecordedRun& runAt(const RecordedSession& session, int64_t utime) {
  const auto after =
      std::find_if(session.runs.begin(), session.runs.end(),
                   [utime](const RecordedRun& run) { return run.samples.front().utime > utime; });
  return after == session.runs.begin() ? session.runs.front() : *std::prev(after);
}

Count countVerdicts(size_t half) {
  Count count;
  for (size_t i = half; i < sessions().size(); i += 2) {
    for (const Verdict& verdict : verdictsOn(sessions()[i].limits, joined(sessions()[i]))) {
      const RecordedRun& run = runAt(sessions()[i], verdict.utime);
      ++(run.sound ? count.sound : count.failed);
      UNSCOPED_INFO(run.session << " step " << run.step << ": " << verdict.words);
    }
    for (const RecordedRun& run : sessions()[i].runs) count.hours += run.hours();
  }
  UNSCOPED_INFO(count.sound << " verdicts in sound steps, " << count.failed << " in failed ones, "
                            << count.hours << " h");
  return count;
}

/// A fault from some time on; `since` [s] counts from it, `before` is the last good sample.
using Spoil = std::function<void(Sample& sample, double since, const Sample& before, double gauge)>;

/// Delays of the verdicts on faulty drives [s].
struct Delays {
  std::vector<double> seconds;  ///< sorted
  int missed = 0;               ///< no verdict within 3 s

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

/// Possible start of a fault: the robot has driven with a pose for 1.2 s and continues for 2.5 s,
/// at 0.5 m/s or more (or as in the filter).
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

/// A monitor that follows a session; the fault is applied to a copy of it.
class Follower {
 public:
  explicit Follower(const MotionLimits& limits) : monitor_(limits) {}

  void follow(const Sample& sample) {
    feed(sample);
    if (!monitor_.fault(sample.utime).empty()) told_ = sample.utime;
  }
  /// The robot would drive: no recent verdict.
  bool drives(int64_t utime) const { return utime - told_ > 5'000'000; }
  /// Adds the time from the onset to the first verdict on the samples; earlier samples are skipped.
  void addDelay(Delays& delays, const std::vector<Sample>& samples, int64_t onset) const {
    Follower other = *this;
    for (const Sample& sample : samples) {
      other.feed(sample);
      if (other.monitor_.fault(sample.utime).empty()) continue;
      if (sample.utime >= onset)
        delays.seconds.push_back(1e-6 * static_cast<double>(sample.utime - onset));
      return;
    }
    ++delays.missed;
  }

 private:
  void feed(const Sample& sample) {
    monitor_.command(sample.command, sample.utime);
    monitor_.receive(sample.ins);
  }

  MotionMonitor monitor_;
  int64_t told_ = 0;
};

/// Delays for a fault that begins every 2 s in the sound runs of one half.
Delays delaysOf(size_t half, const Spoil& spoil, const Moment& moment = drives) {
  Delays delays;
  for (size_t s = half; s < sessions().size(); s += 2) {
    Follower follower(sessions()[s].limits);
    for (const RecordedRun& run : sessions()[s].runs) {
      for (size_t i = 0; i < run.samples.size(); ++i) {
        const bool here = run.sound && i % 40 == 25 && measuredAround(run.samples, i) &&
                          moment(run.samples, i) && follower.drives(run.samples[i].utime);
        std::vector<Sample> samples;
        for (size_t k = i; here && k < std::min(i + 61, run.samples.size()); ++k) {
          samples.push_back(run.samples[k]);
          spoil(samples.back(), 0.05 * static_cast<double>(k - i), run.samples[i - 1],
                sessions()[s].limits.gauge);
        }
        if (here) follower.addDelay(delays, samples, run.samples[i].utime);
        follower.follow(run.samples[i]);
      }
    }
  }
  std::sort(delays.seconds.begin(), delays.seconds.end());
  return delays;
}

/// The same; prints its figures with -s.
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

/// Both tracks are driven, neither below half of the other's speed, with the robot's speed within
/// [min, max) or on the spot.
bool bothDriven(const std::vector<Sample>& samples, size_t i, double min, double max) {
  for (size_t k = i - 10; k <= i + 40; ++k) {
    const TrackCommand& command = samples[k].command;
    const double slower = std::min(std::abs(command.left), std::abs(command.right));
    const double faster = std::max(std::abs(command.left), std::abs(command.right));
    if (slower < std::max(0.4, 0.5 * faster)) return false;
  }
  const double speed = speedAt(samples, i), later = speedAt(samples, i + 20);
  return std::min(speed, later) >= min && std::max(speed, later) < max;
}

/// Both tracks like the faster one.
TrackCommand alike(const TrackCommand& command) {
  const double most =
      std::abs(command.left) > std::abs(command.right) ? command.left : command.right;
  return {most, most};
}

/// Time from which one track stands by command while the other drives: the step's begin, or when
/// its wheels stand; nullopt in other steps.
std::optional<int64_t> deadTrackOnset(const RecordedRun& run, bool from_standing) {
  const TrackCommand command = run.samples.back().command;
  const double most = alike(command).left;
  const bool left = command.left == most;
  const double other = left ? command.right : command.left;
  if (run.step < 0 || !run.sound || std::abs(most) < 0.5 ||
      std::abs(other) > 0.15 * std::abs(most) || run.hours() * 3600.0 < 3.0)
    return std::nullopt;
  if (!from_standing) return run.samples[1].utime;
  const auto stands = [left, most](const Sample& sample) {
    const double driven = left ? sample.wheels.left : sample.wheels.right;
    const double dead = left ? sample.wheels.right : sample.wheels.left;
    return driven / most > 0.6 && std::abs(dead) < 0.2 * std::abs(most);
  };
  const auto begin = std::find_if(run.samples.begin() + 1, run.samples.end(), stands);
  return begin == run.samples.end() ? std::nullopt : std::optional<int64_t>(begin->utime);
}

/// Steps in which one track was commanded to stand, presented to the monitor as both driving:
/// delays from the step's beginning, or from the standstill of that track's wheels.
Delays deadTrackDelays(size_t half, bool from_standing) {
  Delays delays;
  for (size_t s = half; s < sessions().size(); s += 2) {
    Follower follower(sessions()[s].limits);
    for (const RecordedRun& run : sessions()[s].runs) {
      const auto onset = deadTrackOnset(run, from_standing);
      if (onset && follower.drives(run.samples[1].utime)) {
        std::vector<Sample> samples = run.samples;
        for (size_t k = 1; k < samples.size(); ++k) samples[k].command = alike(samples[k].command);
        follower.addDelay(delays, samples, *onset);
      }
      for (const Sample& sample : run.samples) follower.follow(sample);
    }
  }
  std::sort(delays.seconds.begin(), delays.seconds.end());
  return delays;
}

/// The left (1) or right (-1) track fails: only the other one's motion is left.
Spoil deadTrack(double side) {
  constexpr double kTravel = 0.92, kTurn = 0.5;  // shares in the recordings (their README)
  return [=, pose = Pose2{}, last = Pose2{}](Sample& sample, double since, const Sample& before,
                                             double gauge) mutable {
    if (since == 0.0) last = pose = {before.ins.x, before.ins.y, before.ins.yaw};
    const Pose2 now{sample.ins.x, sample.ins.y, sample.ins.yaw};
    const Pose2 moved = between(last, now);
    last = now;
    const double way = moved.x / kTravel + side * 0.5 * gauge * moved.yaw / kTurn;
    const double turned = side * kTurn * way / gauge;
    pose = pose * Pose2{0.5 * kTravel * way, moved.y, turned};
    sample.ins.yaw_rate += 20.0 * (turned - moved.yaw);
    sample.ins.x = pose.x;
    sample.ins.y = pose.y;
    sample.ins.yaw = pose.yaw;
  };
}

/// The robot is stopped by force within 0.2 s.
void holdBack(Sample& sample, double since, const Sample& before, double) {
  const double share = std::min(0.05, since) + 0.0001 * std::sin(40.0 * since);
  sample.ins.x = before.ins.x + share * (sample.ins.x - before.ins.x);
  sample.ins.y = before.ins.y + share * (sample.ins.y - before.ins.y);
  sample.ins.yaw = before.ins.yaw + share * (sample.ins.yaw - before.ins.yaw);
  sample.ins.yaw_rate = 0.0;
}

/// The sections "tuned", 0, and "held out", 1.
size_t eachHalf() {
  size_t half = 0;
  SECTION("tuned") {
    half = 0;
  }
  SECTION("held out") {
    half = 1;
  }
  return half;
}

}  // namespace

TEST_CASE("real drives: at most one false alarm an hour", "[statistics]") {
  if (absent()) return;
  const size_t half = eachHalf();
  const Count count = countVerdicts(half);
  CHECK(count.hours > 0.75);
  // Tuned: a robot that really stands while 1.7 rad/s are commanded.
  CHECK(count.sound <= 1);
  CHECK(count.failed <= 2);
}

TEST_CASE("real drives: a frozen, jumping or mirrored pose is told within 1.5 s", "[statistics]") {
  if (absent()) return;
  const size_t half = eachHalf();
  const bool tuned = half == 0;
  const auto repeat = [](Sample& sample, double, const Sample& before, double) {
    const int64_t utime = sample.ins.utime;
    sample.ins = before.ins;
    sample.ins.utime = utime;
  };
  CHECK(told("pose and gyro repeat", delaysOf(half, repeat)).within(1.5) >= 0.98);
  const auto jump = [](Sample& sample, double, const Sample&, double) { sample.ins.x += 3.0; };
  CHECK(told("3 m jump", delaysOf(half, jump)).within(0.1) == 1.0);
  const auto off = [](Sample& sample, double, const Sample&, double) { sample.ins.yaw += 0.349; };
  CHECK(told("heading +20 deg", delaysOf(half, off)).within(1.5) >= (tuned ? 0.7 : 0.95));
  const auto mirror = [](Sample& sample, double, const Sample& before, double) {
    sample.ins.x -= 2.0 * (sample.ins.x - before.ins.x);
    sample.ins.y -= 2.0 * (sample.ins.y - before.ins.y);
  };
  CHECK(told("travel mirrored", delaysOf(half, mirror)).within(1.5) >= (tuned ? 0.92 : 0.98));
  const auto turn = [](Sample& sample, double, const Sample& before, double) {
    const double turned = sample.ins.yaw - before.ins.yaw;
    const Pose2 moved = between(poseOf(before), poseOf(sample));
    sample.ins.yaw -= 2.0 * turned;
    sample.ins.yaw_rate *= -1.0;
    place(sample, poseOf(before) * Pose2{moved.x, -moved.y, 0.0});
  };
  CHECK(told("turns mirrored, gyro too", delaysOf(half, turn, turns)).within(1.5) >=
        (tuned ? 0.88 : 0.98));
}

TEST_CASE("real drives: drifts are told once they are larger than slip", "[statistics]") {
  if (absent()) return;
  for (const double rate : {0.1, 0.2, 0.3, 0.5}) {
    const auto turn = [rate](Sample& sample, double since, const Sample&, double) {
      sample.ins.yaw += rate * since;
    };
    const Delays delays =
        told("heading drifts at " + std::to_string(rate) + " rad/s", delaysOf(1, turn));
    CHECK(delays.within(1.5) >= (rate < 0.3 ? 0.0 : 0.9));
  }
  for (const double speed : {0.5, 1.0, 2.0}) {
    for (const double angle : {0.0, 0.5 * kPi}) {
      const auto drift = [&](Sample& sample, double since, const Sample& before, double) {
        sample.ins.x += speed * since * std::cos(before.ins.yaw + angle);
        sample.ins.y += speed * since * std::sin(before.ins.yaw + angle);
      };
      const Delays delays = told("position drifts " + std::string(angle > 0.0 ? "aside" : "ahead") +
                                     " at " + std::to_string(speed) + " m/s, no velocity",
                                 delaysOf(1, drift));
      CHECK(delays.within(1.5) >= (speed < 2.0 ? 0.0 : 0.9));
    }
  }
}

TEST_CASE("real drives: blocked, rolling, and one track dead", "[statistics]") {
  if (absent()) return;
  const size_t half = eachHalf();
  for (const double speed : {0.7, 1.0, 1.5}) {
    for (const double left : {speed, -speed}) {
      const auto block = [&](Sample& sample, double, const Sample&, double) {
        sample.command = {left, speed};
      };
      const Delays delays =
          told("blocked at " + std::to_string(left) + ", " + std::to_string(speed) + " m/s",
               delaysOf(half, block, stands));
      CHECK(delays.within(speed < 1.0 ? 2.5 : 1.6) >= 0.95);
    }
  }
  for (const double speed : {0.05, 0.1, 0.2, 0.5}) {
    const auto roll = [speed](Sample& sample, double since, const Sample&, double) {
      sample.ins.x += speed * since;
    };
    const Delays delays =
        told("rolls at " + std::to_string(speed) + " m/s", delaysOf(half, roll, stands));
    CHECK(delays.within(1.5) >= (speed < 0.2 ? 0.0 : 0.9));
  }
  CHECK(told("one track stands, from the step's begin", deadTrackDelays(half, false)).within(3.5) >=
        0.85);
  CHECK(told("one track stands, from when it does", deadTrackDelays(half, true)).within(2.0) >=
        0.85);
}

TEST_CASE("real drives: a track that dies and a robot that is held are told within 1.5 s",
          "[statistics]") {
  if (absent()) return;
  const size_t half = eachHalf();
  struct Case {
    double min, max;         // [m/s]
    double dies, held_back;  // [1] reported within 1.5 s, at least
  };
  // At lower speed less of a fault shows above the tolerance of a window.
  for (const Case& at : {Case{0.0, 0.2, 0.45, 0.7}, {0.5, 0.9, 0.6, 0.8}, {0.9, 9.0, 0.92, 0.97}}) {
    const auto moment = [&at](const std::vector<Sample>& samples, size_t i) {
      return bothDriven(samples, i, at.min, at.max);
    };
    const std::string speed = " at " + std::to_string(at.min) + " m/s";
    for (const double side : {1.0, -1.0})
      CHECK(told((side > 0.0 ? "left track dies" : "right track dies") + speed,
                 delaysOf(half, deadTrack(side), moment))
                .within(1.5) >= at.dies);
    CHECK(told("held back" + speed, delaysOf(half, holdBack, moment)).within(1.5) >= at.held_back);
  }
}

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <limits>

#include <tread/motor_t.hpp>
#include <tread/plan_t.hpp>

#include "common/report/text.hpp"
#include "tools/robot/why/debrief.hpp"

namespace tread::why {
namespace {

constexpr double kTogether = 1.5;  // [s] between reasons of one stop
// [s] after the first reason, in which the nearest one to the cause is searched
constexpr double kFirst = 0.6;
constexpr double kBefore = 1.5;  // [s] before a stop, in which its cause is searched
// [s] after it, in which complaints and restarts of processes are searched
constexpr double kAfterwards = 8.0;
// [s] longest normal interval of HEALTH, which has a period of 1 s
constexpr double kHealthLate = 1.4;
constexpr int64_t kManyGarbled = 100;
constexpr double kOneHeading = 0.03;  // [rad] tolerance of an unchanged heading
constexpr double kOnePlace = 0.05;    // [m] noise of an INS that does not move

/// A reason that was published.
struct Signal {
  double time = 0.0;
  const char* channel = "";
  StopReason code = StopReason::kUnsaid;
  std::string reason;
};

/// Reasons of one stop.
struct Incident {
  std::vector<Signal> signals;
  double until = 0.0;

  double time() const { return signals.front().time; }
  /// Whether the next reason begins another stop: the first one with an input or the bridge as
  /// cause.
  bool endsBefore(const Signal& next) const {
    const auto takesPermission = [](const Signal& signal) {
      return signal.channel == std::string("MOTOR") || signal.code == StopReason::kNoMap ||
             signal.code == StopReason::kMapStale;
    };
    return takesPermission(next) && next.time > time() + kFirst &&
           std::none_of(signals.begin(), signals.end(), takesPermission);
  }
  /// Reasons without a code have the least information.
  static int rankOf(const Signal& signal) {
    return signal.code == StopReason::kUnsaid ? std::numeric_limits<int>::max()
                                              : static_cast<int>(signal.code);
  }
  /// The reason nearest to the cause.
  const Signal& main() const {
    const Signal* best = &signals.front();
    for (const Signal& signal : signals)
      if (signal.time <= time() + kFirst && rankOf(signal) < rankOf(*best)) best = &signal;
    return *best;
  }
};

bool drives(const PlanNote& plan) {
  return plan.state == plan_t::PLAN_DRIVING;
}
bool stops(const PlanNote& plan) {
  return plan.state == plan_t::PLAN_WAITING || plan.state == plan_t::PLAN_BLOCKED ||
         plan.state == plan_t::PLAN_UNREACHABLE || plan.state == plan_t::PLAN_STOPPED ||
         plan.state == plan_t::PLAN_IDLE;
}

/// All reasons that report a problem, ordered by time.
std::vector<Signal> signalsOf(const DriveTimeline& drive) {
  std::vector<Signal> signals;
  const auto add = [&](const Note& note, const Reason& reason, const char* channel) {
    const bool says_nothing = reason.code == StopReason::kUnsaid && reason.words.empty();
    if (!isOrdinary(reason.code) && !says_nothing)
      signals.push_back({note.time, channel, reason.code, reason.words});
  };
  for (const PermissionLoss& loss : drive.losses)
    if (loss.had_it) add(loss, loss.reason, "MOTOR");
  bool drove = false;
  for (const PlanNote& plan : drive.plans) {
    drove = drove || drives(plan);
    if (drove && plan.news && stops(plan)) add(plan, plan.reason, "PLAN");
  }
  for (const auto& execution : drive.executions)
    if (execution.message.outcome == execution_record_t::OUTCOME_ABORTED)
      add(execution,
          {stopReasonFrom(execution.message.outcome_code), execution.message.outcome_reason},
          "EXECUTION");
  std::stable_sort(signals.begin(), signals.end(),
                   [](const Signal& a, const Signal& b) { return a.time < b.time; });
  return signals;
}

/// Time of the planner's next motion after a time; the end of the log if there is none.
double drivesAgain(const DriveTimeline& drive, double time) {
  for (const PlanNote& plan : drive.plans)
    if (plan.news && plan.time > time && drives(plan)) return plan.time;
  return drive.duration;
}

std::vector<Incident> incidentsOf(const DriveTimeline& drive) {
  std::vector<Incident> incidents;
  for (Signal& signal : signalsOf(drive)) {
    // A loss of the permission is a separate stop, whatever the planner had reported before.
    const bool same = !incidents.empty() && !incidents.back().endsBefore(signal) &&
                      (signal.time - incidents.back().signals.back().time < kTogether ||
                       signal.time <= incidents.back().until);
    if (!same && !incidents.empty())
      incidents.back().until = std::min(incidents.back().until, signal.time);
    if (!same) incidents.emplace_back();
    incidents.back().until = drivesAgain(drive, signal.time);
    incidents.back().signals.push_back(std::move(signal));
  }
  return incidents;
}

/// Finds the cause of one stop.
class CauseSearch {
 public:
  CauseSearch(const DriveTimeline& drive, const Incident& incident)
      : drive_(drive), main_(incident.main()), t_(incident.time()) {
    finding_.kind = FindingKind::kStop;
    finding_.time = t_;
    finding_.until = incident.until;
    for (const Signal& signal : incident.signals) {
      if (finding_.evidence.size() >= 4) break;
      finding_.evidence.push_back({signal.time, signal.channel, signal.reason});
    }
  }

  Finding find() {
    switch (main_.code) {
      case StopReason::kEstopEngaged:
        estop();
        break;
      case StopReason::kRangeFinder:
        say("range_finder", "mapping rejected the range finder's scans: " + main_.reason);
        proveComplaint("mapping", t_ - kBefore);
        break;
      case StopReason::kDisarmed:
        say("disarmed", main_.reason);
        quote("ARM", "disarms");
        break;
      case StopReason::kControllerVoltage:
        say("battery", "the motor controller had low voltage: " + main_.reason);
        break;
      case StopReason::kControllerLost:
      case StopReason::kControllerStarts:
      case StopReason::kControllerFault:
        controller();
        break;
      case StopReason::kBridgeHeldUp:
      case StopReason::kClockWentBack:
      case StopReason::kMotorStale:
      case StopReason::kNoMotor:
        if (!processFault("motor_bridge", "MOTOR", 0.2))
          say("motor_bridge_hung", "motor_bridge was stalled: " + main_.reason);
        break;
      case StopReason::kOperatorLost:
      case StopReason::kNoOperator:
      case StopReason::kOperatorLetGo:
      case StopReason::kGoalAbandoned:
        operatorLost();
        break;
      case StopReason::kBadProgram:
      case StopReason::kOtherPlanner:
      case StopReason::kNoProgram:
      case StopReason::kProgramLate:
      case StopReason::kSeriesEnded:
      case StopReason::kNothingInTime:
      case StopReason::kNotBegun:
        if (!processFault("motor_bridge", "MOTOR", 0.2) &&
            !processFault("planner", "PROGRAM", 0.16))
          lost("PROGRAM", "planner", "motor_bridge");
        break;
      case StopReason::kNoIns:
      case StopReason::kInsRestarted:
      case StopReason::kInsStale:
        insStale();
        break;
      case StopReason::kInsBlind:
      case StopReason::kNoUsableIns:
        insBlind();
        break;
      case StopReason::kTilt:
      case StopReason::kTiltUnknown:
        say("tilt", "the robot tilted too far: " + main_.reason);
        break;
      case StopReason::kFenceNear:
      case StopReason::kFenceBlind:
      case StopReason::kFencesLost:
        say("fence", "a fence stopped the robot: " + main_.reason);
        break;
      case StopReason::kInsJump:
      case StopReason::kInsFrozen:
      case StopReason::kTrackDead:
      case StopReason::kStuck:
      case StopReason::kInsDisagrees:
      case StopReason::kUnexplainedMotion:
        motion();
        proveGap();
        break;
      case StopReason::kNoMap:
      case StopReason::kMapStale:
        map();
        break;
      case StopReason::kLearnerLost:
      case StopReason::kBadPatterns:
      case StopReason::kPatternGone:
        if (!processFault("learner", "PATTERN_SET", 3.5)) lost("PATTERN_SET", "learner", "planner");
        break;
      case StopReason::kObstacleAhead:
      case StopReason::kGroundGivesWay:
      case StopReason::kBoxedIn:
      case StopReason::kNoWayFound:
      case StopReason::kGettingOut:
        obstacle();
        proveGap();
        break;
      case StopReason::kGoalUnreachable:
      case StopReason::kGoalEnded:
        say("goal", main_.reason);
        break;
      default:
        say("other", main_.reason);
    }
    return std::move(finding_);
  }

 private:
  void say(const std::string& cause, const std::string& sentence) {
    finding_.cause = cause;
    finding_.sentence = sentence;
  }
  void prove(double time, const std::string& channel, const std::string& words) {
    finding_.evidence.push_back({time, channel, words});
  }
  /// Adds complaints of a process from that time until some time after the stop.
  void proveComplaint(const std::string& process, double from) {
    if (const auto* const note = drive_.complaintOf(process, from, t_ + kAfterwards))
      prove(note->time, "HEALTH", process + ": " + note->message.health_reason);
  }
  /// Adds evidence of a vehicle that differs from its model, so that motions differ from plans.
  void proveGap() {
    const GapNote* last = nullptr;
    for (const GapNote& note : drive_.gaps)
      if (note.time <= t_) last = &note;
    if (last != nullptr && last->holds) prove(last->time, "MARK", "gap_watch: " + last->words);
  }
  /// A person's order shortly before.
  const Event* quote(const char* channel, const std::string& what) {
    const EventNote* last = nullptr;
    for (const EventNote& note : drive_.events)
      if (note.time <= t_ + 0.3 && note.time > t_ - 3.0 && note.said.channel == channel &&
          note.said.words.rfind(what, 0) == 0)
        last = &note;
    if (last != nullptr) prove(last->time, channel, last->said.source + " " + last->said.words);
    return last == nullptr ? nullptr : &last->said;
  }

  void estop() {
    const Event* const person = quote("ESTOP", "emergency stop");
    say("estop",
        person == nullptr ? main_.reason : person->source + " pressed the " + person->words);
  }

  void controller() {
    say("motor_line", "the motor controller did not answer: " + main_.reason);
    proveComplaint("motor_bridge", t_);
  }

  void operatorLost() {
    if (const auto silence = drive_.silenceOf("OPERATOR", t_ - 0.5, 0.6)) {
      say("operator_lost", "the operator's program went silent: " + main_.reason);
      prove(silence->from, "OPERATOR",
            formatted("nothing from here on for %.1f s", silence->length()));
      return;
    }
    if (main_.code == StopReason::kOperatorLetGo) return say("operator_left", main_.reason);
    lost("OPERATOR", "the operator's program", "motor_bridge");
  }

  /// Whether a process that publishes on a channel had died or hung; then adds the finding.
  bool processFault(const std::string& process, const std::string& channel, double longest) {
    if (const auto restart = drive_.restartOf(process, t_ - kBefore, t_ + kAfterwards)) {
      say(process + "_died", diedWords(process, true));
      finding_.evidence.push_back(deathEvidence(*restart, process, true));
      return true;
    }
    if (const auto death = drive_.deathOf(process); death && *death < t_ + 1.5) {
      say(process + "_died", diedWords(process, false));
      finding_.evidence.push_back(deathEvidence(*death, process, false));
      return true;
    }
    const auto silence = drive_.silenceOf(channel, t_, longest);
    if (!silence) return false;
    if (!healthLate(process, *silence)) return false;
    say(process + "_hung", process + formatted(" was stalled for %.2f s", silence->length()));
    prove(silence->from, channel, formatted("nothing from here on for %.2f s", silence->length()));
    return true;
  }

  /// Whether the process's HEALTH was late, too, so that all of it was stalled.
  bool healthLate(const std::string& process, const DriveTimeline::Silence& silence) const {
    const auto found = drive_.health.find(process);
    if (found == drive_.health.end()) return true;
    const std::vector<Said<health_t>>& notes = found->second;
    for (size_t i = 1; i < notes.size(); ++i) {
      const bool around = notes[i - 1].time < silence.to && notes[i].time > silence.from;
      const double period = notes[i].time - notes[i - 1].time;
      // It was due within the silence and came after its end.
      const double due = notes[i - 1].time + 1.0;
      const bool at_end =
          due > silence.from + 0.02 && due < silence.to - 0.06 && notes[i].time > silence.to - 0.06;
      if (around && (period > kHealthLate || at_end)) return true;
    }
    // A short silence may lie between two HEALTH messages: check other evidence.
    return silence.length() < 1.0 && !dueWithin(notes, silence) &&
           !deviceComplains(process, silence);
  }
  static bool dueWithin(const std::vector<Said<health_t>>& notes,
                        const DriveTimeline::Silence& silence) {
    return std::any_of(notes.begin(), notes.end(), [&](const Note& note) {
      return note.time > silence.from + 0.02 && note.time < silence.to - 0.02;
    });
  }
  /// A driver that reports a fault of its device is alive.
  bool deviceComplains(const std::string& process, const DriveTimeline::Silence& silence) const {
    const bool of_device = process == "ins_driver" || process == "lidar_driver";
    return of_device && drive_.complaintOf(process, t_ - 1.0, silence.to + 1.0) != nullptr;
  }

  /// Messages that were sent but not received in time: lost, late, or damaged if the receiver
  /// counted them.
  void lost(const std::string& channel, const std::string& from, const std::string& to) {
    say("lost_" + channel, channel + " was sent by " + from + ", and did not reach " + to +
                               " in time: messages were lost or late between them");
    const auto heard = drive_.heard.find(channel);
    const std::vector<double> sent =
        heard == drive_.heard.end() ? std::vector<double>() : heard->second;
    const auto within = std::upper_bound(sent.begin(), sent.end(), t_) -
                        std::lower_bound(sent.begin(), sent.end(), t_ - 1.0);
    prove(t_, channel, formatted("%td messages within the second before", within));
    // Several senders share this channel, so its losses are not counted.
    if (channel == "OPERATOR") return;
    const Said<health_t>* const before = drive_.healthAt(to, t_ - 1.0);
    const Said<health_t>* const after = drive_.healthAt(to, t_ + kAfterwards);
    if (!areOfOneLife(before, after)) return;
    const int64_t missing = after->message.lost - before->message.lost,
                  late = after->message.late - before->message.late,
                  broken = after->message.undecodable - before->message.undecodable;
    prove(after->time, "HEALTH",
          to + ": since a second before the stop " +
              (missing > kMostLost
                   ? std::string("impossible message numbers")
                   : formatted("%lld messages lost", static_cast<long long>(missing))) +
              formatted(", %lld late, %lld broken", static_cast<long long>(late),
                        static_cast<long long>(broken)));
    if (missing == 0 && late == 0 && broken == 0)
      say("late_" + channel, channel + " was too old for " + to +
                                 ", though no message was lost on the way: " + main_.reason);
  }

  void insStale() {
    if (processFault("ins_driver", "INS", 0.095)) return;
    const auto silence = drive_.silenceOf("INS", t_, 0.095);
    if (!silence)
      return lost("INS", "ins_driver",
                  main_.channel == std::string("PLAN") ? "planner" : "motor_bridge");
    say("ins_device", formatted("the INS gave no usable pose for %.2f s", silence->length()));
    prove(silence->from, "INS", formatted("nothing from here on for %.2f s", silence->length()));
    proveComplaint("ins_driver", t_ - 1.0);
  }

  void insBlind() {
    const auto blind = std::find_if(drive_.ins.begin(), drive_.ins.end(), [&](const InsNote& note) {
      return note.time > t_ - kBefore && note.time < t_ + 1.0 && !note.placed;
    });
    // motor_bridge had no valid position, although the INS message had one when sent.
    if (blind == drive_.ins.end()) return lost("INS", "ins_driver", "motor_bridge");
    const int64_t garbled = garbledSince(t_ - kBefore);
    if (garbled > kManyGarbled) {
      say("ins_device", "data of the INS are corrupted, so there is no pose");
      prove(t_, "HEALTH",
            formatted("ins_driver: %lld more bytes or sentences that cannot be decoded",
                      static_cast<long long>(garbled)));
    } else {
      say("ins_no_fix", "the INS lost its position or heading");
    }
    prove(blind->time, "INS", formatted("status %d, no pose", blind->status));
    proveComplaint("ins_driver", t_ - 1.0);
  }

  /// Bytes and sentences that ins_driver could not decode, from then to 3 s later.
  int64_t garbledSince(double time) const {
    const Said<health_t>* const before = drive_.healthAt("ins_driver", time);
    const Said<health_t>* const after = drive_.healthAt("ins_driver", time + 3.0);
    return areOfOneLife(before, after) ? garbledBy(after->message) - garbledBy(before->message) : 0;
  }
  static int64_t garbledBy(const health_t& health) {
    int64_t garbled = 0;
    for (const counter_t& counter : health.counters)
      for (const char* name : {"stray bytes", "refused: wrong checksum", "refused: not printable"})
        if (counter.counter_name == name) garbled += counter.counted;
    return garbled;
  }
  static bool areOfOneLife(const Said<health_t>* before, const Said<health_t>* after) {
    return before != nullptr && after != nullptr &&
           before->message.boot_id == after->message.boot_id;
  }

  void motion() {
    for (const InsNote& note : drive_.ins)
      if (note.time > t_ - kBefore && note.time < t_ + 0.5 &&
          (note.status & ins_t::STATUS_JUMP) != 0) {
        prove(note.time, "INS", "STATUS_JUMP");
        return say("ins_jump", "the INS jumped: " + main_.reason);
      }
    if (main_.code == StopReason::kInsJump)
      return say("ins_jump", "the INS jumped: " + main_.reason);
    if (frozen())
      return say("ins_frozen",
                 "the INS repeated one position while the robot moved: " + main_.reason);
    if (main_.code == StopReason::kTrackDead)
      return say("drive", "the drive failed: " + main_.reason);
    if (main_.code == StopReason::kStuck || main_.code == StopReason::kInsFrozen)
      return say("stuck", "the robot got stuck: " + main_.reason);
    say("ins_drift", "the motion of the pose does not match the commands: " + main_.reason);
  }

  /// Whether the pose stayed constant for a while after motion of the robot.
  bool frozen() {
    const auto last = drive_.poseAt(t_);
    if (!last) return false;
    double since = t_;
    for (auto note = drive_.ins.rbegin(); note != drive_.ins.rend(); ++note) {
      if (note->time > t_ || !note->placed) continue;
      if (!atOnePlace(note->T_map_body, *last, 1.0)) break;
      since = note->time;
    }
    const auto before = drive_.poseAt(since - 0.5);
    const bool moved = before && !atOnePlace(*before, *last, 3.0);
    if (t_ - since < 0.3 || !moved) return false;
    prove(since, "INS", formatted("one position for %.2f s", t_ - since));
    return true;
  }

  static bool atOnePlace(const Pose2& a, const Pose2& b, double tolerance) {
    return distanceBetween(a, b) < tolerance * kOnePlace &&
           std::abs(wrapAngle(a.yaw - b.yaw)) < tolerance * kOneHeading;
  }

  void map() {
    if (processFault("ins_driver", "INS", 0.3)) return;
    if (processFault("lidar_driver", "SCAN", 0.35)) return;
    if (processFault("mapping", "MAP", 0.6)) return;
    if (const auto silence = drive_.silenceOf("SCAN", t_, 0.35)) {
      say("range_finder", formatted("the range finder gave no scan for %.1f s", silence->length()));
      prove(silence->from, "SCAN", formatted("nothing from here on for %.1f s", silence->length()));
      return;
    }
    lost("MAP", "mapping", "planner");
  }

  /// Of new obstacle cells, those around the one nearest to the robot; whether they disappeared
  /// afterwards.
  void obstacle() {
    const auto pose = drive_.poseAt(t_);
    const CellNote* nearest = nullptr;
    const auto distance = [&](const CellNote& cell) {
      return pose ? (cell.p_map - pose->position()).norm() : 0.0;
    };
    for (const CellNote& cell : drive_.cells)
      if (cell.came && cell.time > t_ - 3.0 && cell.time <= t_ + 0.3 &&
          (nearest == nullptr || distance(cell) < distance(*nearest)))
        nearest = &cell;
    if (nearest == nullptr) return say("no_way", "no path was free: " + main_.reason);
    const auto ghost = drive_.ghostAt(nearest->p_map, t_ - 3.0, t_ + 0.3);
    const std::string where = formatted("x %.1f m, y %.1f m, %.1f m from the robot",
                                        nearest->p_map.x(), nearest->p_map.y(), distance(*nearest));
    prove(
        nearest->time, "MAP",
        formatted("%d cells there became obstacles, %d became free again", ghost.came, ghost.went));
    if (ghost.alone && ghost.went * 2 >= ghost.came)
      return say("ghost", "an obstacle appeared at " + where +
                              ", and disappeared: something passed, or the range finder had "
                              "false echoes");
    say("obstacle", "an obstacle came into view at " + where);
  }

  const DriveTimeline& drive_;

  const Signal& main_;
  double t_;
  Finding finding_;
};

}  // namespace

std::vector<Finding> stopsOf(const DriveTimeline& drive) {
  std::vector<Finding> findings;
  for (const Incident& incident : incidentsOf(drive))
    findings.push_back(CauseSearch(drive, incident).find());
  return findings;
}

}  // namespace tread::why

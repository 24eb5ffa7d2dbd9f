// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include <tread/motor_t.hpp>
#include <tread/plan_t.hpp>

#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"
#include "tools/why/debrief.hpp"
#include "tools/why/reasons.hpp"

namespace tread::why {
namespace {

constexpr double kTogether = 1.5;      // [s] between reasons of one stop
constexpr double kFirst = 0.6;         // [s] in which the nearest reason to the cause is looked for
constexpr double kBefore = 1.5;        // [s] before a stop in which its cause lies
constexpr double kAfterwards = 8.0;    // [s] after it in which processes complain or start again
constexpr double kHealthLate = 1.4;    // [s] between HEALTH, which comes every second
constexpr double kObstacleSize = 0.7;  // [m] about its nearest cell
constexpr double kGhost = 12.0;        // [s] in which an obstacle that was none goes

/// A reason that was published.
struct Signal {
  double time = 0.0;
  const char* channel = "";
  Topic topic = Topic::kOther;
  std::string reason;
};

/// Reasons that belong to one stop.
struct Incident {
  std::vector<Signal> signals;
  double until = 0.0;

  double time() const { return signals.front().time; }
  /// The one nearest to the cause.
  const Signal& main() const {
    const Signal* best = &signals.front();
    for (const Signal& signal : signals)
      if (signal.time <= time() + kFirst && signal.topic < best->topic) best = &signal;
    return *best;
  }
};

bool drives(int plan_state) {
  return plan_state == plan_t::PLAN_DRIVING;
}
bool stops(int plan_state) {
  return plan_state == plan_t::PLAN_WAITING || plan_state == plan_t::PLAN_BLOCKED ||
         plan_state == plan_t::PLAN_UNREACHABLE || plan_state == plan_t::PLAN_STOPPED ||
         plan_state == plan_t::PLAN_IDLE;
}

/// All reasons that tell of something wrong, in the order of time.
std::vector<Signal> signalsOf(const DriveTimeline& drive) {
  std::vector<Signal> signals;
  const auto add = [&](const StateNote& note, const char* channel) {
    if (!isOrdinary(note.reason))
      signals.push_back({note.time, channel, topicOf(note.reason), note.reason});
  };
  bool may = false;
  for (const StateNote& note : drive.motors) {
    const bool now = mayDrive(static_cast<int16_t>(note.state));
    if (may && !now) add(note, "MOTOR");
    may = now;
  }
  bool drove = false;
  for (const StateNote& note : drive.plans) {
    drove = drove || drives(note.state);
    if (drove && stops(note.state)) add(note, "PLAN");
  }
  for (const StateNote& note : drive.aborts) add(note, "EXECUTION");
  std::stable_sort(signals.begin(), signals.end(),
                   [](const Signal& a, const Signal& b) { return a.time < b.time; });
  return signals;
}

/// When the planner drove again after a time; the log's end if it did not.
double drivesAgain(const DriveTimeline& drive, double time) {
  for (const StateNote& note : drive.plans)
    if (note.time > time && drives(note.state)) return note.time;
  return drive.duration;
}

std::vector<Incident> incidentsOf(const DriveTimeline& drive) {
  std::vector<Incident> incidents;
  for (Signal& signal : signalsOf(drive)) {
    const bool same =
        !incidents.empty() && (signal.time - incidents.back().signals.back().time < kTogether ||
                               signal.time <= incidents.back().until);
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
      : drive_(drive), incident_(incident), main_(incident.main()), t_(incident.time()) {
    finding_.kind = FindingKind::kStop;
    finding_.time = t_;
    finding_.until = incident.until;
    for (const Signal& signal : incident.signals) {
      if (finding_.evidence.size() >= 4) break;
      finding_.evidence.push_back({signal.time, signal.channel, signal.reason});
    }
  }

  Finding find() {
    switch (main_.topic) {
      case Topic::kEstop:
        estop();
        break;
      case Topic::kPerson:
        say("disarmed", main_.reason);
        quote("disarms");
        break;
      case Topic::kController:
        controller();
        break;
      case Topic::kBridge:
        if (!processFault("motor_bridge", "MOTOR", 0.2))
          say("motor_bridge_hung", "motor_bridge was held up: " + main_.reason);
        break;
      case Topic::kOperator:
        operatorLost();
        break;
      case Topic::kProgram:
        if (!processFault("motor_bridge", "MOTOR", 0.2) &&
            !processFault("planner", "PROGRAM", 0.16))
          lost("PROGRAM", "planner", "motor_bridge");
        break;
      case Topic::kInsStale:
        insStale();
        break;
      case Topic::kInsBlind:
        insBlind();
        break;
      case Topic::kTilt:
        say("tilt", "it leaned too far: " + main_.reason);
        break;
      case Topic::kFence:
        say("fence", "a fence stopped it: " + main_.reason);
        break;
      case Topic::kMotion:
        motion();
        break;
      case Topic::kMap:
        map();
        break;
      case Topic::kPatterns:
        if (!processFault("learner", "PATTERN_SET", 3.5)) lost("PATTERN_SET", "learner", "planner");
        break;
      case Topic::kObstacle:
      case Topic::kPlan:
        obstacle();
        break;
      case Topic::kGoal:
        say("goal", main_.reason);
        break;
      case Topic::kOther:
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
  void prove(const std::string& process, const HealthNote& note) {
    prove(note.time, "HEALTH", process + ": " + note.reason);
  }
  /// What a person said shortly before.
  const PersonNote* quote(const std::string& what) {
    const PersonNote* last = nullptr;
    for (const PersonNote& note : drive_.people)
      if (note.time <= t_ + 0.3 && note.time > t_ - 3.0 && note.what.rfind(what, 0) == 0)
        last = &note;
    if (last != nullptr)
      prove(last->time, what == "E-stop" ? "ESTOP" : "ARM", last->who + " " + last->what);
    return last;
  }

  void estop() {
    const PersonNote* const person = quote("E-stop");
    say("estop", person != nullptr
                     ? person->who + " pressed the emergency stop (" + person->what + ")"
                     : main_.reason);
  }

  void controller() {
    const bool weak = main_.reason.find("voltage") != std::string::npos;
    if (weak) return say("battery", "the motor controller ran short of voltage: " + main_.reason);
    say("motor_line", "the motor controller did not answer: " + main_.reason);
    if (const HealthNote* const note =
            drive_.complaintOf("motor_bridge", t_, t_ + kAfterwards, "controller"))
      prove("motor_bridge", *note);
  }

  void operatorLost() {
    if (const auto silence = drive_.silenceOf("OPERATOR", t_ - 0.5, 0.6)) {
      say("operator_lost", "the operator's program fell silent: " + main_.reason);
      prove(silence->from, "OPERATOR",
            formatted("nothing from here on for %.1f s", silence->length()));
      return;
    }
    if (main_.reason.find("has let go") != std::string::npos)
      return say("operator_left", main_.reason);
    lost("OPERATOR", "the operator's program", "motor_bridge");
  }

  /// Whether a process that publishes on a channel had died or hung; tells it then.
  bool processFault(const std::string& process, const std::string& channel, double longest) {
    if (const auto restart = drive_.restartOf(process, t_ - kBefore, t_ + kAfterwards)) {
      say(process + "_died", process + " died and was started again");
      prove(*restart, "HEALTH", process + ": another boot_id");
      return true;
    }
    if (const auto death = drive_.deathOf(process); death && *death < t_ + 1.5) {
      say(process + "_died", process + " died, and nobody started it again");
      prove(*death, "HEALTH", process + ": its last message");
      return true;
    }
    const auto silence = drive_.silenceOf(channel, t_, longest);
    if (!silence) return false;
    if (!healthLate(process, *silence)) return false;
    say(process + "_hung", process + formatted(" did nothing for %.2f s", silence->length()));
    prove(silence->from, channel, formatted("nothing from here on for %.2f s", silence->length()));
    return true;
  }

  /// Whether a process' HEALTH was late, too: it did nothing at all.
  bool healthLate(const std::string& process, const DriveTimeline::Silence& silence) const {
    const auto found = drive_.health.find(process);
    if (found == drive_.health.end()) return true;
    const std::vector<HealthNote>& notes = found->second;
    for (size_t i = 1; i < notes.size(); ++i) {
      const bool around = notes[i - 1].time < silence.to && notes[i].time > silence.from;
      const double period = notes[i].time - notes[i - 1].time;
      // It was due within the silence and came when that had ended.
      const double due = notes[i - 1].time + 1.0;
      const bool at_end =
          due > silence.from + 0.02 && due < silence.to - 0.06 && notes[i].time > silence.to - 0.06;
      if (around && (period > kHealthLate || at_end)) return true;
    }
    // A short one may lie between two of them: what else says the process?
    return silence.length() < 1.0 && !dueWithin(notes, silence) && !deviceComplains(process);
  }
  static bool dueWithin(const std::vector<HealthNote>& notes,
                        const DriveTimeline::Silence& silence) {
    return std::any_of(notes.begin(), notes.end(), [&](const HealthNote& note) {
      return note.time > silence.from + 0.02 && note.time < silence.to - 0.02;
    });
  }
  bool deviceComplains(const std::string& process) const {
    return drive_.complaintOf(process, t_ - 1.0, t_ + kAfterwards, "byte") != nullptr;
  }

  void lost(const std::string& channel, const std::string& from, const std::string& to) {
    say("lost_" + channel, channel + " was sent by " + from + ", and did not reach " + to +
                               " in time: messages were lost or late between them");
    const HealthNote* const before = drive_.healthAt(to, t_ - 1.0);
    const HealthNote* const after = drive_.healthAt(to, t_ + 3.0);
    if (before == nullptr || after == nullptr || before->boot != after->boot) return;
    prove(after->time, "HEALTH",
          to + formatted(
                   ": since the note before the stop %lld messages lost, %lld late, %lld broken",
                   static_cast<long long>(after->lost - before->lost),
                   static_cast<long long>(after->late - before->late),
                   static_cast<long long>(after->undecodable - before->undecodable)));
  }

  void insStale() {
    if (processFault("ins_driver", "INS", 0.095)) return;
    const auto silence = drive_.silenceOf("INS", t_, 0.095);
    if (!silence)
      return lost("INS", "ins_driver",
                  main_.channel == std::string("PLAN") ? "planner" : "motor_bridge");
    say("ins_device", formatted("the INS gave nothing usable for %.2f s", silence->length()));
    prove(silence->from, "INS", formatted("nothing from here on for %.2f s", silence->length()));
    for (const char* words : {"byte", "no position", "no heading"})
      if (const HealthNote* const note =
              drive_.complaintOf("ins_driver", t_ - 1.0, t_ + kAfterwards, words))
        return prove("ins_driver", *note);
  }

  void insBlind() {
    say("ins_no_fix", "the INS lost its position or heading");
    for (const InsNote& note : drive_.ins)
      if (note.time > t_ - kBefore && note.time < t_ + 1.0 && !note.placed) {
        prove(note.time, "INS", formatted("status %d, no pose", note.status));
        break;
      }
    if (const HealthNote* const note =
            drive_.complaintOf("ins_driver", t_ - 1.0, t_ + kAfterwards, "no "))
      prove("ins_driver", *note);
  }

  void motion() {
    const auto says = [&](const char* words) {
      return main_.reason.find(words) != std::string::npos;
    };
    for (const InsNote& note : drive_.ins)
      if (note.time > t_ - kBefore && note.time < t_ + 0.5 &&
          (note.status & ins_t::STATUS_JUMP) != 0) {
        prove(note.time, "INS", "STATUS_JUMP");
        return say("ins_jump", "the INS jumped: " + main_.reason);
      }
    if (says("jumps")) return say("ins_jump", "the INS jumped: " + main_.reason);
    if (says("frozen") && frozen())
      return say("ins_frozen", "the INS repeated one pose while the robot moved: " + main_.reason);
    if (says("track dead") || says("tracks blocked") || says("wrong way"))
      return say("drive", "the drive failed: " + main_.reason);
    if (says("frozen")) return say("stuck", "it got stuck: " + main_.reason);
    say("ins_drift", "the pose moved in a way that the commands do not explain: " + main_.reason);
  }

  /// Whether the pose stayed the same to the millimetre for a while.
  bool frozen() {
    double since = t_;
    const InsNote* last = nullptr;
    for (const InsNote& note : drive_.ins) {
      if (note.time > t_ || !note.placed) continue;
      if (last == nullptr || distanceBetween(last->T_map_body, note.T_map_body) > 1e-3)
        since = note.time;
      last = &note;
    }
    if (t_ - since < 0.25) return false;
    prove(since, "INS", formatted("the same pose for %.2f s", t_ - since));
    return true;
  }

  void map() {
    if (processFault("ins_driver", "INS", 0.3)) return;
    if (processFault("lidar_driver", "SCAN", 0.35)) return;
    if (processFault("mapping", "MAP", 0.6)) return;
    if (const auto silence = drive_.silenceOf("SCAN", t_, 0.35)) {
      say("range_finder", formatted("the range finder gave nothing for %.1f s", silence->length()));
      prove(silence->from, "SCAN", formatted("nothing from here on for %.1f s", silence->length()));
      return;
    }
    lost("MAP", "mapping", "planner");
  }

  /// Of the cells that became obstacles shortly before, those about the one nearest to the robot;
  /// whether they went again afterwards.
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
    if (nearest == nullptr) return say("no_way", "no way was free: " + main_.reason);
    int came = 0, went = 0;
    for (const CellNote& cell : drive_.cells) {
      if ((cell.p_map - nearest->p_map).norm() > kObstacleSize) continue;
      if (cell.came && cell.time > t_ - 3.0 && cell.time <= t_ + 0.3) ++came;
      if (!cell.came && cell.time > nearest->time && cell.time < t_ + kGhost) ++went;
    }
    const std::string where = formatted("x %.1f m, y %.1f m, %.1f m from the robot",
                                        nearest->p_map.x(), nearest->p_map.y(), distance(*nearest));
    prove(nearest->time, "MAP",
          formatted("%d cells there became obstacles, %d went again", came, went));
    if (went * 2 >= came)
      return say("ghost", "an obstacle appeared at " + where +
                              ", and went again: something passed, or the range finder saw what "
                              "was not there");
    say("obstacle", "an obstacle came into view at " + where);
  }

  const DriveTimeline& drive_;
  const Incident& incident_;
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

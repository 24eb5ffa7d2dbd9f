// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/planner_inputs.hpp"

#include "tools/lab/replay/robot_replay.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <tuple>

#include "common/drive/log_bus.hpp"
#include "common/drive/robot_log.hpp"
#include "modules/planner/planner_node.hpp"

namespace tread::replay {
namespace {

/// A swapped pair shows in one step, or in a few consecutive ones.
constexpr size_t kNearSteps = 10;

/// Finds inputs by channel, utime and seq.
class InputIndex {
 public:
  InputIndex(const RobotLog& log, const std::vector<PlannerInput>& inputs)
      : log_(log), inputs_(inputs) {
    for (size_t i = 0; i < inputs.size(); ++i) {
      const Receipt& receipt = inputs[i].receipt;
      places_[{receipt.channel, receipt.utime, receipt.seq}].push_back(i);
    }
  }

  /// The newest input named by a program; if ambiguous the nearest in time.
  std::optional<size_t> find(const program_t& program) const {
    const auto found =
        places_.find({program.newest_input, program.newest_input_utime, program.newest_input_seq});
    if (found == places_.end()) return std::nullopt;
    const auto distance = [&](size_t i) {
      return std::abs(log_.events[inputs_[i].event].utime - program.utime);
    };
    return *std::min_element(found->second.begin(), found->second.end(),
                             [&](size_t a, size_t b) { return distance(a) < distance(b); });
  }

 private:
  const RobotLog& log_;
  const std::vector<PlannerInput>& inputs_;
  std::map<std::tuple<std::string, int64_t, int64_t>, std::vector<size_t>> places_;
};

/// A step with a known number of received messages and their end in the log.
struct Known {
  size_t step;
  int64_t offset;  ///< end in the log minus number received: constant while nothing is lost
};

/// Whether the offset returns soon: then nothing was lost.
bool comesBack(const std::vector<Known>& known, size_t from, int64_t offset) {
  const size_t end = std::min(known.size(), from + kNearSteps);
  return std::any_of(known.begin() + static_cast<std::ptrdiff_t>(from),
                     known.begin() + static_cast<std::ptrdiff_t>(end),
                     [offset](const Known& other) { return other.offset == offset; });
}

/// Two messages within microseconds may reach recorder and planner in different order. A step
/// between or just after them is then off by one, later ones are not.
void reorder(Hearing& hearing, const std::vector<Known>& known) {
  int64_t offset = known.empty() ? 0 : known.front().offset;
  for (size_t i = 0; i < known.size(); ++i) {
    const int64_t off = known[i].offset - offset;
    if (off == 0) continue;
    size_t& until = hearing.until[known[i].step];
    if (std::abs(off) > 1 || !comesBack(known, i + 1, offset)) {
      offset = known[i].offset;
      continue;
    }
    if (off > 0 && until < 2) continue;
    if (off < 0) ++until;  // the one after the newest had been received earlier
    std::swap(hearing.inputs[until - 2], hearing.inputs[until - 1]);
    if (off > 0) --until;  // the one before the newest had not been received
    ++hearing.reordered;
  }
}

void countLosses(Hearing& hearing, const std::vector<LoggedStep>& steps,
                 const std::vector<Known>& known) {
  for (size_t i = 0; i < known.size(); ++i) {
    const size_t step = known[i].step;
    const bool first = i == 0;
    const size_t from = first ? hearing.from : hearing.until[known[i - 1].step];
    const int64_t heard = steps[step].program.inputs_heard -
                          (first ? 0 : steps[known[i - 1].step].program.inputs_heard);
    const int64_t held = static_cast<int64_t>(hearing.until[step]) - static_cast<int64_t>(from);
    // Messages received before the log begins are not lost.
    if (heard > held && !(first && from == 0)) hearing.lacking += heard - held;
    if (held > heard) hearing.beyond += held - heard;
  }
}

/// Assigns inputs by time to steps with an unknown newest message, between the known neighbours.
void fillByTime(const RobotLog& log, Hearing& hearing, const std::vector<LoggedStep>& steps,
                const std::vector<bool>& found) {
  size_t limit = hearing.inputs.size();
  std::vector<size_t> limits(steps.size());
  for (size_t i = steps.size(); i-- > 0;) {
    if (found[i]) limit = hearing.until[i];
    limits[i] = limit;
  }
  size_t until = hearing.from;
  for (size_t i = 0; i < steps.size(); ++i) {
    const auto heard = [&](size_t input) {
      return log.events[hearing.inputs[input].event].utime < steps[i].program.utime;
    };
    if (found[i]) until = std::max(until, hearing.until[i]);
    while (!found[i] && until < limits[i] && heard(until)) ++until;
    hearing.until[i] = until;
  }
}

}  // namespace

std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config) {
  // A passive planner, to find out its inputs.
  LogBus bus(0);
  const planner::PlannerNode listener(config, bus);
  std::vector<PlannerInput> inputs;
  for (size_t i = 0; i < log.events.size(); ++i) {
    const int64_t before = bus.statistics().received;
    bus.setNow(log.events[i].utime);
    bus.hear(log.events[i]);
    if (bus.statistics().received > before) inputs.push_back({i, bus.statistics().newest});
  }
  return inputs;
}

Hearing hearingOf(const RobotLog& log, std::vector<PlannerInput> inputs,
                  const std::vector<LoggedStep>& steps) {
  Hearing hearing;
  hearing.inputs = std::move(inputs);
  hearing.until.resize(steps.size());
  const InputIndex index(log, hearing.inputs);
  std::vector<bool> found(steps.size());
  std::vector<Known> known;
  for (size_t i = 0; i < steps.size(); ++i) {
    const program_t& program = steps[i].program;
    if (steps[i].lost) continue;
    found[i] = program.inputs_heard == 0;
    const auto place = found[i] ? std::nullopt : index.find(program);
    if (place) {
      found[i] = true;
      hearing.until[i] = *place + 1;
      const int64_t offset = static_cast<int64_t>(hearing.until[i]) - program.inputs_heard;
      if (known.empty()) hearing.from = static_cast<size_t>(std::max<int64_t>(0, offset));
      known.push_back({i, offset});
    }
    if (!found[i]) ++hearing.by_time;
  }
  reorder(hearing, known);
  countLosses(hearing, steps, known);
  fillByTime(log, hearing, steps, found);
  return hearing;
}

std::string hearingLine(const Hearing& hearing) {
  const size_t end = hearing.until.empty() ? hearing.from : hearing.until.back();
  std::string line = "by its PROGRAMs the planner received " + std::to_string(end - hearing.from) +
                     " messages of the log";
  const auto add = [&line](int64_t count, const std::string& what) {
    if (count > 0) line += "; " + std::to_string(count) + " " + what;
  };
  add(hearing.reordered, "pairs in the other order");
  add(hearing.lacking, "that it received are not in the log");
  add(hearing.beyond, "of the log it did not receive (replayed nevertheless)");
  add(hearing.by_time,
      "steps name a message that is not in the log (their inputs are assigned by time)");
  return line;
}

}  // namespace tread::replay

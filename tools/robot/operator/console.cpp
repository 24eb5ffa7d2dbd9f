// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/console.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "tools/robot/operator/fence_call.hpp"

namespace tread::operators {
namespace {

using Json = nlohmann::json;

constexpr double kPatience = 3.0;  // [s]
constexpr const char* kArming = "arming";
constexpr const char* kDisarming = "disarming";
constexpr const char* kGoing = "goal";
constexpr const char* kStopping = "E-stop";
constexpr const char* kClearing = "clearing the E-stop";
constexpr size_t kMostPast = 30;
/// Calls, ended ones included, after which a page must let go of the robot once.
constexpr size_t kMostCalls = 300;

double finite(const Json& json, const char* key) {
  const double value = json.at(key).get<double>();
  if (!std::isfinite(value) || std::abs(value) > 1e5) throw std::invalid_argument(key);
  return value;
}

GoalRequest goalFrom(const Json& json) {
  GoalRequest request;
  request.T_map_goal = {finite(json, "x"), finite(json, "y"), 0.0};
  if (!json.contains("yaw")) return request;
  request.T_map_goal.yaw = finite(json, "yaw");
  request.yaw_tolerance = 0.35;
  return request;
}

/// Whether the newest MOTOR that a page has shown is recent; a time stamp in the future is invalid.
bool isFresh(const Json& seen, int64_t utime, int64_t longest) {
  if (!seen.is_number_integer()) return false;
  const auto at = seen.get<int64_t>();
  return at > 0 && at <= utime && utime - at <= longest;
}

FenceRequest fenceRequestFrom(const Json& json, const std::string& by) {
  const bool removes = json.at("op") == "remove_fence";
  FenceRequest request{by, removes, {json.at("name").get<std::string>(), false, {}}};
  if (removes) return request;
  std::vector<double> numbers;
  for (const Json& corner : json.at("corners"))
    for (const Json& number : corner) numbers.push_back(number.get<double>());
  request.fence = fenceFrom(request.fence.name, json.value("keep_out", true), numbers);
  return request;
}

}  // namespace

OperatorConsole::OperatorConsole(Bus& bus, std::string operator_name, std::string why) : bus_(bus) {
  requester_.by = operator_name;
  requester_.operator_name = operator_name;
  requester_.why = std::move(why);
}

bool OperatorConsole::runs(const std::string& what) const {
  return std::any_of(calls_.begin(), calls_.end(), [&](const Running& running) {
    return !running.ended && running.what == what;
  });
}

void OperatorConsole::start(const std::string& what, std::unique_ptr<Call> call, bool holds) {
  calls_.push_front({what, std::move(call), holds, false, 0, ""});
}

void OperatorConsole::end(Running& running, int64_t utime, const std::string& why) {
  running.call->letGo(utime);
  running.ended = true;
  running.ended_at = utime;
  if (!why.empty()) running.words = why;
}

std::string OperatorConsole::take(const std::string& text, uint64_t page, int64_t utime) {
  try {
    const Json json = Json::parse(text);
    const auto op = json.at("op").get<std::string>();
    if (takeStop(op, utime)) return "";
    // A page that lags behind shows an outdated robot.
    if (!isFresh(json.at("seen"), utime, kPageLease))
      return "the page's view of the robot is too old to operate it";
    if (page_ != page && page_ != 0) {
      if (utime - alive_ <= kPageLease) return "another page holds the robot";
      letGo(utime, "another page took over");
    }
    page_ = page;
    alive_ = utime;
    if (op == "alive") return "";
    if (calls_.size() + past_.size() >= kMostCalls)
      return "too many commands since this page took the robot: disarm it, then continue";
    if (op == "arm") {
      if (!runs(kArming))
        start(kArming,
              std::make_unique<ArmCall>(bus_, requester_, ArmOptions{true, true, ""}, kPatience),
              true);
    } else if (op == "goal") {
      const GoalRequest request = goalFrom(json);
      for (Running& running : calls_)
        if (!running.ended && running.what == kGoing) end(running, utime, "another goal follows");
      start(kGoing,
            std::make_unique<GoalCall>(bus_, request, requester_.operator_name, bus_.newStation(),
                                       SurfaceNames()),
            true);
    } else if (op == "fence" || op == "remove_fence") {
      start(op == "fence" ? "fence" : "removing a fence",
            std::make_unique<FenceCall>(
                bus_, requester_, fenceRequestFrom(json, requester_.operator_name), kPatience),
            false);
    } else {
      return "no such command: " + op;
    }
    return "";
  } catch (const Json::exception&) {
    return "ignored an unreadable command";
  } catch (const std::invalid_argument& error) {
    return std::string("not taken: ") + error.what();
  }
}

bool OperatorConsole::takeStop(const std::string& op, int64_t utime) {
  if (op == "estop") {
    // A pending opposite request must not win.
    letGo(utime, "stopped");
    for (Running& running : calls_)
      if (!running.ended && running.what == kClearing) end(running, utime, "stopped again");
    if (!runs(kStopping))
      start(kStopping, std::make_unique<StopCall>(bus_, requester_, true, kPatience), false);
  } else if (op == "clear_estop") {
    if (!runs(kStopping) && !runs(kClearing))
      start(kClearing, std::make_unique<StopCall>(bus_, requester_, false, kPatience), false);
  } else if (op == "cancel") {
    letGo(utime, "cancelled", kGoing);
  } else if (op == "disarm") {
    letGo(utime, "disarmed");
    if (!runs(kDisarming))
      start(kDisarming,
            std::make_unique<ArmCall>(bus_, requester_, ArmOptions{false, false, ""}, kPatience),
            false);
  } else {
    return false;
  }
  return true;
}

void OperatorConsole::letGo(int64_t utime, const std::string& why, const std::string& only) {
  for (Running& running : calls_) {
    if (running.ended || !running.holds || (!only.empty() && running.what != only)) continue;
    running.call->cancel(utime);
    end(running, utime, why);
  }
}

void OperatorConsole::leave(uint64_t page, int64_t utime) {
  if (page != page_) return;
  letGo(utime, "the page was closed");
  page_ = 0;
}

void OperatorConsole::step(int64_t utime) {
  // A silent page may no longer show the robot to anybody.
  if (page_ != 0 && utime - alive_ > kPageLease) {
    letGo(utime, "no sign of life from the page: it has released the robot");
    page_ = 0;
  }
  for (Running& running : calls_) {
    if (running.ended) continue;
    const CallResult result = running.call->step(utime);
    // Key hints of a terminal's call mean nothing on a page.
    running.words = result == CallResult::kPending && running.call->holds()
                        ? "armed, and held by this page"
                        : running.call->describe(utime);
    if (result == CallResult::kPending) continue;
    if (result == CallResult::kRefused) running.call->cancel(utime);
    end(running, utime, "");
    if (running.what == kArming)
      letGo(utime, "the robot is no longer held: " + running.words, kGoing);
  }
  for (auto running = calls_.begin(); running != calls_.end();) {
    if (!running->ended || utime - running->ended_at < kShown) {
      ++running;
      continue;
    }
    past_.push_back(std::move(running->call));
    running = calls_.erase(running);
  }
}

bool OperatorConsole::worn() const {
  return past_.size() > kMostPast &&
         std::all_of(calls_.begin(), calls_.end(),
                     [](const Running& running) { return running.ended; });
}

std::string OperatorConsole::words() const {
  std::string stops, others;
  for (const Running& running : calls_) {
    std::string& words = running.what == kStopping || running.what == kClearing ? stops : others;
    words += (words.empty() ? "" : "\n") + running.what + ": " + running.words;
  }
  return stops + (stops.empty() || others.empty() ? "" : "\n") + others;
}

}  // namespace tread::operators

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/desk.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "tools/robot/operator/fence_call.hpp"

namespace tread::operators {
namespace {

using Json = nlohmann::json;

constexpr double kPatience = 3.0;  // [s]
constexpr const char* kArming = "arming";
constexpr const char* kGoing = "goal";

double finite(const Json& json, const char* key) {
  const double value = json.at(key).get<double>();
  if (!std::isfinite(value) || std::abs(value) > 1e5) throw std::invalid_argument(key);
  return value;
}

}  // namespace

OperatorDesk::OperatorDesk(Bus& bus, std::string operator_name, std::string why) : bus_(bus) {
  requester_.by = operator_name;
  requester_.operator_name = operator_name;
  requester_.why = std::move(why);
}

void OperatorDesk::start(const std::string& what, std::unique_ptr<Call> call, bool holds) {
  calls_.push_back({what, std::move(call), holds, false, 0, ""});
}

std::string OperatorDesk::take(const std::string& text, uint64_t page, int64_t utime) {
  try {
    const Json json = Json::parse(text);
    const auto op = json.at("op").get<std::string>();
    if (op == "estop" || op == "clear_estop") {
      start(op == "estop" ? "E-stop" : "clearing the E-stop",
            std::make_unique<StopCall>(bus_, requester_, op == "estop", kPatience), false);
      return "";
    }
    if (op == "cancel") {
      letGo(utime, "cancelled", kGoing);
      return "";
    }
    if (op == "disarm") {
      letGo(utime, "disarmed");
      start("disarming",
            std::make_unique<ArmCall>(bus_, requester_, ArmRequest{false, false, ""}, kPatience),
            false);
      return "";
    }
    const bool lives = page_ != 0 && utime - alive_ < kPageLease;
    if (page_ != page && lives) return "another page holds the robot";
    page_ = page;
    alive_ = utime;
    if (op == "alive") return "";
    if (op == "arm") {
      start(kArming,
            std::make_unique<ArmCall>(bus_, requester_, ArmRequest{true, true, ""}, kPatience),
            true);
    } else if (op == "goal") {
      GoalRequest request;
      request.T_map_goal = {finite(json, "x"), finite(json, "y"), 0.0};
      if (json.contains("yaw")) {
        request.T_map_goal.yaw = finite(json, "yaw");
        request.yaw_tolerance = 0.35;
      }
      for (Running& running : calls_)
        if (!running.ended && running.what == kGoing) {
          running.call->letGo(utime);
          running.ended = true;
          running.ended_at = utime;
          running.words = "another goal follows";
        }
      start(kGoing,
            std::make_unique<GoalCall>(bus_, request, requester_.operator_name, bus_.newStation(),
                                       SurfaceNames()),
            true);
    } else if (op == "fence" || op == "remove_fence") {
      std::vector<double> numbers;
      if (op == "fence")
        for (const Json& corner : json.at("corners"))
          for (const Json& number : corner) numbers.push_back(number.get<double>());
      FenceRequest request{requester_.operator_name,
                           op == "remove_fence",
                           {json.at("name").get<std::string>(), false, {}}};
      if (op == "fence")
        request.fence = fenceFrom(request.fence.name, json.value("keep_out", true), numbers);
      start(op == "fence" ? "fence" : "removing a fence",
            std::make_unique<FenceCall>(bus_, requester_, request, kPatience), false);
    } else {
      return "no such command: " + op;
    }
    return "";
  } catch (const Json::exception&) {
    return "a command that cannot be read was passed over";
  } catch (const std::invalid_argument& error) {
    return std::string("not taken: ") + error.what();
  }
}

void OperatorDesk::letGo(int64_t utime, const std::string& why, const std::string& only) {
  for (Running& running : calls_) {
    if (running.ended || !running.holds || (!only.empty() && running.what != only)) continue;
    running.call->cancel(utime);
    running.call->letGo(utime);
    running.ended = true;
    running.ended_at = utime;
    running.words = why;
  }
}

void OperatorDesk::leave(uint64_t page, int64_t utime) {
  if (page != page_) return;
  letGo(utime, "the page was closed");
  page_ = 0;
}

void OperatorDesk::step(int64_t utime) {
  // Nobody knows whether a silent page still shows the robot to anybody.
  if (page_ != 0 && utime - alive_ > kPageLease) {
    letGo(utime, "the page is silent: it let go of the robot");
    page_ = 0;
  }
  for (Running& running : calls_) {
    if (running.ended) continue;
    const CallResult result = running.call->step(utime);
    running.words = running.call->describe(utime);
    // What a call in a terminal says of its keys is nothing for a page.
    if (running.what == kArming && running.words.rfind("armed and held", 0) == 0)
      running.words = "armed, and held by this page";
    if (result == CallResult::kPending) continue;
    running.call->letGo(utime);
    running.ended = true;
    running.ended_at = utime;
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

std::string OperatorDesk::words(int64_t) const {
  std::string words;
  for (const Running& running : calls_)
    words += (words.empty() ? "" : "\n") + running.what + ": " + running.words;
  return words;
}

}  // namespace tread::operators

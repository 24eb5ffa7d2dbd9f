// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/fence_call.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/messages/fence_messages.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kFenceRepeat = 200'000;  // [us]
constexpr const char* kTakers[] = {"motor_bridge", "planner"};

}  // namespace

FenceCall::FenceCall(Bus& bus, const Requester& requester, FenceRequest request, double patience)
    : bus_(bus),
      beacon_(bus, requester.operator_name),
      request_(std::move(request)),
      patience_(static_cast<int64_t>(patience * 1e6)) {
  request_.by = requester.signature();
  bus.subscribe<fences_t>(kFences, [this](const fences_t& message) {
    const std::vector<Fence> kept = fencesFrom(message);
    const bool in_force = std::any_of(kept.begin(), kept.end(), [this](const Fence& fence) {
      return request_.removes ? fence.name == request_.fence.name : fence == request_.fence;
    });
    // Messages from before the call do not answer it.
    if (started_ && message.utime > beacon_.robotTime(*started_))
      shown_[message.keeper] = in_force != request_.removes;
  });
}

bool FenceCall::shownBy(const std::string& process) const {
  const auto found = shown_.find(process);
  return found != shown_.end() && found->second;
}

CallResult FenceCall::step(int64_t utime) {
  if (!started_) started_ = utime;
  beacon_.step(utime);
  if (shownBy(kTakers[0]) && shownBy(kTakers[1])) return CallResult::kDone;
  if (utime - *started_ > patience_) return CallResult::kRefused;
  if (utime < next_ || (request_.removes && !beacon_.hearsRobot())) return CallResult::kPending;
  next_ = utime + kFenceRepeat;
  fence_t message = toMessage(request_);
  message.utime = beacon_.robotTime(utime);
  message.seq = seq_++;
  bus_.publish(kFence, message);
  return CallResult::kPending;
}

std::string FenceCall::describe(int64_t /*utime*/) const {
  const std::string fence = "fence " + request_.fence.name;
  std::string missing, silent;
  for (const char* process : kTakers) {
    std::string& list = shown_.count(process) == 0 ? silent : missing;
    if (!shownBy(process)) list += (list.empty() ? "" : " and ") + std::string(process);
  }
  if (!silent.empty())
    return "no FENCES from " + silent + ": running on this LCM URL?" + keyWords(bus_);
  if (missing.empty())
    return request_.removes ? "no " + fence + " is in force any more" : fence + " is in force";
  return fence + (request_.removes ? " is still in force in " : " is not in force in ") + missing +
         (request_.removes ? ": only the operator who holds the robot can remove fences, and never "
                             "those of robot.yaml"
                           : ": HEALTH says why it was refused");
}

Fence fenceFrom(const std::string& name, bool keep_out, const std::vector<double>& numbers) {
  Fence fence{name, keep_out, {}};
  if (numbers.size() % 2 != 0)
    throw std::invalid_argument("corners are pairs of x and y [m]: one number is missing");
  for (size_t i = 0; i + 1 < numbers.size(); i += 2)
    fence.corners.emplace_back(numbers[i], numbers[i + 1]);
  const std::string fault = faultOf(fence);
  if (!fault.empty()) throw std::invalid_argument("fence " + name + ": " + fault);
  return fence;
}

}  // namespace tread::operators

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/direct_robot.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

namespace tread::setup {
namespace {

constexpr int64_t kExchange = 10'000;      // [us] between reads of both lines
constexpr int64_t kCommandEvery = 50'000;  // [us]
constexpr int64_t kPatience = 5'000'000;   // [us] for both to start up
constexpr size_t kFewFixes = 10;

std::unique_ptr<Link> openLine(Site& site, const std::string& address) {
  std::unique_ptr<Link> link = site.open(address);
  for (int i = 0; i < 20 && !link->isOpen() && !link->reopen(site.now()); ++i) site.pass(50'000);
  if (!link->isOpen()) throw std::runtime_error(address + ": cannot be opened: " + link->problem());
  return link;
}

template <class Take>
void readLine(Link& link, const Take& take) {
  std::array<uint8_t, 4096> buffer;
  for (int i = 0; i < 16; ++i) {
    const auto size = link.read(buffer.data(), buffer.size());
    if (size.value_or(0) == 0) return;
    take(std::string_view(reinterpret_cast<const char*>(buffer.data()), *size));
  }
}

}  // namespace

DirectRobot::DirectRobot(Site& site, const Drivers& drivers)
    : site_(site),
      full_command_(drivers.full_command),
      full_second_(drivers.isCar() ? drivers.full_steering : drivers.full_command),
      motor_link_(openLine(site, drivers.motor_address)),
      ins_link_(openLine(site, drivers.ins_address)),
      controller_(drivers.make_motor()),
      ins_(drivers.make_ins(std::nullopt)) {
  controller_->open();
}

DirectRobot::~DirectRobot() {
  const std::string zeros = controller_->zeros(3);
  motor_link_->write(reinterpret_cast<const uint8_t*>(zeros.data()), zeros.size());
}

void DirectRobot::exchange() {
  const int64_t now = site_.now();
  if (motor_link_->isOpen() || motor_link_->reopen(now)) {
    readLine(*motor_link_, [&](std::string_view bytes) { controller_->receive(bytes, now); });
    const std::string bytes = silent_ ? std::string() : controller_->poll(now);
    if (!bytes.empty())
      motor_link_->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  }
  if (!ins_link_->isOpen() && !ins_link_->reopen(now)) return;
  readLine(*ins_link_, [&](std::string_view bytes) { ins_->push(bytes, now); });
  while (const auto estimate = ins_->next(now)) {
    const auto missing = InsStatus::kNoPosition | InsStatus::kNoHeading | InsStatus::kJump;
    if ((estimate->status & missing) != 0) continue;
    attitude_ = yawPitchRoll(estimate->R_map_body);
    const Pose2 pose{estimate->p_map_body.x(), estimate->p_map_body.y(), attitude_.yaw};
    if (!std::isfinite(pose.x + pose.y + pose.yaw)) continue;
    fixes_.push_back({estimate->utime, pose});
  }
}

std::string DirectRobot::begin() {
  for (const int64_t end = site_.now() + kPatience; site_.now() < end; site_.pass(kExchange)) {
    exchange();
    if (fault().empty() && fixes_.size() > kFewFixes) return "";
  }
  if (!fault().empty()) return fault();
  return "the INS has no position with a heading; look at its fix";
}

std::string DirectRobot::fault() const {
  const motor::DeviceReport report = controller_->report(site_.now());
  if (report.stop_latched) return "the controller holds an emergency stop: release it";
  const std::string& words = report.link_fault.empty() ? report.device_fault : report.link_fault;
  return words.empty() ? "" : "motor controller: " + words;
}

std::string DirectRobot::run(double seconds, const Choose& choose,
                             const std::function<bool()>& ended) {
  int64_t next = site_.now();
  const int64_t end = next + std::llround(seconds * 1e6);
  for (; site_.now() < end && !(ended && ended()); site_.pass(kExchange)) {
    const int64_t now = site_.now();
    if (now >= next) {
      next += kCommandEvery;
      const auto shares = choose(now);
      silent_ = !shares;
      if (shares) {
        commands_.push_back({now, *shares});
        controller_->command({full_command_ * shares->left, full_second_ * shares->right}, now);
      }
    }
    exchange();
    if (silent_) continue;
    const std::string words = fault();
    if (words.empty()) continue;
    commands_.push_back({site_.now(), {}});  // a reconnected controller gets zero first
    return words;
  }
  silent_ = false;
  return "";
}

std::optional<Pose2> DirectRobot::takePose() {
  if (taken_ == fixes_.size()) return std::nullopt;
  taken_ = fixes_.size();
  return fixes_.back().T_map_body;
}

}  // namespace tread::setup

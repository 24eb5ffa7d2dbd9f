// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/channels.hpp"
#include "tests/system/own_bus.hpp"

namespace tread::testing {

/// The operator's bus, joined with the robot's by a radio that can be cut: no message gets through
/// then, either way.
class Radio {
 public:
  explicit Radio(const std::string& robot_url)
      : url_(ownLcmUrl()),
        robot_(robot_url),
        station_(url_),
        down_{*this, station_},
        up_{*this, robot_},
        thread_([this] { run(); }) {}
  ~Radio() {
    stop_ = true;
    thread_.join();
  }
  Radio(const Radio&) = delete;
  Radio& operator=(const Radio&) = delete;

  /// The operator's.
  const std::string& url() const { return url_; }
  void cut(bool cut) { cut_ = cut; }

 private:
  /// One direction. What it says is not heard back: the channels of the two differ.
  struct Direction {
    Radio& radio;
    lcm::LCM& to;
    void pass(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      if (!radio.cut_) to.publish(channel, buffer->data, buffer->data_size);
    }
  };
  void run() {
    for (const ChannelSpec& spec : {ChannelSpec(kMotor), ChannelSpec(kPlan), ChannelSpec(kHealth),
                                    ChannelSpec(kIns), ChannelSpec(kExecution)})
      robot_.subscribe(spec.name, &Direction::pass, &down_);
    for (const ChannelSpec& spec : {ChannelSpec(kOperator), ChannelSpec(kGoal), ChannelSpec(kArm),
                                    ChannelSpec(kEstop), ChannelSpec(kMark)})
      station_.subscribe(spec.name, &Direction::pass, &up_);
    while (!stop_) {
      robot_.handleTimeout(1);
      station_.handleTimeout(1);
    }
  }

  std::string url_;
  lcm::LCM robot_;
  lcm::LCM station_;
  Direction down_;
  Direction up_;
  std::atomic<bool> cut_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace tread::testing

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "modules/lidar_driver/core/range_scan.hpp"

namespace tread::lidar::testkit {

/// An emulated scanner and the driver's session on one line, stepped each millisecond, with a sweep
/// each 100 ms.
template <class Session, class Device, class Scan>
struct DeviceLine {
  using Sweep = Scan (*)(int64_t finished);

  template <class... OfDevice>
  DeviceLine(Session made, Sweep a_sweep, OfDevice&&... of_device)
      : session(std::move(made)), device(std::forward<OfDevice>(of_device)...), sweep_of(a_sweep) {
    session.open(now);
  }

  std::vector<RangeScan> run(int milliseconds) {
    std::vector<RangeScan> scans;
    for (int i = 0; i < milliseconds; ++i) {
      now += 1000;
      if (now % 100'000 == 0) device.add(sweep_of(now));
      device.receive(session.poll(now), now);
      session.receive(device.transmit(now), now + delay);
      for (RangeScan& scan : session.take(now)) scans.push_back(std::move(scan));
    }
    return scans;
  }

  /// Feeds random bytes, and valid ones with changes, in steps of `step` [us]; a sweep ends
  /// `sweep_age` [us] before each. `look` is called with every resulting scan.
  template <class Look>
  void mistreat(int bytes_to_feed, unsigned seed, int64_t step, int64_t sweep_age, Look look) {
    std::mt19937 random(seed);
    for (int fed = 0; fed < bytes_to_feed;) {
      now += step;
      device.add(sweep_of(now - sweep_age));
      device.receive(session.poll(now), now);
      std::string bytes = device.transmit(now);
      if (bytes.empty()) bytes.resize(1 + random() % 2000);
      for (auto i = 2 + random() % 20; i > 0; --i)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (random() % 8 == 0)
        for (char& byte : bytes) byte = static_cast<char>(random());
      fed += static_cast<int>(bytes.size());
      session.receive(bytes, now);
      for (const RangeScan& scan : session.take(now)) look(scan);
      if (session.lost()) session.open(now);
    }
  }

  int64_t counted(const std::string& what) const {
    const auto found = session.counters().find(what);
    return found == session.counters().end() ? 0 : found->second;
  }

  int64_t now = 1'000'000;
  int64_t delay = 0;  ///< [us] of the device's output
  Session session;
  Device device;
  Sweep sweep_of;
};

}  // namespace tread::lidar::testkit

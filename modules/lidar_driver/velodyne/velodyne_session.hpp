// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/capture/pcap_stream.hpp"
#include "common/config/config_reader.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"
#include "modules/lidar_driver/core/tick_clock.hpp"
#include "modules/lidar_driver/velodyne/velodyne_packet.hpp"

namespace tread::lidar {

/// Configuration of a Velodyne VLP-16, Puck LITE or Puck Hi-Res.
struct VelodyneConfig {
  int64_t packets = 19;    ///< of 1.33 ms in one slice of points: 40 slices a second
  int64_t every = 2;       ///< n-th firing is kept; 19 packets and 2: 3648 points, 44 kB a slice
  double latency = 0.002;  ///< [s] shortest delay from a packet's last firing to its arrival
};

/// Reads the section `velodyne`; throws ConfigError with file:line, also for slices too large to
/// send.
VelodyneConfig readVelodyneConfig(ConfigReader& reader);

/// A Velodyne that sends UDP packets, or a capture of them, as slices of points.
/** It needs no commands. Packets have the device's own time, mapped to the host's clock by the
 * shortest delay; a lost packet ends a slice, so that a point's index gives its time. A capture is
 * played once, at its own pace. The library's driver is not used: it opens a socket of its own,
 * stamps scans with the host's clock until the first position packet and with the device's date
 * afterwards, has no state for the end of a capture, and cannot run in virtual time. */
class VelodyneSession final : public ScanDevice {
 public:
  explicit VelodyneSession(const VelodyneConfig& config) : config_(config) {}

  void open(int64_t now) override;
  void close() override;
  void receive(std::string_view bytes, int64_t now) override;
  std::string poll(int64_t now) override;
  std::vector<RangeScan> take(int64_t now) override;
  bool hungry() const override { return waiting_.size() < kAhead; }
  std::string shortcomings() const override {
    return "Velodyne: checksums (a packet has none), free space (a beam without a return marks "
           "nothing); reflectivity, first and strongest of two returns are not read";
  }

 private:
  static constexpr size_t kAhead = 50;

  /// Extracts packets from the bytes of a network line, whose datagrams need not arrive one by one.
  void receiveLive(std::string_view bytes, int64_t now);
  void receiveCapture(std::string_view bytes, int64_t now);
  void refuseOfCapture(int64_t now);
  void takePacket(std::string_view bytes, int64_t arrival);
  /// Host time [us] of a device time that arrived now.
  int64_t hostTime(uint32_t past_hour, int64_t arrival);
  void append(const VelodynePacket& packet);
  void finishSlice();
  void forget();

  VelodyneConfig config_;
  std::string buffer_;
  std::optional<PcapStream> capture_;
  bool capture_refused_ = false;
  std::deque<CapturedPayload> waiting_;    ///< of a capture, with the times at which they are due
  std::optional<int64_t> capture_offset_;  ///< [us] from the capture's clock to the host's
  TickClock clock_;
  std::optional<uint32_t> last_past_hour_;  ///< [us]
  uint32_t hours_ = 0;                      ///< [us] of full hours, wraps with the clock's counter
  RangeScan slice_;
  int64_t packets_ = 0;      ///< in the slice
  int64_t end_ = 0;          ///< [us] where the slice's last packet ends
  size_t firing_ = 0;        ///< number of the next one, for keeping every n-th
  int64_t last_packet_ = 0;  ///< [us] of the last good one
  int64_t opened_at_ = 0;
  bool open_ = false;
  std::vector<RangeScan> scans_;
};

}  // namespace tread::lidar

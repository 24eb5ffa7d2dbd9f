// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/hokuyo/hokuyo_source.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>

#include <mrpt/comms/CClientTCPSocket.h>
#include <mrpt/hwdrivers/CHokuyoURG.h>

#include "common/bus/host_clock.hpp"

namespace tread::lidar {
namespace {

constexpr const char* kWhichPort = "is this the range finder's port?";

void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// The library's class with its device parameters made visible, its clock off and its talk
/// silenced.
class Device : public mrpt::hwdrivers::CHokuyoURG {
 public:
  Device(const std::string& host, unsigned int port) {
    setIPandPort(host, port);
    m_disable_firmware_timestamp = true;
    logging_enable_console_output = false;
  }
  /// The library's destructor speaks to the device and waits for ever where it is gone: without a
  /// stream and an address it has nobody to speak to.
  ~Device() override {
    m_ip_dir.clear();
    m_stream.reset();
  }
  /// The library would connect again by itself, without a probe.
  bool isConnected() const {
    const auto socket = std::dynamic_pointer_cast<mrpt::comms::CClientTCPSocket>(m_stream);
    return socket && socket->isConnected();
  }
  ScipGeometry geometry() const {
    return {m_sensor_info.scan_first, m_sensor_info.scan_last, m_sensor_info.scan_front,
            m_sensor_info.scans_per_360deg};
  }
  double rangeMin() const { return m_sensor_info.d_min; }
  double rangeMax() const { return m_sensor_info.d_max; }
  double turnSeconds() const {
    return m_sensor_info.motor_speed_rpm > 0 ? 60.0 / m_sensor_info.motor_speed_rpm : 0.1;
  }
};

}  // namespace

class HokuyoSource::Worker {
 public:
  Worker(const std::string& address, double latency)
      : address_(parseLinkAddress(address)),
        latency_us_(static_cast<int64_t>(latency * 1e6)),
        alive_(hostNow()) {}

  static std::shared_ptr<Worker> start(const std::string& address, double latency) {
    const auto worker = std::make_shared<Worker>(address, latency);
    worker->thread_ = std::thread([worker] {
      worker->run();
      worker->ended_ = true;
    });
    return worker;
  }
  /// A thread that is stuck inside the library cannot be joined: it keeps the worker, until the
  /// process ends. False then.
  bool end() {
    constexpr int kPatience = 300;  // [10 ms]
    stop_ = true;
    if (!thread_.joinable()) return ended_;
    for (int i = 0; i < kPatience && !ended_; ++i) pause(10);
    if (!ended_) {
      thread_.detach();
      return false;
    }
    thread_.join();
    return true;
  }

  std::vector<RangeScan> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::move(scans_);
  }
  Reason reason(int64_t now) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return reasons_.best(now);
  }
  double secondsSinceAlive() const { return static_cast<double>(hostNow() - alive_) * 1e-6; }

 private:
  void run() {
    while (!stop_) {
      alive_ = hostNow();
      if (answersScip()) drive();
      for (int i = 0; i < 5 && !stop_; ++i) pause(100);
    }
  }

  /// One command of our own: is there a SCIP device at all, and does it keep the connection?
  bool answersScip() {
    const std::unique_ptr<Link> link = makeLink(address_.text);
    std::string heard;
    bool asked = false;
    for (int i = 0; i < 100 && !stop_; ++i, pause(10)) {
      if (!link->isOpen()) {
        if (asked) break;
        link->reopen(hostNow());
        continue;
      }
      if (!asked) asked = link->write(reinterpret_cast<const uint8_t*>("QT\n"), 3);
      uint8_t buffer[256];
      const auto size = link->read(buffer, sizeof buffer);
      if (!size) break;
      heard.append(reinterpret_cast<const char*>(buffer), *size);
      if (const auto status = statusIn(heard)) return isGood(*status);
    }
    if (!asked)
      note(Rank::kSilent, "cannot connect: " + link->problem());
    else if (heard.empty())
      note(Rank::kSilent, "connected, but it does not answer SCIP 2.0", kWhichPort);
    else
      note(Rank::kUnreadable, "connected, but it does not answer SCIP 2.0: answers of another kind",
           kWhichPort);
    return false;
  }

  /// What the device answers to the command: two characters, and in SCIP 2.0 their sum.
  static std::optional<std::string> statusIn(const std::string& heard) {
    const size_t echo = heard.find("QT\n");
    if (echo == std::string::npos) return std::nullopt;
    const size_t end = heard.find('\n', echo + 3);
    if (end == std::string::npos) return std::nullopt;
    std::string status = heard.substr(echo + 3, std::min<size_t>(2, end - echo - 3));
    for (char& letter : status)
      if (letter < ' ' || letter > '~') letter = '?';
    return status;
  }

  bool isGood(const std::string& status) {
    if (status == "00") return true;
    note(Rank::kRefused, "the device refuses commands of SCIP 2.0, status '" + status + "' to QT",
         "does its firmware speak SCIP 2.0? Its manual lists the status");
    return false;
  }

  void drive() {
    try {
      Device device(address_.host, address_.port);
      // Private in the class itself, public in its base.
      static_cast<mrpt::hwdrivers::CGenericSensor&>(device).initialize();
      const ScipGeometry geometry = device.geometry();
      if (const auto wrong = geometry.problem()) return note(Rank::kRefused, *wrong);
      last_scan_ = hostNow();  // silence counts from here, whatever was before
      while (!stop_) {
        alive_ = hostNow();
        if (!device.isConnected() || !readScan(device, geometry))
          return note(Rank::kSilent, "the device stopped answering; connecting again");
      }
    } catch (const std::exception&) {
      // Its words are for programmers.
      note(Rank::kSilent, "the library gave up the connection; connecting again");
    }
  }

  /// False if the device is lost: it reports an error, or has been silent for a second.
  bool readScan(Device& device, const ScipGeometry& geometry) {
    bool there_is_one = false;
    bool hardware_error = false;
    mrpt::obs::CObservation2DRangeScan observation;
    device.doProcessSimple(there_is_one, observation, hardware_error);
    if (!there_is_one) return !hardware_error && hostNow() - last_scan_ <= 1'000'000;
    last_scan_ = hostNow();
    RangeScan scan;
    scan.duration_us = static_cast<int64_t>(geometry.shareOfTurn() * device.turnSeconds() * 1e6);
    scan.utime = last_scan_ - latency_us_ - scan.duration_us;
    scan.angle_first = geometry.angleFirst();
    scan.angle_step = geometry.angleStep();
    scan.range_min = device.rangeMin();
    scan.range_max = device.rangeMax();
    const size_t beams = observation.getScanSize();
    if (beams != static_cast<size_t>(geometry.last_step - geometry.first_step + 1)) {
      note(Rank::kRefused,
           "a scan has " + std::to_string(beams) + " beams, not what AMIN and AMAX say");
      return true;
    }
    for (size_t i = 0; i < beams; ++i) scan.ranges.push_back(observation.getScanRange(i));
    const std::lock_guard<std::mutex> lock(mutex_);
    // A node that does not fetch must not fill the memory.
    if (scans_.size() < 100) scans_.push_back(std::move(scan));
    reasons_.clear();
    return true;
  }

  void note(Rank rank, const std::string& what, const std::string& remedy = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    reasons_.note(rank, what, hostNow(), 1, remedy);
  }

  LinkAddress address_;
  int64_t latency_us_;
  int64_t last_scan_ = 0;
  std::atomic<int64_t> alive_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> ended_{false};
  mutable std::mutex mutex_;
  std::vector<RangeScan> scans_;
  Reasons reasons_;
  std::thread thread_;
};

HokuyoSource::HokuyoSource(const std::string& address, double latency)
    : worker_(Worker::start(address, latency)) {}
HokuyoSource::~HokuyoSource() {
  end();
}
bool HokuyoSource::end() {
  return worker_->end();
}
std::vector<RangeScan> HokuyoSource::take(int64_t /*utime*/) {
  return worker_->take();
}
Reason HokuyoSource::reason(int64_t utime, bool /*ground*/) const {
  return worker_->reason(utime);
}
double HokuyoSource::stuckFor() const {
  return worker_->secondsSinceAlive();
}

}  // namespace tread::lidar

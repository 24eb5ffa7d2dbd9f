// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/xsens/xsens_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <Eigen/Geometry>

namespace tread::sim {
namespace {

constexpr int64_t kPvtEvery = 250'000;  // [us]

/// Data of a message, high byte first.
class MtData {
 public:
  void begin(uint16_t id, uint8_t length) {
    whole(id, 2);
    whole(length, 1);
  }
  void whole(uint64_t number, unsigned bytes) {
    while (bytes-- > 0) data_.push_back(static_cast<char>(number >> 8U * bytes & 0xFFU));
  }
  void single(double number) {
    const auto narrow = static_cast<float>(number);
    uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    whole(bits, 4);
  }
  /// Fixed point with 16 bits before and 32 after the point, the latter first.
  void fixed(double number) {
    const auto scaled = static_cast<uint64_t>(std::llround(std::ldexp(number, 32)));
    whole(scaled & 0xFFFFFFFFU, 4);
    whole(scaled >> 32U & 0xFFFFU, 2);
  }
  const std::string& str() const { return data_; }

 private:
  std::string data_;
};

std::string messageOf(const std::string& data) {
  std::string message("\xFA\xFF\x36", 3);
  if (data.size() < 0xFF) {
    message.push_back(static_cast<char>(data.size()));
  } else {
    message.push_back('\xFF');
    message.push_back(static_cast<char>(data.size() >> 8U));
    message.push_back(static_cast<char>(data.size() & 0xFFU));
  }
  message += data;
  unsigned sum = 0;
  for (size_t i = 1; i < message.size(); ++i) sum += static_cast<unsigned char>(message[i]);
  message.push_back(static_cast<char>(0x100U - (sum & 0xFFU)));
  return message;
}

std::tm calendar(int64_t utc) {
  const std::time_t seconds = utc / 1'000'000;
  std::tm date{};
  ::gmtime_r(&seconds, &date);
  return date;
}

void putDate(const std::tm& date, MtData& m) {
  m.whole(static_cast<unsigned>(date.tm_year + 1900), 2);
  for (const int part : {date.tm_mon + 1, date.tm_mday, date.tm_hour, date.tm_min, date.tm_sec})
    m.whole(static_cast<unsigned>(part), 1);
}

/// GnssPvtData, as far as a receiver with a fix fills it; 94 bytes.
void putPvt(const EarthFix& fix, MtData& m) {
  const auto thousandths = [&m](double number) {
    m.whole(static_cast<uint32_t>(static_cast<int32_t>(std::lround(number * 1e3))), 4);
  };
  const auto degrees = [&m](double number, double unit) {
    m.whole(static_cast<uint32_t>(static_cast<int32_t>(std::lround(number / unit))), 4);
  };
  m.begin(0x7010, 94);
  m.whole(static_cast<uint64_t>(fix.gps / 1000 % 604'800'000), 4);
  putDate(calendar(fix.utc), m);
  m.whole(7, 1);
  m.whole(30, 4);
  m.whole(static_cast<uint64_t>(fix.utc % 1'000'000 * 1000), 4);
  m.whole(3, 1);
  m.whole(1, 1);
  m.whole(17, 1);
  m.whole(0, 1);
  degrees(fix.longitude, 1e-7);
  degrees(fix.latitude, 1e-7);
  thousandths(fix.height);
  thousandths(fix.height);
  for (const double accuracy : {0.014, 0.02}) thousandths(accuracy);
  for (const double v : {fix.north, fix.east, 0.0, std::hypot(fix.north, fix.east)}) thousandths(v);
  degrees(std::atan2(fix.east, fix.north) * 180.0 / kPi, 1e-5);
  thousandths(0.03);
  for (int i = 0; i < 2; ++i) degrees(0.5, 1e-5);
  for (int i = 0; i < 7; ++i) m.whole(100, 2);
}

}  // namespace

void XsensEmulator::say(const InsMeasurement& sample, const EarthFix& fix, bool valid) {
  MtData m;
  const std::tm date = calendar(fix.utc);
  m.begin(0x1010, 12);
  m.whole(static_cast<uint64_t>(fix.utc % 1'000'000 * 1000), 4);
  putDate(date, m);
  m.whole(valid ? 7 : 0, 1);
  m.begin(0x1060, 4);
  m.whole(static_cast<uint64_t>(sample.utime - std::max<int64_t>(started(), 0)) / 100, 4);
  const double yaw = kPi / 2.0 - fix.azimuth * kPi / 180.0;
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(sample.pitch, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(sample.roll, Eigen::Vector3d::UnitX());
  m.begin(0x2010, 16);
  for (const double part : {turn.w(), turn.x(), turn.y(), turn.z()}) m.single(part);
  m.begin(0x8020, 12);
  for (int i = 0; i < 3; ++i) m.single(sample.rate_body[i]);
  m.begin(0x5042, 12);
  for (const double angle : {fix.latitude, fix.longitude}) m.fixed(valid ? angle : 0.0);
  m.begin(0x5022, 6);
  m.fixed(valid ? fix.height : 0.0);
  m.begin(0xD012, 18);
  for (const double v : {fix.east, fix.north, sample.v_body.z()}) m.fixed(valid ? v : 0.0);
  if (valid && sample.utime - last_pvt_ >= kPvtEvery) {
    putPvt(fix, m);
    last_pvt_ = sample.utime;
  }
  m.begin(0xE020, 4);
  m.whole(valid ? 0x01800007U : 0x00000003U, 4);
  send(messageOf(m.str()));
}

}  // namespace tread::sim

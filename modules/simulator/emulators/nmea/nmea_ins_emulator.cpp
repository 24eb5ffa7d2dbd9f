// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"

#include <cmath>
#include <ctime>
#include <utility>

#include "common/report/text.hpp"

namespace tread::sim {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kKnot = 1852.0 / 3600.0;  // [m/s]

/// Degrees and minutes in NMEA format, 8 decimals of a minute (0.02 mm), with the hemisphere.
std::string angle(double degrees, int digits, char positive, char negative) {
  constexpr int64_t kPerMinute = 100000000;
  const int64_t parts = std::llround(std::abs(degrees) * 60.0 * static_cast<double>(kPerMinute));
  const int64_t minutes = parts / kPerMinute;
  return formatted("%0*lld%02lld.%08lld,%c", digits, static_cast<long long>(minutes / 60),
                   static_cast<long long>(minutes % 60), static_cast<long long>(parts % kPerMinute),
                   degrees < 0.0 ? negative : positive);
}

/// Clockwise angle in [0, 360) degrees, rounded to three decimals so that 360.000 is never printed.
double compass(double radians_clockwise) {
  const double degrees = std::remainder(radians_clockwise / kDegree, 360.0);
  const double rounded = std::round((degrees < 0.0 ? degrees + 360.0 : degrees) * 1000.0) / 1000.0;
  return rounded >= 360.0 ? 0.0 : rounded;
}

bool due(int64_t n, int every) {
  return every > 0 && n % every == 0;
}

}  // namespace

/// A measurement in NMEA's terms.
struct NmeaInsEmulator::Fix {
  std::string time;  ///< hhmmss.sss
  std::tm utc{};
  std::string latitude;   ///< with hemisphere
  std::string longitude;  ///< with hemisphere
  double altitude = 0.0;  ///< above the geoid [m]
  double heading = 0.0;   ///< [deg]
  double course = 0.0;    ///< of the motion over ground [deg]
  double speed = 0.0;     ///< over ground [m/s]
};

NmeaInsEmulator::NmeaInsEmulator(const NmeaInsSettings& settings, uint64_t seed)
    : settings_(settings),
      map_(settings.origin_latitude, settings.origin_longitude, settings.origin_height),
      random_(seed) {}

NmeaInsEmulator::Fix NmeaInsEmulator::fixOf(const InsMeasurement& sample) const {
  Fix fix;
  const int64_t milliseconds = (settings_.utc_at_zero + sample.utime + 500) / 1000;
  const std::time_t seconds = milliseconds / 1000;
  gmtime_r(&seconds, &fix.utc);
  fix.time = formatted("%02d%02d%02d.%03d", fix.utc.tm_hour, fix.utc.tm_min, fix.utc.tm_sec,
                       static_cast<int>(milliseconds % 1000));
  double latitude = 0.0, longitude = 0.0, height = 0.0;
  map_.Reverse(sample.p_map.x(), sample.p_map.y(), sample.p_map.z(), latitude, longitude, height);
  fix.latitude = angle(latitude, 2, 'N', 'S');
  fix.longitude = angle(longitude, 3, 'E', 'W');
  fix.altitude = height - settings_.geoid_separation;
  fix.heading = compass(kPi / 2.0 - sample.yaw);
  const double direction = sample.yaw + std::atan2(sample.v_body.y(), sample.v_body.x());
  fix.course = compass(kPi / 2.0 - direction);
  fix.speed = std::hypot(sample.v_body.x(), sample.v_body.y());
  return fix;
}

void NmeaInsEmulator::add(const InsMeasurement& sample) {
  const int64_t n = count_++;
  if (faults_.silent) return;
  const Fix fix = fixOf(sample);
  sayPlace(n, fix);
  sayMotion(n, fix, sample);
}

void NmeaInsEmulator::sayPlace(int64_t n, const Fix& fix) {
  const bool valid = !faults_.no_fix;
  const char* time = fix.time.c_str();
  const std::string place = fix.latitude + "," + fix.longitude;
  if (due(n, settings_.rates.zda))
    say(formatted("GPZDA,%s,%02d,%02d,%04d,00,00", time, fix.utc.tm_mday, fix.utc.tm_mon + 1,
                  fix.utc.tm_year + 1900));
  if (due(n, settings_.rates.rmc)) {
    const std::string date =
        formatted("%02d%02d%02d", fix.utc.tm_mday, fix.utc.tm_mon + 1, fix.utc.tm_year % 100);
    say(valid ? formatted("GPRMC,%s,A,%s,%.3f,%.3f,%s,,,R", time, place.c_str(), fix.speed / kKnot,
                          fix.course, date.c_str())
              : formatted("GPRMC,%s,V,,,,,,,%s,,,N", time, date.c_str()));
  }
  if (due(n, settings_.rates.gga)) {
    say(valid ? formatted("GPGGA,%s,%s,4,14,0.7,%.4f,M,%.3f,M,1.0,0001", time, place.c_str(),
                          fix.altitude, settings_.geoid_separation)
              : formatted("GPGGA,%s,,,,,0,00,,,M,,M,,", time));
  }
}

void NmeaInsEmulator::sayMotion(int64_t n, const Fix& fix, const InsMeasurement& sample) {
  const bool valid = !faults_.no_fix;
  if (due(n, settings_.rates.vtg)) {
    say(valid ? formatted("GPVTG,%.3f,T,,M,%.4f,N,%.4f,K,D", fix.course, fix.speed / kKnot,
                          fix.speed * 3.6)
              : std::string("GPVTG,,T,,M,,N,,K,N"));
  }
  if (due(n, settings_.rates.hdt))
    say(faults_.no_heading ? std::string("GPHDT,,T") : formatted("GPHDT,%.3f,T", fix.heading));
  if (due(n, settings_.rates.pashr) && !faults_.no_heading) {
    say(formatted("PASHR,%s,%07.3f,T,%+07.3f,%+07.3f,%+06.2f,0.060,0.060,0.060,%d,0",
                  fix.time.c_str(), fix.heading, sample.roll / kDegree, -sample.pitch / kDegree,
                  0.0, valid ? 1 : 0));
  }
  if (due(n, settings_.rates.rot)) {
    // Rate of the heading, even if the device is upside down.
    const double rate = std::cos(sample.roll) < 0.0 ? -sample.rate_body.z() : sample.rate_body.z();
    say(formatted("GPROT,%.3f,A", -rate / kDegree * 60.0));
  }
}

void NmeaInsEmulator::say(const std::string& body) {
  unsigned sum = 0;
  for (char c : body) sum ^= static_cast<unsigned char>(c);
  std::string line = "$" + body + formatted("*%02X", sum);
  if (faults_.garbage_share > 0.0 && chance() < faults_.garbage_share) {
    const size_t length = random_() % 40 + 1;
    for (size_t i = 0; i < length; ++i) out_ += static_cast<char>(random_() % 256);
  }
  if (faults_.corrupt_share > 0.0 && chance() < faults_.corrupt_share) {
    const size_t at = 1 + random_() % (line.size() - 1);
    line[at] = line[at] == '7' ? '8' : '7';
  }
  if (faults_.cut_share > 0.0 && chance() < faults_.cut_share) {
    out_ += line.substr(0, 1 + random_() % (line.size() - 1));
    return;
  }
  out_ += line + "\r\n";
}

double NmeaInsEmulator::chance() {
  return static_cast<double>(random_() >> 11) * 0x1.0p-53;
}

std::string NmeaInsEmulator::transmit(int64_t /*utime*/) {
  return std::exchange(out_, {});
}

}  // namespace tread::sim

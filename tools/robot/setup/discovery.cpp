// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/discovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>

#include "common/link/make_link.hpp"
#include "common/report/text.hpp"
#include "common/store/store.hpp"
#include "modules/lidar_driver/scan_devices.hpp"

namespace tread::setup {
namespace {

using Kind = LinkAddress::Kind;

constexpr int64_t kLookEvery = 5'000;   // [us]
constexpr int64_t kListen = 1'200'000;  // [us] for an INS
constexpr int64_t kAnswer = 700'000;    // [us] for a controller's start-up
constexpr int64_t kScan = 3'000'000;    // [us] for two scans
constexpr double kHokuyoRange = 15.0;   // [m]
constexpr double kLeastInsRate = 5.0;   // [Hz]
constexpr int kRates[] = {115200, 460800, 38400, 9600, 57600, 230400, 921600};

/// Whether such an INS reports ellipsoidal heights, so that its configuration needs the geoid's
/// height.
bool tellsEllipsoidHeight(const std::string& kind) {
  return kind == "vectornav" || kind == "xsens";
}

/// Bytes that are available now.
std::string received(Link& link) {
  std::string bytes;
  std::array<uint8_t, 4096> buffer;
  while (const auto size = link.read(buffer.data(), buffer.size())) {
    if (*size == 0 || bytes.size() > 65536) break;
    bytes.append(reinterpret_cast<const char*>(buffer.data()), *size);
  }
  return bytes;
}

void send(Link& link, const std::string& bytes) {
  if (!bytes.empty()) link.write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

/// Share of the beams with a hit or a reliable "no hit".
double shareThatTells(const lidar::RangeScan& scan) {
  const auto ranges = std::count_if(scan.ranges.begin(), scan.ranges.end(), [&](float r) {
    return static_cast<double>(r) >= scan.range_min;  // excludes NaN
  });
  const auto points = std::count_if(scan.points.begin(), scan.points.end(),
                                    [](const auto& point) { return !std::isnan(point[0]); });
  const size_t all = scan.ranges.size() + scan.points.size();
  return all == 0 ? 0.0 : static_cast<double>(ranges + points) / static_cast<double>(all);
}

/// A port with each of its possible baud rates.
std::vector<std::string> addressesOf(const std::string& port) {
  const LinkAddress address = parseLinkAddress(port);
  if (address.kind != Kind::kTty || port.find('?') != std::string::npos) return {port};
  std::vector<std::string> addresses;
  for (const int rate : kRates) addresses.push_back(port + "?baud=" + std::to_string(rate));
  return addresses;
}

class Search {
 public:
  Search(Site& site, Interview& person, RobotFindings& findings)
      : site_(site), person_(person), findings_(findings), ports_(site.ports()) {}

  void run() {
    if (ports_.empty())
      throw std::runtime_error(
          "this host has no port; plug the devices in, or name ports with --port");
    eachPort([this](const std::string& address) { return listenForIns(address); },
             {Kind::kTty, Kind::kTcp, Kind::kPty});
    if (findings_.ins.kind.empty())
      throw std::runtime_error("no INS sends on " + joined(ports_) + advice_ +
                               "; look at its power, its line and its output");
    eachPort([this](const std::string& address) { return askControllers(address); },
             {Kind::kTty, Kind::kCan, Kind::kPty});
    if (findings_.controller.kind.empty()) takeSilent();
    eachPort([this](const std::string& address) { return askFinders(address); },
             {Kind::kTty, Kind::kTcp, Kind::kUdp, Kind::kPty});
    if (findings_.range_finder.kind.empty()) takeHokuyo();
    if (findings_.range_finder.kind.empty())
      throw std::runtime_error("no range finder sends scans on " + joined(ports_) +
                               "; look at its power and its line; it is needed to see obstacles");
  }

 private:
  /// Tries each remaining port at each rate until something is found; that port is then taken.
  void eachPort(const std::function<bool(const std::string&)>& attempt,
                const std::set<Kind>& kinds) {
    for (auto port = ports_.begin(); port != ports_.end(); ++port) {
      if (kinds.count(parseLinkAddress(*port).kind) == 0) continue;
      const std::vector<std::string> addresses = addressesOf(*port);
      if (!std::any_of(addresses.begin(), addresses.end(), attempt)) continue;
      ports_.erase(port);
      return;
    }
  }

  std::unique_ptr<Link> opened(const std::string& address) {
    std::unique_ptr<Link> link = site_.open(address);
    for (int64_t waited = 0; waited < 300'000 && !link->isOpen() && !link->reopen(site_.now());
         waited += 50'000)
      site_.pass(50'000);
    return link->isOpen() ? std::move(link) : nullptr;
  }

  bool listenForIns(const std::string& address) {
    struct Heard {
      Device device;
      std::unique_ptr<ins::InsSource> source;
      int positions = 0, headings = 0, attitudes = 0;
    };
    const auto link = opened(address);
    if (!link) return false;
    std::vector<Heard> all;
    RobotFindings as = findings_;
    for (const char* kind : {"nmea", "novatel", "ublox", "vectornav", "xsens"}) {
      as.ins = {kind, address, tellsEllipsoidHeight(kind) ? "geoid_separation: 0\n" : "", 0};
      all.push_back({as.ins, driversOf(as).make_ins(std::nullopt)});
    }
    for (const int64_t end = site_.now() + kListen; site_.now() < end; site_.pass(kLookEvery)) {
      const std::string bytes = received(*link);
      for (Heard& heard : all) {
        if (!bytes.empty()) heard.source->push(bytes, site_.now());
        while (const auto estimate = heard.source->next(site_.now())) {
          heard.positions += (estimate->status & InsStatus::kNoPosition) == 0;
          heard.headings += (estimate->status & InsStatus::kNoHeading) == 0;
          heard.attitudes += (estimate->status & InsStatus::kNoAttitude) == 0;
        }
      }
    }
    for (Heard& heard : all) {
      if (!heard.source->lastMessage()) continue;
      heard.device.rate = std::min(heard.positions, heard.headings) * 1e6 / kListen;
      if (heard.device.rate < kLeastInsRate) {
        advice_ = "; " + heard.device.kind + " on " + address + " speaks, but " +
                  (heard.positions < heard.headings ? heard.source->advice().no_position
                                                    : heard.source->advice().no_heading);
        continue;
      }
      findings_.ins = heard.device;
      findings_.has_attitude = heard.attitudes > heard.positions / 2;
      person_.say("INS: " + heard.device.kind + " on " + address + ", " +
                  fixed(heard.device.rate, 0) + " Hz");
      return true;
    }
    return false;
  }

  struct Candidate {
    std::string kind, section, description;
    DriveLayout layout = DriveLayout::kTracks;
  };

  std::vector<Candidate> controllers(const std::string& address) {
    if (findings_.robot.drive.isCar()) {
      std::vector<Candidate> all;
      if (parseLinkAddress(address).kind != Kind::kCan)
        all.push_back({"vesc", carSection(findings_), "", DriveLayout::kThrottleSteering});
      addDescribed(all);
      return all;
    }
    // Four-wheel layouts have two controllers, so they are tried first.
    const DriveLayout four = DriveLayout::kSkidSteer4;
    const std::string can = "vesc_can:\n  watchdog: 0.2\n";
    if (parseLinkAddress(address).kind == Kind::kCan)
      return {{"vesc_can", can, "", four}, {"vesc_can", can, ""}};
    const std::string vesc =
        "vesc:\n  local: 1                # on the line, forwards to the others\n"
        "  watchdog: 0.2           # s\n";
    std::vector<Candidate> all{{"roboteq", "roboteq:\n  watchdog: 0.2           # s\n", ""},
                               {"vesc", vesc, "", four},
                               {"vesc", vesc, ""}};
    addDescribed(all);
    return all;
  }

  void addDescribed(std::vector<Candidate>& all) {
    std::istringstream files(person_.ask("line_protocols"));
    for (std::string file; std::getline(files, file, ',');) {
      if (file == "none") continue;
      const std::string text = readText(file);
      all.push_back({"line_protocol", "line_protocol:\n" + indented(text, 2), text,
                     findings_.robot.drive.layout});
    }
  }

  bool askControllers(const std::string& address) {
    const auto link = opened(address);
    if (!link) return false;
    for (const Candidate& candidate : controllers(address)) {
      RobotFindings as = findings_;
      as.controller = {candidate.kind, address, candidate.section, 0.0};
      as.robot.drive.layout = candidate.layout;
      const auto controller = driversOf(as).make_motor();
      controller->open();
      for (const int64_t end = site_.now() + kAnswer; site_.now() < end && !controller->ready();
           site_.pass(kLookEvery)) {
        const std::string bytes = received(*link);
        if (!bytes.empty()) controller->receive(bytes, site_.now());
        send(*link, controller->poll(site_.now()));
      }
      if (!controller->ready()) continue;
      findings_.controller = as.controller;
      findings_.robot.drive.layout = candidate.layout;
      findings_.line_description = candidate.description;
      const char* const wheels =
          candidate.layout == DriveLayout::kSkidSteer4 ? ", four of them" : "";
      person_.say("motor controller: " + candidate.kind + " on " + address + wheels);
      return true;
    }
    return false;
  }

  void takeSilent() {
    const std::string address = person_.ask("silent_controller");
    if (address == "none")
      throw std::runtime_error("no motor controller answers on " + joined(ports_) +
                               "; look at its power, its line and its baud rate");
    findings_.controller = {"sabertooth", address, "sabertooth:\n  watchdog: 0.2           # s\n",
                            0.0};
    ports_.erase(std::remove_if(ports_.begin(), ports_.end(),
                                [&](const std::string& port) {
                                  return address.compare(0, port.size(), port) == 0;
                                }),
                 ports_.end());
    person_.say("motor controller: sabertooth on " + address + ", which sends no replies");
  }

  bool askFinders(const std::string& address) {
    for (const char* kind : {"velodyne", "sick_cola", "hokuyo", "rplidar", "sick_lms2xx"}) {
      try {
        lidar::checkDeviceAddress(kind, address);
      } catch (const std::invalid_argument&) {
        continue;
      }
      if (askFinder(kind, address)) return true;
    }
    return false;
  }

  bool askFinder(const std::string& kind, const std::string& address) {
    const auto link = opened(address);
    if (!link) return false;
    ConfigReader reader = ConfigReader::fromText("device: " + kind + "\n", "lidar_driver.yaml");
    const auto device = lidar::readScanDevice(reader, 0.002).make();
    device->open(site_.now());
    int scans = 0;
    double range = 0.0, told = 0.0;
    for (const int64_t end = site_.now() + kScan; site_.now() < end && scans < 3;
         site_.pass(kLookEvery)) {
      if (device->lost()) break;
      const std::string bytes = received(*link);
      if (!bytes.empty()) device->receive(bytes, site_.now());
      send(*link, device->poll(site_.now()));
      for (const lidar::RangeScan& scan : device->take(site_.now())) {
        ++scans;
        range = scan.range_max;
        told = shareThatTells(scan);
      }
    }
    send(*link, device->farewell());
    if (scans < 2) return false;
    findings_.range_finder = {kind, address, "", 0.0};
    findings_.range = std::clamp(range, 0.5, 300.0);
    findings_.beams_that_tell = told;
    person_.say("range finder: " + kind + " on " + address + ", sees to " + fixed(range, 0) + " m");
    if (told < kLeastTelling)
      person_.say("only " + fixed(100.0 * told, 0) +
                  " % of its beams give a result here, and the planner drives only where it knows "
                  "the ground to be free: the first goal needs a place with more in sight");
    return true;
  }

  /// A Hokuyo that did not answer, for instance at a TCP address that cannot be discovered.
  void takeHokuyo() {
    const std::string address = person_.ask("hokuyo");
    if (address == "none") return;
    lidar::checkDeviceAddress("hokuyo", address);
    findings_.range_finder = {"hokuyo", address, "", 0.0};
    findings_.range = kHokuyoRange;
    person_.say("range finder: hokuyo on " + address + ", not yet received");
  }

  Site& site_;
  Interview& person_;
  RobotFindings& findings_;
  std::vector<std::string> ports_;
  std::string advice_;
};

}  // namespace

void discover(Site& site, Interview& person, RobotFindings& findings) {
  Search(site, person, findings).run();
}

}  // namespace tread::setup

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The real process on a pseudo-terminal and real LCM: what the motors do when it is terminated,
// killed or suspended.
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/bus/lcm_bus.hpp"
#include "common/messages/operator_beacon.hpp"
#include "common/seal/key_file.hpp"
#include "tests/motor_bridge/driven_robot.hpp"
#include "tests/motor_bridge/endless_planner.hpp"
#include "tests/motor_bridge/messages.hpp"
#include "tests/motor_bridge/scripted_roboteq.hpp"
#include "tests/system/own_bus.hpp"
#include "tests/tools/called_program.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// The master's side of a pseudo-terminal in raw mode.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    REQUIRE(master_ >= 0);
    REQUIRE(grantpt(master_) == 0);
    REQUIRE(unlockpt(master_) == 0);
    termios settings{};
    tcgetattr(master_, &settings);
    cfmakeraw(&settings);
    tcsetattr(master_, TCSANOW, &settings);
  }
  ~Terminal() { close(master_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::string name() const { return ptsname(master_); }
  std::string read() {
    char buffer[1024];
    const ssize_t size = ::read(master_, buffer, sizeof buffer);
    return size > 0 ? std::string(buffer, static_cast<size_t>(size)) : std::string();
  }
  void write(const std::string& text) {
    if (!text.empty()) CHECK(::write(master_, text.data(), text.size()) >= 0);
  }

 private:
  int master_;
};

/// tread-motor-bridge as a child process.
class Process {
 public:
  Process(const std::string& config, const std::string& url, const std::string& key)
      : pid_(fork()) {
    if (pid_ == 0) {
      const std::string program = TREAD_BIN_DIR "/tread-motor-bridge";
      execl(program.c_str(), program.c_str(), "--config", config.c_str(), "--lcm-url", url.c_str(),
            key.empty() ? nullptr : "--key", key.c_str(), nullptr);
      _exit(127);
    }
  }
  ~Process() {
    if (pid_ > 0 && !ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { kill(pid_, signal); }
  bool ended() {
    ended_ = ended_ || waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  int status() const { return status_; }

 private:
  pid_t pid_;
  bool ended_ = false;
  int status_ = -1;
};

/// A planner, INS, operator and controller in real time around the process.
class Rig {
 public:
  /// `key`: the process has one; `our_key`: the others have it, too.
  explicit Rig(bool key = false, bool our_key = false) : url_(tread::testing::ownLcmUrl()) {
    const std::string key_file = "/tmp/tread_motor_bridge_" + std::to_string(getpid()) + ".key";
    unlink(key_file.c_str());
    if (key) writeNewKey(key_file);
    config_ = "/tmp/tread_motor_bridge_" + std::to_string(getpid()) + ".yaml";
    std::ofstream(config_) << "address: tty:" << terminal_.name()
                           << "\nrobot: " TREAD_SOURCE_DIR "/config/robots/teodor/robot.yaml\n";
    bus_ = std::make_unique<LcmBus>(BusAccess{url_, hostSealer(our_key ? key_file : "")},
                                    TimeSource::kHost);
    beacon_ = std::make_unique<OperatorBeacon>(*bus_, "test");
    bus_->subscribe<motor_t>(kMotor, [this](const motor_t& m) { motor_ = m; });
    bus_->subscribe<execution_t>(kExecution, [this](const execution_t& m) { last_ = newest(m); });
    bus_->subscribe<health_t>(kHealth, [this](const health_t& m) { health_ = m; });
    process_ = std::make_unique<Process>(config_, url_, key ? key_file : "");
  }
  ~Rig() { unlink(config_.c_str()); }

  /// Runs everything for a time [us], in steps of about 1 ms.
  void run(int64_t us) {
    for (const int64_t end = bus_->now() + us; bus_->now() < end;) turn();
  }
  /// Arms until the motors turn, for at most a minute: a stall within that second disarms.
  bool drive() {
    for (int i = 0; i < 240 && !turning(); ++i) {
      say(true);
      run(250'000);
    }
    return turning();
  }
  void say(bool armed) {
    arm_t arm{};
    arm.utime = bus_->now();
    arm.armed = armed;
    arm.armed_by = "test";
    bus_->publish(kArm, arm);
  }
  /// An emergency stop from a program without the key.
  void stopUnsealed() const {
    LcmBus other(url_, TimeSource::kHost);
    estop_t stop{};
    stop.utime = other.now();
    stop.engaged = true;
    stop.estop_by = "anyone";
    other.publish(kEstop, stop);
  }
  bool turning() { return !device.stands(bus_->now()); }
  /// Time until the motors stand [us], at most a second.
  int64_t timeToZero() {
    const int64_t begin = bus_->now();
    while (turning() && bus_->now() < begin + 1'000'000) turn();
    return bus_->now() - begin;
  }
  Process& process() { return *process_; }
  const motor_t& motor() const { return motor_; }
  /// A counter in the bridge's HEALTH; 0 if absent.
  int64_t counted(const std::string& name) const {
    for (const counter_t& counter : health_.counters)
      if (counter.counter_name == name) return counter.counted;
    return 0;
  }
  ScriptedRoboteq device;

 private:
  void turn() {
    bus_->handle(1);
    const int64_t now = bus_->now();
    device.write(terminal_.read(), now);
    terminal_.write(device.read());
    beacon_->step(now);
    if (now >= next_ins_) {
      robot_.follow(device.motor1(now), device.motor2(now), now);
      bus_->publish(kIns, robot_.measured(now, seq_++));
      next_ins_ = now + 20'000;
    }
    if (now >= next_program_) {
      bus_->publish(kProgram, toMessage(planner_.plan(now, last_)));
      next_program_ = now + 50'000;
    }
  }

  Terminal terminal_;
  std::string url_;
  std::string config_;
  std::unique_ptr<LcmBus> bus_;
  std::unique_ptr<OperatorBeacon> beacon_;
  std::unique_ptr<Process> process_;
  EndlessPlanner planner_;
  DrivenRobot robot_;
  std::optional<ExecutionRecord> last_;
  motor_t motor_{};
  health_t health_{};
  int64_t seq_ = 0;
  int64_t next_ins_ = 0;
  int64_t next_program_ = 0;
};

/// A rig; null if LCM has no network.
std::unique_ptr<Rig> rigOrSkip(bool key = false, bool our_key = false) {
  try {
    return std::make_unique<Rig>(key, our_key);
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return nullptr;
  }
}

/// A driving rig; null if LCM has no network.
std::unique_ptr<Rig> driving() {
  std::unique_ptr<Rig> rig = rigOrSkip();
  if (rig) REQUIRE(rig->drive());
  return rig;
}

/// Allowance for a busy machine, in addition to virtual time [us].
constexpr int64_t kSlack = 50'000;

}  // namespace

TEST_CASE("SIGTERM, SIGINT and a closed terminal: zero, then exit 0") {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const std::unique_ptr<Rig> rig = driving();
    if (!rig) return;
    rig->process().send(signal);
    CHECK(rig->timeToZero() <= 20'000 + kSlack);
    for (int i = 0; i < 100 && !rig->process().ended(); ++i) rig->run(20'000);
    REQUIRE(rig->process().ended());
    CHECK(rig->process().status() == 0);
    // Only now, because a query may follow the first zero on the line.
    rig->run(20'000);
    CHECK(rig->device.heard.back() == "!M 0 0");
  }
}

TEST_CASE("SIGKILL: the controller's watchdog stops the motors") {
  const std::unique_ptr<Rig> rig = driving();
  if (!rig) return;
  rig->process().send(SIGKILL);
  CHECK(rig->timeToZero() <= 250'000 + kSlack);
}

TEST_CASE("SIGSTOP and SIGCONT: stopped by the watchdog, and nothing moves until armed again") {
  const std::unique_ptr<Rig> rig = driving();
  if (!rig) return;
  rig->process().send(SIGSTOP);
  CHECK(rig->timeToZero() <= 250'000 + kSlack);
  rig->run(500'000);
  rig->process().send(SIGCONT);
  for (int i = 0; i < 200; ++i) {
    rig->run(5'000);
    REQUIRE_FALSE(rig->turning());
  }
  CHECK(rig->device.resumed == 0);
  INFO(rig->motor().state_reason);
  CHECK(rig->motor().bridge_state == motor_t::STATE_FAULT);
  CHECK(rig->drive());
}

TEST_CASE("with a key, ARM and PROGRAM of a program without it move nothing") {
  const std::unique_ptr<Rig> rig = rigOrSkip(true, false);
  if (!rig) return;
  // Its MOTOR is readable for all, so it runs and has received our messages.
  for (int i = 0; i < 100 && rig->counted("refused: unsealed") < 100; ++i) {
    rig->say(true);
    rig->run(100'000);
    REQUIRE_FALSE(rig->turning());
  }
  CHECK(rig->counted("refused: unsealed") >= 100);
  CHECK(rig->motor().bridge_state == motor_t::STATE_DISARMED);
  CHECK(rig->device.resumed == 0);
}

TEST_CASE("with the same key it drives, and a stop without one stops it") {
  const std::unique_ptr<Rig> rig = rigOrSkip(true, true);
  if (!rig) return;
  REQUIRE(rig->drive());
  CHECK(rig->counted("refused: unsealed") == 0);
  rig->stopUnsealed();
  CHECK(rig->timeToZero() <= 20'000 + kSlack);
  rig->run(100'000);
  CHECK(rig->motor().bridge_state == motor_t::STATE_ESTOP);
}

TEST_CASE("with a key that others may read it does not start, and says why in one line") {
  const tread::samples::OwnFolder folder;
  const std::string key = folder.path("key");
  const std::string start = "tread-motor-bridge --lcm-url memq:// --config " TREAD_SOURCE_DIR
                            "/config/robots/teodor/motor_bridge.yaml ";
  for (const std::string& how : {"--key " + key, "--check --key " + key}) {
    const auto absent = tread::samples::called(start + how);
    CHECK(absent.status == 1);
    CHECK(absent.isOneLine());
    CHECK(absent.says("tread-motor-bridge: key " + key + ": cannot be read"));
  }
  writeNewKey(key);
  std::filesystem::permissions(key, std::filesystem::perms(0640));
  const auto open = tread::samples::called(start + "--key " + key);
  CHECK(open.status == 1);
  CHECK(open.isOneLine());
  CHECK(open.says("others than its owner may use it (mode 0640); chmod 600 " + key));
  setenv("TREAD_KEY", key.c_str(), 1);
  const auto by_environment = tread::samples::called(start);
  unsetenv("TREAD_KEY");
  CHECK(by_environment.status == 1);
  CHECK(by_environment.says("mode 0640"));
  std::filesystem::permissions(key, std::filesystem::perms(0600));
  CHECK(tread::samples::called(start + "--check --key " + key).status == 0);
}

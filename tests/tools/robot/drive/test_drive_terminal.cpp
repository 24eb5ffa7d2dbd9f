// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The program in a terminal, and with an input device of the kernel if there is uinput.
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <linux/uinput.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>
#include <catch2/catch.hpp>

#include "tests/system/own_bus.hpp"
#include "tests/system/process.hpp"
#include "tools/robot/drive/evdev_pad.hpp"

namespace tread::testing {
namespace {

/// tread-drive as the foreground program of a separate terminal.
class InTerminal {
 public:
  explicit InTerminal(const std::string& url) {
    int terminal = -1;
    REQUIRE(::openpty(&master_, &terminal, nullptr, nullptr, nullptr) == 0);
    REQUIRE(::tcgetattr(terminal, &before_) == 0);
    terminal_ = terminal;
    const std::string program = std::string(TREAD_BIN_DIR) + "/tread-drive";
    pid_ = ::fork();
    if (pid_ == 0) {
      ::login_tty(terminal);
      ::execl(program.c_str(), program.c_str(), "--keyboard", "--lcm-url", url.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~InTerminal() {
    if (pid_ > 0) ::kill(pid_, SIGKILL);
    ::close(master_);
    ::close(terminal_);
  }
  InTerminal(const InTerminal&) = delete;
  InTerminal& operator=(const InTerminal&) = delete;

  termios now() const {
    termios modes{};
    ::tcgetattr(terminal_, &modes);
    return modes;
  }
  bool asBefore() const {
    return now().c_lflag == before_.c_lflag &&
           std::memcmp(now().c_cc, before_.c_cc, sizeof before_.c_cc) == 0;
  }
  bool untilRaw() {
    for (int i = 0; i < 500 && (now().c_lflag & ECHO) != 0; ++i) read();
    return (now().c_lflag & (ECHO | ICANON)) == 0;
  }
  /// Its output so far.
  const std::string& read() {
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
    std::array<char, 4096> bytes{};
    const ssize_t size = ::read(master_, bytes.data(), bytes.size());
    if (size > 0) said_.append(bytes.data(), static_cast<size_t>(size));
    ::usleep(10'000);
    return said_;
  }
  void type(const std::string& keys) const {
    REQUIRE(::write(master_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
  }
  void signal(int number) const { ::kill(pid_, number); }
  bool ends() {
    for (int i = 0; i < 500; ++i) {
      read();
      if (::waitpid(pid_, nullptr, WNOHANG) != pid_) continue;
      pid_ = -1;
      return true;
    }
    return false;
  }

 private:
  int master_ = -1;
  int terminal_ = -1;
  pid_t pid_ = -1;
  termios before_{};
  std::string said_;
};

/// A gamepad that the kernel takes for a real one.
class VirtualPad {
 public:
  VirtualPad() : file_(::open("/dev/uinput", O_WRONLY | O_NONBLOCK)) {
    if (file_ < 0) return;
    ::ioctl(file_, UI_SET_EVBIT, EV_KEY);
    for (const int button : {BTN_SOUTH, BTN_TR, BTN_START}) ::ioctl(file_, UI_SET_KEYBIT, button);
    ::ioctl(file_, UI_SET_EVBIT, EV_ABS);
    for (const int axis : {ABS_X, ABS_Y}) {
      uinput_abs_setup setup{};
      setup.code = static_cast<uint16_t>(axis);
      setup.absinfo.maximum = 255;
      setup.absinfo.value = 128;
      ::ioctl(file_, UI_ABS_SETUP, &setup);
    }
    uinput_setup setup{};
    std::strcpy(setup.name, "tread test pad");
    ::ioctl(file_, UI_DEV_SETUP, &setup);
    made_ = ::ioctl(file_, UI_DEV_CREATE) == 0;
  }
  ~VirtualPad() { remove(); }
  VirtualPad(const VirtualPad&) = delete;
  VirtualPad& operator=(const VirtualPad&) = delete;
  bool made() const { return made_; }
  void remove() {
    if (made_) ::ioctl(file_, UI_DEV_DESTROY);
    if (file_ >= 0) ::close(file_);
    made_ = false;
    file_ = -1;
  }
  void say(int type, int code, int value) const {
    for (const auto& [t, c, v] : {std::array<int, 3>{type, code, value}, {EV_SYN, SYN_REPORT, 0}}) {
      input_event event{};
      event.type = static_cast<uint16_t>(t);
      event.code = static_cast<uint16_t>(c);
      event.value = v;
      REQUIRE(::write(file_, &event, sizeof event) == sizeof event);
    }
  }

 private:
  int file_;
  bool made_ = false;
};

}  // namespace

TEST_CASE("the terminal is as it was after every way to end") {
  for (const int number : {SIGTERM, SIGHUP, SIGQUIT, 0}) {
    InTerminal drive(ownLcmUrl());
    INFO("signal " << number);
    REQUIRE(drive.untilRaw());
    if (number == 0)
      drive.type("\x03");  // Ctrl-C
    else
      drive.signal(number);
    CHECK(drive.ends());
    CHECK(drive.asBefore());
  }
}

TEST_CASE("it says what drives and how, and that no robot is heard") {
  InTerminal drive(ownLcmUrl());
  REQUIRE(drive.untilRaw());
  for (int i = 0; i < 300 && drive.read().find("no MOTOR") == std::string::npos; ++i) {
  }
  CHECK_THAT(drive.read(), Catch::Contains("keyboard: hold an arrow or w a s d") &&
                               Catch::Contains("no MOTOR message"));
}

TEST_CASE("a gamepad of the kernel is found, moves, and says when it is pulled out") {
  VirtualPad device;
  if (!device.made()) {
    WARN("skipped: no /dev/uinput here; recorded events stand in for a device");
    return;
  }
  for (int i = 0; i < 100 && !drive::padFound(); ++i) ::usleep(10'000);
  drive::EvdevPad pad("");
  CHECK_THAT(pad.name(), Catch::Contains("tread test pad"));
  CHECK(std::isnan(pad.read(0).forward));  // an old position is no measurement
  device.say(EV_KEY, BTN_TR, 1);
  device.say(EV_ABS, ABS_Y, 0);
  ::usleep(50'000);
  CHECK(pad.read(0).hold);
  CHECK(pad.read(0).forward == 1.0);
  device.remove();
  ::usleep(100'000);
  CHECK_THROWS_WITH(pad.read(0), Catch::Contains("is gone"));
}

TEST_CASE("no device is told in one line with what to do") {
  CHECK_THROWS_WITH(drive::EvdevPad("/dev/null"), Catch::Contains("/dev/null: no input device"));
  CHECK_THROWS_WITH(drive::EvdevPad("/nowhere"), Catch::Contains("/nowhere: No such file"));
  if (!drive::padFound())
    CHECK_THROWS_WITH(drive::EvdevPad(""), Catch::Contains("drive with --keyboard"));
}

}  // namespace tread::testing

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>
#include <clocale>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include <ncurses.h>
#include <CLI/CLI.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/key_option.hpp"
#include "common/bus/lcm_listener.hpp"
#include "common/bus/shell.hpp"
#include "common/config/command_line.hpp"
#include "tools/robot/operator/command.hpp"
#include "tools/robot/operator/live_console.hpp"
#include "tools/robot/top/monitor.hpp"

// ncurses defines a macro of this name.
#undef timeout

namespace {

using namespace tread;
using namespace tread::top;

constexpr int kWaitMs = 20;
constexpr int64_t kShow = 250'000;     // [us] between screen updates
constexpr int64_t kHold = 60'000'000;  // [us] the robot is held after the last key
constexpr uint64_t kTerminal = 1;      // page number of this terminal in the console

struct Arguments {
  std::string lcm_url;
  std::string key;
  std::string operator_name = operatorName();
  double once = 0.0;
};

/// The bus, and the kernel's counters of lost datagrams.
class Watch {
 public:
  Watch(BusAccess access, Monitor& monitor)
      : monitor_(monitor),
        listener_(std::move(access),
                  [&](const std::string& channel, const uint8_t* bytes, size_t size, int64_t now) {
                    monitor_.take(channel, bytes, size, now);
                  }) {}
  void handle(int milliseconds) {
    listener_.handle(milliseconds);
    std::ifstream file("/proc/net/snmp");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (const auto counters = kernelCounters(text)) monitor_.take(*counters);
    monitor_.setDoubt(listener_.doubt());
  }

 private:
  Monitor& monitor_;
  LcmListener listener_;
};

/// Adds the current time as "seen": this screen shows messages at once.
std::string withTime(const char* op, int64_t now) {
  return std::string("{\"op\":\"") + op + "\",\"seen\":" + std::to_string(now) + "}";
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The terminal for the lifetime of this object; restored also after an exception.
class Screen {
 public:
  Screen() {
    std::setlocale(LC_ALL, "");
    if (newterm(nullptr, stdout, stdin) == nullptr)
      throw std::runtime_error(
          "this terminal cannot be used (TERM); tread-top --once 3 works without one");
    cbreak();
    noecho();
    nodelay(stdscr, TRUE);
    keypad(stdscr, TRUE);
    curs_set(0);
    if (!has_colors()) return;
    start_color();
    use_default_colors();
    init_pair(1, COLOR_GREEN, -1);
    init_pair(2, COLOR_YELLOW, -1);
    init_pair(3, COLOR_RED, -1);
  }
  ~Screen() { endwin(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  void show(const std::vector<Line>& lines, const std::string& words) const {
    erase();
    const std::vector<std::string> told = linesOf(words);
    const int below = static_cast<int>(std::min<size_t>(told.size(), 4)) + 1;
    const int room = LINES - below;

    for (int i = 0; i < static_cast<int>(lines.size()) && i < room; ++i) {
      const Line& line = lines[static_cast<size_t>(i)];
      attrset(attributesOf(line.mood));
      mvaddnstr(i, 0, line.text.c_str(), COLS);
    }
    attrset(A_NORMAL);
    for (int i = 0; i + 1 < below; ++i)
      mvaddnstr(LINES - below + i, 0, told[static_cast<size_t>(i)].c_str(), COLS);

    attrset(A_REVERSE);
    mvaddnstr(LINES - 1, 0,
              "space E-stop   a arm, held for 60 s from the last key   d disarm   c clear E-stop   "
              "q quit",
              COLS);
    attrset(A_NORMAL);
    refresh();
  }

 private:
  static int attributesOf(Mood mood) {
    switch (mood) {
      case Mood::kTitle:
        return A_BOLD | A_UNDERLINE;
      case Mood::kGood:
        return COLOR_PAIR(1);
      case Mood::kDoubt:
        return COLOR_PAIR(2);
      case Mood::kBad:
        return COLOR_PAIR(3) | A_BOLD;
      case Mood::kPlain:
        break;
    }
    return A_NORMAL;
  }
};

/// Prints the screen once.
int printOnce(Watch& listener, const Monitor& monitor, double seconds,
              const std::atomic<bool>& stop) {
  for (const int64_t end = hostNow() + static_cast<int64_t>(1e6 * seconds);
       !stop && hostNow() < end;)
    listener.handle(kWaitMs);
  for (const Line& line : monitor.lines(hostNow())) std::printf("%s\n", line.text.c_str());
  return 0;
}

int watch(Watch& listener, const Monitor& monitor, operators::LiveConsole& console,
          const std::atomic<bool>& stop) {
  const Screen screen;
  // Over ssh a lost terminal goes unnoticed, so the operator must press keys.
  int64_t held_until = 0;

  std::string refused;
  const auto say = [&](const std::string& json) {
    refused = console->take(json, kTerminal, console.now());
  };
  for (int64_t next = 0; !stop;) {
    listener.handle(kWaitMs);
    console.step();
    for (int key = getch(); key != ERR; key = getch()) {
      if (key == 'q') {
        console->leave(kTerminal, console.now());
        return 0;
      }
      if (key == ' ') say(R"({"op":"estop"})");
      if (key == 'c') say(R"({"op":"clear_estop"})");
      if (key == 'a') say(withTime("arm", console.now()));

      if (key == 'd') say(R"({"op":"disarm"})");
      const bool held = hostNow() < held_until;
      if (key == 'a' || (held && key != 'd')) held_until = hostNow() + kHold;
      if (key == 'd' || key == ' ') held_until = 0;
    }
    if (hostNow() < held_until) {
      const int64_t now = console.now();
      console->take(withTime("alive", now), kTerminal, now);
    }
    if (hostNow() < next) continue;
    next = hostNow() + kShow;
    screen.show(monitor.lines(hostNow()), refused.empty() ? console->words() : refused);
  }
  console->leave(kTerminal, console.now());
  return 0;
}

int run(const Arguments& arguments) {
  const std::atomic<bool>& stop = stopRequest(0);
  const launch::RunningRobot robot = launch::findRobot(arguments.lcm_url, arguments.key);
  Monitor monitor;
  Watch listener(operators::accessTo(robot), monitor);
  if (arguments.once > 0.0) return printOnce(listener, monitor, arguments.once, stop);
  operators::LiveConsole console(robot, arguments.operator_name, "at the terminal of tread-top");
  return watch(listener, monitor, console, stop);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Watches the robot in a terminal: channels with rates, ages, sizes and losses, processes, "
      "motors. Keys arm, disarm and stop. Over ssh give your name by --operator, so that the log "
      "shows who "
      "you are.",
      "tread-top"};
  Arguments arguments;
  app.add_option("--once", arguments.once, "print the screen once after so many seconds, and end")
      ->check(CLI::Range(0.1, 3600.0));
  app.add_option("--operator", arguments.operator_name, operators::kOperatorHelp)
      ->capture_default_str();
  app.add_option("--lcm-url", arguments.lcm_url, operators::kUrlHelp);
  addKeyOption(app, arguments.key);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-top", [&] { return run(arguments); });
}

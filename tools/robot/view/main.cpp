// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <sys/resource.h>

#include <sodium.h>
#include <CLI/CLI.hpp>

#include "common/bus/key_option.hpp"
#include "common/bus/lcm_listener.hpp"
#include "common/bus/shell.hpp"
#include "common/config/command_line.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/operator/command.hpp"
#include "tools/robot/operator/live_console.hpp"
#include "tools/robot/view/certificate.hpp"
#include "tools/robot/view/view_server.hpp"

namespace {

using namespace tread;
using namespace tread::view;

constexpr int kWaitMs = 2;
constexpr double kConsolePeriod = 0.3;  // [s]
/// Nice value next to the robot's processes: a third of their share if the processor is scarce.
constexpr int kNiceness = 5;

struct Arguments {
  std::vector<std::string> logs;
  ServerSettings server;
  std::string lcm_url;
  std::string key;
  std::string operator_name = operatorName();
  std::string state;  ///< folder of the certificate; empty = default
  bool look_only = false;
};

double secondsNow() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

std::string newToken() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot make a token");
  unsigned char bytes[12];
  randombytes_buf(bytes, sizeof bytes);
  char text[2 * sizeof bytes + 1];
  return sodium_bin2hex(text, sizeof text, bytes, sizeof bytes);
}

bool isLoopback(const std::string& address) {
  const bool numbers = address.find_first_not_of("0123456789.") == std::string::npos;
  return (numbers && address.rfind("127.", 0) == 0) || address == "::1" || address == "localhost";
}

void sayWhere(const ViewServer& server, const ServerSettings& settings) {
  const std::string token = settings.token.empty() ? "" : "?token=" + settings.token;
  const std::string place = settings.address + ":" + std::to_string(server.port()) + "/" + token;
  const char* const secure = settings.certificate.empty() ? "" : "s";
  std::printf("tread-view: open http%s://%s\n", secure, place.c_str());
  std::printf("tread-view: Foxglove, Lichtblick: ws%s://%s\n", secure, place.c_str());
  if (!settings.origins.empty())
    std::printf("tread-view: by the proxy: its address with %s\n", token.c_str());
  std::fflush(stdout);
}

/// A server for other machines must not receive the token unencrypted.
void protect(Arguments& arguments) {
  ServerSettings& server = arguments.server;
  const bool local = isLoopback(server.address);
  // Requests through a proxy appear to come from this machine.
  if (server.token.empty() && (!local || !server.origins.empty())) server.token = newToken();
  if (local) return;
  const std::string folder =
      arguments.state.empty() ? launch::defaultRunFolder("view") : arguments.state;
  const Certificate certificate = ownCertificate(folder);
  server.certificate = certificate.path;
  std::printf("tread-view: self-signed certificate%s, the browser asks once; SHA-256 %s\n",
              certificate.made ? ", made now" : "", certificate.fingerprint.c_str());
}

void live(const Arguments& arguments, const std::atomic<bool>& stop) {
  // Before any thread is started: threads inherit the priority.
  setpriority(PRIO_PROCESS, 0, std::max(kNiceness, getpriority(PRIO_PROCESS, 0)));
  const launch::RunningRobot robot = launch::findRobot(arguments.lcm_url, arguments.key);
  operators::LiveConsole console(robot, arguments.operator_name, "by the page of tread-view");
  ServerSettings settings = arguments.server;
  settings.may_command = !arguments.look_only;
  // With a key, local users must not be able to operate the robot through the page without a token.
  if (!robot.key.empty() && settings.may_command && settings.token.empty())
    settings.token = newToken();
  ViewServer server(
      settings,
      [&](const std::string& json, uint64_t page) {
        return console->take(json, page, console.now());
      },
      [&](uint64_t page) { console->leave(page, console.now()); });

  LcmListener listener(
      operators::accessTo(robot),
      [&](const std::string& channel, const uint8_t* bytes, size_t size, int64_t now) {
        server.feed().take({now, channel, {bytes, bytes + size}});
      });
  sayWhere(server, settings);
  std::string told;
  double told_at = 0.0;
  for (double last = secondsNow(); !stop;) {
    listener.handle(kWaitMs);
    console.step();
    server.setOperator(console->holder());
    const double now = secondsNow();
    server.step(now - last);
    last = now;
    // Progress of a goal changes at every step, faster than anybody reads.
    if (now - told_at < kConsolePeriod) continue;
    told_at = now;
    server.feed().setDoubt(listener.doubt());
    const std::string words = console->words();
    if (words == told) continue;
    server.tell("console: " + words);
    told = words;
  }
}

void replay(const Arguments& arguments, const std::atomic<bool>& stop) {
  ServerSettings settings = arguments.server;
  settings.may_command = false;
  ViewServer server(
      settings, [](const std::string&, uint64_t) { return "this is a log"; }, [](uint64_t) {});
  server.feed().openLogs(arguments.logs);
  const std::string problem = server.feed().problem();
  if (!problem.empty()) std::printf("tread-view: %s\n", problem.c_str());
  sayWhere(server, settings);
  for (double last = secondsNow(); !stop;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(kWaitMs));
    const double now = secondsNow();
    server.step(now - last);
    last = now;
  }
}

int run(Arguments& arguments) {
  protect(arguments);
  const std::atomic<bool>& stop = stopRequest(0);
  arguments.logs.empty() ? live(arguments, stop) : replay(arguments, stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Serves a browser page with map, plan, patterns, learning, health and events of the running "
      "robot, with goal, fences and E-stop; or of a log, with a time slider. Foxglove and "
      "Lichtblick connect to the same address.",
      "tread-view"};
  Arguments arguments;
  app.add_option("logs", arguments.logs,
                 "LCM log; several are parts of one recording, in order; none = the running robot");
  app.add_option("--address", arguments.server.address,
                 "address to listen at; for other machines viewers need the printed token")
      ->capture_default_str();
  app.add_option("--port", arguments.server.port, "0 = any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--token", arguments.server.token,
                 "token required from every viewer; default: none on this machine, unless the "
                 "robot has a key or a proxy "
                 "is named (--origin); else a random one");
  app.add_option_function<std::vector<std::string>>(
         "--origin",
         [&](const std::vector<std::string>& urls) {
           for (const std::string& url : urls)
             if (const std::string wrong = addOrigin(url, arguments.server); !wrong.empty())
               throw CLI::ValidationError("--origin", wrong);
         },
         "address of the page behind a proxy, as the browser sees it; this page may operate the "
         "robot")
      ->expected(1)
      ->take_all();
  app.add_option("--state", arguments.state,
                 "folder of the certificate for other machines; default ~/.local/state/tread/view");
  app.add_flag("--look-only", arguments.look_only, "no page may operate the robot");
  app.add_option("--operator", arguments.operator_name, operators::kOperatorHelp)
      ->capture_default_str();
  app.add_option("--lcm-url", arguments.lcm_url, operators::kUrlHelp);
  addKeyOption(app, arguments.key);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-view", [&] { return run(arguments); });
}

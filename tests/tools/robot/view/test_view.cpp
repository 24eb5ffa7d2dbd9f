// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// tread-view with its real clients: the protocol's reference client, a headless browser, the
// format's checker.
#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/messages/blank.hpp"
#include "common/seal/key_file.hpp"
#include "tests/helpers.hpp"
#include "tests/system/process.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/mission_runner.hpp"
#include "tools/robot/launch/stall_watch.hpp"
#include "tools/robot/view/certificate.hpp"

using namespace tread;
using namespace tread::testing;
using tread::samples::called;
using tread::samples::OwnFolder;

namespace {

const std::string kScripts = std::string(TREAD_SOURCE_DIR) + "/tests/tools/robot/view/browser/";

/// The log of a mission of the complete robot, made once.
std::string missionLog() {
  static const OwnFolder folder;
  static const std::string path = [] {
    LogWriter log(folder.path("mission.lcmlog"));
    missions::MissionOptions options;
    options.log = &log;
    options.shortest_line = 8.0;
    missions::runMission(missions::teodor(), 5, options);
    log.flush();
    return folder.path("mission.lcmlog");
  }();
  return path;
}

/// tread-view, and its printed address.
class View {
 public:
  View(const OwnFolder& folder, std::vector<std::string> arguments) {
    const std::string output = folder.path("view.txt");
    arguments.insert(arguments.end(), {"--port", "0"});
    process_ = std::make_unique<Process>("tread-view", arguments, output);
    for (int i = 0; i < 2000 && url_.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const std::string text = contentOf(output);
      const size_t at = text.find("open http"), end = text.find('\n', at);
      if (at != std::string::npos && end != std::string::npos)
        url_ = text.substr(at + 5, end - at - 5);
    }
    CAPTURE(contentOf(output));
    REQUIRE_FALSE(url_.empty());
  }
  const std::string& url() const { return url_; }
  std::string socket() const { return "ws" + url_.substr(4); }
  Process& process() { return *process_; }

 private:
  std::unique_ptr<Process> process_;
  std::string url_;
};

/// Peak memory of a process so far [bytes].
int64_t peakMemory(pid_t pid) {
  const std::string status = contentOf("/proc/" + std::to_string(pid) + "/status");
  const size_t at = status.find("VmHWM:");
  return at == std::string::npos ? 0 : 1024 * std::atoll(status.c_str() + at + 6);
}

/// Processor time of a process so far [s].
double computedBy(pid_t pid) {
  const std::string text = contentOf("/proc/" + std::to_string(pid) + "/stat");
  std::istringstream words(text.substr(text.rfind(')') + 1));
  std::string word;
  for (int i = 0; i < 11; ++i) words >> word;
  double user = 0.0, system = 0.0;
  words >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// A port that nobody listens at.
int freePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof place;
  auto* const generic = reinterpret_cast<sockaddr*>(&place);
  REQUIRE(::bind(socket, generic, size) == 0);
  REQUIRE(::getsockname(socket, generic, &size) == 0);
  ::close(socket);
  return ntohs(place.sin_port);
}

/// Runs a node script; `during` is called every 50 ms with its output so far. `behind`: words of
/// another command that ends in exec.
template <class During>
void runScript(const OwnFolder& folder, const std::string& name, std::vector<std::string> arguments,
               const During& during, std::vector<std::string> behind = {}) {
  const std::string output = folder.path(name + ".txt");
  std::vector<std::string> words = std::move(behind);
  words.insert(words.end(), {"node", kScripts + name, TREAD_PAGE_MODULES});
  words.insert(words.end(), arguments.begin(), arguments.end());
  Process node("/usr/bin/env", words, output);
  for (int i = 0; i < 2400 && !node.waitFor(0.05); ++i) during(contentOf(output));
  CAPTURE(contentOf(output));
  REQUIRE(node.waitFor(0.0));
  REQUIRE(node.exitCode() == 0);
  REQUIRE(contentOf(output).find("1 passed, 0 failed") != std::string::npos);
}
void runScript(const OwnFolder& folder, const std::string& name,
               std::vector<std::string> arguments) {
  runScript(folder, name, std::move(arguments), [](const std::string&) {});
}

}  // namespace

TEST_CASE("the WebSocket speaks to the protocol's own client, in our channels and in Foxglove's") {
  const OwnFolder folder;
  View view(folder, {missionLog()});
  runScript(folder, "foxglove.mjs", {view.socket()});
  view.process().signal(SIGINT);
  CHECK(view.process().waitFor(5.0));
  CHECK(view.process().exitCode() == 0);
}

TEST_CASE("an exported log passes the readers of the format itself") {
  const OwnFolder folder;
  REQUIRE(called("tread-export " + missionLog() + " -o " + folder.path("drive.mcap")).status == 0);
  runScript(folder, "mcap.mjs", {folder.path("drive.mcap")});
}

TEST_CASE(
    "the page shows a log in a browser: map, slider, events, playing, and a server that is back") {
  const OwnFolder folder;
  View view(folder, {missionLog()});
  // The same port for the next one.
  const std::string port = view.url().substr(view.url().rfind(':') + 1);
  std::unique_ptr<Process> again;
  runScript(folder, "page.mjs", {view.url(), "log", folder.path("log.png")},
            [&](const std::string& printed) {
              if (again || printed.find("restart") == std::string::npos) return;
              view.process().signal(SIGKILL);
              view.process().waitFor(5.0);
              std::this_thread::sleep_for(std::chrono::seconds(2));
              again = std::make_unique<Process>(
                  "tread-view",
                  std::vector<std::string>{missionLog(), "--port", port.substr(0, port.find('/'))});
            });
  CHECK(again);
  CHECK(samples::isPng(folder.text("log.png")));
}

TEST_CASE(
    "the page operates the robot, a stranger's page does not: arms, goes, stops by one key, greys "
    "out") {
  const OwnFolder folder;
  RobotRun run(kField, "[-20, 0, 0]");
  run.startAll();
  REQUIRE(run.until(20.0, [&] { return run.plan().any() && run.ins().any(); }));
  View view(folder, {"--lcm-url", run.url(), "--operator", "page"});
  const OwnFolder elsewhere;
  const View asking(elsewhere, {"--lcm-url", run.url(), "--token", "secret"});
  runScript(folder, "origin.mjs", {view.url(), asking.url()});
  bool killed = false;
  runScript(folder, "page.mjs", {view.url(), "live", folder.path("live.png")},
            [&](const std::string& printed) {
              if (killed || printed.find("kill") == std::string::npos) return;
              run.signal("motor_bridge", SIGKILL);
              killed = true;
            });
  CHECK(killed);
}

TEST_CASE("of a robot with a key the page is shown what is sealed by it, and nothing else") {
  const OwnFolder folder;
  const std::string key = folder.path("key"), url = ownLcmUrl();
  writeNewKey(key);
  const View view(folder, {"--lcm-url", url, "--key", key});
  LcmBus stranger(url, TimeSource::kHost);
  LcmBus robot(BusAccess{url, hostSealer(key)}, TimeSource::kHost);
  auto motor = blank<motor_t>();
  motor.bridge_state = motor_t::STATE_DRIVING;
  // The robot is received last, so that a forged message could be the first.
  for (LcmBus* const sender : {&stranger, &robot}) {
    const std::string output = folder.path(sender == &robot ? "robot.txt" : "stranger.txt");
    Process page("/usr/bin/env",
                 {"node", kScripts + "operator.mjs", TREAD_PAGE_MODULES, view.url(), "4"}, output);
    for (int i = 0; i < 120 || page.running(); ++i) {
      motor.utime = sender->now();
      ++motor.seq;
      sender->publish(kMotor, motor);
      page.waitFor(0.04);
    }
    CAPTURE(contentOf(output));
    CHECK(page.exitCode() == 0);
    CHECK((contentOf(output).find("\n0 MOTOR") == std::string::npos &&
           contentOf(output).rfind("0 MOTOR", 0) == std::string::npos) == (sender == &robot));
  }
}

TEST_CASE("viewers without end cost neither memory nor the robot's drive") {
  // For longer: TREAD_FLOOD_SECONDS=60; at another priority than nice 10: TREAD_FLOOD_NICE=19.
  const char* const asked = std::getenv("TREAD_FLOOD_SECONDS");
  const double seconds = asked != nullptr ? std::atof(asked) : 5.0;
  const char* const nice = std::getenv("TREAD_FLOOD_NICE");
  const OwnFolder folder;
  RobotRun run(kField, "[-20, 0, 0]");
  run.startAll();
  REQUIRE(run.until(20.0, [&] { return run.plan().any() && run.ins().any(); }));
  View view(folder, {"--lcm-url", run.url(), "--operator", "page"});
  const std::string output = folder.path("operator.txt");
  Process page("/usr/bin/env",
               {"node", kScripts + "operator.mjs", TREAD_PAGE_MODULES, view.url(), "600"}, output);
  for (int i = 0; i < 400 && contentOf(output).find("is armed") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  int64_t memory = 0;
  const double before = computedBy(view.process().pid());
  const tread::launch::StallWatch watch;
  // Started by root, a browser would get a higher priority than the robot.
  std::vector<std::string> behind;
  if (::geteuid() == 0) behind = {"setpriv", "--bounding-set", "-sys_nice"};
  runScript(
      folder, "flood.mjs", {view.url(), std::to_string(seconds), nice != nullptr ? nice : "10"},
      [&](const std::string&) { memory = std::max(memory, peakMemory(view.process().pid())); },
      behind);
  const double computed = computedBy(view.process().pid()) - before;
  page.signal(SIGTERM);
  REQUIRE(page.waitFor(20.0));
  INFO("machine held up for " << watch.longest() << " s at most");
  INFO(contentOf(output) << contentOf(folder.path("flood.mjs.txt")));
  std::printf(
      "%s%stread-view used %.0f MB at most, computed %.1f s; machine held up for %.3f s at most\n",
      contentOf(output).c_str(), contentOf(folder.path("flood.mjs.txt")).c_str(),
      static_cast<double>(memory) * 1e-6, computed, watch.longest());
  CHECK(page.exitCode() == 0);
  CHECK(contentOf(output).find("is armed") != std::string::npos);
  CHECK(memory > 1'000'000);
  CHECK(memory < 200'000'000);
  // Viewers could take the page's lease, or the processor. A delay of an instrument by 100 ms on a
  // busy machine is not their fault.
  if (watch.longest() < 0.5)
    CHECK_THAT(contentOf(output), !Catch::Contains("operator") && !Catch::Contains("has let go"));
  CHECK(computed < 2.0 + 0.3 * seconds);
}

TEST_CASE("viewers from elsewhere need the token, strangers' pages may not talk to the robot") {
  const OwnFolder folder;
  View open(folder, {missionLog()});
  const auto fetch = [&](const std::string& url, const std::string& more) {
    const std::string file = folder.path("got.txt");
    std::vector<std::string> words{
        "node", "-e",
        "fetch(process.argv[1],{headers:JSON.parse(process.argv[2])}).then("
        "r=>console.log(r.status)).catch(e=>console.log(String(e)))",
        url, more};
    std::filesystem::remove(file);
    Process node("/usr/bin/env", words, file);
    REQUIRE(node.waitFor(10.0));
    return contentOf(file);
  };
  CHECK(fetch(open.url(), "{}") == "200\n");
  CHECK(fetch(open.url() + "else", "{}") == "404\n");
  const OwnFolder other;
  View asked(other, {missionLog(), "--token", "secret"});
  const std::string bare = asked.url().substr(0, asked.url().find('?'));
  CHECK(fetch(asked.url(), "{}") == "200\n");
  CHECK(fetch(bare, "{}") == "403\n");
  CHECK(fetch(bare + "?token=wrong", "{}") == "403\n");
}

TEST_CASE("who listens to other machines shows them a certificate, and nothing in clear") {
  const OwnFolder folder;
  std::string before;
  for (const bool again : {false, true}) {
    const OwnFolder output;
    const View view(output, {"--lcm-url", ownLcmUrl(), "--address", "0.0.0.0", "--state",
                             folder.path("state")});
    const std::string said = contentOf(output.path("view.txt"));
    const std::string fingerprint = said.substr(said.rfind("SHA-256 ") + 8, 95);
    CHECK((said.find("made now") != std::string::npos) == !again);
    if (again) CHECK(fingerprint == before);
    before = fingerprint;
    const std::string& url = view.url();
    REQUIRE(url.rfind("https://0.0.0.0:", 0) == 0);
    const size_t port = url.rfind(':') + 1;
    runScript(folder, "tls.mjs",
              {url.substr(port, url.find('/', port) - port), url.substr(url.find("token=") + 6),
               fingerprint});
  }
}

TEST_CASE("the page works behind a proxy, under a path, and operates only from one that is named") {
  const OwnFolder folder;
  const std::string pem = view::ownCertificate(folder.path("proxy")).path;
  const std::string port = std::to_string(freePort());
  const std::string how = GENERATE("keep", "rewrite");
  const bool named = GENERATE(true, false);
  CAPTURE(how, named);
  std::vector<std::string> words{"--lcm-url", ownLcmUrl(), "--token", "secret"};
  if (named) words.insert(words.end(), {"--origin", "https://127.0.0.1:" + port + "/robot/"});
  const View view(folder, words);
  // A proxy that passes on name and path makes its own page address, and finds no page under its
  // path.
  if (how == "keep" && !named) return;
  runScript(folder, "proxy.mjs", {view.url(), port, pem, how, named ? "ours" : "foreign"});
}

TEST_CASE("a proxy that is named asks for a token, and an address that is none is refused") {
  const OwnFolder folder;
  const View view(folder, {"--lcm-url", ownLcmUrl(), "--origin", "https://robot.example"});
  CHECK_THAT(view.url(), Catch::Contains("?token="));
  const auto refused = called("tread-view --origin robot.example");
  CAPTURE(refused.printed);
  CHECK(refused.status == 2);
  CHECK(refused.says("give https://HOST[:PORT][/PATH/]"));
}

TEST_CASE("what tread-view cannot use is one clear line") {
  const OwnFolder folder;
  const auto missing = called("tread-view /nowhere.lcmlog --port 0");
  CHECK(missing.status == 2);
  CHECK(missing.isOneLine());
  View first(folder, {missionLog()});
  const std::string port = first.url().substr(first.url().rfind(':') + 1);
  const auto taken =
      called("tread-view " + missionLog() + " --port " + port.substr(0, port.size() - 1));
  CHECK(taken.status == 2);
  CHECK(taken.says("is it in use"));
}

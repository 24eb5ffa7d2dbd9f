// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/host.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/bus/life_sign.hpp"
#include "common/report/text.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "tools/robot/launch/launch_file.hpp"
#include "tools/robot/launch/liveness.hpp"

namespace tread::launch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr timespec kPatience{0, 50'000'000};
constexpr int kCallsAtStart = 60;  // one each 50 ms
constexpr int kCallsAfterEnd = 3;
constexpr int kCallsAfterAbort = 20;
constexpr double kLongestLook = 0.25;   // s that may pass between two looks at signs of life
constexpr double kLongestStop = 120.0;  // s

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string utcNow() {
  const time_t now = std::time(nullptr);
  tm parts{};
  char text[32];
  std::strftime(text, sizeof text, "%F %T UTC", gmtime_r(&now, &parts));
  return text;
}

/// Supervisord looks at its processes once a second, or when somebody calls: a call that says
/// nothing makes it start, restart and stop at once.
void call(const std::string& socket_path) {
  sockaddr_un address{};
  if (socket_path.size() >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket_path.data(), socket_path.size());
  const int caller = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (caller < 0) return;
  // Nobody there yet, or a full queue: it will look by itself.
  [[maybe_unused]] const int answer =
      connect(caller, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  close(caller);
}

/// 0 if there is no such file.
ino_t inodeOf(const std::string& path) {
  struct stat facts {};
  return stat(path.c_str(), &facts) == 0 ? facts.st_ino : 0;
}

/// Reads the lines that somebody appends to a log file, also after it was rotated.
class LogFollower {
 public:
  /// What stands in the file already is skipped.
  explicit LogFollower(std::string path);
  /// The whole lines that have come since the last call.
  std::vector<std::string> newLines();

 private:
  void readRest(std::vector<std::string>& lines);

  std::string path_;
  std::ifstream file_;
  ino_t inode_ = 0;
  std::string partial_;
};

LogFollower::LogFollower(std::string path)
    : path_(std::move(path)), file_(path_), inode_(inodeOf(path_)) {
  file_.seekg(0, std::ios::end);
}

std::vector<std::string> LogFollower::newLines() {
  std::vector<std::string> lines;
  readRest(lines);
  if (const ino_t inode = inodeOf(path_); inode != 0 && inode != inode_) {
    readRest(lines);  // what was written between the reading and the renaming
    inode_ = inode;
    file_ = std::ifstream(path_);
    readRest(lines);
  }
  return lines;
}

void LogFollower::readRest(std::vector<std::string>& lines) {
  file_.clear();
  partial_.append(std::istreambuf_iterator<char>(file_), {});
  for (size_t end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
    lines.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
}

/// The parent in the text of /proc/PID/stat; 0 if it cannot be read.
pid_t parentIn(const std::string& stat) {
  const size_t bracket = stat.rfind(") ");  // a program's name may hold blanks and brackets
  pid_t parent = 0;
  if (bracket == std::string::npos || std::sscanf(stat.c_str() + bracket, ") %*c %d", &parent) != 1)
    return 0;
  return parent;
}

/// 0 if there is no such process.
pid_t parentOf(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  return parentIn({std::istreambuf_iterator<char>(file), {}});
}

/// Whether it was halted by a signal or a debugger.
bool isHalted(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string stat{std::istreambuf_iterator<char>(file), {}};
  const size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos || name_end + 2 >= stat.size()) return false;
  return stat[name_end + 2] == 'T' || stat[name_end + 2] == 't';
}

std::vector<pid_t> children() {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (parentOf(name) == getpid()) pids.push_back(std::stoi(name));
  }
  return pids;
}

/// Asks all children of this process to end, and kills those that have not after `stop_time`
/// seconds.
void endChildren(double stop_time) {
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * stop_time));
  for (const pid_t pid : children()) kill(pid, SIGINT);
  for (;;) {
    const pid_t pid = waitpid(-1, nullptr, WNOHANG);
    if (pid < 0) return;  // nobody is left
    if (pid > 0) continue;
    // A halted process sees nothing but SIGKILL; a grandchild may come to us late.
    if (std::chrono::steady_clock::now() > deadline)
      for (const pid_t child : children()) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// As nohup leaves it: this process outlives its terminal.
bool ignoresHangup() {
  struct sigaction now {};
  return sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// One run of supervisord.
class Run {
 public:
  Run(const LaunchFile& launch, const RunPaths& paths, bool watch)
      : name_(launch.name),
        paths_(paths),
        log_(paths.supervisor_log),
        progress_(launch.name, launch.processes.size()),
        liveness_(launch.processes),
        start_(Clock::now()) {
    std::error_code none;
    std::filesystem::remove(paths_.hung, none);
    if (watch) life_.emplace(paths_.life);
  }

  void begin(const RunLock& lock);
  /// Waits for the end of supervisord.
  void wait();
  /// Says how it ended; the exit code.
  int conclude() const;

 private:
  [[noreturn]] void becomeSupervisor(int lock, const sigset_t& mask, pid_t parent) const;
  void stop();
  void reap();
  void tell();
  void watch();
  void end(const Liveness::Hung& hung);

  std::string name_;
  RunPaths paths_;
  LogFollower log_;
  LaunchProgress progress_;
  Liveness liveness_;
  std::optional<LifeSignListener> life_;                     ///< null: who hangs is left alone
  std::map<std::string, std::pair<int, std::string>> hung_;  ///< how often, and the last time
  Clock::time_point start_;
  Clock::time_point looked_ = start_;
  Clock::time_point stop_{};
  sigset_t waited_{};
  pid_t supervisor_ = -1;
  bool stopping_ = false;
  bool ended_ = false;
  int calls_left_ = kCallsAtStart;
  int status_ = 0;
};

void Run::begin(const RunLock& lock) {
  sigset_t before;
  sigemptyset(&waited_);
  for (const int number : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&waited_, number);
  if (!ignoresHangup()) sigaddset(&waited_, SIGHUP);
  sigprocmask(SIG_BLOCK, &waited_, &before);
  std::signal(SIGPIPE, SIG_IGN);  // whoever reads what we say may leave
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t parent = getpid();
  supervisor_ = fork();
  if (supervisor_ == 0) becomeSupervisor(lock.descriptor(), before, parent);
  if (supervisor_ < 0) throw std::runtime_error("no further process can be started");
}

/// In a process group of its own, so that Ctrl-C reaches us alone.
void Run::becomeSupervisor(int lock, const sigset_t& mask, pid_t parent) const {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  // The lock as 3: supervisord closes what is above 4, and its processes inherit nothing above 2.
  if (lock != 3)
    dup2(lock, 3);
  else
    fcntl(lock, F_SETFD, 0);
  // Its processes inherit it.
  if (life_)
    setenv("NOTIFY_SOCKET", paths_.life.c_str(), 1);
  else
    unsetenv("NOTIFY_SOCKET");
  std::signal(SIGPIPE, SIG_DFL);
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  if (chdir(paths_.folder.c_str()) == 0)
    execlp("supervisord", "supervisord", "--configuration", paths_.config.c_str(), nullptr);
  std::perror("tread-launch: supervisord");
  _exit(127);
}

void Run::wait() {
  while (!ended_) {
    const int number = sigtimedwait(&waited_, nullptr, &kPatience);
    if (number > 0 && number != SIGCHLD) stop();
    reap();
    tell();
    if (life_) watch();
    if (stopping_ || calls_left_ > 0) call(paths_.socket);
    if (calls_left_ > 0) --calls_left_;
  }
}

void Run::stop() {
  if (!stopping_) {
    std::cout << name_ << ": stopping" << std::endl;
    stop_ = Clock::now();
  }
  stopping_ = true;
  kill(supervisor_, SIGTERM);
}

void Run::reap() {
  int status = 0;
  for (pid_t pid = 0; (pid = waitpid(-1, &status, WNOHANG)) > 0;) {
    if (pid != supervisor_) continue;
    ended_ = true;
    status_ = status;
  }
}

void Run::tell() {
  for (const std::string& line : log_.newLines()) {
    liveness_.readLog(line);
    if (LaunchProgress::isEnd(line)) calls_left_ = std::max(calls_left_, kCallsAfterEnd);
    if (const auto told = progress_.lineFor(line, secondsSince(start_)))
      std::cout << *told << std::endl;
  }
}

void Run::watch() {
  while (const auto word = life_->take()) liveness_.hear(word->pid, word->lines);
  // While we did not listen ourselves (a busy host, Ctrl-Z), nobody was silent.
  const double passed = std::min(secondsSince(looked_), kLongestLook);
  looked_ = Clock::now();
  if (stopping_) return;  // the supervisor ends them all
  for (const Liveness::Hung& hung : liveness_.pass(passed)) end(hung);
}

void Run::end(const Liveness::Hung& hung) {
  if (parentOf(std::to_string(hung.pid)) != supervisor_) return;  // it has ended by itself
  std::cout << name_ << ": " << hung.line << std::endl;
  // A halted one would have to go on to take SIGABRT, and while one of its threads does, another
  // may still send a command that it had at hand when it was halted.
  kill(hung.pid, hung.kill || isHalted(hung.pid) ? SIGKILL : SIGABRT);
  calls_left_ = std::max(calls_left_, kCallsAfterAbort);
  if (hung.kill) return;
  auto& [times, line] = hung_[hung.process];
  ++times;
  line = utcNow() + ": " + hung.line;
  std::string text;
  for (const auto& [name, what] : hung_)
    text += name + " hung " + std::to_string(what.first) + (what.first == 1 ? " time" : " times") +
            " since the start, last " + what.second + "\n";
  try {
    writeText(paths_.hung, text);
  } catch (const WriteError& error) {
    std::cerr << name_ << ": " << error.what() << std::endl;  // a full disk ends no watch
  }
}

int Run::conclude() const {
  const bool clean = WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
  if (stopping_ && clean) {
    std::cout << name_ << ": stopped after " << formatted("%.1f s", secondsSince(stop_))
              << std::endl;
    return 0;
  }
  std::cerr << name_ << ": the supervisor "
            << (WIFSIGNALED(status_) ? "was killed by signal " + std::to_string(WTERMSIG(status_))
                                     : "ended with code " + std::to_string(WEXITSTATUS(status_)))
            << ", so everything is stopped; see " << paths_.supervisor_log << std::endl;
  return 1;
}

}  // namespace

int supervise(const LaunchFile& launch, const RunPaths& paths, const RunLock& lock, bool watch) {
  int64_t stop_time = 0;
  for (const LaunchProcess& process : launch.processes)
    stop_time = std::max(stop_time, process.stop_time);
  Run run(launch, paths, watch);
  run.begin(lock);
  run.wait();
  endChildren(static_cast<double>(stop_time));
  std::error_code none;
  std::filesystem::remove(paths.socket, none);
  return run.conclude();
}

int stopRun(const std::string& name, const RunPaths& paths) {
  const int pid = RunLock::owner(paths.lock);
  if (pid == 0 && !RunLock::isHeld(paths.lock)) {
    std::cout << name << ": nothing runs in " << paths.folder << std::endl;
    return 0;
  }
  const auto start = Clock::now();
  if (pid > 0 && kill(pid, SIGTERM) != 0) {
    std::cerr << name << ": pid " << pid << " is not ours to stop (" << std::strerror(errno)
              << "); stop it as the user who started it" << std::endl;
    return 1;
  }
  while (RunLock::isHeld(paths.lock)) {
    if (secondsSince(start) > kLongestStop) {
      std::cerr << name << ": still runs after " << formatted("%.1f s", kLongestStop)
                << "; its supervisor's pid is in " << paths.pid << std::endl;
      return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << name << ": stopped after " << formatted("%.1f s", secondsSince(start)) << std::endl;
  return 0;
}

}  // namespace tread::launch

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/process_keeper.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/bus/life_sign.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "tools/robot/launch/liveness.hpp"
#include "tools/robot/launch/process_table.hpp"

namespace tread::launch {
namespace {

constexpr timespec kLookEvery{0, 50'000'000};
constexpr double kLongestLook =
    0.25;                           // [s] counted at most between two checks of the signs of life
constexpr double kTrimEvery = 1.0;  // [s]
constexpr uintmax_t kLargestLog = 5'000'000;
constexpr int kOldLogs = 3;

double secondsNow() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string utcNow() {
  const time_t now = std::time(nullptr);
  tm parts{};
  char text[32];
  std::strftime(text, sizeof text, "%F %T UTC", gmtime_r(&now, &parts));
  return text;
}

int signalOf(const std::string& name) {
  static const std::map<std::string, int> kNumbers{
      {"INT", SIGINT}, {"TERM", SIGTERM}, {"HUP", SIGHUP}, {"QUIT", SIGQUIT}};
  return kNumbers.at(name);
}

/// Whether a signal or a debugger has halted the process.
bool isHalted(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string stat{std::istreambuf_iterator<char>(file), {}};
  const size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos || name_end + 2 >= stat.size()) return false;
  return stat[name_end + 2] == 'T' || stat[name_end + 2] == 't';
}

/// Prints a line unless the terminal blocks: supervision must not wait for a reader.
void say(int terminal, const std::string& line) {
  pollfd ready{terminal, POLLOUT, 0};
  if (poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return;
  const std::string text = line + "\n";
  [[maybe_unused]] const ssize_t written = ::write(terminal, text.data(), text.size());
}

/// Opened for appending, also after it was emptied.
int openedLog(const std::string& path) {
  return ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
}

/// Replaces a file without fsync, as its content is worthless after a power failure. If writing
/// fails the file is removed, since an old one would be wrong.
void replaceQuickly(const std::string& path, const std::string& text) {
  const std::string next = path + ".next";
  const int file = ::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const ssize_t written = file < 0 ? -1 : ::write(file, text.data(), text.size());
  if (file >= 0) ::close(file);
  const bool whole = written == static_cast<ssize_t>(text.size());
  if (!whole || std::rename(next.c_str(), path.c_str()) != 0) ::unlink(path.c_str());
}

/// Copies and empties a log that has grown too large; the process that writes it keeps it open.
void trim(const std::string& path) {
  std::error_code none;
  const uintmax_t size = std::filesystem::file_size(path, none);
  if (none || size < kLargestLog) return;
  const auto old = [&](int number) { return path + "." + std::to_string(number); };
  const std::string copy = path + ".next";
  std::error_code failed;
  std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing, failed);
  if (failed) return static_cast<void>(std::filesystem::remove(copy, none));
  for (int i = kOldLogs; i > 1; --i) std::filesystem::rename(old(i - 1), old(i), none);
  std::filesystem::rename(copy, old(1), none);
  std::filesystem::resize_file(path, 0, none);
}

class Keeper {
 public:
  explicit Keeper(const KeptProcesses& kept);
  /// Returns when all processes have stopped.
  void run();

 private:
  std::string logOf(size_t process) const;
  void carryOut(const ProcessTable::Task& task);
  std::optional<int> start(size_t process) const;
  [[noreturn]] void become(size_t process) const;
  void reap();
  void tell();
  void watch();
  void end(const Liveness::Hung& hung);
  void noteHung(const Liveness::Hung& hung);
  void write(const std::string& path, const std::string& text) const;

  const KeptProcesses& kept_;
  ProcessTable table_;
  Liveness liveness_;
  std::optional<LifeSignListener> life_;  ///< null: hanging processes are not detected
  std::map<std::string, std::pair<int, std::string>> hung_;  ///< count, and the last occurrence
  sigset_t waited_{};
  int log_;
  double looked_;
  double trimmed_;
  bool stopping_ = false;
};

std::vector<LaunchProcess> processesOf(const KeptProcesses& kept) {
  std::vector<LaunchProcess> processes;
  for (const SupervisedProcess& supervised : kept.processes)
    processes.push_back(supervised.process);
  return processes;
}

Keeper::Keeper(const KeptProcesses& kept)
    : kept_(kept),
      table_(kept.launch, processesOf(kept)),
      liveness_(processesOf(kept)),
      log_(openedLog(kept.paths.supervisor_log)),
      looked_(secondsNow()),
      trimmed_(looked_) {
  std::error_code none;
  std::filesystem::remove(kept_.paths.hung, none);
  if (kept_.watch) life_.emplace(kept_.paths.life);
  sigemptyset(&waited_);
  for (const int number : {SIGTERM, SIGCHLD}) sigaddset(&waited_, number);
  write(kept_.paths.pid, std::to_string(getpid()) + "\n");
}

void Keeper::run() {
  while (!table_.done()) {
    for (const ProcessTable::Task& task : table_.due(secondsNow())) carryOut(task);
    if (sigtimedwait(&waited_, nullptr, &kLookEvery) == SIGTERM) {
      stopping_ = true;
      table_.stop();
    }
    reap();
    if (life_) watch();
    tell();  // last, as a slow disk must not delay a stop
  }
  tell();
}

std::string Keeper::logOf(size_t process) const {
  return kept_.paths.logs + "/" + kept_.processes[process].process.name + ".log";
}

void Keeper::carryOut(const ProcessTable::Task& task) {
  const LaunchProcess& process = kept_.processes[task.process].process;
  if (task.kind == ProcessTable::Task::kAskToEnd) {
    kill(task.pid, signalOf(process.stop_signal));
  } else if (task.kind == ProcessTable::Task::kKill) {
    kill(-task.pid, SIGKILL);
  } else {
    const std::optional<int> pid = start(task.process);
    table_.started(task.process, pid, secondsNow());
    if (pid) liveness_.started(process.name, *pid);
  }
}

std::optional<int> Keeper::start(size_t process) const {
  const pid_t pid = fork();
  if (pid == 0) become(process);
  if (pid < 0) return std::nullopt;
  setpgid(pid, pid);  // also in the parent: the group must exist before it can be killed
  return pid;
}

void Keeper::become(size_t process) const {
  setpgid(0, 0);
  const int nothing = ::open("/dev/null", O_RDONLY);
  const int log = openedLog(logOf(process));
  dup2(nothing, STDIN_FILENO);
  if (log >= 0)
    for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(log, output);
  if (nothing > STDERR_FILENO) ::close(nothing);
  if (life_)
    setenv("NOTIFY_SOCKET", kept_.paths.life.c_str(), 1);
  else
    unsetenv("NOTIFY_SOCKET");
  // A background shell may have set them to SIG_IGN; SIGHUP belongs to nohup.
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGQUIT, SIGCHLD})
    std::signal(number, SIG_DFL);
  sigprocmask(SIG_SETMASK, &kept_.mask, nullptr);
  becomeProgram(kept_.processes[process].command);
  std::perror(kept_.processes[process].command.front().c_str());
  _exit(127);
}

void Keeper::reap() {
  int status = 0;
  for (pid_t pid = 0; (pid = waitpid(-1, &status, WNOHANG)) > 0;)
    if (const auto process = table_.ended(pid, status, secondsNow()))
      liveness_.ended(kept_.processes[*process].process.name);
}

void Keeper::tell() {
  std::string lines;
  for (const ProcessTable::Event& event : table_.takeEvents()) {
    lines += utcNow() + " " + event.log + "\n";
    if (!event.told.empty()) say(STDOUT_FILENO, event.told);
  }
  if (!lines.empty()) {
    [[maybe_unused]] const ssize_t written = ::write(log_, lines.data(), lines.size());
    replaceQuickly(kept_.paths.status, table_.status());
  }
  if (secondsNow() < trimmed_ + kTrimEvery) return;
  trimmed_ = secondsNow();
  trim(kept_.paths.supervisor_log);
  for (size_t i = 0; i < kept_.processes.size(); ++i) trim(logOf(i));
}

void Keeper::watch() {
  while (const auto word = life_->take()) liveness_.hear(word->pid, word->lines);
  // If we were halted ourselves (busy host, Ctrl-Z), the silence is not the processes' fault.
  const double now = secondsNow();
  const double passed = std::min(now - std::exchange(looked_, now), kLongestLook);
  if (stopping_) return;  // they are being stopped in order
  for (const Liveness::Hung& hung : liveness_.pass(passed)) end(hung);
}

void Keeper::end(const Liveness::Hung& hung) {
  say(STDOUT_FILENO, kept_.launch + ": " + hung.line);
  // A halted process would have to be continued to handle SIGABRT, and one of its threads might
  // then send a stale command.
  kill(hung.pid, hung.kill || isHalted(hung.pid) ? SIGKILL : SIGABRT);
  if (!hung.kill) noteHung(hung);
}

void Keeper::noteHung(const Liveness::Hung& hung) {
  auto& [times, line] = hung_[hung.process];
  ++times;
  line = utcNow() + ": " + hung.line;
  std::string text;
  for (const auto& [name, what] : hung_)
    text += name + " hung " + std::to_string(what.first) + (what.first == 1 ? " time" : " times") +
            " since the start, last " + what.second + "\n";
  write(kept_.paths.hung, text);
}

/// A full disk must not end the supervision.
void Keeper::write(const std::string& path, const std::string& text) const {
  try {
    writeText(path, text);
  } catch (const WriteError& error) {
    say(STDERR_FILENO, kept_.launch + ": " + error.what());
  }
}

}  // namespace

void becomeKeeper(const KeptProcesses& kept, const RunLock& lock, pid_t parent) {
  setpgid(0, 0);  // Ctrl-C reaches only the parent
  std::signal(SIGTTOU,
              SIG_IGN);  // a background process that writes to the terminal may be halted otherwise
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent || chdir(kept.paths.folder.c_str()) != 0) _exit(1);
  const auto held = static_cast<unsigned>(lock.descriptor());
  if (held > STDERR_FILENO + 1) close_range(STDERR_FILENO + 1, held - 1, 0);
  close_range(held + 1, ~0U, 0);
  try {
    Keeper(kept).run();
  } catch (const std::exception& error) {
    std::cerr << kept.launch << ": " << error.what() << std::endl;
    _exit(1);
  }
  _exit(0);
}

}  // namespace tread::launch

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/launch_file.hpp"

#include <charconv>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "common/report/text.hpp"

namespace tread::launch {
namespace {

/// Supervisor replaces %(name)s everywhere; a plain percent sign is written twice.
std::string withoutPercent(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '%' ? "%%" : std::string(1, c);
  return result;
}

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string("-_./:=@,+%").find(c) != std::string::npos;
}

std::string quotedWord(const std::string& word) {
  if (word.empty()) return "''";
  std::string result;
  for (const char c : word) {
    // A backslash before each special character keeps blank and # apart, which would begin a
    // comment; a blank itself must not be the last character of the line.
    if (isPlain(c) || static_cast<unsigned char>(c) >= 0x80)
      result += c;
    else
      result += c == ' ' ? "' '" : std::string("\\") + c;
  }
  return result;
}

/// Paths are those below the run folder, in which the supervisor works: it expands some values
/// twice and others once, so that no spelling of a percent sign in them would do.
void writeCommon(std::ostream& out, const std::string& name, bool as_root) {
  const RunPaths paths(".");
  out << "; Written by tread-launch at each start; changes are lost.\n"
      << "[unix_http_server]\n"
      << "file=" << paths.socket << "\n"
      << "chmod=0700\n\n"
      << "[supervisord]\n"
      << "identifier=tread-" << name << "\n"
      << "nodaemon=true\n"
      << "silent=true\n"  // tread-launch tells what happens
      << "logfile=" << paths.supervisor_log << "\n"
      << "logfile_maxbytes=1MB\n"
      << "logfile_backups=3\n"
      << "pidfile=" << paths.pid << "\n";
  if (as_root) out << "user=root\n";  // else it warns of it at each start
  out << "\n[rpcinterface:supervisor]\n"
      << "supervisor.rpcinterface_factory = supervisor.rpcinterface:make_main_rpcinterface\n\n"
      << "[supervisorctl]\n"
      << "serverurl=unix://" << paths.socket << "\n";
}

void writeProcess(std::ostream& out, const SupervisedProcess& supervised, size_t place) {
  const LaunchProcess& process = supervised.process;
  out << "\n[program:" << process.name << "]\n"
      << "command=" << supervisorCommand(supervised.command) << "\n"
      << "priority=" << 10 * (place + 1) << "\n"  // the order of starting; stopped in reverse
      << "autorestart=true\n"
      << "startsecs=1\n"
      << "startretries=1000000\n"
      << "stopsignal=" << process.stop_signal << "\n"
      << "stopwaitsecs=" << process.stop_time << "\n"
      << "killasgroup=true\n"
      << "redirect_stderr=true\n"
      << "stdout_logfile=" << RunPaths(".").logs << "/" << process.name << ".log\n"
      << "stdout_logfile_maxbytes=5MB\n"
      << "stdout_logfile_backups=3\n";
}

constexpr const char* kExited = " exited: ";

/// The text after `mark`, or nothing if it does not stand in the line.
std::optional<std::string> after(const std::string& line, const std::string& mark) {
  const size_t at = line.find(mark);
  if (at == std::string::npos) return std::nullopt;
  return line.substr(at + mark.size());
}

/// What stands between the first two of `mark`.
std::string between(const std::string& text, char first, char last) {
  const size_t begin = text.find(first);
  const size_t end = text.find(last, begin + 1);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(begin + 1, end - begin - 1);
}

std::string firstWord(const std::string& text) {
  return text.substr(0, text.find(' '));
}

}  // namespace

RunPaths::RunPaths(const std::string& run)
    : folder(run),
      lock(run + "/lock"),
      config(run + "/supervisord.conf"),
      socket(run + "/supervisor.sock"),
      life(run + "/life.sock"),
      hung(run + "/hung"),
      pid(run + "/supervisord.pid"),
      logs(run + "/log"),
      supervisor_log(run + "/log/supervisord.log") {}

std::string supervisorCommand(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words)
    line += (line.empty() ? "" : " ") + withoutPercent(quotedWord(word));
  return line;
}

std::string supervisorConfig(const std::string& name,
                             const std::vector<SupervisedProcess>& processes, bool as_root) {
  std::ostringstream out;
  writeCommon(out, name, as_root);
  for (size_t i = 0; i < processes.size(); ++i) writeProcess(out, processes[i], i);
  return out.str();
}

std::optional<Spawned> spawnedIn(const std::string& log_line) {
  const auto rest = after(log_line, " spawned: ");
  const auto pid = rest ? after(*rest, "' with pid ") : std::nullopt;
  int number = 0;
  if (!pid || std::from_chars(pid->data(), pid->data() + pid->size(), number).ec != std::errc())
    return std::nullopt;
  return Spawned{between(*rest, '\'', '\''), number};
}

std::optional<std::string> endedIn(const std::string& log_line) {
  for (const char* mark : {kExited, " stopped: "})
    if (const auto rest = after(log_line, mark)) return firstWord(*rest);
  return std::nullopt;
}

LaunchProgress::LaunchProgress(std::string name, size_t processes)
    : name_(std::move(name)), processes_(processes) {}

bool LaunchProgress::isEnd(const std::string& log_line) {
  return after(log_line, kExited).has_value();
}

std::optional<std::string> LaunchProgress::lineFor(const std::string& log_line, double seconds) {
  if (const auto rest = after(log_line, " success: ")) return running(firstWord(*rest), seconds);
  if (const auto rest = after(log_line, kExited))
    return ended(firstWord(*rest), between(*rest, '(', ')'));
  if (const auto rest = after(log_line, " killing "))
    return name_ + ": " + between(*rest, '\'', '\'') + " did not stop in time and is killed";
  if (const auto rest = after(log_line, " gave up: "))
    return name_ + ": " + firstWord(*rest) + ": it never ran for a second";
  if (const auto rest = after(log_line, " spawnerr: ")) return name_ + ": " + *rest;
  return std::nullopt;
}

std::optional<std::string> LaunchProgress::ended(const std::string& process,
                                                 const std::string& how) {
  const int times = ++ends_[process];
  const std::string start = name_ + ": " + process;
  if (times == 1) return start + " ended (" + how + ")";
  if (times == 2)
    return start + " ended again (" + how + "); the pauses before it is started grow, see log/" +
           process + ".log";
  return std::nullopt;
}

std::optional<std::string> LaunchProgress::running(const std::string& process, double seconds) {
  const bool back = ends_.erase(process) > 0;
  const bool first = ran_.insert(process).second;
  if (first && ran_.size() == processes_)
    return formatted("%s: all %zu processes run after %.1f s", name_.c_str(), processes_, seconds);
  if (back) return name_ + ": " + process + " runs again";
  return std::nullopt;
}

}  // namespace tread::launch

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/host.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/link/make_link.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/seal/key_file.hpp"
#include "common/store/output_file.hpp"
#include "tools/robot/launch/supervision.hpp"

namespace tread::launch {
namespace {

struct flock wholeFile() {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  return range;
}

/// Reads a command's output until it ends or the time is over.
std::string readAll(int descriptor, std::chrono::steady_clock::time_point deadline) {
  std::string output;
  char piece[1024];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    pollfd waiting{descriptor, POLLIN, 0};
    if (left.count() <= 0 || poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
    const ssize_t size = read(descriptor, piece, sizeof piece);
    if (size <= 0) break;
    output.append(piece, static_cast<size_t>(size));
  }
  return output;
}

namespace fs = std::filesystem;

std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

bool isProgram(const std::string& path) {
  std::error_code none;
  return fs::is_regular_file(path, none) && access(path.c_str(), X_OK) == 0;
}

/// The address in a configuration file, other keys ignored; empty if none can be read.
std::string configuredAddress(const std::string& path) {
  std::string address;
  try {
    ConfigReader reader = ConfigReader::fromFile(path);
    reader.text("address", address);
  } catch (const ConfigError&) {
    return "";  // the program's own --check reports the problem
  }
  return address;
}

ProcessFacts processFacts(const LaunchProcess& process, const std::string& lcm_url,
                          const LaunchSettings& settings) {
  ProcessFacts facts;
  facts.name = process.name;
  facts.program = process.program;
  const std::string program = findProgram(process.program, settings.bin);
  facts.program_found = !program.empty();
  facts.config = process.config;
  facts.config_readable = process.config.empty() || access(process.config.c_str(), R_OK) == 0;
  const auto check = checkCommand(process, program, lcm_url);
  if (facts.program_found && facts.config_readable && !check.empty()) {
    constexpr double kPatience = 60.0;  // [s] on a busy machine; most answer within half a second
    const CommandOutcome outcome = runCommand(check, kPatience);
    facts.check_code = outcome.code;
    (outcome.code == 0 ? facts.configuration : facts.check_line) =
        outcome.code == 0 ? outcome.output : firstLine(outcome.output);
  }
  const std::string address =
      process.config.empty() || !facts.config_readable ? "" : configuredAddress(process.config);
  facts.device = deviceOf(process.arguments, address, settings.run);
  facts.device_present = access(facts.device.c_str(), F_OK) == 0;
  facts.device_usable = access(facts.device.c_str(), R_OK | W_OK) == 0;
  return facts;
}

/// A socket that is closed by its destructor.
class Socket {
 public:
  Socket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Whether a datagram to the group, sent as LCM sends it, comes back within 1 s; a busy host may
/// need most of that.
bool delivered(const LcmAddress& address) {
  const Socket socket;
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_ANY);
  ip_mreq group{};
  if (inet_pton(AF_INET, address.group.c_str(), &group.imr_multiaddr) != 1) return false;
  socklen_t size = sizeof place;
  auto* generic = reinterpret_cast<sockaddr*>(&place);
  if (bind(socket.get(), generic, sizeof place) != 0 ||
      getsockname(socket.get(), generic, &size) != 0 ||
      setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
    return false;
  const auto ttl = static_cast<unsigned char>(address.ttl);
  setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  place.sin_addr = group.imr_multiaddr;
  const char word[] = "tread-launch";
  if (sendto(socket.get(), word, sizeof word, 0, generic, sizeof place) != sizeof word)
    return false;
  pollfd waiting{socket.get(), POLLIN, 0};
  return poll(&waiting, 1, 1000) == 1;
}

/// Flags in this process's network namespace; sysfs may show another one.
unsigned int loopbackFlags() {
  const Socket socket;
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  if (ioctl(socket.get(), SIOCGIFFLAGS, &request) != 0) return 0;
  return static_cast<unsigned short>(request.ifr_flags);
}

/// Receive buffer that the kernel grants of a wanted size; Linux reports twice the size.
int64_t grantedBuffer(int64_t wanted) {
  const Socket socket;
  int size = static_cast<int>(std::min<int64_t>(wanted, 1 << 30));
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  socklen_t length = sizeof size;
  getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &size, &length);
  return size / 2;
}

/// Problems of the robot's key; empty if there are none.
std::vector<HostFinding> checkKey(const LaunchFile& launch) {
  if (launch.key.empty() && !launch.simulated)
    return {{false, "without a key every program of this host can arm and drive the robot",
             "leave key: none out of the launch file"}};
  std::error_code none;
  if (launch.makes_key && !fs::exists(fs::symlink_status(launch.key, none))) return {};
  try {
    if (!launch.key.empty()) readKey(launch.key);
    return {};
  } catch (const std::runtime_error& error) {
    const std::string line = error.what();
    const size_t end = line.find("; ");
    return {{true, line.substr(0, end), end == std::string::npos ? "" : line.substr(end + 2)}};
  }
}

/// With TCP tread-launch itself is the server.
std::vector<HostFinding> checkRelay(const LcmAddress& address) {
  if (address.provider != "tcpq") return {};
  try {
    requireListening("tcp-server:127.0.0.1:" + std::to_string(address.port));
    return {};
  } catch (const std::runtime_error& error) {
    const std::string line = error.what();
    return {{true, line.substr(0, line.find("; ")),
             "end the program that has it, or use --lcm-url tcpq://127.0.0.1:PORT"}};
  }
}

/// Determines the host's multicast settings; sends one datagram to the group on a separate port.
NetworkFacts networkFacts(const LcmAddress& address, bool sealed) {
  NetworkFacts facts;
  facts.sealed = sealed;
  if (address.provider != "udpm") return facts;
  facts.can_ask = !findProgram("ip", "").empty();
  facts.route_device = routeDevice(runCommand({"ip", "route", "get", address.group}, 5.0).output);
  const unsigned int flags = loopbackFlags();
  facts.loopback_up = (flags & IFF_UP) != 0;
  facts.loopback_multicast = (flags & IFF_MULTICAST) != 0;
  facts.delivered = delivered(address);
  facts.receive_buffer = grantedBuffer(std::max(kWantedBuffer, address.receive_buffer));
  return facts;
}

}  // namespace

void takeNamedKey(LaunchFile& launch) {
  const char* const named = std::getenv("TREAD_KEY");
  if (named == nullptr || *named == '\0' || (!launch.key.empty() && !launch.makes_key)) return;
  launch.key = named;
  launch.makes_key = false;
}

std::string provideKey(const LaunchFile& launch) {
  if (launch.key.empty()) return "";
  const bool made = launch.makes_key && ensureKey(launch.key);
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return launch.name + ": key " + launch.key + (made ? " (made now)" : "") + ", fingerprint " +
         fingerprint(readKey(launch.key)) + "; this user's programs find it; at a station: scp " +
         host + ":" + launch.key + " tread.key && export TREAD_KEY=$PWD/tread.key";
}

RunLock::RunLock(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0)
    throw std::runtime_error(path + ": cannot be made (" + std::strerror(errno) + ")");
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int pid = owner(path);
    close(descriptor_);
    throw std::runtime_error("runs already in this folder" +
                             (pid > 0 ? " (pid " + std::to_string(pid) + ")" : std::string()) +
                             "; stop it with --stop, or use another folder with --run");
  }
  struct flock range = wholeFile();
  fcntl(descriptor_, F_SETLK, &range);
}

RunLock::~RunLock() {
  close(descriptor_);
}

bool RunLock::isHeld(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  close(descriptor);
  return held;
}

int RunLock::owner(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  struct flock range = wholeFile();
  const bool asked = fcntl(descriptor, F_GETLK, &range) == 0;
  close(descriptor);
  return asked && range.l_type != F_UNLCK ? range.l_pid : 0;
}

void becomeProgram(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
}

CommandOutcome runCommand(const std::vector<std::string>& words, double seconds) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {127, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], 1);
    dup2(ends[1], 2);
    becomeProgram(words);
    _exit(127);
  }
  close(ends[1]);
  CommandOutcome outcome;
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * seconds));
  outcome.output = readAll(ends[0], deadline);
  close(ends[0]);
  const bool late = std::chrono::steady_clock::now() >= deadline;
  if (late) kill(child, SIGKILL);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return {127, "could not be started"};
  outcome.code = late ? 124 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (late) outcome.output = "took more than " + std::to_string(static_cast<int>(seconds)) + " s";
  return outcome;
}

std::string ownFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path().string();
}

std::string defaultRunFolder(const std::string& name) {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return std::string(state) + "/tread/" + name;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.local/state/tread/" + name;
  throw std::runtime_error(
      "there is no HOME for the folder of states; name one with --run DIR, or --state DIR");
}

std::string findProgram(const std::string& word, const std::string& bin) {
  if (word.find('/') != std::string::npos) return isProgram(word) ? word : "";
  if (isProgram(bin + "/" + word)) return bin + "/" + word;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (std::string file = folder.append("/").append(word); isProgram(file)) return file;
  return "";
}

/// Tests by creating a file: permissions do not show a read-only or full file system.
bool takesFiles(const std::string& folder) {
  try {
    checkOutputs({{folder + "/trial"}}, {}, true);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Files that another user's run has left, for instance root's.
void findForeign(const std::string& folder, FolderFacts& facts) {
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(folder, none)) {
    if (entry.is_symlink(none) || access(entry.path().c_str(), W_OK) == 0) continue;
    struct stat status {};
    lstat(entry.path().c_str(), &status);
    const passwd* const user = getpwuid(status.st_uid);
    facts.foreign = entry.path().string();
    facts.owner_of_foreign = user != nullptr ? user->pw_name : std::to_string(status.st_uid);
    return;
  }
}

FolderFacts folderFacts(const RunPaths& paths) {
  FolderFacts facts;
  facts.path = paths.folder;
  facts.longest_socket = paths.life.size();
  // A missing folder counts as writable if its nearest existing parent is.
  fs::path nearest = paths.folder;
  std::error_code none;
  const auto isThere = [&] { return fs::exists(fs::symlink_status(nearest, none)); };
  while (!isThere() && nearest.has_relative_path()) nearest = nearest.parent_path();
  if (isThere() && !fs::is_directory(nearest, none)) facts.no_folder = nearest.string();
  facts.writable = takesFiles(nearest.string());
  findForeign(paths.folder, facts);
  struct statvfs disk {};
  if (statvfs(nearest.c_str(), &disk) == 0)
    facts.free_bytes = static_cast<int64_t>(disk.f_bavail) * static_cast<int64_t>(disk.f_frsize);
  facts.occupied = RunLock::isHeld(paths.lock);
  facts.owner = RunLock::owner(paths.lock);
  return facts;
}

/// Checks across processes, on the effective configurations that --check prints.
std::vector<HostFinding> checkTogether(const std::string& mapping, const std::string& learner) {
  try {
    double marking_range = 0.0;
    std::string patterns;
    ConfigReader::fromText(mapping, "tread-mapping --check")
        .number("marking_range", marking_range, {0.0, 1e3}, "m");
    ConfigReader::fromText(learner, "tread-learner --check").text("patterns", patterns);
    return checkReach(readPatternFile(patterns), marking_range);
  } catch (const ConfigError& error) {
    return {{false, error.what(), "programs of one build"}};
  }
}

std::vector<HostFinding> checkHost(const LaunchFile& launch, const LaunchSettings& settings) {
  std::vector<HostFinding> findings;
  const auto add = [&](const std::vector<HostFinding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  add(checkFolder(folderFacts(RunPaths(settings.run))));
  if (findProgram("setpriv", "").empty()) findings.push_back(missingTool("setpriv", "util-linux"));
  add(checkKey(launch));
  if (const auto address = parseLcmUrl(launch.lcm_url)) {
    add(checkNetwork(*address, networkFacts(*address, !launch.key.empty()), launch.simulated));
    add(checkRelay(*address));
  } else
    findings.push_back(
        {true, "LCM URL '" + launch.lcm_url + "' cannot be read", urlRemedy(launch.simulated)});
  std::string mapping;
  std::string learner;
  for (const LaunchProcess& process : launch.processes) {
    const ProcessFacts facts = processFacts(process, launch.lcm_url, settings);
    add(checkProcess(facts));
    if (facts.program == "tread-mapping") mapping = facts.configuration;
    if (facts.program == "tread-learner") learner = facts.configuration;
  }
  if (!mapping.empty() && !learner.empty()) add(checkTogether(mapping, learner));
  return findings;
}

}  // namespace tread::launch

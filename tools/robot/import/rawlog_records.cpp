// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/rawlog_records.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "common/recordings/csv_table.hpp"
#include "tools/robot/import/rawlog_objects.hpp"

namespace tread::import {
namespace {

using recordings::RecordingError;

constexpr rlim_t kMostMemory = rlim_t{4} << 30U;  // [bytes] of the reader
constexpr int kLongestSilence = 30'000;           // [ms] for reading one object
constexpr uint32_t kLongestRecord = 64U << 20U;   // [bytes]

enum class Kind : uint32_t { kPose, kScan, kLeftOut, kProblem, kEnd };

struct Header {
  Kind kind = Kind::kEnd;
  uint32_t size = 0;  // [bytes] that follow
  double time = 0.0;
};

void writeAll(int pipe, const void* data, size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);  // the reader of the pipe is gone
    at += written;
    size -= static_cast<size_t>(written);
  }
}

void send(int pipe, Kind kind, double time, const void* data, size_t size) {
  const Header header{kind, static_cast<uint32_t>(size), time};
  writeAll(pipe, &header, sizeof header);
  writeAll(pipe, data, size);
}

struct Sender {
  int pipe;

  void operator()(const PoseSample& pose) const {
    const std::array<double, 3> numbers{pose.T_map_body.x, pose.T_map_body.y, pose.T_map_body.yaw};
    send(pipe, Kind::kPose, pose.time, numbers.data(), sizeof numbers);
  }
  void operator()(const RawlogScan& scan) const {
    std::vector<uint8_t> bytes(static_cast<size_t>(scan.message.getEncodedSize()));
    scan.message.encode(bytes.data(), 0, static_cast<unsigned>(bytes.size()));
    send(pipe, Kind::kScan, scan.time, bytes.data(), bytes.size());
  }
  void operator()(const LeftOut& left) const {
    send(pipe, Kind::kLeftOut, left.lost ? 1.0 : 0.0, left.what.data(), left.what.size());
  }
  void operator()(const RawlogProblem& problem) const {
    send(pipe, Kind::kProblem, 0.0, problem.what.data(), problem.what.size());
  }
};

/// The child process; never returns.
[[noreturn]] void readAndSend(const std::string& path, int pipe) {
  const rlimit memory{kMostMemory, kMostMemory};
  ::setrlimit(RLIMIT_AS, &memory);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  // MRPT prints many lines about damage; we report one.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  readRawlogObjects(path, [pipe](const RawlogRecord& record) { std::visit(Sender{pipe}, record); });
  send(pipe, Kind::kEnd, 0.0, nullptr, 0);
  ::_exit(0);
}

/// Reads `size` bytes; false at the end of the pipe and after a timeout, which sets `silent`.
bool readAll(int pipe, void* data, size_t size, bool& silent) {
  auto* at = static_cast<char*>(data);
  while (size > 0) {
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, kLongestSilence);
    if (ready < 0 && errno == EINTR) continue;
    silent = ready == 0;
    if (ready <= 0) return false;
    const ssize_t count = ::read(pipe, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

RawlogRecord recordOf(const Header& header, const std::vector<uint8_t>& bytes) {
  const std::string text(bytes.begin(), bytes.end());
  if (header.kind == Kind::kLeftOut) return LeftOut{text, header.time != 0.0};
  if (header.kind == Kind::kProblem) return RawlogProblem{text};
  if (header.kind == Kind::kScan) {
    RawlogScan scan;
    scan.time = header.time;
    if (scan.message.decode(bytes.data(), 0, static_cast<unsigned>(bytes.size())) >= 0) return scan;
  }
  std::array<double, 3> numbers{};
  if (header.kind != Kind::kPose || bytes.size() != sizeof numbers)
    return RawlogProblem{"its reader sent an invalid record"};
  std::memcpy(numbers.data(), bytes.data(), sizeof numbers);
  return PoseSample{header.time, {numbers[0], numbers[1], numbers[2]}};
}

}  // namespace

void readRawlogRecords(const std::string& path, const std::function<void(RawlogRecord)>& take) {
  if (::access(path.c_str(), R_OK) != 0)
    throw RecordingError(path + ": cannot be read: " + std::strerror(errno));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw RecordingError(path + ": no pipe to its reader: " + std::strerror(errno));
  const pid_t reader = ::fork();
  if (reader < 0) throw RecordingError(path + ": no process to read it: " + std::strerror(errno));
  if (reader == 0) {
    ::close(ends[0]);
    readAndSend(path, ends[1]);
  }
  ::close(ends[1]);
  bool silent = false;
  bool ended = false;
  Header header;
  while (!ended && readAll(ends[0], &header, sizeof header, silent)) {
    if (header.kind == Kind::kEnd) {
      ended = true;
    } else if (header.size <= kLongestRecord) {
      std::vector<uint8_t> bytes(header.size);
      if (!readAll(ends[0], bytes.data(), bytes.size(), silent)) break;
      take(recordOf(header, bytes));
    } else {
      break;
    }
  }
  ::close(ends[0]);
  if (!ended) ::kill(reader, SIGKILL);
  while (::waitpid(reader, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (!ended) take(RawlogProblem{silent ? "its reader hung for 30 s" : "its reader crashed"});
}

}  // namespace tread::import

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/log/event_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <stdexcept>
#include <utility>

#include "common/log/older_types.hpp"
#include "common/seal/seal.hpp"

namespace tread {
namespace {

// An LCM event log is a sequence of events: sync word, event number (64 bits), utime (64), length
// of the channel's name (32), length of the message (32), name, message; all big-endian.
constexpr uint32_t kLogSync = 0xEDA1DA01;
constexpr size_t kLogHeaderSize = 28;  // [bytes]
/// LCM's longest channel name.
constexpr uint32_t kLongestChannel = 63;

/// Writes a big-endian number of `Size` bytes.
template <size_t Size>
void putBigEndian(uint8_t* at, uint64_t value) {
  for (size_t i = 0; i < Size; ++i) at[i] = static_cast<uint8_t>(value >> (8 * (Size - 1 - i)));
}

/// Reads a big-endian number of `Size` bytes.
template <size_t Size>
uint64_t getBigEndian(const uint8_t* at) {
  uint64_t value = 0;
  for (size_t i = 0; i < Size; ++i) value = (value << 8) | at[i];
  return value;
}

}  // namespace

struct LogWriter::File {
  OutputFile output;
  std::string path;
  uint64_t events = 0;
  int exceptions = std::uncaught_exceptions();
  bool closed = false;
};

LogWriter::LogWriter(const std::string& path, OutputFile::Kind kind)
    : file_(new File{OutputFile(path, kind), path}) {}

LogWriter::~LogWriter() {
  // A log cut short by an exception is not kept.
  if (std::uncaught_exceptions() == file_->exceptions) try {
      close();
    } catch (const WriteError&) {
    }
}

void LogWriter::write(int64_t utime, const std::string& channel, const uint8_t* bytes,
                      size_t size) {
  if (channel.empty() || channel.size() > kLongestChannel || size > INT32_MAX)
    throw std::invalid_argument("log " + file_->path + ": channel \"" + channel + "\" with " +
                                std::to_string(size) +
                                " bytes; a name has 1..63 characters, a message less than 2 GiB");
  uint8_t header[kLogHeaderSize];
  putBigEndian<4>(header, kLogSync);
  putBigEndian<8>(header + 4, file_->events++);
  putBigEndian<8>(header + 12, static_cast<uint64_t>(utime));
  putBigEndian<4>(header + 20, channel.size());
  putBigEndian<4>(header + 24, size);
  file_->output.write(header, sizeof header);
  file_->output.write(channel);
  file_->output.write(bytes, size);
}

void LogWriter::flush() {
  file_->output.flush();
}

void LogWriter::close() {
  if (!std::exchange(file_->closed, true)) file_->output.commit();
}

// Replaces lcm::LogFile, which skips to the next sync word without reporting it, and allocates any
// length that a damaged header gives.
struct LogReader::File {
  explicit File(const std::string& log_path);
  ~File() { ::close(fd); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// A part of the log in memory; nullptr if it is beyond the end.
  const uint8_t* view(uint64_t from, size_t count);
  /// Whether a sync word is here, or the part of one that the log still has.
  bool isSync(uint64_t at);
  /// Whether an event may begin here: sync word, possible lengths, followed by another event or the
  /// end.
  bool fits(uint64_t at, size_t& channel_size, size_t& message_size);
  /// Whether the event that begins here is complete; returns its lengths.
  bool measure(uint64_t at, size_t& channel_size, size_t& message_size);
  /// Goes to the next complete event, or to the end.
  void skipDamage();
  void describe();

  std::string path;
  int fd = -1;
  uint64_t size = 0;      // [bytes] of the log
  uint64_t position = 0;  // of the next event
  std::vector<uint8_t> window;
  uint64_t window_start = 0;
  uint64_t skipped = 0;  // [bytes]
  uint64_t places = 0;
  uint64_t first_damage = 0;
  uint64_t events = 0;
  bool cut_off = false;  // the log ends in the middle of an event
  std::string problem;
};

namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
  throw std::runtime_error("log " + path + ": cannot be read (" +
                           std::generic_category().message(error) + "); check the path");
}

}  // namespace

LogReader::File::File(const std::string& log_path) : path(log_path) {
  fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat entry {};
  if (fd < 0 || ::fstat(fd, &entry) != 0) refuse(path, errno);
  if (!S_ISREG(entry.st_mode)) {
    ::close(fd);
    refuse(path, S_ISDIR(entry.st_mode) ? EISDIR : ESPIPE);
  }
  size = static_cast<uint64_t>(entry.st_size);
}

const uint8_t* LogReader::File::view(uint64_t from, size_t count) {
  constexpr size_t kWindow = 1 << 20;  // [bytes]
  if (from > size || count > size - from) return nullptr;
  if (from < window_start || from + count > window_start + window.size()) {
    window.resize(std::min<uint64_t>(std::max(count, kWindow), size - from));
    window_start = from;
    size_t filled = 0;
    while (filled < window.size()) {
      const ssize_t got = ::pread(fd, window.data() + filled, window.size() - filled,
                                  static_cast<off_t>(from + filled));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      filled += static_cast<size_t>(got);
    }
    // The file was truncated, or the disk cannot read further: its end is here now.
    if (filled < window.size()) size = from + filled;
    window.resize(filled);
  }
  return count <= window.size() - (from - window_start) ? window.data() + (from - window_start)
                                                        : nullptr;
}

bool LogReader::File::isSync(uint64_t at) {
  const auto left = static_cast<size_t>(std::min<uint64_t>(4, at < size ? size - at : 0));
  const uint8_t* const word = view(at, left);
  if (left == 0 || word == nullptr) return false;
  for (size_t i = 0; i < left; ++i)
    if (word[i] != static_cast<uint8_t>(kLogSync >> (24 - 8 * i))) return false;
  return true;
}

bool LogReader::File::measure(uint64_t at, size_t& channel_size, size_t& message_size) {
  if (!fits(at, channel_size, message_size)) return false;
  // By chance a damaged length may lead to a later event; then other events lie within its span.
  const uint64_t end = at + kLogHeaderSize + channel_size + message_size;
  uint8_t sync[4];
  putBigEndian<4>(sync, kLogSync);
  for (uint64_t from = at + 1;; ++from) {
    const uint8_t* const bytes = view(at, static_cast<size_t>(end - at));
    if (bytes == nullptr) return false;
    const auto* const begin = bytes + (from - at);
    const auto* const found = static_cast<const uint8_t*>(
        ::memmem(begin, static_cast<size_t>(end - from), sync, sizeof sync));
    if (found == nullptr) return true;
    from = at + static_cast<uint64_t>(found - bytes);
    size_t inner_channel = 0;
    size_t inner_message = 0;
    if (fits(from, inner_channel, inner_message)) return false;
  }
}

bool LogReader::File::fits(uint64_t at, size_t& channel_size, size_t& message_size) {
  const uint8_t* const header = view(at, kLogHeaderSize);
  if (header == nullptr || getBigEndian<4>(header) != kLogSync) return false;
  const auto name = getBigEndian<4>(header + 20);
  const auto message = getBigEndian<4>(header + 24);
  const uint64_t end = at + kLogHeaderSize + name + message;
  if (name == 0 || name > kLongestChannel || message > INT32_MAX || end > size) return false;
  channel_size = static_cast<size_t>(name);
  message_size = static_cast<size_t>(message);
  // Otherwise a length is damaged, and the message is incomplete.
  return end == size || isSync(end);
}

void LogReader::File::skipDamage() {
  const uint64_t from = position;
  const bool began = isSync(from);
  size_t channel_size = 0;
  size_t message_size = 0;
  do {
    ++position;
  } while (position < size && !(isSync(position) && measure(position, channel_size, message_size)));
  cut_off = position >= size && began;
  if (places++ == 0) first_damage = from;
  skipped += position - from;
}

void LogReader::File::describe() {
  if (places == 0) return;
  problem = "log " + path + ": ";
  if (events == 0 && position >= size) {
    problem += "no complete event in it; is this an LCM log?";
    return;
  }
  problem += std::to_string(skipped) + " bytes left out at " + std::to_string(places) +
             (places == 1 ? " place" : " places") + ", the first at byte " +
             std::to_string(first_damage) +
             (cut_off ? "; the log ends in the middle of an event" : "; they are damaged");
}

LogReader::LogReader(const std::string& path) : file_(std::make_unique<File>(path)) {}
LogReader::~LogReader() = default;

bool LogReader::next(LogEvent& event) {
  size_t channel_size = 0;
  size_t message_size = 0;
  while (file_->position < file_->size &&
         !file_->measure(file_->position, channel_size, message_size)) {
    file_->skipDamage();
    file_->describe();
  }
  if (file_->position >= file_->size) return false;
  const uint8_t* const bytes =
      file_->view(file_->position, kLogHeaderSize + channel_size + message_size);
  if (bytes == nullptr) return false;
  const uint8_t* const name = bytes + kLogHeaderSize;
  event.utime = static_cast<int64_t>(getBigEndian<8>(bytes + 12));
  event.channel.assign(reinterpret_cast<const char*>(name), channel_size);
  const uint8_t* const message = name + channel_size;
  event.bytes.assign(message, message + sizeWithoutSeal(message, message_size));
  event.sealed = event.bytes.size() < message_size;
  renew(event);
  file_->position += kLogHeaderSize + channel_size + message_size;
  ++file_->events;
  return true;
}

uint64_t LogReader::position() const {
  return file_->position;
}

void LogReader::seek(uint64_t position) {
  file_->position = position;
}

const std::string& LogReader::problem() const {
  return file_->problem;
}

}  // namespace tread

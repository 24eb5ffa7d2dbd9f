// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "common/log/event_log.hpp"
#include "common/log/log_format.hpp"

namespace tread {

struct LogWriter::File {
  std::string path;
  std::FILE* stream = nullptr;
  std::vector<char> buffer;
  uint64_t events = 0;
  int error = 0;  // of the first failure; what was buffered then is lost, so it stays failed

  std::runtime_error failure(const char* what) {
    if (error == 0) error = errno;
    return std::runtime_error("log " + path + ": " + what + " (" +
                              std::generic_category().message(error) +
                              "); check space and permissions");
  }
  void put(const void* bytes, size_t size) {
    if (size == 0) return;  // an empty message may come with a null pointer
    if (error != 0 || std::fwrite(bytes, 1, size, stream) != size)
      throw failure("cannot be written");
  }
};

LogWriter::LogWriter(const std::string& path) : file_(std::make_unique<File>()) {
  constexpr size_t kBufferSize = 1 << 18;  // [bytes]
  file_->path = path;
  errno = 0;
  file_->stream = std::fopen(path.c_str(), "wbe");
  if (file_->stream == nullptr) throw file_->failure("cannot be made");
  file_->buffer.resize(kBufferSize);
  std::setvbuf(file_->stream, file_->buffer.data(), _IOFBF, file_->buffer.size());
}

LogWriter::~LogWriter() {
  std::fclose(file_->stream);
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
  file_->put(header, sizeof header);
  file_->put(channel.data(), channel.size());
  file_->put(bytes, size);
}

void LogWriter::flush() {
  if (file_->error != 0 || std::fflush(file_->stream) != 0)
    throw file_->failure("cannot be written");
}

}  // namespace tread

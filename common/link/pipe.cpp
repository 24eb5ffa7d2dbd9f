// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <deque>
#include <stdexcept>

#include "common/link/link.hpp"

namespace tread {
namespace {

/// What both ends share: the bytes under way and the state of the plug.
struct Cable {
  explicit Cable(size_t capacity_bytes) : capacity(capacity_bytes) {}

  const size_t capacity;
  std::deque<uint8_t> toward[2];  // bytes that end 0 and end 1 have not yet read
  bool connected = true;
  int64_t connections = 1;  // how often the plug was put in
};

class PipeEnd final : public Link {
 public:
  PipeEnd(std::shared_ptr<Cable> cable, size_t side, std::string address)
      : cable_(std::move(cable)), side_(side), address_(std::move(address)) {}
  ~PipeEnd() override { setConnected(false); }

  std::optional<size_t> read(uint8_t* buffer, size_t capacity) override {
    if (!isOpen()) return std::nullopt;
    std::deque<uint8_t>& bytes = cable_->toward[side_];
    const size_t count = std::min(capacity, bytes.size());
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(bytes.begin(), end, buffer);
    bytes.erase(bytes.begin(), end);
    return count;
  }

  bool write(const uint8_t* bytes, size_t size) override {
    std::deque<uint8_t>& queue = cable_->toward[1 - side_];
    if (!isOpen() || size > cable_->capacity - queue.size()) return false;
    queue.insert(queue.end(), bytes, bytes + size);
    return true;
  }

  /// An end that was cut stays closed until it is reopened, as a device file does.
  bool isOpen() const override { return cable_->connected && seen_ == cable_->connections; }
  bool reopen(int64_t /*utime*/) override {
    // No back-off: looking at a plug in memory costs nothing, and an emulator must not be slow.
    if (cable_->connected) seen_ = cable_->connections;
    return isOpen();
  }
  const std::string& address() const override { return address_; }
  std::string problem() const override {
    if (isOpen()) return {};
    return address_ + (cable_->connected ? ": was unplugged, not yet reopened" : ": unplugged");
  }

  void setConnected(bool connected) {
    if (connected == cable_->connected) return;
    cable_->connected = connected;
    cable_->connections += connected;
    for (auto& bytes : cable_->toward) bytes.clear();
  }

 private:
  std::shared_ptr<Cable> cable_;
  size_t side_;
  int64_t seen_ = 1;
  std::string address_;
};

}  // namespace

std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> makePipe(size_t capacity) {
  const auto cable = std::make_shared<Cable>(capacity);
  return {std::make_unique<PipeEnd>(cable, 0, "pipe:0"),
          std::make_unique<PipeEnd>(cable, 1, "pipe:1")};
}

void setPipeConnected(Link& end, bool connected) {
  auto* const pipe = dynamic_cast<PipeEnd*>(&end);
  if (pipe == nullptr)
    throw std::invalid_argument("link " + end.address() + " is no in-memory pipe to cut or mend");
  pipe->setConnected(connected);
}

}  // namespace tread

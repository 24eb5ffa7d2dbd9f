// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/drive/evdev_pad.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

namespace tread::drive {
namespace {

constexpr int kSticks[] = {ABS_X, ABS_Y};
constexpr int kGamepadButton = BTN_SOUTH;
constexpr int kJoystickButton = BTN_TRIGGER;

}  // namespace

struct EvdevPad::Device {
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  explicit Device(const std::string& device_path) : path(device_path) {
    file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) throw std::runtime_error(path + ": " + std::strerror(errno));
    if (const int error = libevdev_new_from_fd(file, &evdev); error < 0) {
      ::close(file);
      throw std::runtime_error(path + ": no input device: " + std::strerror(-error));
    }
  }
  ~Device() {
    libevdev_free(evdev);
    ::close(file);
  }
  bool isPad() const {
    const bool stick = std::all_of(std::begin(kSticks), std::end(kSticks), [this](int axis) {
      return libevdev_has_event_code(evdev, EV_ABS, static_cast<unsigned>(axis)) != 0;
    });
    return stick && (libevdev_has_event_code(evdev, EV_KEY, kGamepadButton) != 0 ||
                     libevdev_has_event_code(evdev, EV_KEY, kJoystickButton) != 0);
  }

  std::string path;
  int file = -1;
  libevdev* evdev = nullptr;
};

namespace {

/// Paths of the event devices in /dev/input, ordered by number.
std::vector<std::string> eventFiles() {
  std::vector<std::string> paths;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", none))
    if (entry.path().filename().string().rfind("event", 0) == 0) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

}  // namespace

std::unique_ptr<EvdevPad::Device> EvdevPad::first() {
  for (const std::string& path : eventFiles()) {
    try {
      auto device = std::make_unique<Device>(path);
      if (device->isPad()) return device;
    } catch (const std::exception&) {
      continue;  // no permission to read it
    }
  }
  return nullptr;
}

bool padFound() {
  try {
    const EvdevPad pad("");
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

EvdevPad::EvdevPad(const std::string& path)
    : device_(path.empty() ? first() : std::make_unique<Device>(path)) {
  if (!device_)
    throw std::runtime_error(
        "no gamepad or joystick in /dev/input that this user may read (group input): plug one in, "
        "name it with --device, or drive with --keyboard");
  if (!device_->isPad())
    throw std::runtime_error(path + ": " + libevdev_get_name(device_->evdev) +
                             " is not a gamepad or joystick");
  for (const int axis : kSticks) {
    const input_absinfo* info = libevdev_get_abs_info(device_->evdev, static_cast<unsigned>(axis));
    state_.setRange(axis, info->minimum, info->maximum);
    state_.begin(EV_ABS, axis, info->value);
  }
}

EvdevPad::~EvdevPad() = default;

Wishes EvdevPad::read(int64_t /*now*/) {
  unsigned flag = LIBEVDEV_READ_FLAG_NORMAL;
  while (true) {
    input_event event{};
    const int result = libevdev_next_event(device_->evdev, flag, &event);
    if (result == LIBEVDEV_READ_STATUS_SYNC) {
      flag = LIBEVDEV_READ_FLAG_SYNC;  // events were lost: resynchronize
    } else if (result == -EAGAIN && flag == LIBEVDEV_READ_FLAG_SYNC) {
      flag = LIBEVDEV_READ_FLAG_NORMAL;
      continue;
    } else if (result == -EAGAIN) {
      return state_.wishes();
    } else if (result < 0) {
      throw std::runtime_error("the " + name() + " is gone: " + std::strerror(-result));
    }
    state_.take(event.type, event.code, event.value);
  }
}

std::string EvdevPad::name() const {
  return std::string("gamepad ") + libevdev_get_name(device_->evdev) + ", " + device_->path;
}

std::string EvdevPad::keys() const {
  return "hold a shoulder button (joystick: trigger) and move the left stick; START arms, SELECT "
         "disarms, the upper or left button gives back; Ctrl-C ends";
}

}  // namespace tread::drive

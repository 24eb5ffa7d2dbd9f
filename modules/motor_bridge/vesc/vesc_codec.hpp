// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tread::motor {

/// A command to one VESC motor controller.
/** Numbers of the VESC firmware (datatypes.h, commands.c, comm_can.c): duty in 1e-5, brake current
 * in mA, speed in electrical revolutions per minute, position of the servo output in 1e-3 of its
 * range. */
struct VescCommand {
  enum class Kind { kDuty, kBrakeCurrent, kRpm, kServo };
  Kind kind = Kind::kDuty;
  int32_t value = 0;
};

/// A controller's data; nullopt = not in this message.
struct VescReading {
  int id = -1;
  std::optional<double> temperature;    ///< the hotter of power stage and motor [degC]
  std::optional<double> motor_current;  ///< [A]
  std::optional<double> erpm;           ///< [1/min] electrical
  std::optional<double> voltage;        ///< of the battery [V]
  std::optional<int> fault;             ///< mc_fault_code
};

/// Fault codes in words; "fault 77" for an unknown one.
std::string vescFault(int code);
/// Whether it concerns the battery's voltage, too high or too low.
bool isVoltageFault(int code);

// Over UART: packets.

/// Start 2 and a length of one byte (3 and two bytes above 255), payload, CRC-16/XMODEM, 3.
std::string vescPacket(std::string_view payload);

/// Finds packets in a stream.
class VescPackets {
 public:
  static constexpr size_t kMaxPayload = 1024;

  /// Upper limit of payloads from now on: limits the bytes lost after a false start.
  void expectAtMost(size_t payload) { most_ = payload; }
  /// Payloads of the packets that these bytes complete.
  std::vector<std::string> push(std::string_view bytes);
  void clear() { buffer_.clear(); }
  int64_t badChecksums() const { return bad_checksums_; }
  int64_t garbageBytes() const { return garbage_; }

 private:
  std::string buffer_;
  size_t most_ = kMaxPayload;
  int64_t bad_checksums_ = 0;
  int64_t garbage_ = 0;
};

enum VescComm : uint8_t {
  kCommFirmware = 0,
  kCommGetValues = 4,
  kCommSetDuty = 5,
  kCommSetBrakeCurrent = 7,
  kCommSetRpm = 8,
  kCommSetServo = 12,
  kCommGetAppConfiguration = 17,
  kCommForwardCan = 34,
};

/// Payload of a command.
std::string vescPayload(const VescCommand& command);
/// The payload for the controller with this CAN id, forwarded by the one on the line.
std::string vescForwarded(int id, std::string_view payload);
/// Reads a reply to COMM_GET_VALUES; nullopt for another reply, or a firmware that does not send
/// the controller's id (before 3.40).
std::optional<VescReading> vescValues(std::string_view payload);

/// Beginning of a controller's app configuration.
struct VescTimeout {
  int id = -1;
  int64_t timeout_ms = 0;  ///< time without a command until it releases the motor; 0 = never
};
/// Reads a reply to COMM_GET_APPCONF: signature (4 bytes), id, timeout (4 bytes), and the rest.
std::optional<VescTimeout> vescTimeout(std::string_view payload);

// Over CAN: extended frames with the identifier command << 8 | id.

/// A frame in SocketCAN's struct can_frame: 16 bytes, identifier in the host's order (little-endian
/// on all supported hosts).
std::string vescFrame(int id, const VescCommand& command);

/// Finds frames in a stream of such structures.
class VescFrames {
 public:
  static constexpr size_t kFrameSize = 16;

  /// The data in the STATUS (9), STATUS_4 (16) and STATUS_5 (27) frames among these bytes.
  std::vector<VescReading> push(std::string_view bytes);
  void clear() { buffer_.clear(); }
  /// Bytes outside of frames, and foreign frames.
  int64_t garbageBytes() const { return garbage_; }
  int64_t otherFrames() const { return others_; }

 private:
  std::string buffer_;
  int64_t garbage_ = 0;
  int64_t others_ = 0;
};

}  // namespace tread::motor

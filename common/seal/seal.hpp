// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tread {

/// The secret shared by a robot's processes and its operators.
struct SealKey {
  std::array<uint8_t, 32> bytes{};
};

/// The seal follows the message's bytes: magic word (4 bytes), session (8), sender (8), time (8),
/// all big-endian, and a tag (16), the keyed BLAKE2b of channel, message and the fields before it.
inline constexpr size_t kSealBytes = 44;

/// The size of a message without its seal, valid or not; without a seal, `size`.
size_t sizeWithoutSeal(const uint8_t* bytes, size_t size);

enum class SealVerdict {
  kGood,
  kUnsealed,
  kWrongTag,
  kOtherSession,
  kTooOld,
  kAhead,
  kReplayed,
  kTooManySenders
};

/// "unsealed", "wrong tag", "replayed": for counters.
const char* toWords(SealVerdict verdict);

/// Result of opening a seal.
struct OpenedSeal {
  SealVerdict verdict = SealVerdict::kUnsealed;
  size_t size = 0;  ///< [bytes] of the message without its seal
  /// [us] of the sender's clock; only where the tag was right (neither unsealed nor wrong tag)
  int64_t sent = 0;
};

/// Seals messages and opens sealed ones: without the key nobody can forge a message, nor alter,
/// repeat, delay or move to another channel one that was overheard.
/** Pure: time is an argument. All sealers with the same key and session must share a clock, except
 * one without a session: it adopts the session of the first message with a right tag, whenever
 * that was sent, and its owner corrects its own clock by `sent`. Until then it cannot seal. */
class Sealer {
 public:
  /// [us] by which a seal may be older than `now`; kMaxAhead: newer.
  static constexpr int64_t kMaxAge = 1'500'000;
  static constexpr int64_t kMaxAhead = 100'000;
  /// Limit of (sender, channel) pairs whose last time is kept.
  static constexpr size_t kMostSenders = 512;

  /// `sender` must differ for each sealer with this key. `session` differs for each boot of the
  /// robot's host, because its clock restarts then.
  Sealer(const SealKey& key, uint64_t sender, std::optional<uint64_t> session);
  Sealer(Sealer&&) = default;
  Sealer& operator=(Sealer&&) = default;
  Sealer(const Sealer&) = delete;  // two with one sender would reuse each other's times
  Sealer& operator=(const Sealer&) = delete;

  /// Appends the seal of a message sent at `utime` [us]. False without a session; nothing is
  /// appended then.
  bool seal(const std::string& channel, std::vector<uint8_t>& message, int64_t utime);

  /// Whether a message received at `now` [us] may be accepted.
  OpenedSeal open(const std::string& channel, const uint8_t* bytes, size_t size, int64_t now);

  /// Refuses messages sent before this time [us]: a restarted process does not remember what it
  /// accepted.
  void refuseBefore(int64_t utime) { earliest_ = utime; }

  std::optional<uint64_t> session() const { return session_; }
  /// The session is then adopted from the next message with a right tag.
  void forgetSession();

 private:
  using Tag = std::array<uint8_t, 16>;
  Tag tagOf(const std::string& channel, const uint8_t* bytes, size_t size) const;
  SealVerdict judgeTime(const std::string& channel, uint64_t sender, int64_t sent, int64_t now);

  SealKey key_;
  uint64_t sender_;
  std::optional<uint64_t> session_;
  int64_t last_sealed_ = INT64_MIN;                             ///< [us]
  int64_t earliest_ = INT64_MIN;                                ///< [us]
  std::map<std::pair<uint64_t, std::string>, int64_t> newest_;  ///< [us] by sender and channel
};

}  // namespace tread

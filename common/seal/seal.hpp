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

/// The secret that a robot's processes and its operators share.
struct SealKey {
  std::array<uint8_t, 32> bytes{};
};

/// A seal stands behind a message's bytes: magic word (4 bytes), session (8), sender (8), time (8),
/// all big-endian, and a tag (16), the keyed BLAKE2b of channel, message and the fields before it.
inline constexpr size_t kSealBytes = 44;

/// The size of a message without the seal behind it, whoever made that; without one, `size`.
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

/// What came of opening a seal.
struct OpenedSeal {
  SealVerdict verdict = SealVerdict::kUnsealed;
  size_t size = 0;  ///< [bytes] of the message without its seal
  /// [us] of the sender's clock; only where the tag was right (neither unsealed nor wrong tag)
  int64_t sent = 0;
};

/// Seals messages and opens sealed ones: who has no key can neither forge a message nor change,
/// repeat, hold up or move to another channel one that he has heard.
/** Pure: time comes in. All who share a key and a session must also share a clock, except a sealer
 * without a session: it adopts that of the first message with a right tag, whenever that was sent,
 * and its owner corrects its own clock by what `sent` says. Until then it cannot seal. */
class Sealer {
 public:
  /// A seal may be that much older than `now` [us], and that much ahead of it.
  static constexpr int64_t kMaxAge = 1'500'000;
  static constexpr int64_t kMaxAhead = 100'000;
  /// Senders, each on each of its channels, whose last time is kept.
  static constexpr size_t kMostSenders = 512;

  /// `sender` must differ for each sealer that has this key. `session` differs for each boot of the
  /// robot's host: its clock begins again then.
  Sealer(const SealKey& key, uint64_t sender, std::optional<uint64_t> session);
  Sealer(Sealer&&) = default;
  Sealer& operator=(Sealer&&) = default;
  Sealer(const Sealer&) = delete;  // two with one sender would repeat each other's times
  Sealer& operator=(const Sealer&) = delete;

  /// Appends the seal of a message sent at `utime` [us]. False without a session; nothing is
  /// appended then.
  bool seal(const std::string& channel, std::vector<uint8_t>& message, int64_t utime);

  /// Whether a message that came in at `now` [us] may be taken.
  OpenedSeal open(const std::string& channel, const uint8_t* bytes, size_t size, int64_t now);

  /// What was sent before is too old, from now on [us]: a process that starts again does not
  /// remember what it took.
  void refuseBefore(int64_t utime) { earliest_ = utime; }

  std::optional<uint64_t> session() const { return session_; }
  /// The next message with a right tag tells the session anew.
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

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/seal/seal.hpp"

#include <sodium.h>

#include <algorithm>
#include <stdexcept>

namespace tread {
namespace {

constexpr uint32_t kMagic = 0xD5EA1ED7;
/// Offsets of the fields in a seal [bytes].
constexpr size_t kSessionAt = 4;
constexpr size_t kSenderAt = 12;
constexpr size_t kTimeAt = 20;
constexpr size_t kTagAt = 28;
/// No clock runs that long [us]: three centuries.
constexpr int64_t kLargestTime = 10'000'000'000'000'000;

void put(uint8_t* at, uint64_t value, size_t size = 8) {
  for (size_t i = 0; i < size; ++i) at[i] = static_cast<uint8_t>(value >> (8 * (size - 1 - i)));
}

uint64_t get(const uint8_t* at, size_t size = 8) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | at[i];
  return value;
}

bool hasSeal(const uint8_t* bytes, size_t size) {
  if (size < kSealBytes) return false;
  const uint8_t* const seal = bytes + (size - kSealBytes);
  return get(seal, 4) == kMagic && get(seal + kTimeAt) <= static_cast<uint64_t>(kLargestTime);
}

}  // namespace

size_t sizeWithoutSeal(const uint8_t* bytes, size_t size) {
  return hasSeal(bytes, size) ? size - kSealBytes : size;
}

const char* toWords(SealVerdict verdict) {
  switch (verdict) {
    case SealVerdict::kGood:
      return "good";
    case SealVerdict::kUnsealed:
      return "unsealed";
    case SealVerdict::kWrongTag:
      return "wrong tag";
    case SealVerdict::kOtherSession:
      return "other session";
    case SealVerdict::kTooOld:
      return "too old";
    case SealVerdict::kAhead:
      return "ahead of time";
    case SealVerdict::kReplayed:
      return "replayed";
    case SealVerdict::kTooManySenders:
      return "too many senders";
  }
  return "unknown";
}

Sealer::Sealer(const SealKey& key, uint64_t sender, std::optional<uint64_t> session)
    : key_(key), sender_(sender), session_(session) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be used");
}

Sealer::Tag Sealer::tagOf(const std::string& channel, const uint8_t* bytes, size_t size) const {
  Tag tag;
  uint8_t length[8];
  put(length, channel.size());
  crypto_generichash_state state;
  crypto_generichash_init(&state, key_.bytes.data(), key_.bytes.size(), tag.size());
  crypto_generichash_update(&state, length, sizeof length);
  crypto_generichash_update(&state, reinterpret_cast<const uint8_t*>(channel.data()),
                            channel.size());
  crypto_generichash_update(&state, bytes, size);
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

bool Sealer::seal(const std::string& channel, std::vector<uint8_t>& message, int64_t utime) {
  if (!session_) return false;
  last_sealed_ = std::max(utime, last_sealed_ + 1);
  const size_t at = message.size();
  message.resize(at + kSealBytes);
  put(&message[at], kMagic, 4);
  put(&message[at + kSessionAt], *session_);
  put(&message[at + kSenderAt], sender_);
  put(&message[at + kTimeAt], static_cast<uint64_t>(last_sealed_));
  const Tag tag = tagOf(channel, message.data(), at + kTagAt);
  std::copy(tag.begin(), tag.end(), message.begin() + static_cast<std::ptrdiff_t>(at + kTagAt));
  return true;
}

void Sealer::forgetSession() {
  session_.reset();
  newest_.clear();
  last_sealed_ = INT64_MIN;
}

OpenedSeal Sealer::open(const std::string& channel, const uint8_t* bytes, size_t size,
                        int64_t now) {
  if (!hasSeal(bytes, size)) return {SealVerdict::kUnsealed, size, 0};
  OpenedSeal opened{SealVerdict::kWrongTag, size - kSealBytes, 0};
  const uint8_t* const seal = bytes + opened.size;
  const Tag tag = tagOf(channel, bytes, opened.size + kTagAt);
  if (sodium_memcmp(tag.data(), seal + kTagAt, tag.size()) != 0) return opened;
  const uint64_t session = get(seal + kSessionAt);
  const uint64_t sender = get(seal + kSenderAt);
  opened.sent = static_cast<int64_t>(get(seal + kTimeAt));
  if (!session_) {
    session_ = session;
    newest_[{sender, channel}] = opened.sent;
    opened.verdict = SealVerdict::kGood;
  } else {
    opened.verdict = session == *session_ ? judgeTime(channel, sender, opened.sent, now)
                                          : SealVerdict::kOtherSession;
  }
  return opened;
}

SealVerdict Sealer::judgeTime(const std::string& channel, uint64_t sender, int64_t sent,
                              int64_t now) {
  if (sent > now + kMaxAhead) return SealVerdict::kAhead;
  if (sent < now - kMaxAge || sent < earliest_) return SealVerdict::kTooOld;
  const auto known = newest_.find({sender, channel});
  if (known != newest_.end()) {
    if (sent <= known->second) return SealVerdict::kReplayed;
    known->second = sent;
    return SealVerdict::kGood;
  }
  if (newest_.size() >= kMostSenders) {
    // Repetitions of their messages are too old anyway.
    for (auto it = newest_.begin(); it != newest_.end();)
      it = it->second < now - kMaxAge ? newest_.erase(it) : std::next(it);
    if (newest_.size() >= kMostSenders) return SealVerdict::kTooManySenders;
  }
  newest_.emplace(std::make_pair(sender, channel), sent);
  return SealVerdict::kGood;
}

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/sha256.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace tread::blind {
namespace {

using Words = std::array<uint32_t, 8>;

/// The first 32 bits of a root's fractional part.
template <class Root>
uint32_t fraction(int prime, Root root) {
  const long double value = root(static_cast<long double>(prime));
  return static_cast<uint32_t>((value - std::floor(value)) * 4294967296.0L);
}

/// The constants are roots of the first primes: cube roots for the rounds, square roots to start.
struct Constants {
  std::array<uint32_t, 64> rounds{};
  Words start{};

  Constants() {
    size_t count = 0;
    for (int n = 2; count < rounds.size(); ++n) {
      bool prime = true;
      for (int d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
      if (!prime) continue;
      rounds[count] = fraction(n, [](long double x) { return std::cbrt(x); });
      if (count < start.size())
        start[count] = fraction(n, [](long double x) { return std::sqrt(x); });
      ++count;
    }
  }
};

uint32_t turn(uint32_t x, int n) {
  return (x >> n) | (x << (32 - n));
}

void digest(const Constants& constants, const uint8_t* block, Words& hash) {
  std::array<uint32_t, 64> w{};
  for (size_t i = 0; i < 16; ++i)
    for (size_t k = 0; k < 4; ++k) w[i] = (w[i] << 8) | block[4 * i + k];
  for (size_t i = 16; i < 64; ++i) {
    const uint32_t s0 = turn(w[i - 15], 7) ^ turn(w[i - 15], 18) ^ (w[i - 15] >> 3);
    const uint32_t s1 = turn(w[i - 2], 17) ^ turn(w[i - 2], 19) ^ (w[i - 2] >> 10);
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  Words v = hash;
  for (size_t i = 0; i < 64; ++i) {
    const uint32_t s1 = turn(v[4], 6) ^ turn(v[4], 11) ^ turn(v[4], 25);
    const uint32_t choice = (v[4] & v[5]) ^ (~v[4] & v[6]);
    const uint32_t t1 = v[7] + s1 + choice + constants.rounds[i] + w[i];
    const uint32_t s0 = turn(v[0], 2) ^ turn(v[0], 13) ^ turn(v[0], 22);
    const uint32_t majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
    v = {t1 + s0 + majority, v[0], v[1], v[2], v[3] + t1, v[4], v[5], v[6]};
  }
  for (size_t i = 0; i < hash.size(); ++i) hash[i] += v[i];
}

}  // namespace

std::string sha256(const std::string& bytes) {
  static const Constants constants;
  std::string padded = bytes;
  padded.push_back(static_cast<char>(0x80));
  while (padded.size() % 64 != 56) padded.push_back('\0');
  const uint64_t bits = static_cast<uint64_t>(bytes.size()) * 8;
  for (int shift = 56; shift >= 0; shift -= 8)
    padded.push_back(static_cast<char>((bits >> shift) & 0xff));
  Words hash = constants.start;
  for (size_t at = 0; at < padded.size(); at += 64)
    digest(constants, reinterpret_cast<const uint8_t*>(padded.data()) + at, hash);
  std::string text;
  for (const uint32_t word : hash)
    for (int shift = 28; shift >= 0; shift -= 4)
      text.push_back("0123456789abcdef"[(word >> shift) & 0xf]);
  return text;
}

}  // namespace tread::blind

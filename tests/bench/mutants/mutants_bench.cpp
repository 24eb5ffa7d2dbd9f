// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <CLI/CLI.hpp>

#include "tests/lcmtypes/type_samples.hpp"

namespace {

using namespace tread;
using Bytes = std::vector<uint8_t>;

constexpr size_t kFingerprint = 8;         // bytes
constexpr size_t kLongest = 20'000;        // bytes of a mutant
constexpr double kSlowest = 1.0;           // s of a hundred messages
constexpr rlim_t kMemory = 1'000'000'000;  // bytes, above which the decoder throws

/// Mutates messages, mostly after their fingerprint, so that decoding continues.
class Mutator {
 public:
  explicit Mutator(uint64_t seed) : random_(seed) {}

  void mutate(Bytes& bytes) {
    for (uint64_t changes = 1 + below(4); changes > 0; --changes) change(bytes);
  }

 private:
  uint64_t below(uint64_t limit) { return random_() % limit; }
  uint8_t byte() { return static_cast<uint8_t>(random_()); }
  size_t place(const Bytes& bytes) {
    const size_t first = bytes.size() > kFingerprint && below(64) != 0 ? kFingerprint : 0;
    return first + below(bytes.size() - first);
  }
  void change(Bytes& bytes) {
    if (bytes.empty()) bytes.push_back(byte());
    const size_t at = place(bytes);
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<uint8_t>(bytes[at] ^ (1U << below(8)));
        return;
      case 1:
        bytes[at] = byte();
        return;
      case 2:
      case 3:
        return writeNumber(bytes, at);
      case 4:
        bytes.resize(at);
        return;
      case 5:
        if (bytes.size() < kLongest) bytes.insert(from, 1 + below(16), byte());
        return;
      case 6:
        bytes.erase(from, from + static_cast<std::ptrdiff_t>(
                                     std::min<size_t>(1 + below(16), bytes.size() - at)));
        return;
      default:
        bytes[at] = bytes[place(bytes)];
    }
  }
  /// A length, count or part of a number that breaks careless readers.
  void writeNumber(Bytes& bytes, size_t at) {
    constexpr std::array<uint32_t, 12> kNumbers{0,          1,          2,          0xFF,
                                                0xFFFF,     0x10000,    0x7FFFFFFF, 0x80000000,
                                                0x80000001, 0xFFFFFFFF, 0x7FF00000, 0x7FF80000};
    const uint32_t number = kNumbers[below(kNumbers.size())];
    for (size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
      bytes[at + i] = static_cast<uint8_t>(number >> (24 - 8 * i));
  }

  std::mt19937_64 random_;
};

struct Tally {
  int64_t taken = 0;   ///< accepted as messages
  double slowest = 0;  ///< s
  std::string broken;  ///< forbidden behaviour of a decoder; empty = none
};

/// An accepted message must be encodable; nothing may throw, take long or need much memory.
template <class Message>
void judge(const Bytes& mutant, Tally& tally) {
  Message message{};
  if (!testing::decode(mutant, message)) return;
  ++tally.taken;
  if (testing::encode(message).empty()) tally.broken = "what was read cannot be sent on";
}

template <class Message>
Tally run(const Message& sample, int64_t count, uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  constexpr int64_t kBatch = 100;
  Mutator mutator(seed);
  const Bytes whole = testing::encode(sample);
  Tally tally;
  Bytes mutant;
  for (int64_t done = 0; done < count && tally.broken.empty();) {
    const auto start = Clock::now();
    for (int64_t end = std::min(count, done + kBatch); done < end; ++done) {
      mutant = whole;
      mutator.mutate(mutant);
      try {
        judge<Message>(mutant, tally);
      } catch (const std::exception& error) {
        tally.broken = std::string("mutant ") + std::to_string(done) + " threw " + error.what();
      }
    }
    tally.slowest =
        std::max(tally.slowest, std::chrono::duration<double>(Clock::now() - start).count());
  }
  if (tally.broken.empty() && tally.slowest > kSlowest) tally.broken = "took too long";
  return tally;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Decodes mutated messages of each channel's type.", "bench-mutants"};
  int64_t count = 1'000'000;
  uint64_t seed = 1;
  std::string only;
  app.add_option("--count", count, "of each type")->check(CLI::Range(1, 1'000'000'000));
  app.add_option("--seed", seed, "of the mutations");
  app.add_option("--only", only, "only this channel");
  CLI11_PARSE(app, argc, argv);
#ifndef __SANITIZE_ADDRESS__  // it reserves far more
  const rlimit memory{kMemory, kMemory};
  setrlimit(RLIMIT_DATA, &memory);
#endif
  int broken = 0;
  testing::forEachChannel([&](const auto& channel, const auto& sample) {
    if (!only.empty() && only != channel.name) return;
    const auto start = std::chrono::steady_clock::now();
    const Tally tally = run(sample, count, seed);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf(
        "%-14s %lld mutants of %zu bytes in %.1f s, %lld taken, slowest hundred %.2f ms: %s\n",
        channel.name, static_cast<long long>(count), testing::encode(sample).size(), seconds,
        static_cast<long long>(tally.taken), 1e3 * tally.slowest,
        tally.broken.empty() ? "good" : tally.broken.c_str());
    std::fflush(stdout);
    broken += tally.broken.empty() ? 0 : 1;
  });
  return broken == 0 ? 0 : 1;
}

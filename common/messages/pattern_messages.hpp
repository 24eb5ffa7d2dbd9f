// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tread/pattern_set_part_t.hpp>

#include "common/pattern/pattern.hpp"

namespace tread {

/// The parts of a set as messages, without utime of sending and seq (the publisher sets seq).
std::vector<pattern_set_part_t> toMessages(const PatternSet& set);

/// Puts sets together from their parts, which may come in any order, twice, or not at all.
/** Every field is checked before use, the parts of a version among each other, the checksum over
 * the whole, and PatternSet::make as the last gate. Parts of versions that are not newer than the
 * last returned are passed over without a word: sets are repeated. A broken part costs no more than
 * its version's present round of parts. */
class PatternSetAssembler {
 public:
  /// Takes a part. Returns a set when it completes a valid one that is newer than the last
  /// returned.
  std::optional<PatternSet> add(const pattern_set_part_t& part);

  /// Why the last part or set was refused, in one line; empty if it was not.
  const std::string& refusal() const { return refusal_; }
  int64_t refused() const { return refused_; }

 private:
  /// A version that is not complete yet.
  struct Pending {
    int64_t version = 0;
    std::map<int32_t, pattern_set_part_t> parts;
  };

  std::optional<PatternSet> refuse(const std::string& why);
  Pending& pendingOf(int64_t version);
  std::optional<PatternSet> complete(Pending& pending);

  /// Newest touched last: a part with a broken version number must not displace the true one.
  std::list<Pending> pending_;
  int64_t last_version_ = 0;
  std::string refusal_;
  int64_t refused_ = 0;
};

}  // namespace tread

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tread::lidar {

/// The two dialects of SICK's Command Language: A is text in hexadecimal, B is binary.
enum class ColaDialect { kA, kB };

/// Splits a byte stream into CoLa telegrams. Source: SICK telegram listing 8014631, section 3.
/** A: 02, text, 03. B: 02 02 02 02, length (32 bits, most significant byte first), that many bytes,
 * their exclusive or. A telegram has at most 64 kB; invalid data are skipped byte by byte. */
class ColaFramer {
 public:
  explicit ColaFramer(ColaDialect dialect) : dialect_(dialect) {}

  /// Complete telegrams without their frame, oldest first.
  std::vector<std::string> push(std::string_view bytes);
  void clear() { buffer_.clear(); }

  int64_t strayBytes() const { return stray_; }
  int64_t badChecksums() const { return bad_checksums_; }

 private:
  bool cutText(std::string& telegram);
  bool cutBinary(std::string& telegram);
  void skip(size_t bytes);

  ColaDialect dialect_;
  std::string buffer_;
  int64_t stray_ = 0;
  int64_t bad_checksums_ = 0;
};

/// A telegram with its frame.
std::string colaFrame(ColaDialect dialect, std::string_view telegram);

}  // namespace tread::lidar

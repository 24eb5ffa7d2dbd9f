// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tread::import {

/// A field of an LCM type: a number, or an array whose length an earlier field holds.
struct ForeignField {
  std::string type;  ///< int16_t, int32_t, int64_t, float, double or boolean
  std::string name;
  std::string length;  ///< name of the field that holds the array's length; empty: one number
};

/// An LCM type of another project's robots.
struct ForeignType {
  std::string name;
  std::vector<ForeignField> fields;

  /// The eight bytes before each message: a hash of the fields' names, types and lengths, not of
  /// the type's own name, by the rule of lcm-gen (lcmgen.c, lcm_struct_hash).
  uint64_t fingerprint() const;
};

/// The numbers of a message by the fields' names; times up to 2^53 us are exact.
using ForeignMessage = std::map<std::string, std::vector<double>>;

/// The types that are known; of equal fingerprint there is one.
const std::vector<ForeignType>& foreignTypes();
/// The type with the fingerprint that these bytes begin with; nullptr if none is known.
const ForeignType* foreignTypeOf(const std::vector<uint8_t>& bytes);
/// Decodes a message of the type, fingerprint included; nothing if it is too short or too long, or
/// says a length below zero.
std::optional<ForeignMessage> decodeForeign(const ForeignType& type,
                                            const std::vector<uint8_t>& bytes);

}  // namespace tread::import

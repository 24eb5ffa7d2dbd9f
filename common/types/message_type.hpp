// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// A field of a message type: a value, or an array of values.
struct MessageField {
  std::string type;  ///< boolean, byte, int8_t to int64_t, float, double, string, or another type
  std::string name;
  /// Of each dimension: a number, or the name of an earlier field
  std::vector<std::string> lengths;
  std::string comment;  ///< at the end of its line: unit, frame, value for "unknown"
};

/// A named constant of a type.
struct MessageConstant {
  std::string type;  ///< int8_t to int64_t, float or double
  std::string name;
  std::string value;  ///< as it was written
  std::string comment;
};

/// A message type as described by a .lcm file, for readers that learn the type at run time.
struct MessageType {
  std::string name;
  std::string comment;  ///< in front of it
  std::vector<MessageField> fields;
  std::vector<MessageConstant> constants;
  /// Name of the enumeration of the constants, from the comment "enum NAME" in front of them;
  /// empty = none
  std::string enumeration;
  bool is_bit_set = false;  ///< "enum NAME: bits": its constants are combined

  const MessageField* field(const std::string& wanted) const;
};

/// The integer that means "unknown" or "none" in a field, from its comment: "; -1" at the begin of
/// a part, or "; blank N"; 0 without either.
int64_t blankInteger(const MessageField& field);

/// A set of types that may contain each other.
class MessageTypes {
 public:
  MessageTypes() = default;
  MessageTypes(MessageTypes&&) = default;
  MessageTypes& operator=(MessageTypes&&) = default;

  /// Parses the syntax of lcm-gen; throws std::invalid_argument with line and error.
  static MessageTypes fromText(const std::string& text);

  /// nullptr if there is none of this name.
  const MessageType* find(const std::string& name) const;
  /// Sorted by name.
  const std::map<std::string, MessageType>& all() const { return types_; }
  /// The eight bytes before each message: a hash of the fields' names, types and lengths, but not
  /// of the type's name, computed as by lcm-gen (lcmgen.c, lcm_struct_hash).
  uint64_t fingerprint(const MessageType& type) const;
  /// The type with the fingerprint at the start of these bytes; nullptr if it is unknown.
  const MessageType* typeOf(const std::vector<uint8_t>& bytes) const;

 private:
  void check() const;

  std::map<std::string, MessageType> types_;
  std::map<uint64_t, const MessageType*> by_fingerprint_;
};

/// Receives the values of a message in order.
class MessageVisitor {
 public:
  virtual ~MessageVisitor() = default;
  /// Followed by the field's values: one, or as many as its lengths give, the last dimension
  /// fastest.
  virtual void beginField(const MessageField& field, size_t count) = 0;
  virtual void endField(const MessageField& field) = 0;
  virtual void integer(int64_t value) = 0;
  virtual void real(double value, bool single) = 0;  ///< `single`: a float
  virtual void text(const std::string& value) = 0;
  /// Begin of a nested message: its fields follow until endMessage().
  virtual void beginMessage(const MessageType& type) = 0;
  virtual void endMessage(const MessageType& type) = 0;
};

/// Passes all values of a message to a visitor; `bytes` begins with its fingerprint.
/** False if the bytes are no message of the type: another fingerprint, too few or too many bytes, a
 * negative length. The visitor may have received the beginning then. */
bool visit(const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes,
           MessageVisitor& visitor);

/// The numbers of a message by field name, times exact up to 2^53 us; nullopt if the bytes are no
/// message of the type, or the type holds other messages or texts.
std::optional<std::map<std::string, std::vector<double>>> numbersOf(
    const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes);

}  // namespace tread

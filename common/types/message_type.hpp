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
  std::vector<std::string> lengths;  ///< of each dimension: a number, or an earlier field's name
  std::string comment;               ///< behind it in its line: unit, frame, what "unknown" is
};

/// A named number of a type.
struct MessageConstant {
  std::string name;
  std::string value;  ///< as it was written
  std::string comment;
};

/// A message type as a .lcm file describes it, for who meets it only at run time.
struct MessageType {
  std::string name;
  std::string comment;  ///< in front of it
  std::vector<MessageField> fields;
  std::vector<MessageConstant> constants;

  const MessageField* field(const std::string& wanted) const;
};

/// Types that may contain each other.
class MessageTypes {
 public:
  MessageTypes() = default;
  MessageTypes(MessageTypes&&) = default;
  MessageTypes& operator=(MessageTypes&&) = default;

  /// Reads what lcm-gen reads; throws std::invalid_argument with line and what is wrong there.
  static MessageTypes fromText(const std::string& text);

  /// nullptr if there is none.
  const MessageType* find(const std::string& name) const;
  /// Sorted by name.
  const std::map<std::string, MessageType>& all() const { return types_; }
  /// The eight bytes before each message: a hash of the fields' names, types and lengths, not of
  /// the type's own name, by the rule of lcm-gen (lcmgen.c, lcm_struct_hash).
  uint64_t fingerprint(const MessageType& type) const;
  /// The type whose fingerprint these bytes begin with; nullptr if none is known.
  const MessageType* typeOf(const std::vector<uint8_t>& bytes) const;

 private:
  void check() const;

  std::map<std::string, MessageType> types_;
  std::map<uint64_t, const MessageType*> by_fingerprint_;
};

/// Tread's own types, those of lcmtypes/tread.
const MessageTypes& treadTypes();

/// The type of a channel of Tread; nullptr for any other channel.
const MessageType* typeOfChannel(const std::string& channel);

/// Hears the values of a message one after the other.
class MessageVisitor {
 public:
  virtual ~MessageVisitor() = default;
  /// Values of the field follow: one, or as many as its lengths tell, the last dimension fastest.
  virtual void beginField(const MessageField& field, size_t count) = 0;
  virtual void endField(const MessageField& field) = 0;
  virtual void integer(int64_t value) = 0;
  virtual void real(double value, bool single) = 0;  ///< `single`: a float
  virtual void text(const std::string& value) = 0;
  /// A value that is a message itself: its fields lie between the two.
  virtual void beginMessage(const MessageType& type) = 0;
  virtual void endMessage(const MessageType& type) = 0;
};

/// Tells a visitor all values of a message; its fingerprint comes first in `bytes`.
/** False if the bytes are no message of the type: another fingerprint, too few or too many bytes, a
 * length below zero. The visitor may have heard the beginning then. */
bool visit(const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes,
           MessageVisitor& visitor);

/// The numbers of a message by its fields' names, times up to 2^53 us exactly; nothing if the bytes
/// are no message of the type, or the type holds other messages or texts.
std::optional<std::map<std::string, std::vector<double>>> numbersOf(
    const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes);

}  // namespace tread

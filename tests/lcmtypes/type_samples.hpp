// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/channels.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

namespace tread::testing {

/// Makes messages with another value in each field, the same on every platform, from the types'
/// descriptions.
class SampleMaker {
 public:
  std::vector<uint8_t> bytesOf(const std::string& type) {
    const MessageType& description = *treadTypes().find(type);
    return tread::bytesOf(treadTypes(), description, message(description).dump());
  }

 private:
  using Json = nlohmann::json;

  static constexpr int kLength = 2;  ///< of what has no constant length

  Json message(const MessageType& type) {
    Json message;
    for (const MessageField& field : type.fields) message[field.name] = valuesOf(type, field);
    return message;
  }
  Json valuesOf(const MessageType& type, const MessageField& field) {
    if (isLength(type, field)) return kLength;
    if (field.lengths.empty()) return valueOf(field);
    if (field.type == "byte") return "f/4=";  // 127, 254
    size_t count = 1;
    for (const std::string& length : field.lengths)
      count *= type.field(length) != nullptr ? kLength : std::stoul(length);
    Json values = Json::array();
    for (size_t i = 0; i < count; ++i) values.push_back(valueOf(field));
    return values;
  }
  Json valueOf(const MessageField& field) {
    ++made_;
    if (const MessageType* const inner = treadTypes().find(field.type)) return message(*inner);
    if (field.type == "string") return "sample " + std::to_string(made_);
    if (field.type == "boolean") return true;
    const int sign = made_ % 3 == 0 ? -1 : 1;
    if (field.type == "float" || field.type == "double") {
      if (made_ % 7 == 0) return made_ % 2 == 0 ? "NaN" : "-Infinity";
      return sign * (made_ + 0.375);
    }
    return sign * made_;
  }
  static bool isLength(const MessageType& type, const MessageField& wanted) {
    for (const MessageField& field : type.fields)
      for (const std::string& length : field.lengths)
        if (length == wanted.name) return true;
    return false;
  }

  int made_ = 0;
};

template <class Message>
std::vector<uint8_t> encode(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  if (message.encode(bytes.data(), 0, size) != size) bytes.clear();
  return bytes;
}

/// Whether these bytes decode completely as a message.
// Not inlined: g++ 12 reports a variable of the generated code as uninitialized otherwise.
template <class Message>
[[gnu::noinline]] bool decode(const std::vector<uint8_t>& bytes, Message& message) {
  const int size = static_cast<int>(bytes.size());
  return message.decode(bytes.data(), 0, size) == size;
}

/// A message with a value in every field.
template <class Message>
Message sampleOf() {
  Message message{};
  if (!decode(SampleMaker().bytesOf(Message::getTypeName()), message))
    throw std::logic_error(std::string("no sample of ") + Message::getTypeName());
  return message;
}

template <class... Messages, class Visitor>
void visitSamples(const std::tuple<Messages...>* /*types*/, Visitor& visit) {
  (visit(sampleOf<Messages>()), ...);
}

/// Calls `visit` with a sample of each type.
template <class Visitor>
void forEachType(Visitor&& visit) {
  visitSamples(static_cast<const AllMessages*>(nullptr), visit);
}

template <class Message>
Message sampleFor(const Channel<Message>& /*channel*/) {
  return sampleOf<Message>();
}

/// Calls `visit` with each typed channel and a sample of its type.
template <class Visitor>
void forEachChannel(Visitor&& visit) {
  const auto visitAll = [&](const auto&... channel) { (visit(channel, sampleFor(channel)), ...); };
  std::apply(visitAll, kTypedChannels);
}

}  // namespace tread::testing

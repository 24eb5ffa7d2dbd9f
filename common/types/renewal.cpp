// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/types/renewal.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/types/message_json.hpp"

namespace tread {

/// The .lcm files of each folder of lcmtypes/before; made by the build.
extern const char* const kTypesBefore[];

namespace {

using Json = nlohmann::json;

const std::vector<MessageTypes>& typesBefore() {
  static const std::vector<MessageTypes> types = [] {
    std::vector<MessageTypes> read;
    for (const char* const* text = kTypesBefore; *text != nullptr; ++text)
      read.push_back(MessageTypes::fromText(*text));
    return read;
  }();
  return types;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Of a field that a message does not have; arrays of no fixed length are new with their length 0.
Json unknownOf(const MessageField& field) {
  if (!field.lengths.empty()) return Json::array();
  if (field.type == "string") return "";
  if (field.type == "boolean") return false;
  if (field.type == "float" || field.type == "double") return "NaN";
  return endsWith(field.name, "_code") ? -1 : 0;
}

void fillMissing(Json& message, const MessageType& type) {
  for (const MessageField& field : type.fields) {
    const auto member = message.find(field.name);
    if (member == message.end()) {
      message[field.name] = unknownOf(field);
      continue;
    }
    const MessageType* const inner = treadTypes().find(field.type);
    if (inner == nullptr) continue;
    if (member->is_object()) fillMissing(*member, *inner);
    if (member->is_array())
      for (Json& each : *member) fillMissing(each, *inner);
  }
}

}  // namespace

bool renewByNames(const std::string& channel, std::vector<uint8_t>& bytes) {
  for (const MessageTypes& types : typesBefore()) {
    const MessageType* const older = types.typeOf(bytes);
    const MessageType* const type = older == nullptr ? nullptr : typeOfChannel(channel);
    if (type == nullptr || older->name != type->name) continue;
    const std::optional<std::string> text = jsonOf(types, *older, bytes);
    if (!text) return false;
    Json message = Json::parse(*text);
    fillMissing(message, *type);
    bytes = bytesOf(treadTypes(), *type, message.dump());
    return true;
  }
  return false;
}

}  // namespace tread

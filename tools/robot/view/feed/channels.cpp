// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/feed/channels.hpp"

#include "common/bus/channels.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/scene_schemas.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

namespace tread::view {

OfferedChannels::OfferedChannels() {
  for (const ChannelSpec& spec : kChannels)
    add(spec.name, std::string("tread.") + spec.type,
        jsonSchemaOf(treadTypes(), *typeOfChannel(spec.name)));
  for (const auto& [topic, schema] : sceneTopics()) add(topic, schema, sceneSchema(schema));
  const char* const any = R"({"type":"object","properties":{}})";
  add(kHistoryTopic, "tread.view.history", any);
  add(kPlayerTopic, "tread.view.player", any);
}

void OfferedChannels::add(const std::string& topic, const std::string& schema_name,
                          const std::string& schema) {
  by_topic_[topic] = all_.size();
  all_.push_back({static_cast<uint32_t>(all_.size()) + 1, topic, schema_name, schema});
}

const OfferedChannel* OfferedChannels::find(const std::string& topic) const {
  const auto found = by_topic_.find(topic);
  return found == by_topic_.end() ? nullptr : &all_[found->second];
}

}  // namespace tread::view

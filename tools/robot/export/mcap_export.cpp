// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/export/mcap_export.hpp"

#include "common/mcap/mcap_writer.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/scene_schemas.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"
#include "tools/robot/export/log_selection.hpp"

namespace tread::exporting {
namespace {

uint64_t nanoseconds(int64_t utime) {
  return static_cast<uint64_t>(utime) * 1000;
}

class McapExport {
 public:
  explicit McapExport(const std::string& path) : writer_(path) {}

  void take(const LogEvent& event) {
    if (const auto message = countedJson(event, counts))
      put(event.channel, "tread." + message->type->name, event.utime, message->json,
          [&] { return jsonSchemaOf(treadTypes(), *message->type); });
  }
  void draw(const LogEvent& event) {
    for (const SceneMessage& message : scene_.take(event))
      put(message.topic, message.schema, event.utime, message.json,
          [&] { return sceneSchema(message.schema); });
  }
  void close() { writer_.close(); }

  ExportCounts counts;

 private:
  template <class Schema>
  void put(const std::string& topic, const std::string& schema_name, int64_t utime,
           const std::string& json, const Schema& schema) {
    auto channel = channels_.find(topic);
    if (channel == channels_.end()) {
      auto known = schemas_.find(schema_name);
      if (known == schemas_.end())
        known =
            schemas_.emplace(schema_name, writer_.addSchema(schema_name, "jsonschema", schema()))
                .first;
      channel = channels_.emplace(topic, writer_.addChannel(known->second, topic, "json")).first;
    }
    writer_.write(channel->second, nanoseconds(utime), nanoseconds(utime), json);
  }

  mcap::Writer writer_;
  SceneMaker scene_;
  std::map<std::string, uint16_t> schemas_, channels_;
};

}  // namespace

ExportCounts exportMcap(const std::vector<std::string>& logs, const Selection& selection,
                        const std::string& path, bool scene) {
  McapExport mcap(path);
  mcap.counts.problem = SelectedEvents(logs, selection).forEach([&](const LogEvent& event) {
    mcap.take(event);
    if (scene) mcap.draw(event);
  });
  mcap.close();
  return std::move(mcap.counts);
}

}  // namespace tread::exporting

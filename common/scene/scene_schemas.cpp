// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/scene/scene_schemas.hpp"

#include <nlohmann/json.hpp>

#include "common/scene/scene.hpp"

namespace tread {
namespace {

using Schema = nlohmann::ordered_json;

const Schema kNumber{{"type", "number"}}, kInteger{{"type", "integer"}}, kText{{"type", "string"}},
    kBoolean{{"type", "boolean"}}, kBytes{{"type", "string"}, {"contentEncoding", "base64"}};

Schema object(const Schema& properties) {
  return {{"type", "object"}, {"properties", properties}};
}
Schema listOf(const Schema& item) {
  return {{"type", "array"}, {"items", item}};
}

Schema timeSchema() {
  return object({{"sec", kInteger}, {"nsec", kInteger}});
}
Schema vectorSchema() {
  return object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
}
Schema quaternionSchema() {
  return object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});
}
Schema poseSchema() {
  return object({{"position", vectorSchema()}, {"orientation", quaternionSchema()}});
}
Schema colourSchema() {
  return object({{"r", kNumber}, {"g", kNumber}, {"b", kNumber}, {"a", kNumber}});
}
Schema fieldsSchema() {
  return listOf(object({{"name", kText}, {"offset", kInteger}, {"type", kInteger}}));
}

Schema entitySchema() {
  const Schema solid =
      object({{"pose", poseSchema()}, {"size", vectorSchema()}, {"color", colourSchema()}});
  Schema cylinder = solid;
  cylinder["properties"]["bottom_scale"] = cylinder["properties"]["top_scale"] = kNumber;
  const Schema arrow = object({{"pose", poseSchema()},
                               {"shaft_length", kNumber},
                               {"shaft_diameter", kNumber},
                               {"head_length", kNumber},
                               {"head_diameter", kNumber},
                               {"color", colourSchema()}});
  const Schema line = object({{"type", kInteger},
                              {"pose", poseSchema()},
                              {"thickness", kNumber},
                              {"scale_invariant", kBoolean},
                              {"points", listOf(vectorSchema())},
                              {"color", colourSchema()},
                              {"colors", listOf(colourSchema())},
                              {"indices", listOf(kInteger)}});
  return object({{"id", kText},
                 {"frame_id", kText},
                 {"timestamp", timeSchema()},
                 {"lifetime", timeSchema()},
                 {"frame_locked", kBoolean},
                 {"arrows", listOf(arrow)},
                 {"cubes", listOf(solid)},
                 {"cylinders", listOf(cylinder)},
                 {"lines", listOf(line)}});
}

Schema schemaNamed(const std::string& name) {
  const Schema stamped{{"timestamp", timeSchema()}};
  Schema fields = stamped;
  if (name == "foxglove.FrameTransform") {
    fields.update(Schema{{"parent_frame_id", kText},
                         {"child_frame_id", kText},
                         {"translation", vectorSchema()},
                         {"rotation", quaternionSchema()}});
  } else if (name == "foxglove.Grid") {
    fields.update(Schema{{"frame_id", kText},
                         {"pose", poseSchema()},
                         {"column_count", kInteger},
                         {"cell_size", object({{"x", kNumber}, {"y", kNumber}})},
                         {"row_stride", kInteger},
                         {"cell_stride", kInteger},
                         {"fields", fieldsSchema()},
                         {"data", kBytes}});
  } else if (name == "foxglove.PointCloud") {
    fields.update(Schema{{"frame_id", kText},
                         {"pose", poseSchema()},
                         {"point_stride", kInteger},
                         {"fields", fieldsSchema()},
                         {"data", kBytes}});
  } else if (name == "foxglove.Log") {
    fields.update(Schema{{"level", kInteger},
                         {"message", kText},
                         {"name", kText},
                         {"file", kText},
                         {"line", kInteger}});
  } else {
    const Schema deletion =
        object({{"timestamp", timeSchema()}, {"type", kInteger}, {"id", kText}});
    fields = Schema{{"deletions", listOf(deletion)}, {"entities", listOf(entitySchema())}};
  }
  Schema schema = object(fields);
  schema["title"] = name;
  return schema;
}

}  // namespace

std::string sceneSchema(const std::string& name) {
  return schemaNamed(name).dump();
}

const std::vector<std::pair<std::string, std::string>>& sceneTopics() {
  static const std::vector<std::pair<std::string, std::string>> topics{
      {"scene/tf", "foxglove.FrameTransform"},
      {"scene/map", "foxglove.Grid"},
      {"scene/scan", "foxglove.PointCloud"},
      {"scene/plan", "foxglove.SceneUpdate"},
      {"scene/events", "foxglove.Log"}};
  return topics;
}

}  // namespace tread

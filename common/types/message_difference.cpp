// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/types/message_difference.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>
#include <variant>

#include "common/config/scalars.hpp"
#include "common/types/tread_types.hpp"

namespace tread {
namespace {

struct MessageValue {
  std::string path;
  std::variant<int64_t, double, std::string> value;
};

/// All values of a message with their paths, without the fields of some names.
class ValueList : public MessageVisitor {
 public:
  explicit ValueList(const std::set<std::string>& without) : without_(without) {}

  void beginField(const MessageField& field, size_t) override {
    levels_.back().field = &field;
    levels_.back().index = 0;
    levels_.back().skipped = levels_.back().inherited || without_.count(field.name) > 0;
  }
  void endField(const MessageField&) override {}
  void integer(int64_t value) override {
    levels_.back().lengths[levels_.back().field->name] = value;
    add(value);
  }
  void real(double value, bool) override { add(value); }
  void text(const std::string& value) override { add(value); }
  void beginMessage(const MessageType&) override {
    const bool skipped = levels_.back().skipped;
    Level inner;
    inner.prefix = path() + ".";
    inner.inherited = skipped;
    ++levels_.back().index;
    levels_.push_back(inner);
  }
  void endMessage(const MessageType&) override { levels_.pop_back(); }

  std::vector<MessageValue> values;

 private:
  struct Level {
    std::string prefix;
    const MessageField* field = nullptr;
    size_t index = 0;
    bool inherited = false, skipped = false;
    std::map<std::string, int64_t> lengths;  ///< the integers so far, by name
  };

  void add(std::variant<int64_t, double, std::string> value) {
    if (!levels_.back().skipped) values.push_back({path(), std::move(value)});
    ++levels_.back().index;
  }
  /// Name of the present value, with an index for each dimension.
  std::string path() const {
    const Level& level = levels_.back();
    std::string indices;
    size_t rest = level.index;
    for (auto length = level.field->lengths.rbegin(); length != level.field->lengths.rend();
         ++length) {
      const auto named = level.lengths.find(*length);
      const auto size =
          static_cast<size_t>(named == level.lengths.end() ? std::stoll(*length) : named->second);
      indices = "[" + std::to_string(rest % size) + "]" + indices;
      rest /= size;
    }
    return level.prefix + level.field->name + indices;
  }

  const std::set<std::string>& without_;
  std::vector<Level> levels_{1};
};

std::string textOf(const MessageValue& value) {
  if (const auto* number = std::get_if<int64_t>(&value.value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value.value)) return formatNumber(*number);
  return "'" + std::get<std::string>(value.value) + "'";
}

bool agree(const MessageValue& a, const MessageValue& b, double tolerance) {
  const auto* x = std::get_if<double>(&a.value);
  const auto* y = std::get_if<double>(&b.value);
  if (x == nullptr || y == nullptr) return a.value == b.value;
  return std::memcmp(x, y, sizeof *x) == 0 || std::abs(*x - *y) < tolerance;
}

}  // namespace

std::string differenceBetween(const std::string& type, const std::vector<uint8_t>& log,
                              const std::vector<uint8_t>& replay, double tolerance,
                              const std::set<std::string>& without) {
  if (log == replay) return "";
  const MessageType* const description = treadTypes().find(type);
  ValueList in_log(without);
  ValueList in_replay(without);
  if (description == nullptr || !visit(treadTypes(), *description, log, in_log) ||
      !visit(treadTypes(), *description, replay, in_replay))
    throw std::invalid_argument("bytes that are no " + type);
  // A length stands in front of what it counts: where the paths part, the lengths have differed.
  for (size_t i = 0; i < in_log.values.size() && i < in_replay.values.size(); ++i) {
    const MessageValue& a = in_log.values[i];
    const MessageValue& b = in_replay.values[i];
    if (!agree(a, b, tolerance)) return a.path + ": log " + textOf(a) + ", replay " + textOf(b);
  }
  return "";
}

}  // namespace tread

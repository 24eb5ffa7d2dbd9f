// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/bank_text.hpp"

#include <sstream>
#include <vector>

#include "modules/learner/core/sealed_text.hpp"

namespace tread::learner {
namespace {

constexpr const char* kHeader = "tread-surface-bank 1";
/// Names of the common corrections, in the order of TwistCorrection.
constexpr const char* kCommonNames[TwistCorrection::kCommon] = {
    "forward_gain", "yaw_gain", "sideslip", "turn_loss", "yaw_by_speed", "yaw_bias", "crab"};

void writeSurface(std::ostringstream& out, size_t place, const RememberedSurface& surface,
                  const PatternSet& shipped) {
  out << "surface " << place << " last_met " << surface.last_met << " noise";
  for (Eigen::Index axis = 0; axis < 3; ++axis) out << ' ' << number(surface.noise[axis]);
  out << '\n';
  for (int i = 0; i < TwistCorrection::kCommon; ++i)
    out << kCommonNames[i] << ' ' << number(surface.x[i]) << '\n';
  for (size_t p = 0; p < shipped.patterns().size(); ++p) {
    out << "pattern " << shipped.patterns()[p].id << " driven " << number(surface.driven[p])
        << " own";
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      out << ' ' << number(surface.x[GroundModel::ownAt(p) + axis]);
    out << '\n';
  }
}

/// One surface as the numbers that SurfaceBank::restore() takes.
void readSurface(Words& words, size_t place, const PatternSet& shipped,
                 std::vector<double>& memory) {
  words.expect("surface");
  words.require(words.integer() == static_cast<int64_t>(place));
  words.expect("last_met");
  memory.push_back(static_cast<double>(words.integer()));
  words.expect("noise");
  std::vector<double> noise;
  for (int axis = 0; axis < 3; ++axis) noise.push_back(words.real());
  for (const char* name : kCommonNames) {
    words.expect(name);
    memory.push_back(words.real());
  }
  std::vector<double> driven;
  for (const MotionPattern& pattern : shipped.patterns()) {
    words.expect("pattern");
    words.require(words.integer() == pattern.id);
    words.expect("driven");
    driven.push_back(words.real());
    words.expect("own");
    for (int axis = 0; axis < 3; ++axis) memory.push_back(words.real());
  }
  memory.insert(memory.end(), driven.begin(), driven.end());
  memory.insert(memory.end(), noise.begin(), noise.end());
}

}  // namespace

std::string formatBank(const SurfaceBank& bank, const PatternSet& shipped) {
  std::ostringstream out;
  out << kHeader << "\nshipped " << shipped.checksum() << "\nsurfaces " << bank.size() << '\n';
  for (size_t k = 0; k < bank.size(); ++k) writeSurface(out, k + 1, bank[k].stored(), shipped);
  return sealed(out.str());
}

std::optional<std::string> parseBank(const std::string& text, const PatternSet& shipped,
                                     SurfaceBank& bank) {
  const auto content = unsealed(text);
  const std::string header = kHeader;
  if (!content || content->compare(0, header.size(), header) != 0) return "is damaged";
  Words words(content->substr(header.size()));
  words.expect("shipped");
  if (words.integer() != shipped.checksum()) return "belongs to another shipped pattern set";
  words.expect("surfaces");
  const int64_t count = words.integer();
  std::vector<double> memory{static_cast<double>(count)};
  for (int64_t k = 1; k <= count && words.good(); ++k)
    readSurface(words, static_cast<size_t>(k), shipped, memory);
  size_t at = 0;
  if (!words.good() || !bank.restore(memory, at)) return "is damaged";
  return std::nullopt;
}

}  // namespace tread::learner

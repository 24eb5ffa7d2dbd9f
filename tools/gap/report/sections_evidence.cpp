// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <map>

#include "tools/gap/report/pictures.hpp"
#include "tools/gap/report/sections.hpp"
#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

/// Cells whose residual is there beyond chance.
size_t marked(const std::vector<AtlasCell>& cells) {
  return static_cast<size_t>(
      std::count_if(cells.begin(), cells.end(), [](const AtlasCell& cell) { return cell.marked; }));
}

std::vector<std::string> mapPictures(const Finding& finding) {
  std::vector<std::string> pictures;
  for (const AtlasMap& map : finding.atlas.maps) {
    if (map.v_edges.size() < 2 || map.omega_edges.size() < 2) continue;
    const double full_colour = largestResidual(map);
    pictures.push_back(mapPicture(map, false, full_colour));
    pictures.push_back(mapPicture(map, true, full_colour));
  }
  return pictures;
}

/// Logs in the order in which the drives were given: the model is none.
std::string logName(const std::vector<InputFile>& inputs, size_t drive) {
  std::vector<std::string> names;
  for (const InputFile::Role role : {InputFile::Role::kTrain, InputFile::Role::kTest})
    for (const InputFile& input : inputs)
      if (input.role == role) names.push_back(input.name);
  if (drive >= names.size()) return "log " + std::to_string(drive + 1);
  constexpr size_t kRoom = 26;
  const std::string name = names[drive].substr(0, names[drive].rfind(".lcmlog"));
  return name.size() <= kRoom ? name : name.substr(0, kRoom - 2) + "..";
}

/// Errors over the ground, log by log, before and after in the same colours.
std::vector<std::string> placePictures(const Finding& finding,
                                       const std::vector<InputFile>& inputs) {
  std::map<size_t, std::vector<PlaceError>> logs;
  for (const PlaceError& place : finding.shown.places) logs[place.drive].push_back(place);
  std::vector<std::string> pictures;
  for (const auto& [drive, places] : logs) {
    const double full_colour = fullColourOf(places);
    for (const bool after : {false, true})
      pictures.push_back(placePicture(places, after, full_colour, logName(inputs, drive)));
  }
  return pictures;
}

/// Whose model predicted the executions that are shown.
std::string predictedBy(const Finding& finding, const std::vector<InputFile>& inputs) {
  if (std::any_of(inputs.begin(), inputs.end(),
                  [](const InputFile& input) { return input.role == InputFile::Role::kTest; }))
    return "they are of the test logs.";
  if (finding.gap && finding.gap->structure_nested)
    return "each is predicted by the model that the other half of the driving gave.";
  return "each is predicted with parameters that the other half of the driving gave; the effects "
         "were chosen with all of it.";
}

std::string remarkOf(const SearchStep& step) {
  std::vector<std::string> close;
  for (const RunnerUp& runner_up : step.runner_ups)
    if (runner_up.behind <= runner_up.error) close.push_back(shortTitleOf(runner_up.effect));
  std::string text = step.remark;
  if (!close.empty()) text += (text.empty() ? "as good: " : "; as good: ") + joined(close, "or");
  return text;
}

std::vector<Block> atlasBlocks(const Finding& finding) {
  if (finding.atlas.curves.empty()) return {};
  std::vector<Block> blocks;
  size_t before = 0;
  size_t after = 0;
  for (const AtlasCurve& curve : finding.atlas.curves) {
    before += marked(curve.before);
    after += marked(curve.after);
  }
  blocks.push_back(Paragraph{
      "Residuals, measured less predicted, over what they may depend on. Of all fields " +
      std::to_string(before) + " were off beyond chance before and " + std::to_string(after) +
      " are now (filled dots: beyond chance even for so many fields; intervals: 95 % each, over "
      "blocks of driving)."});
  if (const std::vector<std::string> maps = mapPictures(finding); !maps.empty())
    blocks.push_back(Pictures{maps,
                              "Mean residual over speed and yaw rate; white is right, "
                              "empty was not driven."});
  Pictures curves{{}, "Orange, dashed: the old model. Blue: the new one."};
  for (const AtlasCurve& curve : finding.atlas.curves) curves.svg.push_back(atlasPicture(curve));
  blocks.push_back(curves);
  return blocks;
}

std::vector<Block> executionsBlocks(const Finding& finding, const std::vector<InputFile>& inputs) {
  if (finding.shown.overlays.empty()) return {};
  std::vector<Block> blocks;
  constexpr size_t kTypical = 6;
  Pictures pictures{
      {},
      "Each from where it begins; ahead is up. Dots are where it ends, with the heading there. "
      "Blue shade: 9 of 10 are within."};
  for (size_t i = 0; i < finding.shown.overlays.size(); ++i) {
    const Overlay& overlay = finding.shown.overlays[i];
    const std::string rank = i < kTypical ? "typical" : "worst";
    pictures.svg.push_back(overlayPicture(overlay, rank + ", " + threeDigits(overlay.begin) +
                                                       " s of " + logName(inputs, overlay.drive)));
  }
  blocks.push_back(
      Paragraph{"Six typical executions, then the three worst, none of them used for the fit: " +
                predictedBy(finding, inputs)});
  if (!finding.shown.overlays.front().band.empty())
    blocks.push_back(Paragraph{
        "The shade is a 90 % band: the residual noise of the fitted model (for each channel a part "
        "that is always there and one in proportion to the motion), carried along the predicted "
        "path, times the factor with which it holds 9 of 10 of all " +
        std::to_string(finding.shown.places.size()) + " such executions at each time."});
  blocks.push_back(pictures);
  return blocks;
}

std::vector<Block> placesBlocks(const Finding& finding, const std::vector<InputFile>& inputs) {
  if (!finding.gap) return {};
  if (finding.shown.places.empty())
    return {Paragraph{"No map: the logs have no absolute poses at the executions' ends."}};
  return {Pictures{
      placePictures(finding, inputs),
      "Position error at the end of each execution that was not used for the fit, where it was "
      "driven; grey is right. Errors that gather in one place speak for the ground there."}};
}

std::vector<Block> stepsBlocks(const Finding& finding) {
  if (finding.search.steps.empty()) return {};
  std::vector<Block> blocks;
  blocks.push_back(Paragraph{
      "Each step adds the effect that helps most on blocks of driving that were not fitted, or "
      "takes one away again that the others make superfluous. Gains in log likelihood (nats) with "
      "standard error; p "
      "is the chance of so large a score anywhere in the catalogue if nothing were there."});
  Table table{{"step", "effect", "remark", "score", "p", "gain"}, {}, 3};
  size_t number = 0;
  for (const SearchStep& step : finding.search.steps) {
    const std::string sign = step.removed ? "- " : "+ ";
    table.rows.push_back({std::to_string(++number), sign + titleOf(step.effect), remarkOf(step),
                          threeDigits(step.score), saidChance(step.p_value),
                          threeDigits(step.gain) + " \u00b1 " + threeDigits(step.gain_error)});
  }
  blocks.push_back(table);
  blocks.push_back(Pictures{{stepsPicture(finding.search.steps)}, "Gain of each step."});
  return blocks;
}

}  // namespace

std::vector<Section> evidenceSections(const Finding& finding,
                                      const std::vector<InputFile>& inputs) {
  return {{"Where simulation and measurement disagree", atlasBlocks(finding)},
          {"Executions, as measured and as predicted", executionsBlocks(finding, inputs)},
          {"Where on the ground", placesBlocks(finding, inputs)},
          {"Step by step", stepsBlocks(finding)}};
}

}  // namespace tread::gap

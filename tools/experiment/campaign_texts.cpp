// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>

#include "tools/experiment/campaign.hpp"

namespace tread::experiment {

std::string textOfBank(const Campaign& campaign) {
  return textOfTours(campaign.tours, campaign.grounds.front().averaged);
}

std::string watchedPattern(const Campaign& campaign) {
  const Ground& ground = campaign.grounds.front();
  const auto watched = neverExecuted(ground, campaign.settings.sequences);
  if (!watched || campaign.first.drift.empty()) return "";
  return ground.averaged.patterns()[*watched].name;
}

std::string textOfDrift(const Campaign& campaign) {
  const std::string watched = watchedPattern(campaign);
  if (watched.empty()) return "";
  std::string text =
      "DRIFT: width of the never executed pattern '" + watched +
      "' over its shipped one while the test sequences are driven\nagain and again on unchanged "
      "ground, mean over surfaces.\n\nafter          ";
  char words[32];
  const size_t all = campaign.settings.drift;
  const size_t shown[] = {all / 10, all / 3, 2 * all / 3, all};
  for (const size_t j : shown) {
    std::snprintf(words, sizeof words, "%8zu", j);
    text += words;
  }
  for (size_t i = 0; i < campaign.first.drift.size(); ++i) {
    std::snprintf(words, sizeof words, "\n%-15s", campaign.settings.rules[i].c_str());
    text += words;
    for (const size_t j : shown) {
      std::snprintf(words, sizeof words, "%8.3f", campaign.first.drift[i][j]);
      text += words;
    }
  }
  return text + "\n";
}

std::string textOfVariants(const Campaign& campaign) {
  std::string text;
  for (const Variant& variant : campaign.variants) {
    Setting setting = campaign.setting;
    setting.paper_reference = false;
    setting.books = variant.books.size();
    text += "VARIANT: " + variant.words + ", a tenth of the repetitions.\n" +
            textOfKeyFigures(variant.tables, setting, variant.books) + "\n";
  }
  return text;
}

}  // namespace tread::experiment

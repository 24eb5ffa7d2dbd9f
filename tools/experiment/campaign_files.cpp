// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "common/recordings/text_file.hpp"
#include "tools/experiment/campaign.hpp"
#include "tools/experiment/figures.hpp"

namespace tread::experiment {

void writeCampaign(const std::string& folder, const Campaign& campaign) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw std::runtime_error(folder + ": the folder cannot be made: " + failure.message());
  const auto path = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  const TransitionErrors& shown =
      campaign.first
          .transitions[transitionOfFigures(campaign.first, campaign.settings, campaign.grounds)];
  const std::string words = wordsOf(shown, campaign.grounds);
  drawDevelopment(path("figure4.png"), shown, campaign.settings, words);
  drawDistributions(path("figure5.png"), shown, campaign.settings, words);
  const std::string watched = watchedPattern(campaign);
  if (!watched.empty())
    drawDrift(path("drift.png"), campaign.first.drift, campaign.settings, watched);
  const Tables& tables = campaign.tables;
  recordings::writeText(path("table1.csv"), csvOfErrors(tables));
  recordings::writeText(path("table2.csv"), csvOfReductions(tables));
  recordings::writeText(path("all_patterns.csv"), csvOfAllPatterns(tables));
  recordings::writeText(path("unchanged.csv"), csvOfUnchanged(tables));
  recordings::writeText(path("unchanged_sequences.csv"), csvOfUnchangedSequences(tables));
  if (!watched.empty())
    recordings::writeText(path("drift.csv"), csvOfDrift(campaign.first, campaign.settings));
  if (campaign.books.size() > 1)
    recordings::writeText(path("books.csv"), csvOfBooks(campaign.books, campaign.request.seed));
  recordings::writeText(path("table1.txt"),
                        textOfErrors(tables, campaign.setting) + "\n" +
                            textOfAgreement(tables, campaign.setting, campaign.books));
  recordings::writeText(path("table2.txt"), textOfReductions(tables, campaign.setting));
  recordings::writeText(
      path("key_figures.txt"),
      textOfVariants(campaign) + textOfKeyFigures(tables, campaign.setting, campaign.books));
  if (!campaign.tours.empty()) recordings::writeText(path("bank.txt"), textOfBank(campaign));
  Pictures pictures{recordings::readText(path("figure4.png")),
                    recordings::readText(path("figure5.png")), ""};
  if (!watched.empty()) pictures.drift = recordings::readText(path("drift.png"));
  recordings::writeText(path("report.html"), htmlOf(campaign, pictures));
}

}  // namespace tread::experiment

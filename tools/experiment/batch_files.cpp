// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "common/recordings/text_file.hpp"
#include "common/report/text.hpp"
#include "tools/experiment/batch.hpp"
#include "tools/experiment/figures.hpp"

namespace tread::experiment {

std::string textOfBank(const Batch& batch) {
  return textOfExcitation(batch.excitation, batch.grounds.front().averaged);
}

std::string watchedPattern(const Batch& batch) {
  const Ground& ground = batch.grounds.front();
  const auto watched = neverExecuted(ground, batch.settings.sequences);
  if (!watched || batch.first.drift.empty()) return "";
  return ground.averaged.patterns()[*watched].name;
}

std::string textOfDrift(const Batch& batch) {
  const std::string watched = watchedPattern(batch);
  if (watched.empty()) return "";
  std::string text =
      "DRIFT: width of the never executed pattern '" + watched +
      "' over its shipped one while the test sequences are driven\nagain and again on unchanged "
      "ground, mean over surfaces.\n\nafter          ";
  const size_t all = batch.settings.drift;
  const size_t shown[] = {all / 10, all / 3, 2 * all / 3, all};
  for (const size_t j : shown) text += formatted("%8zu", j);
  for (size_t i = 0; i < batch.first.drift.size(); ++i) {
    text += formatted("\n%-15s", batch.settings.rules[i].c_str());
    for (const size_t j : shown) text += formatted("%8.3f", batch.first.drift[i][j]);
  }
  return text + "\n";
}

std::string textOfVariants(const Batch& batch) {
  std::string text;
  for (const Variant& variant : batch.variants) {
    Setting setting = batch.setting;
    setting.paper_reference = false;
    setting.books = variant.books.size();
    text += "VARIANT: " + variant.words + ", a tenth of the repetitions.\n" +
            textOfKeyFigures(variant.tables, setting, variant.books) + "\n";
  }
  return text;
}

void writeBatch(const std::string& folder, const Batch& batch) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw std::runtime_error(folder + ": the folder cannot be made: " + failure.message());
  const auto path = [&](const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
  };
  const TransitionErrors& shown =
      batch.first.transitions[transitionOfFigures(batch.first, batch.settings, batch.grounds)];
  const std::string words = wordsOf(shown, batch.grounds);
  drawDevelopment(path("figure4.png"), shown, batch.settings, words);
  drawDistributions(path("figure5.png"), shown, batch.settings, words);
  const std::string watched = watchedPattern(batch);
  if (!watched.empty()) drawDrift(path("drift.png"), batch.first.drift, batch.settings, watched);
  const Tables& tables = batch.tables;
  for (const TableFile& file : tableFiles())
    recordings::writeText(path(std::string(file.name) + ".csv"), csvOf(tables, file));
  if (!watched.empty())
    recordings::writeText(path("drift.csv"), csvOfDrift(batch.first, batch.settings));
  if (batch.books.size() > 1)
    recordings::writeText(path("books.csv"), csvOfBooks(batch.books, batch.request.seed));
  recordings::writeText(path("table1.txt"),
                        textOfErrors(tables, batch.setting) + "\n" +
                            textOfAgreement(tables, batch.setting, batch.books));
  recordings::writeText(path("table2.txt"), textOfReductions(tables, batch.setting));
  recordings::writeText(
      path("key_figures.txt"),
      textOfVariants(batch) + textOfKeyFigures(tables, batch.setting, batch.books));
  if (!batch.excitation.empty()) recordings::writeText(path("bank.txt"), textOfBank(batch));
  Pictures pictures{recordings::readText(path("figure4.png")),
                    recordings::readText(path("figure5.png")), ""};
  if (!watched.empty()) pictures.drift = recordings::readText(path("drift.png"));
  recordings::writeText(path("report.html"), htmlOf(batch, pictures));
}

}  // namespace tread::experiment

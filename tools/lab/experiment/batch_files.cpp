// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/batch_files.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "common/report/page.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"
#include "common/store/store.hpp"
#include "tools/lab/experiment/figures.hpp"
#include "tools/lab/experiment/first_executions_text.hpp"
#include "tools/lab/experiment/key_figures.hpp"
#include "tools/lab/experiment/text_tables.hpp"

namespace tread::experiment {

namespace {

std::string aboutLine(const Batch& batch) {
  const Request& request = batch.request;
  std::string text = std::to_string(request.repetitions) + " repetitions of each transition over " +
                     std::to_string(std::min(request.excitations, request.repetitions)) +
                     " excitation runs of " + std::to_string(request.excitation) +
                     " executions a surface, memory w = " + formatted("%g", request.memory) +
                     ", seed " + std::to_string(request.seed);
  if (request.sets > 1)
    text += ", means over " + std::to_string(request.sets) + " sets of recordings";
  if (request.length > 1)
    text += ", each command held " + std::to_string(request.length) + " times as long";
  if (request.change_inside) text += "; the ground changes in the middle of the first execution";
  text += ". Test sequences:";
  const auto& patterns = batch.grounds.front().averaged.patterns();
  for (const Sequence& sequence : batch.settings.sequences) {
    text += sequence == batch.settings.sequences.front() ? " " : "; ";
    for (size_t j = 0; j < sequence.size(); ++j)
      text += (j > 0 ? ", " : "") + patterns[sequence[j]].name;
  }
  return text + ".";
}

/// A table of "position / orientation" with a column per rule.
report::Table ruleTable(const Batch& batch, std::vector<std::string> first_columns) {
  report::Table table{std::move(first_columns), {}, 1};
  const std::vector<std::string>& rules = batch.setting.rules;
  table.header.insert(table.header.end(), rules.begin(), rules.end());
  return table;
}

void addRow(const Batch& batch, const std::vector<Row>& rows, const Row& wanted,
            std::vector<std::string> cells, report::Table& table) {
  for (const std::string& rule : batch.setting.rules) {
    const auto value = [&](const char* quantity) {
      const Row* row = find(rows, wanted.from, wanted.to, quantity, rule, "", wanted.k);
      return formatted("%.3f", row->estimate.value);
    };
    cells.push_back(value(kPosition) + " / " + value(kOrientation));
  }
  table.rows.push_back(std::move(cells));
}

report::Section allPatternsSection(const Batch& batch) {
  report::Table table = ruleTable(batch, {"transition", "k"});
  for (const std::string& from : batch.setting.surfaces)
    for (const std::string& to : batch.setting.surfaces)
      for (const int k : batch.settings.all_patterns_after) {
        if (from == to) continue;
        Row wanted;
        wanted.from = from;
        wanted.to = to;
        wanted.k = k;
        addRow(batch, batch.tables.all_patterns, wanted, {from + " to " + to, std::to_string(k)},
               table);
      }
  return {"Errors over all patterns after k executions",
          {report::Paragraph{"Fresh recordings of each pattern; position / orientation."}, table}};
}

report::Table unchangedTable(const Batch& batch, const std::vector<Row>& rows) {
  report::Table table = ruleTable(batch, {"surface"});
  for (const std::string& surface : batch.setting.surfaces) {
    Row wanted;
    wanted.from = wanted.to = surface;
    addRow(batch, rows, wanted, {surface}, table);
  }
  return table;
}

report::Section unchangedSection(const Batch& batch) {
  return {
      "Cost on an unchanged surface",
      {report::Paragraph{"Error in the long run relative to the correct set; position / "
                         "orientation. Patterns in random order:"},
       unchangedTable(batch, batch.tables.unchanged), report::Paragraph{"Repeated test sequences:"},
       unchangedTable(batch, batch.tables.unchanged_sequences)}};
}

/// A PNG file embedded in the page, as wide as the page.
report::Pictures picture(const std::string& path, const std::string& caption) {
  return {{"<img style=\"grid-column: 1 / -1; max-width: 100%\" alt=\"" + escaped(caption) +
           "\" src=\"data:image/png;base64," + base64(readText(path)) + "\">"},
          caption};
}

/// Preformatted text.
report::Section textSection(const std::string& title, const std::string& text) {
  return {title, {report::Commands{{text}}}};
}

/// report.html, including the pictures in the folder.
report::Page pageOf(const Batch& batch, const std::string& transition, const std::string& folder) {
  report::Page page;
  page.title = "Transitions between surfaces";
  page.verdict = page.title + ": " + batch.source;
  page.first = {report::Paragraph{aboutLine(batch)}};
  page.sections = {
      textSection("Key figures", textOfKeyFigures(batch.tables, batch.setting, batch.sets)),
      textSection("Table I: errors", textOfErrors(batch.tables, batch.setting) +
                                         textOfAgreement(batch.tables, batch.setting, batch.sets)),
      textSection("Table II: error reductions", textOfReductions(batch.tables, batch.setting)),
      textSection("First executions", textOfFirstExecutions(batch.tables, batch.setting)),
      {"Figure 4: from " + transition, {picture(folder + "/figure4.png", "error over executions")}},
      {"Figure 5: from " + transition, {picture(folder + "/figure5.png", "error distributions")}},
      allPatternsSection(batch)};
  if (!batch.tables.unchanged.empty()) page.sections.push_back(unchangedSection(batch));
  if (!watchedPattern(batch).empty())
    page.sections.push_back(
        {"Drift on an unchanged surface",
         {picture(folder + "/drift.png", "drift"), report::Commands{{textOfDrift(batch)}}}});
  if (!textOfRemembered(batch).empty())
    page.sections.push_back(textSection("Remembered surfaces", textOfRemembered(batch)));
  if (!batch.variants.empty())
    page.sections.push_back(textSection("Under other conditions", textOfVariants(batch)));
  if (!batch.notes.empty())
    page.sections.push_back({"About the recordings", {report::Points{batch.notes}}});
  return page;
}

}  // namespace

std::string textOfRemembered(const Batch& batch) {
  std::string text;
  for (size_t i = 0; i < batch.settings.rules.size(); ++i) {
    std::string line = formatted("\n%-24s", batch.settings.rules[i].c_str());
    for (const TrialGround& ground : batch.grounds) {
      std::vector<double> counts;
      for (const TransitionErrors& transition : batch.first.transitions)
        if (batch.grounds[transition.from].surface == ground.surface)
          counts.push_back(transition.remembered[i]);
      if (counts.front() >= 0.0) line += formatted("%12.1f", medianOf(counts));
    }
    if (line.size() > 25) text += line;
  }
  if (text.empty()) return "";
  std::string head = formatted("%-24s", "from");
  for (const TrialGround& ground : batch.grounds) head += formatted("%12s", ground.surface.c_str());
  return "REMEMBERED surfaces before a transition, including that of the shipped set; mean over "
         "excitation runs.\n\n" +
         head + text + "\n";
}

std::string watchedPattern(const Batch& batch) {
  const TrialGround& ground = batch.grounds.front();
  const auto watched = neverExecuted(ground, batch.settings.sequences);
  if (!watched || batch.first.drift.empty()) return "";
  return ground.averaged.patterns()[*watched].name;
}

std::string textOfDrift(const Batch& batch) {
  const std::string watched = watchedPattern(batch);
  if (watched.empty()) return "";
  std::string text =
      "DRIFT: width of the never executed pattern '" + watched +
      "' relative to its shipped one, while the test sequences are\nrepeated on unchanged "
      "ground, mean over surfaces.\n\nafter                   ";
  const size_t all = batch.settings.drift;
  const size_t shown[] = {all / 10, all / 3, 2 * all / 3, all};
  for (const size_t j : shown) text += formatted("%8zu", j);
  for (size_t i = 0; i < batch.first.drift.size(); ++i) {
    text += formatted("\n%-24s", batch.settings.rules[i].c_str());
    for (const size_t j : shown) text += formatted("%8.3f", batch.first.drift[i][j]);
  }
  return text + "\n";
}

std::string textOfVariants(const Batch& batch) {
  std::string text;
  for (const Variant& variant : batch.variants) {
    Setting setting = batch.setting;
    setting.paper_reference = false;
    setting.sets = variant.sets.size();
    text += "VARIANT: " + variant.words + ", a tenth of the repetitions.\n" +
            textOfKeyFigures(variant.tables, setting, variant.sets) + "\n";
  }
  return text;
}

void writeBatch(const std::string& folder, const Batch& batch) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw std::runtime_error(folder + ": the folder cannot be created: " + failure.message());
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
    writeText(path(std::string(file.name) + ".csv"), csvOf(tables, file));
  if (!watched.empty()) writeText(path("drift.csv"), csvOfDrift(batch.first, batch.settings));
  if (batch.sets.size() > 1) writeText(path("sets.csv"), csvOfSets(batch.sets, batch.request.seed));
  writeText(path("table1.txt"), textOfErrors(tables, batch.setting) + "\n" +
                                    textOfAgreement(tables, batch.setting, batch.sets));
  writeText(path("table2.txt"), textOfReductions(tables, batch.setting));
  writeText(path("first_executions.txt"), textOfFirstExecutions(tables, batch.setting));
  writeText(path("key_figures.txt"),
            textOfVariants(batch) + textOfKeyFigures(tables, batch.setting, batch.sets));
  writeText(path("report.html"), report::htmlOf(pageOf(batch, words, folder)));
}

}  // namespace tread::experiment

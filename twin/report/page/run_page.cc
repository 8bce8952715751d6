#include "twin/report/page/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "twin/core/bench_format.h"
#include "twin/core/reading_clock.h"
#include "twin/report/page/causes.h"
#include "twin/report/page/circles.h"
#include "twin/report/page/curves.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/readings_page.h"
#include "twin/report/page/tables.h"

namespace twinbench::report {
namespace {

void AddFigures(const std::vector<Figure>& figures, PageSection& section) {
  for (const Figure& figure : figures) section.blocks.emplace_back(figure);
}

PageSection CurveSection(const PageChoice& circles, const nlohmann::json& results, const std::vector<Figure>& curves) {
  PageSection section{"Errors", "Each curve with its expanded uncertainty U as a band. Polar: the distance from the dashed circle is the error.", {}};
  if (std::vector<Figure> less = DeviationFigures(curves); !less.empty()) {
    section.lead += " Truth: the simulated errors, without those orders that the design does not separate.";
    PageChoice choice{"Estimate less truth", "with its expanded uncertainty U", {"of"}, {}, {}};
    for (Figure& figure : less) {
      choice.answers.push_back({figure.title.substr(figure.title.find(": ") + 2)});
      choice.figures.push_back(std::move(figure));
    }
    section.blocks.emplace_back(std::move(choice));
  }
  AddFigures(curves, section);
  if (!circles.figures.empty()) section.blocks.emplace_back(circles);
  if (Figure ranks = ErrorRankFigure(results); !ranks.series.empty()) section.blocks.emplace_back(std::move(ranks));
  AddFilled(ErrorRankTable(results), section);
  return section;
}

/// Directions apart, and curves of what was separated by its orders alone.
std::vector<Figure> ShownCurves(const nlohmann::json& results, std::vector<Figure> curves) {
  ShowDirections(results, curves);
  for (Figure& summed : SummedCurves(results)) curves.push_back(std::move(summed));
  return curves;
}

/// @param curves, circles  Of which the spectra are, beside those that the results hold.
PageSection SpectrumSection(const std::vector<Figure>& curves, const std::vector<Figure>& circles, std::vector<Figure> spectra) {
  for (const std::vector<Figure>* figures : {&curves, &circles})
    for (const Figure& figure : *figures)
      if (auto harmonics = HarmonicsOf(figure)) spectra.push_back(std::move(*harmonics));
  std::ranges::stable_sort(spectra, std::greater(), [](const Figure& figure) { return figure.series.front().x.size(); });
  PageChoice choice{"Amplitude spectrum", "", {"of"}, {}, std::move(spectra)};
  for (const Figure& figure : choice.figures) choice.answers.push_back({figure.title.substr(0, figure.title.find(": amplitude spectrum"))});
  PageSection section{"Spectra", "Amplitudes order by order. Of 100 orders that hold nothing but noise, 95 stay below the dashed line.", {}};
  if (!choice.figures.empty()) section.blocks.emplace_back(std::move(choice));
  return section;
}

PageSection ValueSection(const nlohmann::json& results, const nlohmann::json& score) {
  PageSection section{"Results", "u: standard uncertainty, U = k u: an interval that holds the value in 95 % of cases.", {}};
  for (PageTable& table : std::vector{ListTable(results), ValueTable(results, score)}) {
    if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
  }
  for (PageTable& table : ObjectTables(results)) section.blocks.emplace_back(std::move(table));
  return section;
}

PageSection VolumetricSection(const nlohmann::json& results) {
  PageSection section{"In space", "Each point is a place that was looked at; its colour is the error that is chosen.", {}};
  for (PageColumns& columns : VolumetricColumns(results)) section.blocks.emplace_back(std::move(columns));
  return section;
}

PageSection ImageSection(const std::vector<PageImage>& images) {
  PageSection section{"Light", "Irradiance on the detectors at the end of the run, cut to the lit part.", {}};
  for (const PageImage& image : images) section.blocks.emplace_back(image);
  return section;
}

PageSection BudgetSection(const nlohmann::json& results) {
  PageSection section{"Uncertainty", "", {}};
  if (Figure budget = BudgetFigure(results); !budget.series.empty()) section.blocks.emplace_back(std::move(budget));
  if (PageTable lost = NotSeparableTable(results); !lost.rows.empty()) section.blocks.emplace_back(std::move(lost));
  return section;
}

/// What the scenario asks, or else what the bench measures, and the run.
std::string TitleOf(const PageSource& source) {
  std::string title = source.title;
  if (title.empty() && !source.provenance.bench.empty()) title = FormatOf(source.provenance.bench).title;
  if (title.empty()) return source.name;
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return title + ": " + source.name;
}

/// "rotary_4dof · simulated, seed 1 · 628 readings in 1:10 h · twinbench 0.9".
std::string SubtitleOf(const PageSource& source, const std::vector<Reading>& readings) {
  const Provenance& from = source.provenance;
  std::string text = from.bench;
  text += from.source == "twin" ? fmt::format(" · simulated, seed {}", from.seed) : " · " + from.source;
  if (!from.clock_origin_utc.empty()) text += " · " + from.clock_origin_utc;
  if (!readings.empty()) text += fmt::format(" · {} reading{}", readings.size(), readings.size() == 1 ? "" : "s");
  if (!readings.empty() && HasClock(readings)) {
    const auto minutes = std::lround(ToSeconds(readings.back().time - readings.front().time) / 60.0);
    text += fmt::format(" in {}:{:02} h", minutes / 60, minutes % 60);
  }
  return from.program_version.empty() ? text : text + " · twinbench " + from.program_version;
}

}  // namespace

PageSection ProvenanceSection(const PageSource& source) {
  const Provenance& from = source.provenance;
  PageTable table{"Provenance", {"what", "is"}, {}};
  const auto add = [&table](const std::string& what, const std::string& is) {
    if (!is.empty()) table.rows.push_back({what, is});
  };
  add("bench", from.bench);
  add("readings from", from.source);
  if (from.source == "twin") add("seed", fmt::format("{}", from.seed));
  add("began at (UTC)", from.clock_origin_utc);
  add("recorded by twinbench", from.program_version);
  add("page made by twinbench", source.program_version);
  for (const auto& [file, digest] : source.digests) add("SHA-256 of " + file, digest);
  return {"Provenance", "", {table}};
}

Page RunPage(const PageSource& source, const nlohmann::json& results, const nlohmann::json& score, const std::vector<Reading>& readings,
             const std::vector<PageImage>& images) {
  const std::vector<Figure> curves = CurveFigures(results, score);
  const PageChoice circles = CircleChoice(results);
  const std::vector<Figure> shown = ShownCurves(results, curves);
  const std::vector<Figure>& first = circles.figures.empty() ? shown : circles.figures;
  Page page{TitleOf(source), SubtitleOf(source, readings), "", VerdictTone::kPlain, {}, TilesOf(results, score, first)};
  if (results.contains("diagnosis")) {
    const PageVerdict verdict = VerdictOf(results.at("diagnosis"));
    page.verdict = verdict.text, page.tone = verdict.tone;
    page.sections = DiagnosisSections(results.at("diagnosis"));
  }
  PageSection errors = CurveSection(circles, results, shown), values = ValueSection(results, score);
  if (errors.blocks.empty()) std::swap(errors, values);  // the answer comes first, right behind its causes
  const auto behind_causes = page.sections.begin() + std::min<std::ptrdiff_t>(1, std::ssize(page.sections));
  if (!errors.blocks.empty()) page.sections.insert(behind_causes, std::move(errors));
  for (PageSection& section : std::vector{SpectrumSection(curves, circles.figures, SpectrumFigures(results, score)),
                                          VolumetricSection(results), std::move(values), BudgetSection(results),
                                          ReadingsSection(readings, source.provenance.bench), ImageSection(images)}) {
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  }
  page.sections.push_back(ProvenanceSection(source));
  return page;
}

}  // namespace twinbench::report

#include "twin/report/page/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/page/causes.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/page/residual_figures.h"
#include "twin/report/sound.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

Figure RankFigure(const json& diagnosis, const std::vector<CauseGroup>& groups) {
  const bool by_share = std::ranges::any_of(groups, [](const CauseGroup& group) { return std::isfinite(group.share); });
  Figure figure{FigureForm::kShares, "Causes", by_share ? "ranked by what each explains of the variance beyond noise" : "how probable each is by these readings",
                {"", ""}, {by_share ? "share of the variance" : "probability", ""}, {}};
  FigureSeries bars{figure.y.name, SeriesRole::kEstimate, {}, {}, {}};
  for (const CauseGroup& group : groups) {
    figure.categories.push_back(group.name);
    bars.y.push_back(by_share ? group.share : group.probability);
  }
  const double unknown = by_share ? NumberAt(diagnosis.at("plots"), "share_unnamed") : diagnosis.contains("unknown") ? NumberAt(diagnosis.at("unknown"), "probability") : 0.0;
  if (unknown > 0.0) {
    figure.categories.push_back("unmodelled effect");
    bars.y.push_back(unknown);
  }
  if (!figure.categories.empty()) figure.series.push_back(bars);
  return figure;
}

PageTable CauseTable(const std::vector<CauseGroup>& groups) {
  PageTable table{"Sizes", {"cause", "size", "share of the variance", "probability", "measure next"}, {}};
  for (const CauseGroup& group : groups)
    table.rows.push_back({group.name, group.size, Percent(group.share), Percent(group.probability), group.next});
  return table;
}

PageTable TieTable(const json& diagnosis) {
  PageTable table{"Indistinguishable in this run (aliased)", {"cause", "indistinguishable from", "overlap"}, {}};
  for (const json& cause : ListAt(diagnosis, "causes")) {
    for (const json& rival : ListAt(cause, "indistinguishable_from"))
      table.rows.push_back({NameOfCause(cause), NameOfCause(rival), NumberText(NumberAt(rival, "overlap"))});
  }
  return table;
}

PageTable GainTable(const json& diagnosis) {
  PageTable table{"Held-out improvement: readings that the extension was not fitted to", {"what", "is", "unit"}, {}};
  if (!diagnosis.contains("gain")) return table;
  const json& gain = diagnosis.at("gain");
  for (const auto& [key, spoken] : std::vector<std::pair<std::string, std::string>>{
           {"heldout_rms_before", "rms before"}, {"heldout_rms_after", "rms after"}, {"noise_floor", "noise alone leaves"}}) {
    for (const std::string unit : {"um", "arcsec"}) {
      const double value = NumberAt(gain, key + "_" + unit);
      if (std::isfinite(value)) table.rows.push_back({spoken, fmt::format("{:.3g}", value), InPrint(unit)});
    }
  }
  if (const double removed = NumberAt(gain, "fraction_removed"); std::isfinite(removed)) {
    const auto interval = NumbersAt(gain, "interval95");
    const bool is_known = interval && interval->size() == 2 && std::isfinite((*interval)[0]);
    table.rows.push_back({"share removed of what is no noise", Percent(removed), ""});
    if (is_known) table.rows.push_back({"its 95 % interval", Percent((*interval)[0]) + " to " + Percent((*interval)[1]), ""});
  }
  return table;
}

PageTable ResidualTestTable(const json& diagnosis) {
  PageTable table{"Residual tests", {"test", "p", "what it says"}, {}};
  for (const json& test : ListAt(diagnosis, "screen"))
    table.rows.push_back({TextAt(test, "test"), fmt::format("{:.2g}", NumberAt(test, "p")), InPrint(TextAt(test, "reading"))});
  return table;
}

PageSection CauseSection(const json& diagnosis) {
  PageSection section{"Diagnosis", "", {}};
  const double p = NumberAt(diagnosis, "alarm_p");
  if (std::isfinite(p)) section.lead = fmt::format("Probability of so large a residual if the scenario were right: {}.", p < 1e-9 ? "below 1e-9" : fmt::format("{:.2g}", p));
  const std::vector<CauseGroup> groups = GroupsOf(diagnosis);
  if (Figure causes = RankFigure(diagnosis, groups); !causes.series.empty()) section.blocks.emplace_back(std::move(causes));
  AddFilled(CauseTable(groups), section);
  AddFilled(TieTable(diagnosis), section);
  AddFilled(GainTable(diagnosis), section);
  return section;
}

PageSection ResidualSection(const json& diagnosis) {
  PageSection section{"Residuals", "Readings less what the scenario predicts, against each recorded condition.", {}};
  if (diagnosis.contains("plots")) {
    if (PageChoice choice = ResidualChoice(diagnosis.at("plots")); !choice.figures.empty()) section.blocks.emplace_back(std::move(choice));
  }
  AddFilled(ResidualTestTable(diagnosis), section);
  return section;
}

PageSection SightSection(const json& diagnosis) {
  PageSection section{"Detectability", "", {}};
  AddFilled(DetectableTable(diagnosis), section);
  AddFilled(InvisibleTable(diagnosis), section);
  if (const std::string words = TextAt(diagnosis, "in_words"); !words.empty())
    section.blocks.emplace_back(PageText{"The diagnosis in words", InPrint(words)});
  return section;
}

}  // namespace

PageVerdict VerdictOf(const json& diagnosis) {
  const std::string verdict = TextAt(diagnosis, "verdict");
  const std::string words = TextAt(diagnosis, "in_words");
  const VerdictTone tone = verdict == "none" ? VerdictTone::kGood : verdict == "unknown" ? VerdictTone::kBad : VerdictTone::kDoubt;
  if (!words.empty()) return {InPrint(words.substr(0, words.find('\n'))), tone};
  if (verdict == "none") return {"Consistent with the scenario: nothing found.", tone};
  if (verdict == "unknown") return {"Unmodelled effect: " + TextAt(diagnosis.value("unknown", json()), "signature"), tone};
  std::string names;
  for (const json& cause : ListAt(diagnosis, "causes")) names += (names.empty() ? "" : verdict == "tie" ? " or " : ", ") + NameOfCause(cause);
  return {(verdict == "tie" ? "Ambiguous: " : "Cause identified: ") + names, tone};
}

std::vector<PageSection> DiagnosisSections(const json& diagnosis) {
  std::vector<PageSection> sections;
  for (PageSection& section : std::vector{CauseSection(diagnosis), ResidualSection(diagnosis), SightSection(diagnosis)}) {
    if (!section.blocks.empty() || section.title == "Diagnosis") sections.push_back(std::move(section));
  }
  return sections;
}

}  // namespace twinbench::report

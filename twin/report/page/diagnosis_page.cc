#include "twin/report/page/diagnosis_page.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "twin/report/page/causes.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/sound.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

struct Chosen {
  Figure figure;
  std::vector<std::string> answers;
  double explained = 0.0;  // by the extension
  double loudness = 0.0;   // mean of (residual / u)^2, where there is no extension
};

std::string UnitOf(const json& plots, const std::string& channel) {
  if (plots.contains("units") && plots.at("units").contains(channel)) return InPrint(TextAt(plots.at("units"), channel));
  return InPrint(TextAt(plots, "unit"));
}

double SquaresOf(const std::vector<double>& values, const std::vector<double>& u) {
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double scaled = u.empty() ? values[k] : values[k] / u[k];
    if (std::isfinite(scaled)) sum += scaled * scaled;
  }
  return sum;
}

/// How much of the residual the extension explains, as the logarithm of a likelihood ratio: with the stated uncertainty of each
/// point, or, where there is none, with what is left after it.
double ExplainedIn(const std::vector<double>& before, const std::vector<double>& after, const std::vector<double>& u) {
  if (!u.empty()) return 0.5 * (SquaresOf(before, u) - SquaresOf(after, u));
  const double ratio = SquaresOf(before, {}) / SquaresOf(after, {});
  return ratio > 0.0 && std::isfinite(ratio) ? 0.5 * static_cast<double>(before.size()) * std::log(ratio) : 0.0;
}

/// Against a room that kept its temperature there is nothing to be seen.
bool Changes(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low > 1e-9 * std::max(std::abs(*low), std::abs(*high));
}

/// Bits alike, gaps too.
bool AreAlike(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// One curve where nothing was extended, else both and what is between them.
std::vector<FigureSeries> BeforeAndAfter(const std::vector<double>& x, const std::vector<double>& before, const std::vector<double>& after,
                                         const std::vector<double>& u) {
  if (AreAlike(before, after)) return {{"residual", SeriesRole::kEstimate, x, before, u}};
  std::vector<double> causes;
  for (std::size_t k = 0; k < before.size(); ++k) causes.push_back(before[k] - after[k]);
  return {{"before", SeriesRole::kBefore, x, before, u}, {"after", SeriesRole::kAfter, x, after, u}, {"identified causes", SeriesRole::kExpected, x, causes, {}}};
}

void AddAgainst(const json& plots, std::vector<Chosen>& chosen) {
  const json against = plots.value("against", json::object());
  for (const auto& [circumstance, channels] : against.items()) {
    for (const auto& [channel, curve] : channels.items()) {
      const auto x = NumbersAt(curve, "x"), before = NumbersAt(curve, "before"), after = NumbersAt(curve, "after");
      if (!x || !before || !after || x->size() < 2 || !Changes(*x)) continue;
      const std::vector<double> u = NumbersAt(curve, "u").value_or(std::vector<double>());
      const auto [name, unit] = NameAndUnit(circumstance);
      Figure figure{FigureForm::kLine, "Residual of " + NameAndUnit(channel).name + " against " + name, "means with their uncertainty",
                    {name, unit}, {channel, UnitOf(plots, channel)},
                    BeforeAndAfter(*x, *before, *after, u)};
      chosen.push_back({figure, {name, channel}, ExplainedIn(*before, *after, u),
                        u.empty() ? 0.0 : SquaresOf(*before, u) / static_cast<double>(before->size())});
    }
  }
}

/// A value for each position and set-up.
void AddMaps(const json& plots, std::vector<Chosen>& chosen) {
  const json maps = plots.value("maps", json::object());
  for (const auto& [channel, map] : maps.items()) {
    const auto position = NumbersAt(map, "position"), setup = NumbersAt(map, "setup");
    if (!position || !setup || position->size() < 2) continue;
    for (std::size_t s = 0; s < setup->size(); ++s) {
      const auto before = NumbersOf(map.at("before").at(s)), after = NumbersOf(map.at("after").at(s));
      if (!before || !after || before->size() != position->size()) continue;
      const std::string where = fmt::format("position in mounting {:g}", (*setup)[s]);
      Figure figure{FigureForm::kLine, "Residual of " + NameAndUnit(channel).name + " against " + where, "", {"position", ""},
                    {channel, UnitOf(plots, channel)},
                    BeforeAndAfter(*position, *before, *after, {})};
      chosen.push_back({figure, {where, channel}, ExplainedIn(*before, *after, {}), 0.0});
    }
  }
}

/// Residuals of every channel against every circumstance, before and after the extension.
/// @param plots  `plots` of a diagnosis in results.json: means of bins with their standard uncertainty, and a value for every position
///               of every set-up.
/// @return first the figure of which the extension explains most, or, where nothing was extended, the one that differs most from
///         nothing.
PageChoice ResidualChoice(const json& plots) {
  std::vector<Chosen> chosen;
  AddAgainst(plots, chosen);
  AddMaps(plots, chosen);
  const auto tells_less = [](const Chosen& a, const Chosen& b) {
    return std::pair(a.explained, a.loudness) < std::pair(b.explained, b.loudness);
  };
  const auto loudest = std::max_element(chosen.begin(), chosen.end(), tells_less);
  if (loudest != chosen.end()) std::rotate(chosen.begin(), loudest, loudest + 1);
  const bool is_extended = std::any_of(chosen.begin(), chosen.end(), [](const Chosen& c) { return c.figure.series.size() > 1; });
  PageChoice choice{is_extended ? "Residuals before and after the extension" : "Residuals", "", {"against", "of"}, {}, {}};
  for (Chosen& one : chosen) {
    choice.answers.push_back(one.answers);
    choice.figures.push_back(std::move(one.figure));
  }
  return choice;
}

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

#include "twin/campaign/campaign_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/report/page/named_numbers.h"

namespace twinbench::campaign {
namespace {

using report::Figure;
using report::FigureForm;
using report::FigureSeries;
using report::PageChoice;
using report::PageSection;
using report::PageTable;
using report::SeriesRole;

constexpr int kBins = 30;
constexpr std::size_t kMostPoints = 20000;  // of one scatter plot

/// All numbers of one result, or of a list.
struct Sample {
  std::vector<std::int64_t> trial;
  std::vector<double> value, pull;  // pull: error over u
  bool of_list = false;
};

std::map<std::string, Sample> SamplesOf(const Table& table) {
  std::map<std::string, Sample> samples;
  table.ForEach([&](const TrialRow& row) {
    for (const TrialResult& result : row.results) {
      const std::size_t bracket = result.name.rfind('[');
      const bool in_list = bracket != std::string::npos && result.name.ends_with(']');
      Sample& sample = samples[in_list ? result.name.substr(0, bracket) + "[]" : result.name];
      sample.of_list = in_list;
      if (std::isfinite(result.value)) {
        sample.trial.push_back(row.trial);
        sample.value.push_back(result.value);
      }
      if (const double pull = result.error / result.u; std::isfinite(pull)) sample.pull.push_back(pull);
    }
  });
  return samples;
}

/// Bins of equal width from the least to the largest value.
FigureSeries HistogramOf(const std::vector<double>& values, const std::string& name) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double width = std::max((*high - *low) / kBins, std::abs(*high) * 1e-12 + 1e-300);
  FigureSeries bars{name, SeriesRole::kEstimate, {}, std::vector<double>(kBins, 0.0), {}};
  for (int k = 0; k < kBins; ++k) bars.x.push_back(*low + (k + 0.5) * width);
  for (const double value : values)
    ++bars.y[static_cast<std::size_t>(std::clamp(static_cast<int>((value - *low) / width), 0, kBins - 1))];
  return bars;
}

/// As many as a standard normal variable would have in each bin.
FigureSeries NormalIn(const FigureSeries& bars, std::size_t n) {
  FigureSeries expected{"normal", SeriesRole::kExpected, bars.x, {}, {}};
  const double half = bars.x.size() > 1 ? (bars.x[1] - bars.x[0]) / 2.0 : 0.0;
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  for (const double x : bars.x) expected.y.push_back(static_cast<double>(n) * (below(x + half) - below(x - half)));
  return expected;
}

Figure ValueHistogram(const std::string& name, const Sample& sample) {
  const auto [words, unit] = report::NameAndUnit(name);
  return {FigureForm::kHistogram, "Values of " + report::PathInWords(words), "", {"value", unit}, {"trials", ""}, {HistogramOf(sample.value, "trials")}};
}

Figure PullHistogram(const std::string& name, const Sample& sample) {
  Figure figure{FigureForm::kHistogram, "Error over u of " + report::PathInWords(report::NameAndUnit(name).name), "dashed: as a normal variable would be", {"error / u", ""}, {"numbers", ""}, {HistogramOf(sample.pull, "numbers")}};
  figure.series.push_back(NormalIn(figure.series[0], sample.pull.size()));
  return figure;
}

/// Those whose truth is known first.
PageChoice Histograms(const std::map<std::string, Sample>& samples) {
  PageChoice choice{"Distributions", "", {"of", "show"}, {}, {}};
  for (const auto& [name, sample] : samples) {
    if (sample.pull.size() < 2) continue;
    choice.answers.push_back({name, "error / u"});
    choice.figures.push_back(PullHistogram(name, sample));
  }
  for (const auto& [name, sample] : samples) {
    if (!sample.of_list && sample.value.size() > 1) {
      choice.answers.push_back({name, "value"});
      choice.figures.push_back(ValueHistogram(name, sample));
    }
  }
  return choice;
}

/// Results that are one number each against a key that was varied.
PageChoice Scatters(const std::map<std::string, Sample>& samples, const std::vector<VariedKey>& keys) {
  PageChoice choice{"Results against what was varied", "", {"of", "against"}, {}, {}};
  for (const auto& [name, sample] : samples) {
    if (sample.of_list || sample.value.size() < 2) continue;
    for (const VariedKey& key : keys) {
      const auto [words, unit] = report::NameAndUnit(name);
      const auto [key_words, key_unit] = report::NameAndUnit(key.name);
      FigureSeries points{"trials", SeriesRole::kEstimate, {}, {}, {}};
      for (std::size_t k = 0; k < std::min(sample.value.size(), kMostPoints); ++k) {
        const auto at = key.values.find(sample.trial[k]);
        if (at == key.values.end()) continue;
        points.x.push_back(at->second);
        points.y.push_back(sample.value[k]);
      }
      choice.answers.push_back({name, key.name});
      choice.figures.push_back({FigureForm::kPoints, report::PathInWords(words) + " against " + key_words, "", {key_words, key_unit}, {words, unit}, {points}});
    }
  }
  return choice;
}

PageTable SummaryTable(const Summary& summary) {
  PageTable table{"Results", {"result", "unit", "numbers", "mean", "scatter", "u (rms)", "bias", "within 95 %"}, {}};
  for (const auto& [name, result] : summary.Results()) {
    const auto [words, unit] = report::NameAndUnit(name);
    const auto text = [](double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string(); };
    table.rows.push_back({report::PathInWords(words), unit, fmt::format("{}", result.count), text(result.ShownMean()), text(result.sd), text(result.rms_u),
                          result.scored > 0 ? text(result.bias) : "", result.scored > 0 ? fmt::format("{:.1f} %", 100.0 * result.coverage95) : ""});
  }
  return table;
}

PageTable WorstTable(const Summary& summary) {
  constexpr std::size_t kMost = 10;
  PageTable table{"Furthest from the truth", {"trial", "result", "off by [u]"}, {}};
  for (const WorstTrial& worst : summary.Worst(kMost)) table.rows.push_back({fmt::format("{}", worst.trial), worst.result, fmt::format("{:.2f}", worst.normed)});
  return table;
}

PageTable LostTable(const Summary& summary) {
  PageTable table{"Lost trials", {"trial", "why"}, {}};
  for (const TrialRow& row : summary.Lost()) table.rows.push_back({fmt::format("{}", row.trial), row.failure});
  return table;
}

PageTable VerdictTable(const Summary& summary) {
  PageTable table{"Verdicts", {"verdict", "trials"}, {}};
  for (const auto& [verdict, count] : summary.Verdicts()) table.rows.push_back({verdict, fmt::format("{}", count)});
  return table;
}

}  // namespace

std::vector<PageSection> CampaignSections(const Table& table, const Summary& summary) {
  const std::map<std::string, Sample> samples = SamplesOf(table);
  PageSection results{"Results", fmt::format("{} trials, {} lost. Errors are those against the twin's truth.", summary.Trials(), summary.Lost().size()), {}};
  PageSection plots{"Distributions", "", {}};
  for (PageTable& t : std::vector{SummaryTable(summary), VerdictTable(summary), WorstTable(summary), LostTable(summary)}) {
    if (!t.rows.empty()) results.blocks.emplace_back(std::move(t));
  }
  for (PageChoice& choice : std::vector{Histograms(samples), Scatters(samples, table.Varied())}) {
    if (!choice.figures.empty()) plots.blocks.emplace_back(std::move(choice));
  }
  std::vector<PageSection> sections = {results};
  if (!plots.blocks.empty()) sections.push_back(plots);
  return sections;
}

report::PageTile CoverageTile(const Summary& summary) {
  constexpr double kExpected = 0.95, kByChance = 3.0;
  // Numbers of a list go together; trials do not.
  const double sd = std::sqrt(kExpected * (1.0 - kExpected) / static_cast<double>(summary.Trials()));
  report::PageTile tile{"Coverage of U", "", "", report::VerdictTone::kGood};
  double furthest = -1.0;
  for (const auto& [name, result] : summary.Results()) {
    if (result.scored == 0) continue;
    const double off = std::abs(result.coverage95 - kExpected) / sd;
    if (off <= furthest) continue;
    furthest = off;
    tile.value = fmt::format("{:.1f} %", 100.0 * result.coverage95);
    tile.note = fmt::format("of the errors of {}, the furthest from 95 % in {} trials", report::PathInWords(name), summary.Trials());
    tile.tone = off > kByChance ? report::VerdictTone::kBad : report::VerdictTone::kGood;
  }
  return tile;
}

}  // namespace twinbench::campaign

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/campaign/summary.h"

namespace twinbench::campaign {
namespace {

constexpr std::size_t kShown = 5;

std::string Cell(double value, const char* form) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : "-";
}

std::string ResultLine(const std::string& name, const ResultSummary& r) {
  return fmt::format("{:<44} {:>8} {:>12} {:>10} {:>10} {:>10} {:>11} {:>9}\n", name, r.count, Cell(r.ShownMean(), "{:.5g}"),
                     Cell(r.sd, "{:.3g}"), Cell(r.rms_error, "{:.3g}"), Cell(r.rms_u, "{:.3g}"), Cell(r.bias, "{:.3g}"),
                     Cell(100.0 * r.coverage95, "{:.1f} %"));
}

std::string LostText(const Summary& summary) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, summary.Lost().size()); ++i)
    text += fmt::format("  trial {}: {}\n", summary.Lost()[i].trial, summary.Lost()[i].failure);
  if (summary.Lost().size() > kShown) text += fmt::format("  and {} more\n", summary.Lost().size() - kShown);
  return text;
}

std::string WorstText(const Summary& summary) {
  std::string text;
  for (const WorstTrial& w : summary.Worst(kShown))
    text += fmt::format("  trial {}: {} is off by {:.2f} u\n", w.trial, w.result, w.normed);
  return text.empty() ? "" : "furthest from the truth:\n" + text;
}

}  // namespace

std::string SummaryText(const Summary& summary, const std::string& study_path) {
  std::string text =
      fmt::format("{} trials, {} lost\n", summary.Trials(), summary.Lost().size()) + LostText(summary);
  for (const auto& [verdict, count] : summary.Verdicts()) text += fmt::format("diagnosis {}: {}\n", verdict, count);
  text += fmt::format("{:<44} {:>8} {:>12} {:>10} {:>10} {:>10} {:>11} {:>9}\n", "result ([]: all of a list)", "count",
                      "mean", "sd", "rms error", "rms u", "bias", "in k u");
  for (const auto& [name, result] : summary.Results()) text += ResultLine(name, result);
  const std::string worst = WorstText(summary);
  text += worst;
  if (!worst.empty() || !summary.Lost().empty())
    text += fmt::format(
        "one of them again: twinbench campaign {} --trial N > trialN.toml; twinbench run trialN.toml -o trialN\n",
        study_path);
  return text;
}

}  // namespace twinbench::campaign

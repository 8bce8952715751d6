#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/budget_lists.h"
#include "twin/report/text_table.h"
#include "twin/report/uncertainty_text.h"

namespace twinbench::report {
namespace {

using Json = nlohmann::json;
using uncertainty::OneAtATime;

/// Shares of one figure, first that without which least is left.
std::vector<const uncertainty::Share*> BySize(const OneAtATime& found, std::size_t figure) {
  std::vector<const uncertainty::Share*> shares;
  for (const uncertainty::Share& share : found.shares) shares.push_back(&share);
  std::ranges::stable_sort(shares, std::less<>(), [=](const auto* share) { return share->without[figure]; });
  return shares;
}

}  // namespace

std::string ContributionsText(const OneAtATime& found) {
  std::string text;
  for (std::size_t f = 0; f < found.total.size(); ++f) {
    const double total = found.total[f].value;
    text += fmt::format("{}: {:.3g}\n", found.total[f].name, total);
    std::vector<std::vector<std::string>> rows;
    for (const uncertainty::Share* share : BySize(found, f)) {
      rows.push_back({share->contribution, share->alone.empty() ? "" : fmt::format("{:.3g}", share->alone[f]),
                      fmt::format("{:.3g}", share->without[f]),
                      fmt::format("{:.1f} %", 100.0 * (1.0 - std::pow(share->without[f] / total, 2)))});
    }
    rows.push_back({"electronics and light alone", fmt::format("{:.3g}", found.none[f]), "", ""});
    text += TextTable({{"source"}, {"alone", true}, {"switched off", true}, {"variance contribution", true}},
                      rows, kBudgetWidth);
    text += fmt::format("in quadrature: {:.3g}\n\n", found.InQuadrature(f));
  }
  return text;
}

Json ContributionsJson(const OneAtATime& found) {
  Json figures = Json::array();
  for (std::size_t f = 0; f < found.total.size(); ++f) {
    Json shares = Json::array();
    for (const uncertainty::Share& share : found.shares)
      shares.push_back({{"contribution", share.contribution},
                        {"alone", share.alone.empty() ? Json() : Json(share.alone[f])},
                        {"without", share.without[f]}});
    figures.push_back({{"name", found.total[f].name},
                       {"total", found.total[f].value},
                       {"none", found.none[f]},
                       {"in_quadrature", found.InQuadrature(f)},
                       {"contributions", shares}});
  }
  return {{"figures", figures}};
}

}  // namespace twinbench::report

#include "tools/twinbench/campaign_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"

namespace twinbench::tools {
namespace {

constexpr std::size_t kFewResults = 6;
constexpr auto kBetweenSums = std::chrono::milliseconds(100);
constexpr int kShareOfLooks = 20;  // summing up takes one part in so many of this thread's time at the most

bool IsList(const std::string& name) {
  return name.ends_with("[]");
}

nlohmann::json OrNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Of a list, whose numbers have means of their own, no uncertainty of the mean is told.
nlohmann::json ResultJson(const std::string& name, const campaign::ResultSummary& r) {
  const double u_mean = IsList(name) || r.count < 2 ? NAN : r.sd / std::sqrt(static_cast<double>(r.count));
  return {{"name", name},           {"count", r.count},        {"mean", OrNull(r.mean)}, {"u_mean", OrNull(u_mean)}, {"sd", OrNull(r.sd)},
          {"rms_u", OrNull(r.rms_u)}, {"scored", r.scored}, {"rms_error", OrNull(r.rms_error)}, {"bias", OrNull(r.bias)}, {"coverage95", OrNull(r.coverage95)}};
}

/// Single numbers whose error is known first, then other single ones, then lists.
std::vector<std::string> FirstFew(const std::map<std::string, campaign::ResultSummary>& results) {
  std::vector<std::pair<int, std::string>> ranked;
  for (const auto& [name, r] : results) ranked.emplace_back(2 * (IsList(name) ? 1 : 0) + (r.scored > 0 ? 0 : 1), name);
  std::ranges::sort(ranked);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(kFewResults, ranked.size()); ++k) names.push_back(ranked[k].second);
  return names;
}

}  // namespace

CampaignPage::CampaignPage(LivePage& page, const std::string& where, const campaign::Table& table, std::vector<std::string> chosen)
    : page_(page), chosen_(std::move(chosen)) {
  if (!page_.IsOpen()) return;
  page_.Begin({{"bench", ""}, {"folder", where}, {"columns", nlohmann::json::array()}});
  table.ForEach([this](const campaign::TrialRow& row) {
    summary_.Add(row);
    TellLost(row);
  });
}

void CampaignPage::Hear(const campaign::CampaignProgress& progress) {
  if (!page_.IsOpen()) return;
  summary_.Add(*progress.row);
  TellLost(*progress.row);
  const auto now = WallClock::now();
  if (now < due_ && progress.done < progress.planned) return;
  TellResults(progress);
  due_ = WallClock::now() + std::max<WallClock::duration>(kBetweenSums, kShareOfLooks * (WallClock::now() - now));
}

void CampaignPage::TellLost(const campaign::TrialRow& row) {
  if (!row.failure.empty()) page_.Told("lost_trial", {{"trial", row.trial}, {"failure", row.failure}});
}

void CampaignPage::TellResults(const campaign::CampaignProgress& progress) {
  const std::map<std::string, campaign::ResultSummary> results = summary_.Results();
  if (!is_chosen_ && !results.empty()) ChooseAmong(results);
  const double elapsed_s = std::chrono::duration<double>(WallClock::now() - begun_).count();
  nlohmann::json told = {{"done", progress.done},
                         {"planned", progress.planned},
                         {"lost", progress.lost},
                         {"left_s", elapsed_s * static_cast<double>(progress.planned - progress.done) / static_cast<double>(progress.done)},
                         {"trials", summary_.Trials()},
                         {"results", nlohmann::json::array()}};
  for (const std::string& name : chosen_)
    if (const auto found = results.find(name); found != results.end()) told["results"].push_back(ResultJson(name, found->second));
  page_.Told("trials", told);
}

void CampaignPage::ChooseAmong(const std::map<std::string, campaign::ResultSummary>& results) {
  is_chosen_ = true;
  if (chosen_.empty()) chosen_ = FirstFew(results);
  std::vector<std::string> names;
  for (const auto& [name, r] : results) names.push_back(name);
  for (const std::string& name : chosen_)
    if (!results.contains(name))
      throw InputError("--show " + name, "the trials come to no such result; those that are done are in the table, and --resume goes on",
                       "one that the summary names; the nearest is " + Nearest(name, names));
}

}  // namespace twinbench::tools

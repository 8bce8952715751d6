#include "twin/diagnose/aliased_orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr int kHighestAlias = 1000;  // finer structure of a turn is averaged by what reads it
constexpr std::size_t kMostAliases = 3;
constexpr int kAsLikely = 9;  // times the order: with nothing known of its scale, an alias below has more than a tenth of the probability

/// Whole periods per turn; 0 if it has no such parameter.
int OrderOf(const Cause& cause, const std::string& bench) {
  const EffectEntry* const entry = FindEffect(cause.effect, bench);
  if (entry == nullptr) return 0;
  const auto known = std::ranges::find(entry->parameters, "order", &EffectParameter::name);
  const auto fitted = std::ranges::find(cause.parameters, "order", &ParameterEstimate::name);
  if (known == entry->parameters.end() || fitted == cause.parameters.end()) return 0;
  const bool is_whole = fitted->value == std::round(fitted->value) && fitted->value <= kHighestAlias;
  return is_whole && known->meaning.starts_with("periods per turn") ? static_cast<int>(fitted->value) : 0;
}

std::string Listed(const std::vector<int>& orders) {
  std::string text;
  for (std::size_t k = 0; k < std::min(kMostAliases, orders.size()); ++k) text += fmt::format("{}{}", k == 0 ? "" : ", ", orders[k]);
  return text + (orders.size() > kMostAliases ? ", ..." : "");
}

}  // namespace

Eigen::VectorXd UnevennessOfOrders(int most, const Eigen::VectorXd& angle_rad) {
  Eigen::ArrayXcd step(angle_rad.size()), wave = Eigen::ArrayXcd::Ones(angle_rad.size());
  std::ranges::transform(angle_rad, step.begin(), [](double a) { return std::polar(1.0, a); });
  Eigen::VectorXd uneven(most + 1);
  for (int order = 0; order <= most; ++order, wave *= step) uneven[order] = std::sqrt(std::max(0.0, 1.0 - std::norm(wave.mean())));
  return uneven;
}

std::vector<int> AliasesOf(const Cause& cause, const LinearRun& run) {
  const int order = OrderOf(cause, run.bench);
  const Eigen::VectorXd& angle_rad = run.schedule.reference_rad.allFinite() ? run.schedule.reference_rad : run.schedule.target_rad;
  if (order == 0 || angle_rad.size() == 0 || !angle_rad.allFinite()) return {};
  const double seen = std::isfinite(cause.rho) && cause.rho > 0.0 ? tuning::kBaarda / cause.rho : kUneven;
  const Eigen::VectorXd uneven = UnevennessOfOrders(order + kHighestAlias, angle_rad);
  const auto is_same = [&](int apart) { return uneven[apart] < std::min(seen, kUneven); };
  std::vector<int> aliases;
  for (int other = 1; other <= kHighestAlias; ++other) {
    if (other != order && (is_same(order + other) || is_same(std::abs(order - other)))) aliases.push_back(other);
  }
  return aliases;
}

void TellAliases(const LinearRun& run, Diagnosis& diagnosis) {
  for (Cause& cause : diagnosis.causes) {
    const std::vector<int> aliases = AliasesOf(cause, run);
    if (aliases.empty()) continue;
    for (std::size_t k = 0; k < std::min(kMostAliases, aliases.size()); ++k)
      cause.indistinguishable_from.push_back({cause.effect, fmt::format("order {}", aliases[k]), 1.0});
    const std::string orders = fmt::format("order {} or {}", OrderOf(cause, run.bench), Listed(aliases));
    cause.next_measurement = fmt::format("the same measuring positions from another start angle, a third of a step on, which separates {}", orders);
    if (diagnosis.verdict == Verdict::kNamed && aliases.front() < kAsLikely * OrderOf(cause, run.bench)) diagnosis.verdict = Verdict::kTie;
    diagnosis.gain.another_run = kNaN;
    diagnosis.notes.push_back(fmt::format("{} is of {}: these measuring positions do not distinguish them, and what it improves is stated for them only", cause.effect, orders));
  }
}

}  // namespace twinbench::diagnose

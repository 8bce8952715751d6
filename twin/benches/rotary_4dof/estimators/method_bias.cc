#include "twin/benches/rotary_4dof/estimators/method_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace twinbench::separate {
namespace {

/// Root mean square of what is finite; NaN of nothing.
double FiniteRms(const std::vector<double>& values) {
  double sum = 0.0;
  int count = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v * v;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

bool IsListed(const NotSeparable& entry, const std::vector<NotSeparable>& lost) {
  return std::ranges::any_of(lost, [&](const NotSeparable& other) { return other.what == entry.what; });
}

/// What the method believes to be lost, and what the design loses besides.
std::vector<NotSeparable> AllLosses(const Separation& rigorous, const Separation& published) {
  std::vector<NotSeparable> lost = rigorous.not_separable;
  for (const NotSeparable& entry : published.not_separable) {
    if (!IsListed(entry, lost)) lost.push_back(entry);
  }
  return lost;
}

MethodStatus StatusOf(double rms, double u_noise) {
  constexpr double kTooMuch = 2.0;
  if (!std::isfinite(rms)) return MethodStatus::kNotDetermined;
  return rms > kTooMuch * u_noise ? MethodStatus::kBiased : MethodStatus::kWithinNoise;
}

const char* StatusName(MethodStatus status) {
  switch (status) {
    case MethodStatus::kWithinNoise:
      return "within_noise";
    case MethodStatus::kBiased:
      return "biased";
    case MethodStatus::kNotDetermined:
      return "not_determined";
  }
  return "";
}

/// What noise leaves of the published values. Of readings whose noise is not known the rigorous result estimates
/// it; elimination makes sqrt 2 more of it (docs/theory.md 2).
double PublishedNoise(const std::vector<double>& u_published, const std::vector<double>& u_rigorous) {
  const double stated = FiniteRms(u_published);
  return std::isfinite(stated) ? stated : std::numbers::sqrt2 * FiniteRms(u_rigorous);
}

ComponentBias BiasOf(Table table, Component c, const TableErrors& rigorous, const TableErrors& published,
                     const TableErrors& u_rigorous, const TableErrors& u_published) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < published[c].size(); ++i) difference.push_back(published[c][i] - rigorous[c][i]);
  const double u_noise = std::hypot(FiniteRms(u_rigorous[c]), PublishedNoise(u_published[c], u_rigorous[c]));
  ComponentBias bias{table, c, FiniteRms(difference), u_noise};
  bias.status = StatusOf(bias.rms, bias.u_noise);
  return bias;
}

/// @param block  Of the component in the stacked covariances.
void AddUncertainty(const ComponentBias& bias, std::size_t block, TableEstimate& estimate) {
  std::vector<double>& u = estimate.u[bias.component];
  const auto first = static_cast<Eigen::Index>(block * u.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = std::hypot(std::isfinite(u[i]) ? u[i] : bias.u_noise, bias.rms);
    const auto row = first + static_cast<Eigen::Index>(i);
    estimate.cov_systematic.AddVariance(row, bias.rms * bias.rms);
  }
}

std::string NoteOf(const ComponentBias& bias) {
  const bool angle = IsAngle(bias.component);
  const std::string what = fmt::format("published {} {}", TableName(bias.table),
                                       kComponentNames[static_cast<std::size_t>(bias.component)]);
  if (bias.status == MethodStatus::kNotDetermined)
    return what + ": INVALID, these readings do not determine it although the equations give numbers";
  return fmt::format(
      "{}: BIASED, {:.3g} {} rms from weighted least squares (exact model), where noise makes {:.2g}; included in its uncertainty",
      what, bias.rms / (angle ? units::arcsec : units::um), angle ? "arcsec" : "um",
      bias.u_noise / (angle ? units::arcsec : units::um));
}

void CompareTables(Table table, const TableEstimate& rigorous, const std::vector<NotSeparable>& lost,
                   TableEstimate& published, MethodBias& bias) {
  const TableErrors exact = RemoveNotSeparable(rigorous.value, table, lost);
  const TableErrors printed = RemoveNotSeparable(published.value, table, lost);
  for (std::size_t block = 0; block < published.components.size(); ++block) {
    bias.push_back(BiasOf(table, published.components[block], exact, printed, rigorous.u, published.u));
    AddUncertainty(bias.back(), block, published);
  }
}

}  // namespace

MethodBias ApplyMethodBias(const Separation& rigorous, Separation& published) {
  const std::vector<NotSeparable> lost = AllLosses(rigorous, published);
  MethodBias bias;
  CompareTables(Table::kTarget, rigorous.target, lost, published.target, bias);
  CompareTables(Table::kReference, rigorous.reference, lost, published.reference, bias);
  published.not_separable = lost;
  for (const ComponentBias& component : bias) {
    if (component.status != MethodStatus::kWithinNoise) published.notes.push_back(NoteOf(component));
  }
  return bias;
}

nlohmann::json ToJson(const MethodBias& bias) {
  nlohmann::json json;
  for (const ComponentBias& c : bias) {
    const double unit = IsAngle(c.component) ? units::arcsec : units::um;
    const std::string key = std::string(kComponentNames[static_cast<std::size_t>(c.component)]) +
                            (IsAngle(c.component) ? "_arcsec" : "_um");
    nlohmann::json entry = {{"status", StatusName(c.status)}};
    if (std::isfinite(c.rms)) entry["rms"] = c.rms / unit;
    if (std::isfinite(c.u_noise)) entry["u_noise"] = c.u_noise / unit;
    json[TableName(c.table)][key] = entry;
  }
  return json;
}

}  // namespace twinbench::separate

#include "twin/benches/rotary_4dof/estimators/separate.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "twin/benches/rotary_4dof/estimators/published.h"
#include "twin/benches/rotary_4dof/estimators/residuals.h"
#include "twin/benches/rotary_4dof/estimators/separator.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

/// Mean motion by position (all passes), for each set-up.
std::map<int, std::map<int, std::pair<Vector4, int>>> SumsByPosition(const std::vector<Motion>& motions,
                                                                     const Layout& layout) {
  std::map<int, std::map<int, std::pair<Vector4, int>>> sums;
  for (const Sample& sample : layout.samples) {
    auto& sum = sums[sample.setup].try_emplace(sample.target, Vector4::Zero(), 0).first->second;
    sum.first += motions[sample.motion].Values();
    ++sum.second;
  }
  return sums;
}

void NoteScale(const Vector4& scale, bool covariance_known, Separation& result) {
  if (!covariance_known) {
    result.notes.push_back(result.dof > 0
                               ? "noise of the readings not known: uncertainties are from the residuals"
                               : "noise of the readings not known and no residuals: 0.3 µm per PSD axis assumed");
    return;
  }
  for (int d = 0; d < measure::kDofs; ++d) {
    if (scale[d] == 1.0) continue;
    result.notes.push_back(
        fmt::format("{}: residuals exceed the stated noise (p < 0.001), its uncertainty is scaled by {:.2f}",
                    measure::kDofNames[static_cast<std::size_t>(d)], scale[d]));
  }
}

void NoteMissing(const TableEstimate& estimate, const char* name, Separation& result) {
  for (const Component c : estimate.components) {
    std::string lost;
    for (std::size_t i = 0; i < estimate.value.position_rad.size(); ++i) {
      if (std::isnan(estimate.value[c][i]))
        lost += fmt::format(" {:.4g}", estimate.value.position_rad[i] / units::deg);
    }
    if (lost.empty()) continue;
    result.notes.push_back(fmt::format("{} {}: not determined by the readings left, at{} deg", name,
                                       kComponentNames[static_cast<std::size_t>(c)], lost));
  }
}

std::vector<Closure> FindClosure(const std::vector<Motion>& motions, const Layout& layout) {
  const auto sums = SumsByPosition(motions, layout);
  std::vector<Closure> closure;
  for (std::size_t s = 1; s < layout.design.setups.size(); ++s) {
    Vector4 sum = Vector4::Zero();
    int common = 0;
    for (const auto& [target, value] : sums.at(static_cast<int>(s))) {
      const auto first = sums.at(0).find(target);
      if (first == sums.at(0).end()) continue;
      sum += value.first / value.second - first->second.first / first->second.second;
      ++common;
    }
    closure.push_back({layout.design.setups[s].label, sum / common});
  }
  return closure;
}

Separation SeparateRigorous(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                            const SeparateOptions& options) {
  Separator separator(motions, geometry, options);
  Separation first = separator.Separate(motions);
  const bool known = separator.covariance_known();
  const Vector4 scale = known ? StatedNoiseScale(first) : AssumedNoiseScale(first, geometry);
  NoteScale(scale, known, first);
  if (scale == Vector4::Ones()) return first;
  separator.Rescale(motions, scale);
  Separation result = separator.Separate(motions);
  result.notes = first.notes;
  if (known) result.chi2 = first.chi2;  // the test was against the stated noise
  return result;
}

void AddAsynchronous(const std::array<double, kComponents>& rms, TableEstimate& estimate) {
  const std::size_t n = estimate.value.position_rad.size();
  estimate.asynchronous = rms;
  for (std::size_t s = 0; s < estimate.components.size(); ++s) {
    const Component component = estimate.components[s];
    if (rms[static_cast<std::size_t>(component)] == 0.0) continue;
    for (std::size_t i = 0; i < n; ++i) {
      const double variance = std::pow(rms[static_cast<std::size_t>(component)], 2);
      estimate.cov_systematic.AddVariance(static_cast<Eigen::Index>(s * n + i), variance);
      estimate.u[component][i] = std::sqrt(std::pow(estimate.u[component][i], 2) + variance);
    }
  }
}

/// What repeats in about two turns looks like an error of either table at the positions of a few mountings; the reference's tilt
/// moves the grating by another lever than the target's would, for which it is taken.
std::array<double, kComponents> AsynchronousOf(const RotarySettings& bench, std::size_t table) {
  const auto of_both = [&](double TableSettings::*half) { return std::hypot(bench.target.*half, bench.reference.*half) / std::sqrt(2.0); };
  const double lever_m = table == 0 ? bench.reference_height_m / std::sqrt(2.0) : 0.0;
  const double tilt_rad = std::hypot(bench.mechanics.asynchronous_tilt_rad[table], of_both(&TableSettings::half_frequency_tilt_rad));
  const double radial_m = std::hypot(bench.mechanics.asynchronous_radial_m[table], of_both(&TableSettings::half_frequency_radial_m),
                                     bench.reference.half_frequency_tilt_rad * lever_m);
  return {tilt_rad, tilt_rad, 0.0, radial_m, radial_m, 0.0};  // in the order of Component
}

}  // namespace

SeparateOptions OptionsFrom(const Scenario& scenario) {
  const std::string& clamping = RotaryOf(scenario).procedure.clamping;
  if (clamping != "reclamp" && clamping != "reseat") {
    throw InputError("procedure.clamping", "\"" + clamping + "\"", "\"reclamp\" or \"reseat\"");
  }
  SeparateOptions options;
  for (std::size_t table = 0; table < 2; ++table)
    options.asynchronous[table] = AsynchronousOf(RotaryOf(scenario), table);
  options.layout.positions = RotaryOf(scenario).procedure.positions;
  options.layout.clamping = clamping == "reclamp" ? Clamping::kReclamp : Clamping::kReseat;
  return options;
}

Separation Separate(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                    const SeparateOptions& options) {
  const bool published = options.estimator == Estimator::kPublished;
  Separation result = published ? SeparatePublished(motions, geometry, options.layout)
                                : SeparateRigorous(motions, geometry, options);
  result.estimator = options.estimator;
  result.closure = FindClosure(motions, FindLayout(motions, geometry, options.layout));
  AddAsynchronous(options.asynchronous[0], result.target);
  AddAsynchronous(options.asynchronous[1], result.reference);
  NoteMissing(result.target, "target", result);
  NoteMissing(result.reference, "reference", result);
  return result;
}

}  // namespace twinbench::separate

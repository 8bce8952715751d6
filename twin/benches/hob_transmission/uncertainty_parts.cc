#include "twin/benches/hob_transmission/uncertainty_parts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/uncertainty_parts.h"
#include "twin/separate/order_model.h"

namespace twinbench::benches::hob {
namespace {

using separate::hob::HarmonicSeries;
using separate::hob::PositionError;
using separate::hob::PositionStatus;

double Variance_rad2(const HarmonicSeries& series, int order) {
  return 0.5 * series.At(order).cov.trace();
}

double Step_rad(const RingEncoderSettings& ring) {
  return units::turn / ring.lines / ring.interpolation;
}

/// Variances of one order of a position.
struct OfOrder {
  double noise = 0.0, steps = 0.0, repeatability = 0.0, drift = 0.0;
};

OfOrder Of(const PositionError& position, int order, double of_steps_rad2) {
  const auto k = static_cast<std::size_t>(order - 1);
  OfOrder parts;
  parts.drift = k < position.of_drift_rad2.size() ? position.of_drift_rad2[k] : 0.0;
  const double repeated = k < position.of_rounding_rad2.size() ? position.of_rounding_rad2[k] : 0.0;
  const double scatter = Variance_rad2(position.series, order) - parts.drift - repeated - position.of_folding_rad2;
  // White samples: 2 / N of their variance in either part of C.
  const double per_sample = 2.0 / position.samples;
  const bool within = position.scatter == separate::harmonics::ScatterSource::kWithinTurn;
  const double white = within ? scatter : std::min(scatter, per_sample * std::pow(position.residual_rms_rad, 2));
  parts.steps = std::min(white, per_sample * of_steps_rad2);
  parts.noise = white - parts.steps;
  parts.steps += repeated;
  parts.repeatability = scatter - white + position.of_folding_rad2;
  return parts;
}

}  // namespace

double StepVariance_rad2(const HobSettings& settings, bool is_at_rest) {
  const double hob_rad = settings.transmission.Ratio() * Step_rad(settings.hob_encoder),
               table_rad = is_at_rest ? Step_rad(settings.table_encoder) : 0.0;
  return (hob_rad * hob_rad + table_rad * table_rad) / 12.0;
}

nlohmann::json PartsOf(const std::vector<const PositionError*>& positions, double of_steps_rad2,
                       bool with_second_order) {
  std::vector<double> total;
  report::VariancePart noise{"noise", {}}, steps{"quantisation", {}}, repeatability{"repeatability", {}},
      drift{"drift", {}}, second{"second order", {}};
  int highest = 1 << 20;
  for (const PositionError* p : positions) highest = std::min(highest, p->series.Highest());
  for (int order = 1; order <= (positions.empty() ? 0 : highest); ++order) {
    OfOrder sum;
    double floors = 0.0, all = 0.0;
    for (const PositionError* p : positions) {
      const OfOrder one = Of(*p, order, of_steps_rad2);
      const double floor = with_second_order ? std::pow(separate::harmonics::SecondOrder(*p), 2) : 0.0;
      sum = {sum.noise + one.noise, sum.steps + one.steps, sum.repeatability + one.repeatability,
             sum.drift + one.drift};
      floors += floor;
      all += Variance_rad2(p->series, order) + floor;
    }
    total.push_back(all);
    noise.variance.push_back(sum.noise);
    steps.variance.push_back(sum.steps);
    repeatability.variance.push_back(sum.repeatability);
    drift.variance.push_back(sum.drift);
    second.variance.push_back(floors);
  }
  return report::PartsJson(total, {noise, steps, repeatability, drift, second});
}

nlohmann::json PartsOfOrder(const nlohmann::json& parts, int order) {
  const auto k = static_cast<std::size_t>(order - 1);
  nlohmann::json of_order = nlohmann::json::object();
  for (const auto& [name, shares] : parts.items()) {
    if (k < shares.size() && shares[k].is_number()) of_order[name] = shares[k];
  }
  return of_order;
}

nlohmann::json PartsOf(const separate::hob::OrderComparison& comparison, const ComparedParts& parts) {
  const double estimated = comparison.estimated.cov.trace(), reference = comparison.reference.cov.trace(),
               all = estimated + reference;
  nlohmann::json shares = nlohmann::json::object();
  const auto add = [&](const nlohmann::json& of_series, double weight) {
    const nlohmann::json of_order = PartsOfOrder(of_series, comparison.order);
    for (const auto& [name, share] : of_order.items())
      shares[name] = shares.value(name, 0.0) + weight * share.get<double>();
  };
  add(parts.estimated, estimated / all);
  add(parts.reference, reference / all);
  return shares;
}

nlohmann::json WithStandard(nlohmann::json parts, const HarmonicSeries& series, double u_standard_rad,
                            const std::vector<double>& rounding_rad2) {
  nlohmann::json standard = nlohmann::json::array();
  for (int order = 1; order <= series.Highest(); ++order) {
    const auto k = static_cast<std::size_t>(order - 1);
    const double all_rad2 = Variance_rad2(series, order), share = std::pow(u_standard_rad, 2) / all_rad2,
                 of_steps = k < rounding_rad2.size() ? rounding_rad2[k] / all_rad2 : 0.0;
    for (auto& part : parts) {
      if (k < part.size() && part[k].is_number()) part[k] = (1.0 - share - of_steps) * part[k].get<double>();
    }
    if (of_steps > 0.0) parts["quantisation"][k] = of_steps + (parts["quantisation"][k].is_number() ? parts["quantisation"][k].get<double>() : 0.0);
    standard.push_back(share);
  }
  if (u_standard_rad > 0.0) parts["standard"] = standard;
  return parts;
}

}  // namespace twinbench::benches::hob

#include "twin/benches/hob_transmission/diagnosis/hob_noise.h"

#include <cmath>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/noise_estimate.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr double kLeast_rad = 1e-5 * units::arcsec;
constexpr double kNoWeight = 1e5;  // times the noise

/// Of one sample of m, as stated; 0 if no encoder states its noise.
double Stated_rad(const Scenario& scenario) {
  const double ratio = HobOf(scenario).transmission.Ratio();
  const double noise_rad =
      std::hypot(HobOf(scenario).table_encoder.noise_rad, ratio * HobOf(scenario).hob_encoder.noise_rad);
  if (noise_rad == 0.0) return 0.0;
  const RingEncoderSettings& hob = HobOf(scenario).hob_encoder;
  const double step_rad = 2.0 * units::kPi / (static_cast<double>(hob.lines) * hob.interpolation);
  return std::hypot(noise_rad, ratio * step_rad / std::sqrt(12.0));
}

/// Every turn of a pass as a pass of its own over the same places: what repeats with the table is then no noise.
Schedule ByTurns(const SignalContext& c) {
  constexpr int kMostTurns = 10000;
  const double turn_rad = 2.0 * units::kPi;
  Schedule s = c.schedule;
  for (Eigen::Index i = 0; i < c.Samples(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double turn = std::floor(c.table_rad[i] / turn_rad + 1e-9);
    s.pass[at] = s.pass[at] * kMostTurns + static_cast<int>(turn);
    s.reference_rad[i] = c.table_rad[i] - turn * turn_rad;
  }
  return s;
}

double Estimated_rad(const SignalContext& c, const Eigen::VectorXd& left_rad) {
  const Eigen::VectorXd values = left_rad.array().isFinite().select(left_rad, 0.0);
  return EstimateNoise_rad(ByTurns(c), values);
}

}  // namespace

void SetResidual(const SignalContext& c, const Eigen::MatrixXd& left_rad, const Scenario& scenario,
                 LinearRun& run) {
  const Eigen::Index channels = left_rad.cols(), groups = c.groups.Groups();
  run.residual.resize(groups * channels);
  run.sigma.resize(groups * channels);
  const double stated_rad = Stated_rad(scenario);
  run.sigma_stated = stated_rad > 0.0;
  for (Eigen::Index k = 0; k < channels; ++k) {
    const double told_rad = k == 0 ? stated_rad : HobOf(scenario).interferometer.noise_rad;
    const double sigma_rad = std::max(told_rad > 0.0 ? told_rad : Estimated_rad(c, left_rad.col(k)), kLeast_rad);
    const Eigen::VectorXd mean_rad = c.groups.Mean(left_rad.col(k));
    for (Eigen::Index g = 0; g < groups; ++g) {
      const bool there = std::isfinite(mean_rad[g]);
      run.residual[g * channels + k] = there ? mean_rad[g] : 0.0;
      run.sigma[g * channels + k] = sigma_rad / std::sqrt(c.groups.Size(g)) * (there ? 1.0 : kNoWeight);
    }
  }
}

}  // namespace twinbench::diagnose::hob

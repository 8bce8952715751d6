#include "twin/benches/hob_transmission/estimators/index_errors.h"

#include <cmath>

#include "twin/benches/hob_transmission/estimators/hob_bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/errors.h"

namespace twinbench::separate::hob {
namespace {

/// Orders of the ring that stand out of the noise: all others would only add theirs to every place.
std::vector<int> RingLines(const HarmonicSeries& encoder, int places) {
  HarmonicSeries seen = encoder;
  for (Coefficient& order : seen.orders) {
    if (!std::isfinite(order.value.real())) order = {0.0, Eigen::Matrix2d::Identity()};
  }
  return FindLines(seen, 1.0 / places);
}

double ValueOfLines(const HarmonicSeries& series, const std::vector<int>& orders, double angle_rad) {
  double sum_rad = 0.0;
  for (const int k : orders) sum_rad += (series.At(k).value * std::polar(1.0, k * angle_rad)).real();
  return sum_rad;
}

/// Samples fall due once a step of the procedure, at edges that lie half a line apart in both directions: one
/// place. Samples that were taken otherwise are sorted by lines of the ring.
class PlaceGrid {
 public:
  PlaceGrid(const std::vector<HobSample>& samples, bool from_origin, const HobSettings& bench) {
    constexpr double kOnGrid = 0.9;  // of 1, the length of the mean pointer
    const int steps = bench.hob_procedure.samples_per_turn;
    Complex sum = 0.0;
    for (const HobSample& s : samples) sum += std::polar(1.0, steps * RingAngle_rad(s, from_origin));
    const bool on_grid = std::abs(sum) > kOnGrid * static_cast<double>(samples.size());
    step_rad_ = units::turn / (on_grid ? steps : bench.table_encoder.lines);
    phase_rad_ = on_grid ? std::arg(sum) / steps : 0.0;
  }
  double Nearest_rad(double ring_rad) const {
    return phase_rad_ + step_rad_ * std::round((ring_rad - phase_rad_) / step_rad_);
  }

 private:
  double step_rad_ = kNaN, phase_rad_ = 0.0;
};

}  // namespace

IndexErrors HobIndexErrors(const Scenario& scenario, const std::vector<Reading>& readings) {
  const HobSettings& own = HobOf(scenario);
  const HobAnalysis analysis = AnalyseHob(readings, scenario, Estimator::kRigorous);
  if (!analysis.separation) throw InputError("readings", analysis.not_separated, "samples of a whole turn");
  const std::vector<int> ring_lines = RingLines(analysis.encoder, own.hob_procedure.samples_per_turn);
  const bool from_origin = own.hob_procedure.encoder_zero == "table_origin";
  std::vector<HobSample> samples = SamplesOf(readings);
  std::erase_if(samples, [](const HobSample& s) { return s.is_at_rest || !std::isfinite(s.table_encoder_rad); });
  const PlaceGrid grid(samples, from_origin, own);
  std::vector<IndexReading> values;
  for (const HobSample& s : samples) {
    const double ring_rad = RingAngle_rad(s, from_origin);
    const double error_rad = s.table_encoder_rad - own.transmission.Ratio() * s.hob_encoder_rad -
                             ValueOfLines(analysis.encoder, ring_lines, ring_rad);
    const int constant = 2 * s.setup + (s.direction > 0 ? 0 : 1);
    values.push_back({constant, grid.Nearest_rad(ring_rad) + s.head_rad, error_rad});
  }
  IndexErrors errors = MeansByPlace(values);
  errors.table = "transmission";
  errors.commanded = own.transmission.compensation;
  return errors;
}

}  // namespace twinbench::separate::hob

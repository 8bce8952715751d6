#include "twin/benches/turntable_autocollimator/diagnosis/families.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/turntable_autocollimator/diagnosis/family_parts.h"
#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose::turntable {
namespace {

/// A size that is plausible is no reason to look past a larger one that alone would be seen: up to ten times the
/// catalogue's default, until it leaves a trace.
void WidenPriors(const LinearRun& run, std::vector<Family>& families) {
  constexpr double kTrace = 20.0, kMost = 10.0;  // in units of noise; of the default
  const NoiseModel noise{run.sigma, {}};
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  for (Family& family : families) {
    const Eigen::MatrixXd S = noise.Whiten(run, family.ColumnsAt(family.grid / 2));
    const Eigen::VectorXd information = S.cwiseProduct(projector.Apply(S)).colwise().sum();
    for (std::size_t j = 0; j < family.amplitudes.size(); ++j) {
      double& sd = family.amplitudes[j].prior_sd;
      sd = std::clamp(kTrace / std::sqrt(std::max(1e-300, information[static_cast<Eigen::Index>(j)])), sd,
                      kMost * sd);
    }
  }
}

}  // namespace

std::vector<Family> Families(const TurntableRun& turntable, const std::vector<std::string>& excluded) {
  const auto context = std::make_shared<const SignalContext>(turntable.context);
  const Schedule& schedule = turntable.run.schedule;
  const TimeSeries series = TimeSeriesOf(schedule, std::vector<int>(schedule.reading.size(), 0), kAxes);
  std::vector<Family> families = NamedFamilies(context, UsualSigma_rad(turntable.run), series);
  WidenPriors(turntable.run, families);
  std::erase_if(families, [&](const Family& f) { return std::ranges::find(excluded, f.effect) != excluded.end(); });
  std::ranges::move(UnknownFamilies(turntable, series), std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::turntable

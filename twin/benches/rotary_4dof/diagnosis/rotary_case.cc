#include "twin/benches/rotary_4dof/diagnosis/rotary_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/units.h"

namespace twinbench::diagnose::rotary {
namespace {

struct ComponentName {
  separate::Series series;
  const char* name;
};

constexpr ComponentName kComponentNames[] = {
    {separate::Series::kTargetEx, "target ex"}, {separate::Series::kTargetEy, "target ey"},
    {separate::Series::kTargetEz, "target ez"}, {separate::Series::kTargetDy, "target dy"},
    {separate::Series::kRefEx, "reference ex"}, {separate::Series::kRefEy, "reference ey"},
    {separate::Series::kRefEz, "reference ez"}};

/// Scatter about the mean: a constant is a mounting, no error of a table.
double ScatterOf(const separate::Design& design, separate::Series series, const Eigen::VectorXd& x) {
  double sum = 0.0, sum2 = 0.0;
  for (int i = 0; i < design.n; ++i) {
    const double v = x[design.Column(series, i)];
    sum += v;
    sum2 += v * v;
  }
  return std::sqrt(std::max(0.0, sum2 / design.n - std::pow(sum / design.n, 2)));
}

Scenario With(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.effects.insert(scenario.effects.end(), effects.begin(), effects.end());
  return scenario;
}

}  // namespace

RotaryCase::RotaryCase(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model,
                       const std::vector<std::string>& excluded, const std::vector<EffectSettings>& about)
    : rotary_(BuildRun(readings, With(scenario, about), model)) {
  const Schedule& s = rotary_.run.schedule;
  const TimeSeries series = TimeSeriesOf(s, std::vector<int>(s.reading.size(), 0), kChannels);
  families_ = NamedFamilies(rotary_, scenario, series);
  if (model.published) {
    std::vector<Family> of_model = ModelFamilies(rotary_);
    std::ranges::move(of_model, std::back_inserter(families_));
  }
  std::erase_if(families_,
                [&excluded](const Family& f) { return std::ranges::find(excluded, f.effect) != excluded.end(); });
  std::vector<Family> unknown = UnknownFamilies(rotary_, scenario.environment.reference_degC, series);
  std::ranges::move(unknown, std::back_inserter(families_));
  for (const EffectSettings& effect : about) TakeOut(effect);
}

void RotaryCase::TakeOut(const EffectSettings& effect) {
  for (const Family& family : families_) {
    if (family.kind != Kind::kNamed || family.effect != effect.name || family.where != effect.where) continue;
    rotary_.run.residual += family.ColumnsAt(0).col(0) * effect.parameters.at(family.amplitudes.front().name);
    return;
  }
}

std::string BiasInWords(const separate::Design& design, const Eigen::VectorXd& unknowns) {
  std::string worst = "nothing";
  double most = 0.0;
  for (const auto& [series, name] : kComponentNames) {
    const bool length = series == separate::Series::kTargetDy;
    const double rms = ScatterOf(design, series, unknowns);
    const double in_unit = length ? rms * separate::kLengthUnit_m / units::um : rms / units::arcsec;
    if (in_unit <= most) continue;
    most = in_unit;
    worst = fmt::format("{} up to {:.2g} {} rms", name, in_unit, length ? "um" : "arcsec");
  }
  return worst;
}

}  // namespace twinbench::diagnose::rotary

#include "twin/benches/rotary_4dof/diagnosis/rotary_twin.h"

#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"

namespace twinbench::diagnose::rotary {
namespace {

std::vector<model::Disturbance> AtMount(const std::vector<Vector4>& free) {
  Eigen::MatrixXd values(std::ssize(free), 4);
  for (std::size_t i = 0; i < free.size(); ++i) values.row(static_cast<Eigen::Index>(i)) = free[i];
  return {{"mount.ez", values.col(0)},
          {"mount.ex", values.col(1)},
          {"mount.ey", values.col(2)},
          {"mount.dy", values.col(3)}};
}

Scenario With(Scenario scenario, const BenchConstant& constant, double value) {
  EffectSettings effect;
  effect.name = constant.effect;
  effect.where = constant.where;
  effect.parameters[constant.parameter] = value;
  scenario.effects.push_back(effect);
  return scenario;
}

bool MayBeNegative(const BenchConstant& constant, const std::string& bench) {
  for (const EffectParameter& p : FindEffect(constant.effect, bench)->parameters) {
    if (p.name == constant.parameter) return p.lower_SI < 0.0;
  }
  return true;
}

}  // namespace

RotaryTwin::RotaryTwin(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& used,
                       const measure::BenchGeometry& geometry)
    : maker_(maker), scenario_(scenario), used_(used), geometry_(geometry), follow_(maker(scenario, used)) {}

Eigen::VectorXd RotaryTwin::Rows_m(const Eigen::MatrixXd& shown_V) const {
  Eigen::VectorXd rows_m(kChannels * shown_V.rows());
  for (Eigen::Index i = 0; i < shown_V.rows(); ++i) {
    const std::array<double, kChannels> reading_V = {shown_V(i, 0), shown_V(i, 1), shown_V(i, 2), shown_V(i, 3)};
    rows_m.segment<4>(kChannels * i) = measure::OnSurface(reading_V, geometry_);
  }
  return rows_m;
}

Eigen::VectorXd RotaryTwin::Shown_m(const std::vector<Vector4>& free) const {
  const Eigen::MatrixXd shown_V = follow_->Predict(AtMount(free));
  for (Eigen::Index i = 0; i < shown_V.rows(); ++i) {
    if (!shown_V.row(i).allFinite())
      throw InputError("reading " + std::to_string(used_[static_cast<std::size_t>(i)].reading),
                       "it has a value where the scenario's bench would show none",
                       "a scenario of the bench that the readings come from");
  }
  return Rows_m(shown_V);
}

Eigen::VectorXd RotaryTwin::Slope_m(const std::string& point, const std::vector<Vector4>& free) const {
  return Rows_m(model::Slope(*follow_, model::PointNamed(*follow_, point), AtMount(free)));
}

Eigen::VectorXd RotaryTwin::Slope_m(const BenchConstant& constant, double step,
                                    const std::vector<Vector4>& free) const {
  const std::vector<model::Disturbance> at = AtMount(free);
  const double below = MayBeNegative(constant, scenario_.bench) ? -step : 0.0;
  const auto shown_V = [&](double value) { return maker_(With(scenario_, constant, value), used_)->Predict(at); };
  return Rows_m(shown_V(step) - shown_V(below)) / (step - below);
}

}  // namespace twinbench::diagnose::rotary

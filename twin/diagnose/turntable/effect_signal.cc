#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/turntable/signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::turntable {
namespace {

double Value(const EffectSettings& effect, const char* parameter) {
  const auto found = effect.parameters.find(parameter);
  Require(found != effect.parameters.end(), "an effect lacks a parameter of the catalogue");
  return found->second;
}

Eigen::VectorXd Harmonic_rad(const EffectSettings& effect, const Eigen::VectorXd& turns) {
  return Value(effect, "amplitude") * (2.0 * units::kPi * turns.array() + Value(effect, "phase")).cos();
}

int AxisOf(const EffectSettings& effect) {
  return effect.where == kAxisNames[kY] ? kY : kX;
}

/// What moves the zero of an axis, whatever it reads.
Eigen::VectorXd ZeroSignal_rad(const EffectSettings& e, const SignalContext& c) {
  if (e.name == "autocollimator_drift")
    return Value(e, "rate") * model::Drift_s(c.schedule.time_s) * Eigen::Vector2d(1.0, Value(e, "curvature"));
  if (e.name == "autocollimator_temperature" && c.HasTemperature()) return Value(e, "coefficient") * c.above_K;
  if (e.name == "mount_creep") return Value(e, "amplitude") * CreepSignal(c, Value(e, "time_constant"));
  if (e.name == "slip") return Value(e, "step") * model::Step(c.schedule.reading, std::floor(Value(e, "at_reading")));
  if (e.name == "tone") return Harmonic_rad(e, Value(e, "frequency") * c.schedule.time_s);
  return Eigen::VectorXd::Zero(c.Readings());
}

/// What depends on the reading: without its linear part, which the instrument has.
Eigen::MatrixXd ReadingSignals_rad(const EffectSettings& e, const Eigen::MatrixXd& shown_rad,
                                   const SignalContext& c) {
  if (e.name == "autocollimator_nonlinearity")
    return Value(e, "at_edge") * CubicSignals(shown_rad, c.range_rad, true);
  Eigen::MatrixXd signals = Eigen::MatrixXd::Zero(shown_rad.rows(), kAxes);
  if (e.name == "autocollimator_periodic")
    signals.col(AxisOf(e)) = Harmonic_rad(e, shown_rad.col(AxisOf(e)) / Value(e, "period"));
  return signals;
}

/// How far the turntable stands from where it was sent, and the beam's slope on the mirror.
Eigen::VectorXd BodySignal_rad(const Scenario& scenario, const SignalContext& c) {
  Eigen::VectorXd body_rad = scenario.target.backlash_rad * BacklashSignal(c);
  for (const EffectSettings& e : scenario.effects) {
    if (e.name == "backlash") body_rad += Value(e, "width") * BacklashSignal(c);
    if (e.name == "settling") body_rad += Value(e, "amplitude") * SettlingSignal(c, Value(e, "time_constant"));
  }
  return body_rad + BelievedInstrument(scenario).sag_m * FlatnessSignal_per_m(c);
}

Eigen::MatrixXd ZeroSignals_rad(const Scenario& scenario, const SignalContext& c) {
  Eigen::MatrixXd zero_rad = Eigen::MatrixXd::Zero(c.Readings(), kAxes);
  if (c.HasTemperature()) {
    zero_rad.col(kX) = scenario.collimator.x_per_kelvin_rad * c.above_K;
    zero_rad.col(kY) = scenario.collimator.y_per_kelvin_rad * c.above_K;
  }
  for (const EffectSettings& e : scenario.effects) zero_rad.col(AxisOf(e)) += ZeroSignal_rad(e, c);
  for (const EmpiricalSettings& signal : scenario.empiricals) {
    std::map<int, double> by_reading;
    for (std::size_t k = 0; k < signal.reading.size(); ++k) by_reading[signal.reading[k]] = signal.value_rad[k];
    const int axis = signal.channel == kAxisNames[kY] ? kY : kX;
    for (Eigen::Index i = 0; i < zero_rad.rows(); ++i) {
      const auto found = by_reading.find(c.schedule.reading[static_cast<std::size_t>(i)]);
      if (found != by_reading.end()) zero_rad(i, axis) += found->second;
    }
  }
  return zero_rad;
}

Eigen::MatrixXd SignalsOfReading_rad(const Eigen::MatrixXd& shown_rad, const Scenario& scenario,
                                     const SignalContext& c) {
  Eigen::MatrixXd sum_rad = scenario.collimator.error_at_edge_rad * CubicSignals(shown_rad, c.range_rad, true);
  for (const EffectSettings& e : scenario.effects) sum_rad += ReadingSignals_rad(e, shown_rad, c);
  return sum_rad;
}

}  // namespace

Instrument BelievedInstrument(const Scenario& scenario) {
  Instrument instrument{scenario.collimator.roll_rad, scenario.autocollimator.gain_error,
                        scenario.mirror.flatness_m};
  for (const EffectSettings& e : scenario.effects) {
    if (e.name == "autocollimator_roll") instrument.roll_rad += Value(e, "angle");
    if (e.name == "autocollimator_scale") instrument.gain_error += Value(e, "gain_error");
    if (e.name == "mirror_flatness") instrument.sag_m += Value(e, "sag");
  }
  return instrument;
}

Eigen::Vector2d ZeroPerKelvin_rad(const Scenario& scenario) {
  Eigen::Vector2d per_K(scenario.collimator.x_per_kelvin_rad, scenario.collimator.y_per_kelvin_rad);
  for (const EffectSettings& e : scenario.effects) {
    if (e.name == "autocollimator_temperature") per_K[AxisOf(e)] += Value(e, "coefficient");
  }
  return per_K;
}

bool IsAddedBehind(const EffectSettings& effect) {
  constexpr std::array kBehind = {"autocollimator_drift", "mount_creep", "slip", "tone", "autocollimator_periodic"};
  return std::ranges::count(kBehind, effect.name) > 0;
}

bool DependsOnReading(const Scenario& scenario) {
  return scenario.collimator.error_at_edge_rad != 0.0 ||
         std::ranges::any_of(scenario.effects, [](const EffectSettings& e) {
           return e.name == "autocollimator_nonlinearity" || e.name == "autocollimator_periodic";
         });
}

Eigen::MatrixXd SlopesOfReading(const Eigen::MatrixXd& shown_rad, const Scenario& scenario,
                                const SignalContext& context) {
  constexpr double kStep_rad = 1e-3 * units::arcsec;
  const auto at = [&](double step_rad) {
    return SignalsOfReading_rad(shown_rad.array() + step_rad, scenario, context);
  };
  return (at(kStep_rad) - at(-kStep_rad)) / (2.0 * kStep_rad);
}

KnownSignals KnownSignalsOf(const Eigen::MatrixXd& shown_rad, const Eigen::VectorXd& sweep_rad,
                            const Scenario& scenario, const SignalContext& context) {
  const Instrument instrument = BelievedInstrument(scenario);
  const Eigen::VectorXd body_rad = (1.0 + instrument.gain_error) * (sweep_rad + BodySignal_rad(scenario, context));
  KnownSignals known{Eigen::MatrixXd(shown_rad.rows(), kAxes), ZeroSignals_rad(scenario, context)};
  known.of_optics_rad << std::cos(instrument.roll_rad) * body_rad, -std::sin(instrument.roll_rad) * body_rad;
  known.behind_rad += SignalsOfReading_rad(shown_rad, scenario, context);
  return known;
}

}  // namespace twinbench::diagnose::turntable

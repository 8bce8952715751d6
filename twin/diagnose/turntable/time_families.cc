#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/named_parts.h"

namespace twinbench::diagnose::turntable {
namespace {

/// Without its quadratic part.
Family SteadyDrift(const SignalContext& c, int axis) {
  return Linear("autocollimator_drift", kAxisNames[static_cast<std::size_t>(axis)], "rate",
                OnAxis(DriftSignals_s(c).leftCols(1), axis));
}

/// Amplitudes: the rate, and the rate times the share of the quadratic part.
Family Drift(const SignalContext& c, int axis) {
  Family family = Linear("autocollimator_drift", kAxisNames[static_cast<std::size_t>(axis)], "rate",
                         OnAxis(DriftSignals_s(c), axis));
  family.amplitudes.push_back(family.amplitudes[0]);
  family.amplitudes[1].name = "bend";
  family.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double curvature = x[1] / x[0];
    const Eigen::Vector2d slope(-curvature / x[0], 1.0 / x[0]);
    return std::vector{Estimate("autocollimator_drift", "rate", x[0], std::sqrt(cov(0, 0))),
                       Estimate("autocollimator_drift", "curvature", curvature, std::sqrt(slope.dot(cov * slope)))};
  };
  return family;
}

/// Slower than a quarter of an hour a creep is a drift.
Family Creep(const Context& context, int axis) {
  Shape time_constant = ShapeOf("mount_creep", "time_constant", Ratios(5.0, 900.0, 8));
  time_constant.lower = 2.0;
  time_constant.upper = 900.0;
  return Shaped("mount_creep", axis, {AmplitudeOf("mount_creep", "amplitude")}, time_constant,
                [context](const Eigen::VectorXd& tau_s) { return CreepSignal(*context, tau_s[0]); });
}

/// Within a set-up: a step at its first reading is a constant of it.
std::vector<double> Onsets(const Schedule& s) {
  std::vector<double> onsets;
  for (std::size_t i = 1; i < s.reading.size(); ++i) {
    if (s.setup[i] == s.setup[i - 1] && s.phase[i] == s.phase[i - 1]) onsets.push_back(s.reading[i]);
  }
  constexpr std::size_t kMost = 1000;
  const std::size_t every = 1 + onsets.size() / kMost;
  std::vector<double> kept;
  for (std::size_t k = 0; k < onsets.size(); k += every) kept.push_back(onsets[k]);
  return kept;
}

void AddSlips(const Context& context, std::vector<Family>& families) {
  const std::vector<double> onsets = Onsets(context->schedule);
  if (onsets.empty()) return;
  const auto base = std::make_shared<Base>();
  base->grid = static_cast<int>(std::ssize(onsets));
  base->channels = kAxes;
  base->series = [context, onsets](int g) {
    return Eigen::MatrixXd(StepSignal(*context, static_cast<int>(onsets[static_cast<std::size_t>(g)])));
  };
  for (const int axis : {kX, kY}) {
    Family family = Linear("slip", kAxisNames[static_cast<std::size_t>(axis)], "step", {});
    family.shapes = {ShapeOf("slip", "at_reading", onsets)};
    family.grid = base->grid;
    family.columns = nullptr;
    family.base = base;
    family.map = MapOfAxis(axis, 1);
    families.push_back(std::move(family));
  }
}

void AddTones(const Context& context, std::vector<Family>& families) {
  const std::vector<double> frequencies_Hz = ToneFrequencies_Hz(context->schedule);
  const Signal tone = [context](const Eigen::VectorXd& frequency_Hz) {
    return Wave(2.0 * units::kPi * frequency_Hz[0] * context->schedule.time_s);
  };
  const auto base = std::make_shared<Base>();
  base->grid = static_cast<int>(std::ssize(frequencies_Hz));
  base->channels = kAxes;
  base->series = [tone, frequencies_Hz](int g) {
    return tone(Eigen::VectorXd::Constant(1, frequencies_Hz[static_cast<std::size_t>(g)]));
  };
  for (const int axis : {kX, kY}) {
    Family family =
        Shaped("tone", axis, WaveAmplitudes("tone"), ShapeOf("tone", "frequency", frequencies_Hz), tone);
    family.base = base;
    family.map = MapOfAxis(axis, 2);
    ReportWave("tone", "frequency", family);
    families.push_back(std::move(family));
  }
}

}  // namespace

void AddTime(const Context& context, std::vector<Family>& families) {
  for (const int axis : {kX, kY}) {
    const char* const where = kAxisNames[static_cast<std::size_t>(axis)];
    families.push_back(SteadyDrift(*context, axis));
    families.push_back(Drift(*context, axis));
    families.push_back(Creep(context, axis));
    if (context->HasTemperature())
      families.push_back(
          Linear("autocollimator_temperature", where, "coefficient", OnAxis(context->above_K, axis)));
  }
  AddSlips(context, families);
  AddTones(context, families);
}

}  // namespace twinbench::diagnose::turntable

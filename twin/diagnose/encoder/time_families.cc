#include <cmath>

#include "twin/diagnose/encoder/named_parts.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Amplitudes: the rate, and the rate times the share of the quadratic part.
Family Drift(const SignalContext& c) {
  Family family = Linear("drift", {"rate", "rate"}, DriftSignals_s(c));
  family.amplitudes[1].name = "bend";
  family.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double curvature = x[1] / x[0];
    const Eigen::Vector2d slope(-curvature / x[0], 1.0 / x[0]);
    return std::vector{Estimate("drift", "rate", x[0], std::sqrt(cov(0, 0))),
                       Estimate("drift", "curvature", curvature, std::sqrt(slope.dot(cov * slope)))};
  };
  return family;
}

Family Slip(const Context& context) {
  constexpr std::size_t kMostOnsets = 2500;
  const std::vector<int>& readings = context->reading;
  const std::size_t every = 1 + readings.size() / kMostOnsets;
  std::vector<double> onsets;
  for (std::size_t i = 1; i < readings.size(); i += every) onsets.push_back(readings[i]);
  Family family = Named("slip");
  family.amplitudes = {AmplitudeOf("slip", "step")};
  family.shapes = {ShapeOf("slip", "at_reading", onsets)};
  family.grid = static_cast<int>(onsets.size());
  family.columns = [context, onsets](int g) {
    return Eigen::MatrixXd(StepSignal(*context, static_cast<int>(onsets[static_cast<std::size_t>(g)])));
  };
  return family;
}

}  // namespace

void AddTime(const Context& context, std::vector<Family>& families) {
  families.push_back(Drift(*context));
  families.push_back(Slip(context));
}

}  // namespace twinbench::diagnose::encoder

#include "twin/core/units.h"
#include "twin/diagnose/encoder/named_parts.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Amplitudes of cosine and sine; together they are the catalogue's amplitude and phase.
std::vector<Amplitude> WaveAmplitudes(const std::string& effect) {
  Amplitude wave = AmplitudeOf(effect, "amplitude");
  std::vector<Amplitude> waves(2, wave);
  waves[0].name = "cosine";
  waves[1].name = "sine";
  return waves;
}

/// amplitude * cos(order * angle + phase).
/// @param order  Name of the catalogue's parameter for it; empty: it has none.
Family Harmonic(const std::string& effect, const Eigen::VectorXd& angle_rad, const std::vector<double>& orders,
                const std::string& order, double factor = 1.0) {
  Family family = Named(effect);
  family.amplitudes = WaveAmplitudes(effect);
  family.grid = static_cast<int>(orders.size());
  if (!order.empty()) family.shapes = {ShapeOf(effect, order, orders)};
  family.columns = [angle_rad, orders, factor](int g) {
    return Eigen::MatrixXd(Wave(factor * orders[static_cast<std::size_t>(g)] * angle_rad));
  };
  family.parameters = [effect, order](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    std::vector<ParameterEstimate> estimates = {Estimate(effect, "amplitude", polar.size, polar.u_size),
                                                Estimate(effect, "phase", polar.phase_rad, polar.u_phase_rad)};
    if (!order.empty())
      estimates.insert(estimates.begin(), Estimate(effect, order, shape[0], 0.0));  // whole number
    return estimates;
  };
  return family;
}

/// True if the device was turned on the shaft between set-ups: only then is its angle not the reference's.
bool WasTurned(const SignalContext& c) {
  const Eigen::VectorXd offset_rad = c.device_rad - c.reference_rad;
  return offset_rad.maxCoeff() - offset_rad.minCoeff() > 1.0 * units::deg;
}

}  // namespace

void AddPeriodic(const SignalContext& c, std::vector<Family>& families) {
  const int last = LargestOrder(c);
  families.push_back(Harmonic("eccentricity", c.device_rad, {1.0}, ""));
  families.push_back(Harmonic("ellipticity", c.device_rad, {2.0}, ""));
  if (last >= 3) families.push_back(Harmonic("periodic", c.device_rad, WholeOrders(3, last), "order"));
  if (c.device.teeth > 0)
    families.push_back(Harmonic("gear_mesh", c.device_rad, {static_cast<double>(c.device.teeth)}, "teeth"));
  if (c.device.lines > 0)
    families.push_back(Harmonic("interpolation", c.device_rad, WholeOrders(1, 4), "order", c.device.lines));
  if (!WasTurned(c) || last < 1) return;
  Family fault = Harmonic("reference_fault", c.reference_rad, WholeOrders(1, last), "order");
  fault.columns = [columns = fault.columns](int g) { return Eigen::MatrixXd(-columns(g)); };  // it is taken off
  families.push_back(std::move(fault));
}

}  // namespace twinbench::diagnose::encoder

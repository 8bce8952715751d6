#include <algorithm>
#include <cmath>

#include "twin/diagnose/hob/family_parts.h"

namespace twinbench::diagnose::hob {
namespace {

/// What a ring shows too much, by orders of its own angle.
struct RingPlace {
  std::string where;
  SharedBase orders;  // 1, 2, ...
  double factor;      // seen in m for what it shows
};

/// One order out of a base that has all of them.
SharedBase Only(const SharedBase& orders, int order) {
  auto one = std::make_shared<Base>(*orders);
  one->grid = 1;
  one->series = [orders, order](int) { return orders->series(order - 1); };
  return one;
}

Family RingWave(const Context& context, const std::string& effect, const RingPlace& ring, int order) {
  Family family = NamedFamily(effect, ring.where);
  family.amplitudes = WaveAmplitudes(effect);
  Use(context, {Only(ring.orders, order), Seen::kByEncoders, ring.factor}, family);
  family.parameters = WaveParameters(effect);
  return family;
}

/// Orders that eccentricity and ellipticity have not.
Family Periodic(const Context& context, const RingPlace& ring) {
  constexpr int kFirst = 3;
  Family family = NamedFamily("periodic", ring.where);
  family.amplitudes = WaveAmplitudes("periodic");
  auto higher = std::make_shared<Base>(*ring.orders);
  higher->grid = ring.orders->grid - kFirst + 1;
  higher->series = [orders = ring.orders](int g) { return orders->series(g + kFirst - 1); };
  std::vector<double> values;
  for (int g = 0; g < higher->grid; ++g) values.push_back(g + kFirst);
  Use(context, {higher, Seen::kByEncoders, ring.factor}, family);
  family.shapes = {ShapeOf("periodic", "order", values)};
  family.parameters = WaveParameters("periodic", "order");
  return family;
}

/// The wave of twice the phase has the size ratio / (2 + ratio), of which the signature is the first order.
std::vector<ParameterEstimate> MismatchParameters(const Eigen::VectorXd&, const Eigen::VectorXd& x,
                                                  const Eigen::MatrixXd& cov) {
  const double less = std::max(1.0 - 0.5 * x[0], 0.1);
  return {Estimate("amplitude_mismatch", "ratio", x[0] / less, std::sqrt(cov(0, 0)) / (less * less))};
}

}  // namespace

void AddRings(const Common& common, std::vector<Family>& families) {
  const Context& context = common.context;
  for (const RingPlace& ring : {RingPlace{"table", common.ring_orders, 1.0},
                                RingPlace{"hob", common.hob_orders, -context->train.Ratio()}}) {
    families.push_back(RingWave(context, "eccentricity", ring, 1));
    families.push_back(RingWave(context, "ellipticity", ring, 2));
    if (ring.orders->grid >= 3) families.push_back(Periodic(context, ring));
  }
}

void AddHobSignals(const Context& context, std::vector<Family>& families) {
  const double factor = -context->train.Ratio() / context->hob_lines;
  const auto faults = std::make_shared<const Eigen::MatrixXd>(SignalFaults_rad(*context));
  const auto add = [&](const std::string& effect, const std::vector<std::string>& parameters, Eigen::Index first) {
    Family family = NamedFamily(effect);
    for (const std::string& parameter : parameters) family.amplitudes.push_back(AmplitudeOf(effect, parameter));
    const auto count = std::ssize(parameters);
    const auto series = [faults, first, count](int) { return Eigen::MatrixXd(faults->middleCols(first, count)); };
    Use(context, {BaseOf(context, 1, series), Seen::kByEncoders, factor}, family);
    families.push_back(std::move(family));
  };
  add("signal_offset", {"offset_sin", "offset_cos"}, 0);
  add("amplitude_mismatch", {"ratio"}, 2);
  families.back().parameters = MismatchParameters;
  add("quadrature_error", {"angle"}, 3);
}

}  // namespace twinbench::diagnose::hob

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

using units::deg;

/// Whole orders that no named cause has.
std::vector<double> FreeOrders(const Collector& collect) {
  std::vector<double> orders;
  const int last = LargestOrder(collect.context());
  if (!collect.Covered("eccentricity") && !collect.Covered("signal_offset")) orders.push_back(1.0);
  if (!collect.Covered("ellipticity") && !collect.Covered("amplitude_mismatch") &&
      !collect.Covered("quadrature_error"))
    orders.push_back(2.0);
  if (!collect.Covered("periodic")) {
    for (const double order : WholeOrders(3, last)) orders.push_back(order);
  }
  return orders;
}

void AddHarmonics(Collector& collect) {
  const Eigen::VectorXd angle_rad = collect.context().device_rad;
  const std::vector<double> orders = FreeOrders(collect);
  if (orders.empty()) return;
  collect.Add(
      "harmonic", static_cast<int>(orders.size()),
      [=](int g) { return Wave(orders[static_cast<std::size_t>(g)] * angle_rad); },
      [=](int g) {
        return fmt::format("harmonic of order {:.0f} locked to reference angle, same in both directions",
                           orders[static_cast<std::size_t>(g)]);
      });
}

/// Lines between the whole orders, a tenth of the resolution apart. Nearer to a whole order than the run can tell
/// there are none; and none at all in a single turn, where neighbouring whole orders imitate any line between them.
void AddLines(Collector& collect) {
  constexpr double kFewestTurns = 1.5;
  const SignalContext& c = collect.context();
  if (Turns(c) < kFewestTurns) return;
  const double last = std::min(60.0, LargestOrder(c) + 0.5);
  const double turns = Turns(c), step = std::clamp(0.1 / turns, 0.01, 0.2);
  const double nearest = std::clamp(0.2 / turns, 0.01, 0.45);
  Shape order{"order", "1", 1.0, 0.3, std::max(last, 0.4), {}};
  for (double k = 0.3; k <= last; k += step) {
    if (std::abs(k - std::round(k)) > nearest) order.value.push_back(k);
  }
  if (order.value.empty()) return;
  collect.AddOver(
      "line", order, [angle_rad = c.device_rad](const Eigen::VectorXd& k) { return Wave(k[0] * angle_rad); },
      [values = order.value](int g) {
        return fmt::format("line at {:.3f} per turn locked to reference angle, same in both directions",
                           values[static_cast<std::size_t>(g)]);
      });
}

// --- direction ---

void AddDirections(Collector& collect) {
  const SignalContext& c = collect.context();
  const std::vector<Eigen::VectorXd> senses = Senses(c);
  const Eigen::VectorXd held = senses.front();
  if (held.maxCoeff() == held.minCoeff()) return;
  if (!collect.Covered("backlash"))
    collect.Add("direction offset", held, "offset locked to direction, odd in direction");
  const int last = std::min(24, LargestOrder(c));
  const std::string words = "direction times order {} locked to reference angle, odd in direction";
  for (const Eigen::VectorXd& sense : senses) AddModulated(collect, "direction harmonic", last, sense, words);
  const Eigen::VectorXd travel_rad = TravelSinceReversal_rad(c);
  Shape decay{"decays_over", "deg", deg, 1.0 * deg, 720.0 * deg, Ratios(2.0 * deg, 360.0 * deg, 14)};
  collect.AddOver(
      "reversal", decay,
      [=](const Eigen::VectorXd& way_rad) {
        const Eigen::VectorXd left = (-travel_rad.array() / way_rad[0]).exp();
        return Eigen::MatrixXd(held.cwiseProduct(left));
      },
      [values = decay.value](int g) {
        return fmt::format("direction times a decay over {:.3g} deg behind each reversal, odd in direction",
                           values[static_cast<std::size_t>(g)] / deg);
      });
}

}  // namespace

std::vector<Family> UnknownFamilies(const Context& context, const std::vector<std::string>& covered) {
  Collector collect(context, covered);
  AddHarmonics(collect);
  AddLines(collect);
  AddDirections(collect);
  AddInTime(collect);
  AddByPassAndSetUp(collect);
  AddSpeeds(collect);
  return collect.Take();
}

}  // namespace twinbench::diagnose::encoder

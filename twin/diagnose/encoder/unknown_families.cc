#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/collector.h"
#include "twin/diagnose/encoder/wave_grid.h"

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
  constexpr double kFirst = 0.3;
  Shape order{"order", "1", 1.0, kFirst, std::max(last, 0.4), {}};
  std::vector<int> place;  // of each value among all steps
  for (int j = 0; kFirst + j * step <= last; ++j) {
    const double k = kFirst + j * step;
    if (std::abs(k - std::round(k)) <= nearest) continue;
    order.value.push_back(k);
    place.push_back(j);
  }
  if (place.empty()) return;
  const auto waves = std::make_shared<const WaveGrid>(c.device_rad, kFirst, step, place.back() + 1);
  collect.AddOver(
      "line", order,
      [nearest, angle_rad = c.device_rad](const Eigen::VectorXd& k) {
        return Wave(AwayFromWhole(k[0], nearest) * angle_rad);
      },
      [values = order.value](int g) {
        return fmt::format("line at {:.3f} per turn locked to reference angle, same in both directions",
                           values[static_cast<std::size_t>(g)]);
      },
      [waves, place](int g) { return waves->At(place[static_cast<std::size_t>(g)]); });
}

// --- direction ---

/// What dies out behind each reversal, alone and beside an offset that stays: a hysteresis of another form.
void AddBehindReversals(Collector& collect, const Eigen::VectorXd& held) {
  const Eigen::VectorXd travel_rad = TravelSinceReversal_rad(collect.context());
  Shape decay{"decays_over", "deg", deg, 1.0 * deg, 720.0 * deg, Ratios(2.0 * deg, 360.0 * deg, 14)};
  const auto left = [=](const Eigen::VectorXd& way_rad) -> Eigen::VectorXd {
    return held.array() * (-travel_rad.array() / way_rad[0]).exp();
  };
  const auto words = [values = decay.value](const char* what) {
    return [=](int g) { return fmt::format(fmt::runtime(what), values[static_cast<std::size_t>(g)] / deg); };
  };
  collect.AddOver(
      "reversal", decay, [=](const Eigen::VectorXd& way_rad) { return Eigen::MatrixXd(left(way_rad)); },
      words("direction times a decay over {:.3g} deg behind each reversal, odd in direction"));
  if (collect.Covered("hysteresis")) return;
  collect.AddOver(
      "transition", decay,
      [=](const Eigen::VectorXd& way_rad) {
        Eigen::MatrixXd columns(held.size(), 2);
        columns << held, left(way_rad);
        return columns;
      },
      words("offset locked to direction that is reached over {:.3g} deg behind each reversal, odd in direction"));
}

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
  AddBehindReversals(collect, held);
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

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/wave_grid.h"
#include "twin/diagnose/hob/collector.h"

namespace twinbench::diagnose::hob {
namespace {

/// Whole orders of the table that are not free anyway.
void AddHarmonics(Collector& collect) {
  const SharedBase all = collect.common().table_orders;
  const int free =
      collect.context().channels > 1 ? 0 : std::min(collect.context().train.free_orders, all->grid - 1);
  auto orders = std::make_shared<Base>(*all);
  orders->grid = all->grid - free;
  orders->series = [all, free](int g) { return all->series(g + free); };
  collect.Add({"harmonic"}, orders, [free](int g) {
    return fmt::format("harmonic of order {} locked to table angle, same in both directions", g + 1 + free);
  });
}

/// Orders of the rings, which named causes have exactly.
void AddRingHarmonics(Collector& collect) {
  collect.Add({"ring harmonic", kSameShape}, collect.common().ring_orders,
              [](int g) { return fmt::format("harmonic of order {} locked to the table's ring and head", g + 1); });
  collect.Add({"hob harmonic", kSameShape}, collect.common().hob_orders,
              [](int g) { return fmt::format("harmonic of order {} locked to hob angle", g + 1); });
}

/// Lines between the whole orders; nearer to one than a pass can tell there are none.
void AddLines(Collector& collect) {
  const SignalContext& c = collect.context();
  const double turns = (c.table_rad.maxCoeff() - c.table_rad.minCoeff()) / (2.0 * units::kPi);
  if (turns < 1.5) return;
  constexpr double kFirst = 0.3;
  const double last = std::min(60.5, collect.common().table_orders->grid + 0.5);
  const double step = std::clamp(0.3 / turns, 0.03, 0.2), nearest = std::clamp(0.25 / turns, 0.01, 0.45);
  Shape order{"order", "1", 1.0, kFirst, last, {}};
  std::vector<int> place;  // of each value among all steps
  for (int j = 0; kFirst + j * step <= last; ++j) {
    const double k = kFirst + j * step;
    if (std::abs(k - std::round(k)) <= nearest) continue;
    order.value.push_back(k);
    place.push_back(j);
  }
  if (place.empty()) return;
  const auto waves = std::make_shared<const encoder::WaveGrid>(c.table_rad, kFirst, step, place.back() + 1);
  const SharedBase base = BaseOf(collect.common().context, static_cast<int>(place.size()),
                                 [waves, place](int g) { return waves->At(place[static_cast<std::size_t>(g)]); });
  collect.AddOver(
      {"line"}, order, base,
      [nearest, angle_rad = c.table_rad](const Eigen::VectorXd& k) {
        return Wave(encoder::AwayFromWhole(k[0], nearest) * angle_rad);
      },
      [values = order.value](int g) {
        return fmt::format("line at {:.3f} per turn locked to table angle, same in both directions",
                           values[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddByAngle(Collector& collect) {
  AddHarmonics(collect);
  AddRingHarmonics(collect);
  AddLines(collect);
}

}  // namespace twinbench::diagnose::hob

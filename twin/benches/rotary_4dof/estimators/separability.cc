#include "twin/benches/rotary_4dof/estimators/separability.h"

#include "twin/benches/rotary_4dof/estimators/lost_components.h"
#include "twin/core/last_answer.h"

namespace twinbench::separate {

namespace {

Separability Found(const Design& design) {
  Separability result;
  result.orders = OrderBlocks(design);
  std::vector<OrderNull> nulls;
  for (const OrderBlock& block : result.orders) {
    nulls.push_back({block.basis.order, block.basis.parts, block.null.topRows(kSeries * block.basis.parts)});
  }
  result.lost = ListLostComponents(nulls);
  return result;
}

/// All that a design is.
std::vector<double> NumbersOf(const Design& d) {
  std::vector<double> numbers = {static_cast<double>(d.n), d.target_offset_rad, d.reference_offset_rad, d.target_height_m, d.reference_height_m};
  for (const SetUp& s : d.setups)
    numbers.insert(numbers.end(), {static_cast<double>(s.label), static_cast<double>(s.shift), s.rho_rad, static_cast<double>(s.clamping)});
  return numbers;
}

}  // namespace

Separability FindSeparability(const Design& design) {
  static LastAnswer<std::vector<double>, Separability> last;
  return *last.To(NumbersOf(design), [&] { return Found(design); });
}

}  // namespace twinbench::separate

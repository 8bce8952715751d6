#include "twin/benches/rotary_4dof/estimators/separability.h"

#include "twin/benches/rotary_4dof/estimators/lost_components.h"

namespace twinbench::separate {

Separability FindSeparability(const Design& design) {
  Separability result;
  result.orders = OrderBlocks(design);
  std::vector<OrderNull> nulls;
  for (const OrderBlock& block : result.orders) {
    nulls.push_back({block.basis.order, block.basis.parts, block.null.topRows(kSeries * block.basis.parts)});
  }
  result.lost = ListLostComponents(nulls);
  return result;
}

}  // namespace twinbench::separate

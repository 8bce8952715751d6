#pragma once

#include <memory>
#include <vector>

#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/diagnose/engine/candidates.h"

/// What the makers of families have in common; only they need it.
namespace twinbench::diagnose::hob {

using Context = std::shared_ptr<const SignalContext>;
using SharedBase = std::shared_ptr<const Base>;

/// Means over groups of samples.
ToRows MeansOf(const Context& context);

/// Columns that named and unknown families share.
struct Common {
  Context context;
  SharedBase ring_orders, table_orders, hob_orders;  // orders 1, 2, ... of each angle
  TimeSeries series;                                 // nothing swings on through a mounting
};
Common CommonOf(const Context& context, int largest_order);

/// Every effect of the catalogue that leaves a trace.
std::vector<Family> NamedFamilies(const Common& common, double plausible_rad);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const HobRun& hob, const Common& common, double plausible_rad);

}  // namespace twinbench::diagnose::hob

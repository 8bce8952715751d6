#include "twin/benches/rotary_4dof/format.h"

#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::benches::rotary {

namespace {

TableSettings& TableOf(Scenario& s, bool of_reference) {
  return of_reference ? RotaryOf(s).reference : RotaryOf(s).target;
}

/// The card's, of what it reads.
double RangeOf(const Scenario& s, const std::string& column) {
  return column.ends_with("_V") ? RotaryOf(s).adc.range_V : 0.0;
}

}  // namespace

const BenchFormat& Format() {
  static const BenchFormat format = {
      .name = kRotaryBench, .title = "errors of two stacked rotary tables by a grating and two PSDs",
      .add_keys = AddKeys, .check_together = CheckTogether, .tables = TableNames{"target", "reference", TableOf},
      .has_fixtures = true, .columns = Columns(), .desired = Desired(), .range_of = RangeOf,
      .smallest_addition = Addition, .effects = Effects(), .channels = {kChannelNames.begin(), kChannelNames.end()},
      .points = {kChannelNames.begin(), kChannelNames.end()}, .angles = {"target", "reference"},
      .signal = SignalKind::kPosition};
  return format;
}

}  // namespace twinbench::benches::rotary

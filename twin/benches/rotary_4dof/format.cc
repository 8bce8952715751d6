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
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kRotaryBench;
    f.title = "errors of two stacked rotary tables by a grating and two PSDs";
    f.add_keys = AddKeys;
    f.check_together = CheckTogether;
    f.tables = TableNames{"target", "reference", TableOf};
    f.has_fixtures = true;
    f.columns = Columns();
    f.channels = {kChannelNames.begin(), kChannelNames.end()};
    f.points = {kChannelNames.begin(), kChannelNames.end()};
    f.angles = {"target", "reference"};
    f.signal = SignalKind::kPosition;
    f.desired = Desired();
    f.range_of = RangeOf;
    f.smallest_addition = Addition;
    f.effects = Effects();
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::rotary

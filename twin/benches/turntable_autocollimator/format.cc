#include "twin/benches/turntable_autocollimator/format.h"

#include "twin/benches/names.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::benches::turntable {

namespace {

TableSettings& TableOf(Scenario& s, bool of_reference) {
  return of_reference ? TurntableOf(s).multitooth_table : TurntableOf(s).turntable;
}

double RangeOf(const Scenario& s, const std::string& column) {
  return column.starts_with("autocollimator_") ? TurntableOf(s).autocollimator.range_rad : 0.0;
}

}  // namespace

const BenchFormat& Format() {
  static const BenchFormat format = {
      .name = kTurntableBench, .title = "a turntable against a multi-tooth table by an autocollimator",
      .add_keys = AddKeys, .check_together = CheckTogether, .tables = TableNames{"turntable", "multitooth", TableOf},
      .columns = Columns(), .into_frame = CountBothTheSameWay, .desired = Desired(), .range_of = RangeOf,
      .smallest_addition = Addition, .effects = Effects(), .channels = {"x", "y"}, .points = {"x", "y"},
      .angles = {"turntable", "multitooth"}};
  return format;
}

}  // namespace twinbench::benches::turntable

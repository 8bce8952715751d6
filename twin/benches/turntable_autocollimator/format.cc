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
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kTurntableBench;
    f.title = "a turntable against a multi-tooth table by an autocollimator";
    f.add_keys = AddKeys;
    f.check_together = CheckTogether;
    f.tables = TableNames{"turntable", "multitooth", TableOf};
    f.columns = Columns();
    f.into_frame = CountBothTheSameWay;
    f.channels = {"x", "y"};
    f.points = {"x", "y"};
    f.angles = {"turntable", "multitooth"};
    f.desired = Desired();
    f.range_of = RangeOf;
    f.smallest_addition = Addition;
    f.effects = Effects();
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::turntable

#include "twin/benches/freeform_five_axis/format.h"

#include <cmath>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/names.h"

namespace twinbench::benches::freeform {
namespace {

std::string Addition(int /*setups*/) {
  return "more poses, and the artefact at other heights, as in freeform_procedure.mounts";
}

/// Twice where an axis has errors; all of the light on one side of the detector, and the last pixel of the camera.
double RangeOf(const Scenario& s, const std::string& column) {
  constexpr double kReserve = 1.5;  // gains, noise
  const FreeformSettings& bench = FreeformOf(s);
  if (bench.ReadsDisplacements()) return 0.0;  // of any machine
  for (std::size_t axis = 0; axis < kCommanded.size(); ++axis) {
    if (column == kCommanded[axis].column) return 2.0 * (std::abs(bench.machine.centre[axis]) + bench.machine.half[axis]);
  }
  return kReserve * (column == "ccd_px" ? 2.0 * bench.ccd.centre_px : column.ends_with("_V") ? bench.qpd.sum_V : 0.0);
}

}  // namespace

const BenchFormat& Format() {
  static const BenchFormat format = {
      .name = kFreeformBench, .title = "a five-axis machine's probe against an array of paraboloids",
      .add_keys = AddKeys, .columns = Columns(), .desired = Desired(), .range_of = RangeOf,
      .smallest_addition = Addition, .effects = Effects(), .channels = {"qpd_x", "qpd_y", "ccd"},
      .points = {"qpd_x", "qpd_y", "ccd"}, .angles = {"a", "b"}, .signal = SignalKind::kOwn};
  return format;
}

}  // namespace twinbench::benches::freeform

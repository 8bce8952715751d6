#include "twin/benches/freeform_five_axis/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::freeform {
namespace {

std::string Addition(int /*setups*/) {
  return "more poses, and the artefact at other heights, as in freeform_procedure.mounts";
}

}  // namespace

const BenchFormat& Format() {
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kFreeformBench;
    f.title = "a five-axis machine's probe against an array of paraboloids";
    f.add_keys = AddKeys;
    f.columns = Columns();
    f.channels = {"qpd_x", "qpd_y", "ccd"};
    f.points = {"qpd_x", "qpd_y", "ccd"};
    f.angles = {"a", "b"};
    f.desired = Desired();
    f.smallest_addition = Addition;
    f.effects = Effects();
    f.signal = SignalKind::kOwn;
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::freeform

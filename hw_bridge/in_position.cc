#include "hw_bridge/in_position.h"

#include <fmt/format.h>

#include <algorithm>

#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

struct InFile {
  const char* unit;
  double to_SI;
  const char* what;
};
constexpr InFile kTable{"arcsec", units::arcsec, "table"}, kRotaryAxis{"arcsec", units::arcsec, "axis"}, kLinearAxis{"um", units::um, "axis"};

/// @param table  "target", "axis_x".
void Tie(const KeyPlaces& places, const std::string& path, const std::string& table, const InFile& in, double u, const std::string& less, double& in_position) {
  const std::string key = fmt::format("{}.in_position_{}", table, in.unit);
  if (!places.contains(key)) {
    in_position = std::min(in_position, u);
    return;
  }
  if (in_position <= u) return;
  throw InputError(WhereIn(places, path, key),
                   fmt::format("{} is {:.3g}, and the results of this scenario claim to be certain to {:.3g} {}: nobody "
                               "would see that the {} stands elsewhere",
                               key, in_position / in.to_SI, u / in.to_SI, in.unit, in.what),
                   fmt::format("at most {:.3g}, or no such key: then it is the claim. Where the {} does not settle to that, a scenario that "
                               "claims less: {}",
                               u / in.to_SI, in.what, less));
}

}  // namespace

void TieToClaim(BenchFile& file, const std::string& name, double u_rad, const std::string& less) {
  if (name == "target") Tie(file.places, file.path, name, kTable, u_rad, less, file.target_limits.in_position_rad);
  if (name == "reference") Tie(file.places, file.path, name, kTable, u_rad, less, file.reference_limits.in_position_rad);
}

void TieToClaim(MachineFile& file, const std::vector<MachineAxis>& axes, const std::string& name, double u, const std::string& less) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k].name != name) continue;
    Tie(file.places, file.path, "axis_" + name, axes[k].is_rotary ? kRotaryAxis : kLinearAxis, u, less, file.axes[k].in_position);
  }
}

}  // namespace twinbench::hw

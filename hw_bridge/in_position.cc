#include "hw_bridge/in_position.h"

#include <fmt/format.h>

#include <algorithm>

#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

/// @param key  "target.in_position_arcsec".
void Tie(const KeyPlaces& places, const std::string& path, const std::string& key, double u_rad, double& in_position_rad) {
  if (!places.contains(key)) {
    in_position_rad = std::min(in_position_rad, u_rad);
    return;
  }
  if (in_position_rad <= u_rad) return;
  throw InputError(WhereIn(places, path, key),
                   fmt::format("{} is {:.3g}, and the results of this scenario claim to be certain to {:.3g} arcsec: nobody "
                               "would see that the table stands elsewhere",
                               key, in_position_rad / units::arcsec, u_rad / units::arcsec),
                   fmt::format("at most {:.3g}, or no such key: then it is the claim", u_rad / units::arcsec));
}

}  // namespace

void TieToClaim(BenchFile& file, const std::string& name, double u_rad) {
  const std::string key = name + ".in_position_arcsec";
  if (name == "target") Tie(file.places, file.path, key, u_rad, file.target_limits.in_position_rad);
  if (name == "reference") Tie(file.places, file.path, key, u_rad, file.reference_limits.in_position_rad);
}

void TieToClaim(MachineFile& file, const std::vector<MachineAxis>& axes, const std::string& name, double u_rad) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k].name != name || !axes[k].is_rotary) continue;
    Tie(file.places, file.path, "axis_" + name + ".in_position_arcsec", u_rad, file.axes[k].in_position);
  }
}

}  // namespace twinbench::hw

#include "twin/benches/turntable_autocollimator/diagnosis/places.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/at.h"

namespace twinbench::diagnose::turntable {
namespace {

/// An angle within a turn, in millionths of it.
long InTurn(double angle_rad) {
  constexpr long kParts = 1000000;
  const long part = std::lround(angle_rad / (2.0 * units::kPi) * kParts) % kParts;
  return part < 0 ? part + kParts : part;
}

/// Sweeps by set-up and pass, and their middles.
void NumberSweeps(const Schedule& s, Places& places) {
  std::map<std::pair<int, int>, int> number;
  std::vector<double> count;
  for (int i = 0; i < s.Readings(); ++i) {
    places.sweep.push_back(-1);
    if (s.phase[At(i)] != Phase::kCalibration) continue;
    const auto found = number.try_emplace({s.setup[At(i)], s.pass[At(i)]}, static_cast<int>(number.size())).first;
    places.sweep.back() = found->second;
    places.sweep_centre_rad.resize(number.size(), 0.0);
    count.resize(number.size(), 0.0);
    places.sweep_centre_rad[At(found->second)] += s.target_rad[i];
    count[At(found->second)] += 1.0;
  }
  places.sweeps = static_cast<int>(number.size());
  for (std::size_t k = 0; k < count.size(); ++k) places.sweep_centre_rad[k] /= count[k];
}

/// Positions in the order of their first reading, those of full circles before all others, sweeps last.
void NumberBlocks(const Schedule& s, Places& places) {
  std::map<long, int> number;
  places.block.assign(At(s.Readings()), -1);
  for (const bool circle : {true, false}) {
    for (int i = 0; i < s.Readings(); ++i) {
      if (places.sweep[At(i)] >= 0 || (s.phase[At(i)] == Phase::kFullCircle) != circle) continue;
      places.block[At(i)] =
          number.try_emplace(InTurn(s.target_rad[i]), static_cast<int>(number.size())).first->second;
    }
    if (circle) places.circle_blocks = static_cast<int>(number.size());
  }
  const int positions = static_cast<int>(number.size());
  for (int i = 0; i < s.Readings(); ++i) {
    if (places.sweep[At(i)] >= 0) places.block[At(i)] = positions + places.sweep[At(i)];
  }
  places.blocks = positions + places.sweeps;
}

void NumberSetUps(const Schedule& s, Places& places) {
  std::map<int, int> number;
  for (int i = 0; i < s.Readings(); ++i) {
    const bool swept = places.sweep[At(i)] >= 0;
    places.setup.push_back(
        swept ? -1 : number.try_emplace(s.setup[At(i)], static_cast<int>(number.size())).first->second);
  }
  places.setups = static_cast<int>(number.size());
}

void NumberTeeth(const Schedule& s, Places& places) {
  std::map<long, std::set<int>> positions_of;
  std::map<int, std::set<long>> teeth_at;
  for (int i = 0; i < s.Readings(); ++i) {
    if (places.sweep[At(i)] >= 0) continue;
    const long tooth = InTurn(s.reference_rad[i]);
    positions_of[tooth].insert(places.block[At(i)]);
    teeth_at[places.block[At(i)]].insert(tooth);
  }
  std::map<long, int> number;
  for (int i = 0; i < s.Readings(); ++i) {
    const long tooth = InTurn(s.reference_rad[i]);
    const bool free =
        places.sweep[At(i)] < 0 && (positions_of[tooth].size() > 1 || teeth_at[places.block[At(i)]].size() > 1);
    places.tooth.push_back(free ? number.try_emplace(tooth, static_cast<int>(number.size())).first->second : -1);
  }
  places.teeth = static_cast<int>(number.size());
}

}  // namespace

Places PlacesOf(const Schedule& schedule) {
  Places places;
  NumberSweeps(schedule, places);
  NumberBlocks(schedule, places);
  NumberSetUps(schedule, places);
  NumberTeeth(schedule, places);
  return places;
}

}  // namespace twinbench::diagnose::turntable

#include "twin/procedure/standing.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "twin/core/units.h"

namespace twinbench::procedure {
namespace {

constexpr auto kBetweenTwoLooks = std::chrono::milliseconds(50);
constexpr double kTableCreeps_rad = 10.0 * units::arcsec;  // in that time: more than encoders flicker
constexpr double kAxisCreeps = 5e-5;                       // m or rad, likewise

/// What one look says of something that can move.
struct Look {
  std::string name;
  double encoder = kNaN;
  bool moves = false;
};

std::vector<Look> LookAt(RotaryBench& bench) {
  const auto look = [](const char* name, const TableState& state) { return Look{name, state.encoder_rad, state.moving}; };
  return {look("target", bench.target.State()), look("reference", bench.reference.State())};
}

std::vector<Look> LookAt(MachineBench& bench) {
  std::vector<Look> looks;
  const std::vector<AxisState> states = bench.machine.State();
  for (std::size_t k = 0; k < states.size(); ++k)
    looks.push_back({bench.machine.Axes()[k].name, states[k].encoder, states[k].moving});
  return looks;
}

template <class AnyBench>
Standstill LookTwice(AnyBench& bench, double creeps) {
  const std::vector<Look> before = LookAt(bench);
  for (const Look& look : before) {  // the rest of the way need not wait for a second look
    if (look.moves) return {false, look.name + " moves"};
  }
  std::this_thread::sleep_for(kBetweenTwoLooks);
  const std::vector<Look> then = LookAt(bench);
  std::string moving;
  for (std::size_t k = 0; k < then.size(); ++k) {
    const bool crept = std::abs(then[k].encoder - before[k].encoder) > creeps;
    if (then[k].moves || crept) moving += (moving.empty() ? "" : ", ") + then[k].name;
  }
  return {moving.empty(), moving.empty() ? "" : moving + " moves"};
}

}  // namespace

Standstill WhetherBothStand(RotaryBench& bench) {
  return LookTwice(bench, kTableCreeps_rad);
}

Standstill WhetherMachineStands(MachineBench& bench) {
  return LookTwice(bench, kAxisCreeps);
}

}  // namespace twinbench::procedure

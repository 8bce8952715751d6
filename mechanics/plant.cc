#include "mechanics/plant.h"

#include <algorithm>
#include <stdexcept>

#include "mechanics/drives.h"

namespace twinbench::mechanics {

Fidelity FidelityFromName(const std::string& name) {
  if (name == "kinematic") return Fidelity::kKinematic;
  if (name == "linear") return Fidelity::kLinear;
  if (name == "bullet") return Fidelity::kBullet;
  throw std::invalid_argument("fidelity: \"" + name + "\" is none of kinematic, linear, bullet");
}

double Plant::AdvanceUntilSettled(double limit_s) {
  constexpr double kPiece_s = 1e-3;
  double passed_s = std::min(ProfileLeft_s(), limit_s);
  Advance(passed_s);
  while (!Settled() && passed_s < limit_s) {
    Advance(kPiece_s);
    passed_s += kPiece_s;
  }
  return passed_s;
}

std::unique_ptr<Plant> MakePlant(Fidelity fidelity, const StackParameters& parameters) {
  switch (fidelity) {
    case Fidelity::kKinematic:
      return MakeKinematicPlant(parameters);
    case Fidelity::kLinear:
      return MakeLinearPlant(parameters);
    case Fidelity::kBullet:
      return MakeBulletPlant(parameters);
  }
  throw std::invalid_argument("fidelity: unknown");
}

}  // namespace twinbench::mechanics

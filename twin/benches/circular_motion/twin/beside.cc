#include "twin/benches/circular_motion/twin/beside.h"

#include <cmath>

namespace twinbench::sim {

using namespace benches::circular;

CircleBeside::CircleBeside(const CircleRun& run, std::vector<Reading> taken)
    : run_(run), course_(std::move(taken)), room_(run.Room()), twin_(run.TwinOf(course_, bodies_)) {
  for (const Reading& r : course_) run_.Felt(r, room_);  // its thermometer has been read as often
}

Reading CircleBeside::Take(const Reading& commanded) {
  constexpr int kBesideThePlan = -1;               // a pass
  constexpr double kOnCircle_m = 1.0 * units::nm;  // more: the machine went beside it
  Reading r = commanded;
  r.pass = kBesideThePlan;
  r = run_.Felt(WithAngle(course_.empty() ? nullptr : &course_.back(), r), room_);
  twin_.Append(r, room_.AboveReference_K(r.time), bodies_);
  course_.push_back(r);
  Reading shown = run_.Shown(r, twin_, course_.size() - 1);
  const double off_m = Radius_m(shown) - run_.SetupOf(shown).radius_m;
  if (run_.SetupOf(shown).IsBar() && std::abs(off_m) > kOnCircle_m) kBar_m(shown) += off_m;
  return shown;
}

}  // namespace twinbench::sim

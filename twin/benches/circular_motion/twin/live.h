#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/circular_motion/twin/twin.h"
#include "twin/core/scenario.h"
#include "twin/sim/driven_machine.h"
#include "twin/sim/environment.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {

/// A run of the scenario's procedure: the room's temperature, the set-ups as they were mounted, and chance.
///
/// Same scenario, same bits; the noise of a reading follows from its number alone.
class CircleRun {
 public:
  /// @throws InputError if the temperature file cannot be read.
  explicit CircleRun(const Scenario& scenario);

  int Readings() const { return static_cast<int>(course_.size()); }
  /// One of the procedure's readings before it is taken, with its temperature.
  const Reading& Planned(int reading) const { return course_[static_cast<std::size_t>(reading)]; }
  Reading Take(int reading) const;

  /// Another course of the same machine: in its room, a reading with the temperature that is felt at its time, what
  /// follows such a course, and one of its readings as the instruments show it.
  Environment Room() const;
  Reading Felt(Reading r, Environment& room) const;
  CircleTwin TwinOf(const std::vector<Reading>& course, BodiesOnce& bodies) const;
  Reading Shown(const Reading& r, const CircleTwin& twin, std::size_t at) const;
  const CircularSetup& SetupOf(const Reading& r) const;

  /// {"errors": scenario keys, "setups": what each was mounted with, "path": where the spindle was (set-up, pass),
  /// "effects", "seed"}.
  nlohmann::json Truth() const;

 private:
  CircleExtra Chance(const Reading& r) const;
  benches::circular::Deviation Digitised(const Reading& r, benches::circular::Deviation shown) const;

  Scenario scenario_;
  std::vector<Reading> course_;
  Eigen::VectorXd above_K_;
  BodiesOnce bodies_;
  CircleTwin twin_;
  std::vector<CircleExtra> mounted_;  // one a set-up
  std::vector<OutlierDraw> outliers_;
};

/// The circles' machine and its instruments, to be driven: on the plan of the scenario it shows what CircleRun
/// does, beside it what the same machine shows there.
std::unique_ptr<DrivenPhysics> MakeCirclePhysics(const Scenario& scenario);

}  // namespace twinbench::sim

#include "twin/benches/hob_transmission/procedure.h"

namespace twinbench::procedure {

std::vector<HobPass> HobPasses(const HobSettings& bench) {
  const HobProcedureSettings& s = bench.hob_procedure;
  std::vector<HobPass> passes;
  for (int setup = 0; setup < static_cast<int>(s.heads_rad.size()); ++setup) {
    for (const double speed_rad_s : s.hob_speeds_rad_s) {
      for (const int direction : s.passes)
        passes.push_back({setup, direction, direction * speed_rad_s, s.turns * s.samples_per_turn});
    }
    if (setup != 0 || !bench.interferometer.used || !bench.interferometer.IsReadAtRest()) continue;
    for (const int direction : s.passes) passes.push_back({setup, direction, 0.0, bench.interferometer.stops});
  }
  return passes;
}

std::vector<Reading> HobSchedule(const HobSettings& bench) {
  std::vector<Reading> readings;
  int number = 0;
  for (const HobPass& pass : HobPasses(bench)) {
    for (int position = 0; position < pass.readings; ++position) {
      Reading reading;
      reading.reading = static_cast<int>(readings.size());
      reading.setup = pass.setup;
      reading.pass = number;
      reading.direction = pass.direction;
      reading.position = position;
      reading.head_rad = bench.hob_procedure.heads_rad[static_cast<std::size_t>(pass.setup)];
      reading.velocity_rad_s = bench.transmission.Ratio() * pass.hob_speed_rad_s;
      readings.push_back(reading);
    }
    ++number;
  }
  return readings;
}

int PlannedReadings(const HobSettings& bench) {
  int readings = 0;
  for (const HobPass& pass : HobPasses(bench)) readings += pass.readings;
  return readings;
}

}  // namespace twinbench::procedure

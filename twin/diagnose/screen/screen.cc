#include "twin/diagnose/screen/screen.h"

#include <algorithm>
#include <utility>

#include "twin/diagnose/screen/moderated.h"
#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose {
namespace {

int EnoughNullRuns(int rows) {
  return std::clamp(2000000 / std::max(rows, 1), 150, 300);
}

}  // namespace

std::vector<ScreenTest> Screen(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               int null_runs, std::uint64_t seed) {
  const screen::Sample sample =
      screen::Simulate(run, noise, projector, null_runs > 0 ? null_runs : EnoughNullRuns(run.Rows()), seed);
  std::vector<ScreenTest> all;
  for (const auto test :
       {screen::TestFit, screen::TestNoiseScale, screen::TestTails, screen::TestWhiteness, screen::TestTime,
        screen::TestSteps, screen::TestCusum, screen::TestTones, screen::TestAveraging, screen::TestHarmonics,
        screen::TestLock, screen::TestDirection, screen::TestGroups, screen::TestTemperature, screen::TestSpot,
        screen::TestSpotMap, screen::TestPatterns, screen::TestChannelOrder}) {
    for (ScreenTest& found : test(sample)) all.push_back(screen::Moderated(std::move(found)));
  }
  return all;
}

}  // namespace twinbench::diagnose

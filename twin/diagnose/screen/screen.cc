#include "twin/diagnose/screen/screen.h"

#include <algorithm>
#include <utility>

#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose {
namespace {

/// Words that claim something are kept for what noise alone seldom does.
ScreenTest Moderated(ScreenTest test) {
  constexpr double kSeldom = 0.05;
  if (test.p > kSeldom) test.reading = "not beyond noise; loudest: " + test.reading;
  return test;
}

int EnoughNullRuns(int rows) {
  return std::clamp(900000 / std::max(rows, 1), 100, 300);
}

}  // namespace

std::vector<ScreenTest> Screen(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               int null_runs, std::uint64_t seed) {
  const screen::Sample sample =
      screen::Simulate(run, noise, projector, null_runs > 0 ? null_runs : EnoughNullRuns(run.Rows()), seed);
  std::vector<ScreenTest> all;
  for (const auto test : {screen::TestFit, screen::TestNoiseScale, screen::TestTails, screen::TestWhiteness,
                          screen::TestTime, screen::TestSteps, screen::TestTones, screen::TestHarmonics,
                          screen::TestLock, screen::TestDirection, screen::TestGroups, screen::TestTemperature,
                          screen::TestSpot, screen::TestPatterns, screen::TestChannelOrder}) {
    for (ScreenTest& found : test(sample)) all.push_back(Moderated(std::move(found)));
  }
  return all;
}

}  // namespace twinbench::diagnose

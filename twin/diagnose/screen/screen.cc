#include "twin/diagnose/screen/screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/screen/raw_tests.h"
#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose {
namespace {

/// "0.31 um (0.32 arcsec)", whichever there is; empty if a size has no meaning.
std::string SizeInWords(const ScreenTest& test) {
  const std::string length = fmt::format("{:.3g} um", test.effect_m / units::um);
  const std::string angle = fmt::format("{:.3g} arcsec", test.effect_rad / units::arcsec);
  if (!std::isfinite(test.effect_rad)) return std::isfinite(test.effect_m) ? length : "";
  return std::isfinite(test.effect_m) ? fmt::format("{} ({})", length, angle) : angle;
}

std::string Told(const std::vector<ScreenTest>& loud) {
  constexpr std::size_t kMostTold = 6;  // the file has all of them
  std::string text;
  for (std::size_t k = 0; k < std::min(loud.size(), kMostTold); ++k)
    text += fmt::format("{}({}) {}", k > 0 ? "; " : "", loud[k].name, loud[k].reading);
  if (loud.size() > kMostTold) text += fmt::format("; and {} more", loud.size() - kMostTold);
  return text;
}

}  // namespace

std::vector<ScreenTest> Moderated(std::vector<ScreenTest> tests) {
  constexpr double kSeldom = 0.05;
  for (ScreenTest& test : tests) {
    const std::string size = SizeInWords(test);
    if (!size.empty()) test.reading += "; size " + size;
    if (test.p > kSeldom) test.reading = "not beyond noise; loudest: " + test.reading;
  }
  return tests;
}

std::vector<ScreenTest> Screen(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               int null_runs, std::uint64_t seed) {
  const int enough = std::clamp(2000000 / std::max(run.Rows(), 1), 150, 300);
  const screen::Sample sample = screen::Simulate(run, noise, projector, null_runs > 0 ? null_runs : enough, seed);
  std::vector<ScreenTest> tests;
  for (const auto test :
       {screen::TestFit, screen::TestNoiseScale, screen::TestTails, screen::TestWhiteness, screen::TestTime,
        screen::TestSteps, screen::TestCusum, screen::TestTones, screen::TestAveraging, screen::TestHarmonics,
        screen::TestLock, screen::TestDirection, screen::TestGroups, screen::TestTemperature, screen::TestSpot,
        screen::TestSpotMap, screen::TestPatterns, screen::TestChannelOrder})
    test(sample, tests);
  return Moderated(std::move(tests));
}

std::vector<ScreenTest> ScreenRaw(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs,
                                  std::uint64_t seed) {
  const screen::RawSample sample{blocks, scale, screen::Thin(blocks, scale), null_runs, seed};
  std::vector<ScreenTest> tests;
  for (const auto test :
       {screen::TestHum, screen::TestRingDown, screen::TestRawAllan, screen::TestCodes, screen::TestSettling})
    test(sample, tests);
  return Moderated(std::move(tests));
}

std::vector<ScreenTest> Loud(std::vector<ScreenTest> tests) {
  const double threshold = kScreenFalseAlarms / static_cast<double>(std::max<std::size_t>(1, tests.size()));
  std::erase_if(tests, [=](const ScreenTest& test) { return !(test.p < threshold); });
  std::ranges::stable_sort(tests, {}, &ScreenTest::p);
  return tests;
}

std::string ScreenInWords(const std::vector<ScreenTest>& tests) {
  const std::vector<ScreenTest> loud = Loud(tests);
  const std::string told =
      loud.empty() ? fmt::format("none of {} shows what noise alone would give in fewer than", tests.size())
                   : fmt::format("{} of {} {} what noise alone would give in fewer than", loud.size(), tests.size(),
                                 loud.size() == 1 ? "shows" : "show");
  return fmt::format("Residual tests of the scenario as it was believed: {} {:.0f} run in 100.{}", told,
                     100.0 * kScreenFalseAlarms, loud.empty() ? "" : " " + Told(loud) + ".");
}

}  // namespace twinbench::diagnose

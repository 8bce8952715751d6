#include <fmt/format.h>

#include <algorithm>

#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose {
namespace {

constexpr std::size_t kMostTold = 6;  // the file has all of them

std::string Told(const std::vector<ScreenTest>& loud) {
  std::string text;
  for (std::size_t k = 0; k < std::min(loud.size(), kMostTold); ++k)
    text += fmt::format("{}({}) {}", k > 0 ? "; " : "", loud[k].name, loud[k].reading);
  if (loud.size() > kMostTold) text += fmt::format("; and {} more", loud.size() - kMostTold);
  return text;
}

}  // namespace

std::vector<ScreenTest> Loud(std::vector<ScreenTest> tests) {
  const double threshold = kScreenFalseAlarms / static_cast<double>(std::max<std::size_t>(1, tests.size()));
  std::erase_if(tests, [=](const ScreenTest& test) { return !(test.p < threshold); });
  std::stable_sort(tests.begin(), tests.end(), [](const ScreenTest& a, const ScreenTest& b) { return a.p < b.p; });
  return tests;
}

std::string ScreenInWords(const std::vector<ScreenTest>& tests) {
  const std::vector<ScreenTest> loud = Loud(tests);
  const char* show = loud.size() == 1 ? "shows" : "show";
  const std::string alarms = fmt::format("{:.0f} run in 100", 100.0 * kScreenFalseAlarms);
  if (loud.empty())
    return fmt::format(
        "Residual tests of the scenario as it was believed: none of {} shows what noise alone would give in fewer "
        "than {}.",
        tests.size(), alarms);
  return fmt::format(
      "Residual tests of the scenario as it was believed: {} of {} {} what noise alone would give in fewer than "
      "{}. {}.",
      loud.size(), tests.size(), show, alarms, Told(loud));
}

}  // namespace twinbench::diagnose

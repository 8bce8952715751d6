#include "twin/uncertainty/every_run.h"

#include <algorithm>
#include <array>

namespace twinbench::uncertainty {
namespace {

constexpr std::array<std::string_view, 4> kAlikeInAll = {"standard", "second order", "model", "prior"};

}  // namespace

bool IsNotByStatistics(const std::string& part) {
  return part == kRoundingOfReadings || IsSameInEveryRun(part);
}

bool IsSameInEveryRun(const std::string& part) {
  return std::ranges::find(kAlikeInAll, part) != kAlikeInAll.end();
}

double OwnShare(const Quantity& quantity) {
  double own = 1.0;
  for (const Part& part : quantity.parts) {
    if (IsSameInEveryRun(part.name)) own -= part.share;
  }
  return std::max(0.0, own);
}

bool OutlastsTheRun(const std::string& quantity) {
  return !quantity.starts_with("setups[");
}

}  // namespace twinbench::uncertainty

#include "twin/benches/turntable_autocollimator/estimators/lost_harmonics.h"

#include <numeric>

namespace twinbench::separate::turntable {

int CommonSteps(int n, const std::vector<int>& shifts) {
  int common = n;
  for (const int shift : shifts) common = std::gcd(common, shift - shifts.front());
  return common;
}

int CommonSteps(const StopGrid& grid) {
  int common = grid.n;
  for (const SetUp& a : grid.setups) {
    for (const SetUp& b : grid.setups) {
      if (a.row == b.row) common = std::gcd(common, a.shift - b.shift);
    }
  }
  return common;
}

std::vector<int> LostHarmonics(int n, int common_steps) {
  std::vector<int> lost;
  for (int order = n / common_steps; order <= n / 2; order += n / common_steps) lost.push_back(order);
  return lost;
}

}  // namespace twinbench::separate::turntable

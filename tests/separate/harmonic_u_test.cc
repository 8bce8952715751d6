#include "twin/benches/rotary_4dof/estimators/harmonic_u.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/separate/bench.h"
#include "twin/benches/rotary_4dof/estimators/separator.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

TEST(HarmonicUncertainties, AreThoseOfTheClosedFormOfTheShifts) {
  // An amplitude's variance is 2 / (n m) that of a reading, times 1 / (1 - |S_k|^2 / m^2).
  const int n = 12;
  const std::vector<int> shifts = {0, 1, 4};
  const auto motions = EmptyMotions(n, shifts, 1, Matrix4::Identity());
  const TableEstimate target = Separator(motions, Bench(), Options(n, Clamping::kReseat)).Separate(motions).target;
  const std::vector<double> u = HarmonicUncertainties(target, Component::kEz);
  ASSERT_EQ(u.size(), 6u);
  const auto m = static_cast<double>(shifts.size());
  for (int k = 1; k < n / 2; ++k) {
    std::complex<double> sum = 0.0;
    for (const int s : shifts) sum += std::polar(1.0, 2.0 * units::kPi * k * s / n);
    const double expected = std::sqrt(2.0 / (n * m) / (1.0 - std::norm(sum) / (m * m)));
    EXPECT_NEAR(u[static_cast<std::size_t>(k) - 1], expected, 1e-3 * expected) << k;
  }
}

TEST(HarmonicUncertainties, OfAComponentThatIsNotDeterminedAreNotKnown) {
  const auto motions = EmptyMotions(12, {0, 1}, 1, Matrix4::Identity());
  const TableEstimate target = Separator(motions, Bench(), Options(12, Clamping::kReclamp)).Separate(motions).target;
  for (const double u : HarmonicUncertainties(target, Component::kDy)) EXPECT_TRUE(std::isnan(u));
}

}  // namespace
}  // namespace twinbench::separate

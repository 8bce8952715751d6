#include "tests/foreign/grating_stand.h"

#include <gtest/gtest.h>

#include "tests/support/oracle_poses.h"
#include "twin/core/units.h"

namespace twinbench::foreign {
namespace {

TableError ErrorOf(const test::OracleError& e) {
  return {e[0], e[1], e[2], e[3], e[4], e[5]};
}

TEST(GratingStand, ShinesWhereTheIndependentPosesSay) {
  const std::vector<test::OraclePose> poses = test::OraclePoses();
  ASSERT_GT(poses.size(), 100U);
  for (const test::OraclePose& pose : poses) {
    const Stacking stacking{pose.target_rad,      pose.reference_rad,      pose.shift_rad, !pose.is_reclamped,
                            ErrorOf(pose.target), ErrorOf(pose.reference), {}};
    const Spots spots = ShineOn(GratingOn(stacking), {});
    const std::array found_m{spots.u_a_m, spots.v_a_m, spots.u_b_m, spots.v_b_m};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found_m[k], pose.spots_m[k], 1e-5 * units::um) << k;
  }
}

}  // namespace
}  // namespace twinbench::foreign

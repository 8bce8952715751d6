#include "twin/procedure/step_proof.h"

#include <gtest/gtest.h>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

/// x goes by `x` where it should go by 1, y by `y` where it should stand; no noise but a hundredth.
std::vector<ColumnInStep> Went(double x, double y, double should = 1.0) {
  return {{"x", should, x, 0.01}, {"y", 0.0, y, 0.01}};
}

bool IsProved(StepProof& proof, const std::vector<ColumnInStep>& columns) {
  try {
    proof.Require(columns);
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kMoved);
    return false;
  }
  return true;
}

TEST(StepProof, WhatIsShownGoesAsFarAsItShouldAndNothingElseGoes) {
  StepProof proof(false);
  EXPECT_TRUE(IsProved(proof, Went(1.2, 0.2)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 0.0)));  // it stands
  EXPECT_FALSE(IsProved(proof, Went(-1.0, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 1.0)));  // channels are exchanged
  EXPECT_FALSE(IsProved(proof, Went(1e-3, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(206.0 / 1000.0, 0.0)));  // microradians for arc seconds
  EXPECT_FALSE(IsProved(proof, Went(kNaN, 0.0)));
  EXPECT_TRUE(IsProved(proof, Went(1.0, 0.0)));
}

TEST(StepProof, SignsAndGainsOfWiresAreWhatTheFirstStepSaysThatNeitherStandsNorIsExchanged) {
  StepProof proof(true);
  EXPECT_FALSE(IsProved(proof, Went(0.0, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 1.0)));
  EXPECT_FALSE(IsProved(proof, Went(1e-3, 0.0)));
  EXPECT_TRUE(IsProved(proof, Went(-0.5, 0.1)));
  EXPECT_TRUE(IsProved(proof, Went(0.5, -0.1, -1.0)));  // the other way
  EXPECT_FALSE(IsProved(proof, Went(0.5, 0.1)));
  EXPECT_FALSE(IsProved(proof, Went(-1.0, 0.1)));
}

TEST(StepProof, BehindComingBackAllIsShownAsBefore) {
  StepProof proof(false);
  const auto came_back = [](double off) { return std::vector<ColumnInStep>{{"x", 1.0, 1.0, 0.01, true, off}, {"y", 0.0, 0.0, 0.01}}; };
  EXPECT_TRUE(IsProved(proof, came_back(0.3)));
  EXPECT_FALSE(IsProved(proof, came_back(1.0)));
  EXPECT_FALSE(IsProved(proof, came_back(-0.5)));
  EXPECT_FALSE(IsProved(proof, came_back(kNaN)));
}

TEST(StepProof, OfASizeThatNobodyKnowsTheSignIsSureWhereNoiseLeavesIt) {
  StepProof proof(false);
  const auto went = [](double did) { return std::vector<ColumnInStep>{{"x", 1.0, did, 0.01, false}}; };
  EXPECT_TRUE(IsProved(proof, went(20.0)));
  EXPECT_TRUE(IsProved(proof, went(-0.1)));
  EXPECT_FALSE(IsProved(proof, went(-0.2)));
}

}  // namespace
}  // namespace twinbench::procedure

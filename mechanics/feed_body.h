#pragma once

#include <Eigen/Core>
#include <memory>

#include "mechanics/feed_parameters.h"
#include "mechanics/plant.h"

namespace twinbench::mechanics {

/// Place and speed of the nut (the screw's angle times lead / 2 pi), of the slide; the speed controller's integral.
using FeedVector = Eigen::Matrix<double, 5, 1>;
inline constexpr int kNut = 0, kNutSpeed = 1, kSlide = 2, kSlideSpeed = 3, kIntegral = 4;

/// Slide and screw for one servo period under a constant force of the drive. The integral is left as it is.
class FeedBody {
 public:
  virtual ~FeedBody() = default;

  virtual FeedVector Step(const FeedVector& at, double drive_N, Bristles& bristles) = 0;

  /// Without play and with a friction that is given: linear in all three.
  virtual FeedVector StepPressed(const FeedVector& at, double drive_N, double friction_N) = 0;
};

std::unique_ptr<FeedBody> MakeLinearFeedBody(const FeedDriveParameters& parameters);
std::unique_ptr<FeedBody> MakeBulletFeedBody(const FeedDriveParameters& parameters);

}  // namespace twinbench::mechanics

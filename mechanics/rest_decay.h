#pragma once

#include <vector>

#include "mechanics/servo.h"
#include "mechanics/stack_propagator.h"

/// What is left of a motion once both commands rest and the drives are linear: it decays by itself, and any number
/// of servo periods of that is one product.
namespace twinbench::mechanics {

/// One servo period of stack and controllers is a linear map P of the distance to rest; P^n is put together from
/// P^1, P^2, P^4, ... So a stack that stands costs nothing until it is looked at, and nothing is cut off.
class RestDecay {
 public:
  static constexpr int kSize = 2 * kCoordinates + 2;
  using Distance = Eigen::Matrix<double, kSize, 1>;  // of the state (rotors' angles too), then of the integrals

  RestDecay(const StackParameters& parameters, const StackPropagator& propagator);

  /// Distance after `periods`; zero once it is below a hundredth of what rounding leaves (1e-18 m, rad) for ever.
  Distance After(const Distance& from, std::int64_t periods) const;

  /// How many periods from now the distance is zero, rounded up to a power of two.
  std::int64_t Gone(const Distance& from) const;

 private:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  static constexpr int kPowers = 15;  // 2^14 periods are 8 s; slower loops than that do not settle

  std::vector<Matrix> power_;  // P^(2^k)
};

}  // namespace twinbench::mechanics

#include "mechanics/base_response.h"

#include <Eigen/LU>
#include <numbers>

#include "mechanics/matrices.h"
#include "mechanics/require.h"
#include "mechanics/servo.h"
#include "mechanics/stack_propagator.h"

namespace twinbench::mechanics {
namespace {

using Complex = std::complex<double>;

Complex ServoStiffness(const ServoGains& gains, Complex p) {
  return gains.proportional_Nm_rad + gains.derivative_Nm_s_rad * p + gains.integral_Nm_rad_s / p;
}

}  // namespace

ComplexResponse RespondToBase(const StackParameters& parameters, double frequency_Hz) {
  RequirePositive(frequency_Hz, "base response: frequency_Hz");
  const StackParameters stack = InPayloadFrame(parameters);
  StackDynamics dynamics(stack);
  const Matrix12 mass = InverseOf(dynamics.InverseMass(Vector12::Zero()));
  const Complex p(0.0, 2.0 * std::numbers::pi * frequency_Hz);
  Eigen::Matrix<Complex, kCoordinates, kCoordinates> stiffness = p * p * mass;
  stiffness.diagonal() += p * BearingDamping(stack) + BearingStiffness(stack).cast<Complex>();
  const Eigen::Matrix2d inertia = SpinInertia(stack);
  for (int t = 0; t < 2; ++t) {
    const double servo_Hz = stack.table[static_cast<std::size_t>(t)].servo_Hz;
    stiffness(SpinIndex(t), SpinIndex(t)) += ServoStiffness(ServoGains::For(inertia(t, t), servo_Hz), p);
  }
  return stiffness.partialPivLu().solve(-mass.leftCols<3>().cast<Complex>());
}

}  // namespace twinbench::mechanics

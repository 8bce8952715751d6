#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "mechanics/feed_body.h"

namespace twinbench::mechanics {

/// A feed drive whose slide slips one way while the command goes round a circle at a constant rate. Then a servo
/// period is a linear map A of the state, and the bristles stand at the bend at which they slip. Over n periods,
/// with the command's phasor C, and with a friction that goes from F0 to F1 at the rate D,
///
///   state(n) = A^n (state(0) - Z C0 - p F0 - q D) + Z C1 + p F1 + q D
///
/// where Z C, p F and q D are the steady answers to the circle, to a constant friction and to one that grows. A is
/// measured at the body itself, so that a leap ends where single steps do, but for the curvature of the friction
/// within it.
class CalmFeed {
 public:
  /// @throws std::invalid_argument if A does not decay: the drive would swing up by itself.
  CalmFeed(const FeedDriveParameters& parameters, FeedBody& body);

  /// The circle to come. @param rate_rad_s  Not zero.
  void SetRate(double rate_rad_s);

  /// State of a drive that has long followed; friction and play included. @param command_m  Phasor: its real part
  /// is the commanded coordinate.
  FeedVector Steady(std::complex<double> command_m) const;
  double SteadyBend_m(std::complex<double> command_m) const;

  /// How many periods may be taken at once from here: 0 if a reversal is near, bristles are not at their bend, a
  /// flank is not pressed or the speed is not steady.
  int Periods(const FeedVector& at, double bend_m, std::complex<double> command_m, int most) const;

  FeedVector Leap(const FeedVector& at, std::complex<double> from_m, std::complex<double> to_m, int periods) const;

  struct Rested {
    FeedVector at;
    double bend_m;
    int periods;
  };
  /// At a command that rests, once no more than 10 nm are left to go. Bristles then are a spring that gives as far
  /// as they are not yet bent, and all is linear but for a thousandth of those 10 nm.
  /// @return nothing if more is left to go, or if the slide lies free in its play.
  std::optional<Rested> Rest(const FeedVector& at, double bend_m, double command_m, int most) const;

 private:
  using Matrix = Eigen::Matrix<double, 5, 5>;
  struct Slip {
    double speed_m_s, acceleration_m_s2;
  };

  /// Bristles near rest.
  struct Spring {
    double gives;  // share of their stiffness: that which is not yet bent the way the slide goes
    double bent_N;
  };

  FeedVector Period(FeedBody& body, const FeedVector& at, double command_m, double command_m_s,
                    double friction_N) const;
  Slip SlipOf(std::complex<double> command_m) const;
  double Bend_m(const Slip& slip) const;
  double Friction_N(const Slip& slip) const;
  bool Pressed(const Slip& slip) const;
  bool BendsLate(const Slip& slip) const;
  Spring SpringOf(double bend_m, double speed_m_s) const;
  Matrix MapOnSpring(double gives) const;
  bool StaysPressed(const FeedVector& from, const FeedVector& to) const;
  FeedVector Circle(std::complex<double> command_m) const { return (response_ * command_m).real(); }
  /// Of the play on the side to which the nut pushes: taken out of the state it is one without play.
  FeedVector Play(double sense) const;

  FeedDriveParameters p_;
  BristleLaw law_;
  std::vector<Matrix> powers_;  // A^1, A^2, A^4, ...
  FeedVector by_command_, by_command_rate_, by_friction_;
  FeedVector constant_, growing_;  // p, q
  double rate_rad_s_ = 0.0;
  Eigen::Matrix<std::complex<double>, 5, 1> response_;  // Z
};

}  // namespace twinbench::mechanics

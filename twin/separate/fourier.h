#pragma once

#include <Eigen/Core>
#include <memory>

namespace twinbench::separate {

/// Discrete Fourier transforms of one length, n log n for every n.
///
/// A length whose prime factors are small (36 000 = 2^5 3^2 5^3) is transformed by its factors, which costs n times
/// their sum (Cooley & Tukey, Math. Comp. 19 (1965) 297). One with a prime factor above 64 becomes a convolution of
/// a power of two, at least 2 n - 1 long (Bluestein, IEEE Trans. Audio 18 (1970) 451): some six times slower than a
/// smooth length, and as accurate to a digit. One object must not be used by two threads at once.
class Fourier {
 public:
  /// @throws std::logic_error unless n > 0.
  explicit Fourier(int n);
  ~Fourier();
  Fourier(Fourier&&) noexcept;
  Fourier& operator=(Fourier&&) noexcept;

  int n() const;
  /// X_k = sum over i of x_i exp(-2 pi j k i / n)
  Eigen::VectorXcd Forward(const Eigen::VectorXcd& x) const;
  /// x_i = sum over k of X_k exp(2 pi j k i / n); n times what Forward has undone.
  Eigen::VectorXcd Backward(const Eigen::VectorXcd& X) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// Largest prime factor of n; 1 of 1.
int LargestPrimeFactor(int n);

}  // namespace twinbench::separate

#include "twin/separate/fourier.h"

#include <complex>
#include <unsupported/Eigen/FFT>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr int kLargestFactor = 64;  // above it a convolution of a power of two is faster

int PowerOfTwoAbove(int least) {
  int power = 1;
  while (power < least) power *= 2;
  return power;
}

/// exp(-j pi i^2 / n); i^2 is reduced in integers, so that a large n loses no digits.
Eigen::VectorXcd Chirp(int n) {
  Eigen::VectorXcd chirp(n);
  for (long long i = 0; i < n; ++i) {
    chirp[static_cast<Eigen::Index>(i)] = std::polar(1.0, -units::kPi * static_cast<double>(i * i % (2LL * n)) / n);
  }
  return chirp;
}

}  // namespace

struct Fourier::Plan {
  int n = 0;
  int length = 0;              // of the transforms that are done: n, or a power of two
  Eigen::FFT<double> fft;      // keeps its factors
  Eigen::VectorXcd chirp;      // empty where n is transformed itself
  Eigen::VectorXcd convolver;  // transform of the chirp's conjugate, over the length

  explicit Plan(int points) : n(points), length(points) {
    fft.SetFlag(Eigen::FFT<double>::Unscaled);
    if (LargestPrimeFactor(n) <= kLargestFactor) return;
    length = PowerOfTwoAbove(2 * n - 1);
    chirp = Chirp(n);
    Eigen::VectorXcd kernel = Eigen::VectorXcd::Zero(length);
    kernel.head(n) = chirp.conjugate();
    for (int i = 1; i < n; ++i) kernel[length - i] = kernel[i];
    convolver.resize(length);
    fft.fwd(convolver, kernel);
    convolver /= length;
  }

  /// k i = (k^2 + i^2 - (k - i)^2) / 2 makes the transform a convolution with the chirp.
  Eigen::VectorXcd Convolved(const Eigen::VectorXcd& x) {
    Eigen::VectorXcd padded = Eigen::VectorXcd::Zero(length), transform(length);
    padded.head(n) = x.cwiseProduct(chirp);
    fft.fwd(transform, padded);
    transform = transform.cwiseProduct(convolver).eval();
    fft.inv(padded, transform);
    return padded.head(n).cwiseProduct(chirp);
  }
};

Fourier::Fourier(int n) {
  Require(n > 0, "a Fourier transform has at least one point");
  plan_ = std::make_unique<Plan>(n);
}

Fourier::~Fourier() = default;
Fourier::Fourier(Fourier&&) noexcept = default;
Fourier& Fourier::operator=(Fourier&&) noexcept = default;

int Fourier::n() const {
  return plan_->n;
}

Eigen::VectorXcd Fourier::Forward(const Eigen::VectorXcd& x) const {
  Require(x.size() == plan_->n, "one value a point");
  if (plan_->n == 1) return x;  // the library wants a factor
  if (plan_->chirp.size() > 0) return plan_->Convolved(x);
  Eigen::VectorXcd X(plan_->n);
  plan_->fft.fwd(X, x);
  return X;
}

Eigen::VectorXcd Fourier::Backward(const Eigen::VectorXcd& X) const {
  Require(X.size() == plan_->n, "one value a harmonic");
  if (plan_->n == 1) return X;
  if (plan_->chirp.size() > 0) return plan_->Convolved(X.conjugate()).conjugate();
  Eigen::VectorXcd x(plan_->n);
  plan_->fft.inv(x, X);
  return x;
}

int LargestPrimeFactor(int n) {
  int largest = 1;
  for (int factor = 2; n > 1; ++factor) {
    if (factor > n / factor) factor = n;  // what is left has no factor
    for (; n % factor == 0; n /= factor) largest = factor;
  }
  return largest;
}

}  // namespace twinbench::separate

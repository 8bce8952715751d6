#pragma once

#include <complex>
#include <limits>
#include <vector>

/// Two curves read against each other: r_j(i) = a(i) + b(i + s_j) + what is free in set-up j, at n even stops i of
/// a full circle and for shifts s_j of whole stops. Where b was read at places between the stops too, every row of
/// such places is a curve b of its own. docs/theory.md, 11.
namespace twinbench::separate::shifts {

/// Shifts of the set-ups, and the weight (1 / variance) that every reading of a set-up has.
struct ShiftSet {
  int n = 0;
  std::vector<int> shifts;      // in stops, of any sign
  std::vector<double> weights;  // positive
  std::vector<int> rows = {};   // which curve b each set-up meets, from 0 on; empty: all the same

  int Rows() const;
  /// The set-ups of one row, as a set that has no other.
  ShiftSet OfRow(int row) const;
};

/// What the set-ups together say of one harmonic of both curves: their normal matrix is
/// [W, S; conj(S), W] for (a_k, b_k), X_k = sum_i x_i exp(-2 pi j k i / n).
struct HarmonicTransfer {
  int order = 0;
  double total = 0.0;              // W, sum of the weights
  std::complex<double> sum = 0.0;  // S_k = sum_j w_j exp(2 pi j k s_j / n)
  double determinant = 0.0;        // W^2 - |S_k|^2, all its digits right also where it is 1e-9 of W^2
  bool lost = false;               // every shift shows it alike: no reading tells a_k from b_k

  /// Variance of a_k, or b_k, in units of 1 / W, what the readings would leave if one curve were known:
  /// 1 / (1 - |S_k|^2 / W^2). 1 is the best there is, infinite is lost. (Multi-step method: Evans, Hocken & Estler,
  /// CIRP Annals 45 (1996) 617.)
  double VarianceFactor() const {
    return lost ? std::numeric_limits<double>::infinity() : total * total / determinant;
  }
};

/// Greatest common divisor of n and all differences of shifts within a row: the stops fall into so many classes that
/// no set-up connects, and the harmonics that are multiples of n divided by it are lost.
int CommonDivisor(const ShiftSet& set);

/// Harmonics 1 to n / 2 that are lost.
std::vector<int> LostHarmonics(const ShiftSet& set);

/// Harmonics 0 to n / 2 of a set of one row. Cost: n times the number of shifts.
/// @throws std::logic_error if there is no set-up, more than one row, or a weight is not positive.
std::vector<HarmonicTransfer> Transfers(const ShiftSet& set);

}  // namespace twinbench::separate::shifts

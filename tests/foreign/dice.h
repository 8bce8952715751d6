#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace twinbench::foreign {

/// Random numbers of the standard library: those of the twin play no part in foreign cases.
class Dice {
 public:
  /// @param purpose  "noise", "schedule", ...: one cause, one sequence.
  Dice(std::uint64_t seed, const std::string& purpose) {
    std::vector<std::uint32_t> words(purpose.begin(), purpose.end());
    words.push_back(static_cast<std::uint32_t>(seed));
    words.push_back(static_cast<std::uint32_t>(seed >> 32U));
    std::seed_seq sequence(words.begin(), words.end());
    engine_.seed(sequence);
  }

  double Between(double lower, double upper) { return std::uniform_real_distribution(lower, upper)(engine_); }
  /// Evenly in the logarithm.
  double Sized(double lower, double upper) { return lower * std::pow(upper / lower, Between(0.0, 1.0)); }
  int Whole(int first, int last) { return std::uniform_int_distribution(first, last)(engine_); }
  double Normal() { return std::normal_distribution()(engine_); }
  double Student(double degrees_of_freedom) { return std::student_t_distribution(degrees_of_freedom)(engine_); }
  double ChiSquared(double degrees_of_freedom) {
    return std::chi_squared_distribution(degrees_of_freedom)(engine_);
  }
  double Phase() { return Between(0.0, 2.0 * M_PI); }
  double Sign() { return Whole(0, 1) == 1 ? 1.0 : -1.0; }

  template <class T>
  const T& OneOf(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(Whole(0, static_cast<int>(choices.size()) - 1))];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace twinbench::foreign

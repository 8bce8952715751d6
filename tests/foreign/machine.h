#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// Machines with something wrong that nobody told the program of: made from the published form of readings and from
/// closed forms, with neither the twin nor its signals.
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

/// What the noise of a run is like, and what happens to readings behind it.
struct NoiseShape {
  std::string name;
  double size = 1.0;                // over what the bench states, or its usual size
  double degrees_of_freedom = 0.0;  // of Student's t; 0: Gaussian
  double correlation = 0.0;         // of neighbouring readings
  double step = 0.0;                // of a quantiser, in usual sizes; 0: none
  double missing = 0.0;             // share of the readings that are lost
};

/// The ways in which runs with nothing wrong are put under stress.
inline std::vector<NoiseShape> Stresses() {
  std::vector<NoiseShape> all = {{"noise x 0.5", 0.5}, {"noise x 2", 2.0}, {"Student t, 3 dof", 1.0, 3.0},
                                 {"AR(1) 0.5", 1.0, 0.0, 0.5}, {"rows missing", 1.0, 0.0, 0.0, 0.0, 0.15}};
  for (const double step : {0.5, 2.0, 5.0, 20.0})
    all.push_back(
        {"quantised at " + std::to_string(step).substr(0, step < 10.0 ? 3 : 4) + " sigma", 1.0, 0.0, 0.0, step});
  return all;
}

/// One channel's noise, in usual sizes, reading by reading.
class NoiseSeries {
 public:
  NoiseSeries(NoiseShape shape, Dice dice) : shape_(std::move(shape)), dice_(std::move(dice)), last_(Fresh()) {}
  double Next() {
    const double r = shape_.correlation;
    last_ = r * last_ + std::sqrt(1.0 - r * r) * Fresh();
    return shape_.size * last_;
  }

 private:
  /// Student's t as it is, not brought to a variance of one: its middle is as wide as that of the normal noise.
  double Fresh() {
    return shape_.degrees_of_freedom > 0.0 ? dice_.Student(shape_.degrees_of_freedom) : dice_.Normal();
  }
  NoiseShape shape_;
  Dice dice_;
  double last_;
};

inline double Quantised(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

/// Names of the catalogue: "backlash", or with the place that it must have: "psd_gain psd_a_x".
using Names = std::vector<std::string>;

/// What is wrong, and which answers are honest.
struct Truth {
  std::string kind;  // "warm-up"; of several "eccentricity + warm-up"
  std::vector<Names> listed =
      {};                   // causes of the catalogue: its name first, then those that no reading tells from it
  int unlisted = 0;         // causes that the catalogue lacks
  Names honest = {};        // further names that are near enough: "drift" of a warm-up
  bool only_noise = false;  // the noise is unusual and nothing else: silence is right as well
  bool repeats = true;      // another run of the machine shows the same

  bool IsClean() const { return listed.empty() && unlisted == 0; }
};

/// One run of a machine.
struct Run {
  std::uint64_t seed = 1;  // of its schedule and its noise
  bool noise = true;
  bool faults = true;  // false: the same machine in order
};

inline constexpr Run kFirst{1};
inline constexpr Run kAnother{2};
inline constexpr Run kAnotherWithoutNoise{2, false, true};

struct Machine {
  Truth truth;
  Scenario believed;
  std::function<std::vector<Reading>(const Run&)> readings;
  std::function<Scenario(Scenario)> in_another_run = [](Scenario scenario) { return scenario; };  // its schedule
};

/// A machine before it is made.
struct Plan {
  std::string set, name;
  std::function<Machine()> make;
};

/// One that the catalogue lacks.
inline Truth Unlisted(Names honest = {}) {
  Truth truth;
  truth.unlisted = 1;
  truth.honest = std::move(honest);
  return truth;
}
inline Truth Listed(Names names) {
  Truth truth;
  truth.listed = {std::move(names)};
  return truth;
}

/// Puts the faults of a machine together.
inline void Append(const Truth& more, Truth& truth) {
  const bool is_first = truth.kind.empty();
  truth.only_noise = is_first && more.only_noise;
  truth.kind += (is_first ? "" : " + ") + more.kind;
  truth.listed.insert(truth.listed.end(), more.listed.begin(), more.listed.end());
  truth.honest.insert(truth.honest.end(), more.honest.begin(), more.honest.end());
  truth.unlisted += more.unlisted;
  truth.repeats = truth.repeats && more.repeats;
}

/// The size at which `length` of it is `wanted`, or as near as sizes between the bounds come. Bisection in the
/// logarithm, because faults like clipping do not grow with their size in proportion.
inline double SizeOfLength(double wanted, double smallest, double largest,
                           const std::function<double(double size)>& length) {
  constexpr int kHalvings = 40;
  double low = smallest, high = largest;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = std::sqrt(low * high);
    (length(middle) < wanted ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace twinbench::foreign

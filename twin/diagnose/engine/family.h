#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

/// Candidates of the search: families of signatures, one a cause and place, or a generic shape for the unknown.
namespace twinbench::diagnose {

enum class Kind { kNamed, kUnknown };

/// A parameter in which the signature is linear.
struct Amplitude {
  std::string name;  // of the effect catalogue
  std::string unit;
  double to_SI = 1.0;
  double prior_sd = 1.0;  // SI: plausible before checking
  double lower, upper;    // SI, physical bounds
};

/// A parameter in which it is not: time constant, frequency, onset. One value a grid point.
struct Shape {
  std::string name;
  std::string unit;
  double to_SI = 1.0;
  double lower, upper;        // SI
  std::vector<double> value;  // SI
};

struct Family {
  Kind kind = Kind::kNamed;
  std::string effect, where;    // unknown: name of the shape and what it shows on
  std::string group;            // families of one group share one prior mass: the effect, or the sort of unknown
  std::vector<Amplitude> amplitudes;
  std::vector<Shape> shapes;    // all of equal length; empty: one grid point
  int grid = 1;                 // number of grid points

  /// Signature at a grid point: rows x amplitudes, SI of the readings per SI of the amplitude, not whitened.
  std::function<Eigen::MatrixXd(int)> columns;

  /// Describes a fitted member of an unknown family in the grammar of docs/diagnosis.md.
  std::function<std::string(int grid_point, const Eigen::VectorXd& amplitudes)> describe;
};

}  // namespace twinbench::diagnose

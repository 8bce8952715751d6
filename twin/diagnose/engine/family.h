#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/tuning.h"

/// Candidates of the search: families of signatures, one a cause and place, or a generic shape for the unknown.
namespace twinbench::diagnose {

enum class Kind { kNamed, kUnknown };

/// A parameter in which the signature is linear.
struct Amplitude {
  std::string name;  // of the effect catalogue
  std::string unit;
  double to_SI = 1.0;
  double prior_sd = 1.0;                         // SI: plausible before checking
  double lower = -kInfinity, upper = kInfinity;  // SI, physical bounds

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
};

/// A parameter in which it is not: time constant, frequency, onset. One value a grid point.
struct Shape {
  std::string name;
  std::string unit;
  double to_SI = 1.0;
  double lower, upper;        // SI
  std::vector<double> value;  // SI
  bool is_inside = false;     // at a bound the signature is that of another cause: this one is not named there
};

/// A column of a series as an [[effect]] "signal" that a twin can carry out.
struct Product {
  EffectSettings signal;  // without size; `where` is empty if it shows on every channel of the family's pattern
  int column = 0;         // of a wave: its cosine, with its sine behind
  bool is_wave = false;
  double scale = 1.0;  // size of the signal per amplitude of the column
};

struct Family {
  Kind kind = Kind::kNamed;
  std::string effect, where;  // unknown: name of the shape and what it shows on
  std::string same_as;        // unknown: the effect that has just this shape where it shows on the same; empty: none
  std::string group;          // families of one group share one prior mass: the effect, or the sort of unknown
  double prior_weight = 1.0;  // within the group
  /// Share of what looks exactly so that is this cause, and nothing that no catalogue of ours lists: less than
  /// usual for a wrong scale of a whole PSD, which looks like its distance, or a device off centre, which looks
  /// like a reference off centre.
  double listed = tuning::kListed;
  std::vector<Amplitude> amplitudes;
  std::vector<Shape> shapes;  // all of equal length; empty: one grid point
  int grid = 1;               // number of grid points

  /// Signature at a grid point: rows x amplitudes, SI of the readings per SI of the amplitude, not whitened.
  std::function<Eigen::MatrixXd(int grid_point)> columns;

  /// Or, cheaper where families share it: columns = base columns * map.
  std::shared_ptr<const Base> base;
  Eigen::MatrixXd map;

  /// The signature at any shape (one value a Shape), to refine what the grid found; empty: the grid is all there
  /// is.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& shape)> at;

  /// The catalogue's parameters from fitted amplitudes; empty: amplitudes and shapes are these parameters.
  /// @param cov  Of the amplitudes, and of the shape after them.
  std::function<std::vector<ParameterEstimate>(const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes,
                                               const Eigen::MatrixXd& cov)>
      parameters;

  /// What a fitted member of an unknown family is as signals; empty: nothing that predicts another run.
  std::function<std::vector<Product>(const Eigen::VectorXd& shape, int grid_point)> products;

  /// One value at a time on each channel, whatever the bench does: without products it is tabulated by time.
  bool goes_by_time = false;
  /// So many columns in time that they follow nearly anything: what has a form is tried first.
  bool takes_any_course = false;
  /// The size that is fitted is that of the trace which the cause leaves, whatever its shape.
  bool size_is_of_trace = false;

  /// Describes a fitted member of an unknown family in the grammar of docs/diagnosis.md.
  /// @param shape  As it was refined; empty without shapes.
  std::function<std::string(int grid_point, const Eigen::VectorXd& amplitudes, const Eigen::VectorXd& shape)> describe;

  /// A cause that is a wave of a whole order.
  bool IsWholeOrder() const { return kind == Kind::kNamed && !at && amplitudes.front().name == "cosine"; }
  Eigen::MatrixXd ColumnsAt(int grid_point) const {
    return base ? base->Columns(grid_point) * map : columns(grid_point);
  }
  Eigen::VectorXd ShapeAt(int grid_point) const;
};

/// Standard deviation of a shape parameter from the `cov` that Family::parameters gets; NaN if it has none.
inline double ShapeDeviation(const Family& family, std::size_t k, const Eigen::MatrixXd& cov) {
  const auto at = static_cast<Eigen::Index>(family.amplitudes.size() + k);
  return at < cov.cols() ? std::sqrt(cov(at, at)) : std::numeric_limits<double>::quiet_NaN();
}

inline Eigen::VectorXd Family::ShapeAt(int grid_point) const {
  Eigen::VectorXd shape(std::ssize(shapes));
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    shape[static_cast<Eigen::Index>(k)] = shapes[k].value[static_cast<std::size_t>(grid_point)];
  }
  return shape;
}

}  // namespace twinbench::diagnose

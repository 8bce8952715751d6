#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "twin/separate/index_errors.h"

/// Which harmonics a table's index errors have, and which of them could as well be others.
namespace twinbench::separate {

struct LineSearchOptions {
  int highest_order = 200;  // lines above it are taken not to exist
  double certain = 0.95;    // least probability of an order among those that look alike
};

/// An order that a line could have as well, seen from where the errors were read.
struct AlikeOrder {
  int order = 0;
  double probability = kNaN;
};

/// cos_rad cos(order angle) + sin_rad sin(order angle) in the errors.
struct IndexLine {
  int order = 0;  // the likeliest
  double cos_rad = kNaN, sin_rad = kNaN;
  double u_rad = kNaN;            // of either, the larger; not below what differs between turns
  double probability = kNaN;      // of this order among those alike; they sum to 1
  std::vector<AlikeOrder> alike;  // the others above a thousandth, likeliest first
  double log_odds = kNaN;         // of a line, against none
  bool is_half_seen = false;      // one phase of it changes no value: half the places of an even grid
  bool changes = false;           // smaller than what it differs by between turns (IndexErrors::u_order_rad) allows
  bool is_certain = false;        // fully seen, and its probability reaches LineSearchOptions::certain

  double Amplitude_rad() const { return std::hypot(cos_rad, sin_rad); }
  double At(double angle_rad) const {
    return cos_rad * std::cos(order * angle_rad) + sin_rad * std::sin(order * angle_rad);
  }
};

struct LineFit {
  std::vector<IndexLine> lines;  // by order
  std::vector<int> unseen;       // orders of which no phase, or only one, changes a value there
  std::vector<int> doubled;      // orders that look just like another one there
  double residual_rad = kNaN;    // standard deviation of a mean of one reading's weight beside the lines
  int dof = 0;
};

/// Finds the lines one after another, each by its evidence, and looks at every one again with all others in the
/// model.
///
/// A line of order k has prior probability proportional to 1 / k^2: index errors come from eccentricity and
/// ovality of rings and bearings first, and from teeth of gears as exceptions. Its evidence is the Bayesian
/// information criterion's; the size of the noise is known as well as repeats tell it, and no better than four
/// times as well as what is left says. On even positions order n - k looks like order k; there the prior alone
/// decides, and only orders below about n / 8 are certain.
///
/// Uncertainty: from the residuals. Not included: errors of the reference that have the same order.
/// Reference: Schwarz, Annals of Statistics 6 (1978) 461-464; orthogonal matching pursuit, Pati et al. (1993).
/// @throws InputError if there are fewer than 8 places.
LineFit FindLines(const IndexErrors& errors, const LineSearchOptions& options = {});

/// [cos(order angle), sin(order angle)] at every place.
Eigen::MatrixXd ColumnsOf(const IndexErrors& errors, int order);

/// One column of ones for each group.
Eigen::MatrixXd GroupColumns(const IndexErrors& errors);

/// Of one reading: noise, and what stays at a place.
double VarianceOfOne_rad2(const IndexErrors& errors);

/// Square roots of the weights of the places: 1 for a reading's mean whose noise is that of one reading.
Eigen::VectorXd WeightRootsOf(const IndexErrors& errors);

}  // namespace twinbench::separate

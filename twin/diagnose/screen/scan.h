#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/significance.h"

namespace twinbench::diagnose::screen {

/// Alternatives to be tried on every channel: orders, frequencies, onsets. Each has `width` columns (2 for cosine
/// and sine), each with a free amplitude in each channel.
struct Scan {
  struct Item {
    std::string words;
    std::vector<Eigen::MatrixXd> shape;  // readings x width: one for all channels, or one a channel
  };

  std::string test;
  int width = 1;
  std::vector<Item> items = {};

  /// @param words  Arguments of the test's item in the table of words.
  template <typename... Args>
  void Add(std::vector<Eigen::MatrixXd> shape_by_channel, const Args&... words) {
    items.push_back({ItemOf(test, words...), std::move(shape_by_channel)});
  }
  template <typename... Args>
  void Add(Eigen::MatrixXd shape, const Args&... words) {
    Add(std::vector{std::move(shape)}, words...);
  }
};

/// Least squares of one item, in the space that the free unknowns leave. Amplitude k of channel c stands at
/// c * width + k, in SI of the reading per unit of the shape.
struct Fit {
  int width = 1;
  Eigen::MatrixXd information;  // S' W S, whitened
  Eigen::VectorXd before;       // diagonal of S' S: before projection
  Eigen::MatrixXd gradient;     // S' W y, a column each y

  Eigen::RowVectorXd chi2;    // what the item explains
  int dof = 0;                // directions that survive the projection
  Eigen::VectorXd amplitude;  // in the first y

  /// The fit with amplitudes restricted to `constraint` times fewer ones.
  Fit Constrained(const Eigen::MatrixXd& constraint, int new_width) const;
};

/// Fits an item to the run itself.
Fit FitItem(const Sample& sample, const Scan& scan, int item);

/// Standard normal deviate as improbable as chi2 of `dof` degrees of freedom (Wilson and Hilferty 1931).
double NormalScore(double chi2, int dof);

/// Normal score of what each item explains in each column: items x columns. An item of which the free unknowns
/// leave less than 1e-3 in every direction scores -infinity.
Eigen::MatrixXd Scores(const Sample& sample, const Scan& scan);

/// Gives a test size and words. A pattern or channel is named if it alone explains most of what free amplitudes in
/// all channels explain beyond noise; a channel only, where items have a shape of their own on each.
void Describe(const Sample& sample, const Fit& fit, bool one_shape, const std::string& item, ScreenTest& test);

/// The largest score of a scan, and the fit of that item to the run; nothing if the free unknowns absorb every
/// item.
struct Scanned {
  ScreenTest test;
  int item = 0;
  Fit fit;
};
std::optional<Scanned> Strongest(const Sample& sample, const Scan& scan);

/// Adds its test.
void TestScan(const Sample& sample, const Scan& scan, Tests& tests);

}  // namespace twinbench::diagnose::screen

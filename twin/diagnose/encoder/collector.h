#pragma once

#include <set>
#include <string>
#include <vector>

#include "twin/diagnose/encoder/family_parts.h"

/// How the generic families are made; only the files that make them need it.
namespace twinbench::diagnose::encoder {

using Words = std::function<std::string(int grid_point)>;

/// Collects generic families.
class Collector {
 public:
  Collector(const Context& context, const std::vector<std::string>& covered)
      : context_(context), covered_(covered.begin(), covered.end()) {}

  const SignalContext& context() const { return *context_; }
  bool Covered(const std::string& effect) const { return covered_.contains(effect); }

  /// @param columns  Dimensionless: amplitudes are angles.
  Family& Add(const std::string& sort, int grid, const Columns& columns, const Words& words);

  /// One family without a grid.
  void Add(const std::string& sort, const Eigen::MatrixXd& columns, const std::string& words);
  /// A grid over one continuous shape.
  /// @param columns  The same as `at` on the grid, where there is a quicker way to them.
  void AddOver(const std::string& sort, const Shape& shape, const ColumnsAt& at, const Words& words,
               const Columns& columns = {});

  std::vector<Family> Take() { return std::move(families_); }

 private:
  Context context_;
  std::set<std::string> covered_;
  std::vector<Family> families_;
};

/// Divided by its rms, so that an amplitude is an angle.
Eigen::VectorXd Unit(const Eigen::VectorXd& signal);

/// Time from 0 to 1 over the run.
Eigen::VectorXd Fraction(const SignalContext& context);

/// Waves of the whole orders up to `last` times a factor of each reading.
/// @param words  "{}" is the order.
void AddModulated(Collector& collect, const std::string& sort, int last, const Eigen::VectorXd& factor,
                  const std::string& words);

// Generic families of one lock each.
void AddInTime(Collector& collect);
void AddByPassAndSetUp(Collector& collect);
void AddSpeeds(Collector& collect);

}  // namespace twinbench::diagnose::encoder

#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/turntable/named_parts.h"

/// How the generic families are made; only the files that make them need it.
namespace twinbench::diagnose::turntable {

/// Grid point -> readings x k, each of rms about one.
using Signals = std::function<Eigen::MatrixXd(int grid_point)>;
using Words = std::function<std::string(int grid_point)>;

inline constexpr const char* kBothAxes = "x, y";

/// Collects generic families.
class Collector {
 public:
  Collector(const TurntableRun& turntable, const Context& context) : turntable_(turntable), context_(context) {}

  const TurntableRun& turntable() const { return turntable_; }
  const Context& context() const { return context_; }
  const Schedule& schedule() const { return context_->schedule; }

  /// The same signals on x, on y, and on both with amplitudes of their own.
  void Add(const std::string& sort, int grid, const Signals& signals, const Words& words);
  /// The same without a grid.
  void Add(const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words);
  /// On one axis only.
  void AddOn(int axis, const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words);

  std::vector<Family> Take() { return std::move(families_); }

 private:
  Family& New(const std::string& sort, const std::string& where, Eigen::Index amplitudes, const Words& words);

  const TurntableRun& turntable_;
  Context context_;
  std::vector<Family> families_;
};

/// Divided by its rms.
Eigen::VectorXd Unit(const Eigen::VectorXd& signal);

/// Each row of `columns` times the entry of `factor`.
Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor);

/// Indicators of the values that a label takes in circles and verifications: readings x values, ascending.
Eigen::MatrixXd Indicators(const Collector& collect, const std::vector<int>& label);

/// Time from 0 to 1 over the run.
Eigen::VectorXd Fraction(const Schedule& schedule);

/// The largest order that the positions of a full circle can show, at most 12.
int LargestOrder(const TurntableRun& turntable);

// Generic families of one lock each.
void AddByAngle(Collector& collect);
void AddByDirection(Collector& collect);
void AddByPass(Collector& collect);
void AddInTime(Collector& collect);
void AddByReading(Collector& collect);

}  // namespace twinbench::diagnose::turntable

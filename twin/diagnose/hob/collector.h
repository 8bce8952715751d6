#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/hob/family_parts.h"

/// How the generic families are made; only the files that make them need it.
namespace twinbench::diagnose::hob {

using Words = std::function<std::string(int grid_point)>;

/// A sort of structure without a name.
struct Sort {
  std::string name;     // families of one sort share one prior mass
  double weight = 1.0;  // less if a named cause has this shape exactly
};
inline constexpr double kSameShape = 0.2;

/// Collects generic families: each on both channels, on the encoders' alone and on the interferometer's alone, as
/// far as they are there.
class Collector {
 public:
  explicit Collector(const Common& common) : common_(common) {}

  const Common& common() const { return common_; }
  const SignalContext& context() const { return *common_.context; }

  void Add(const Sort& sort, const SharedBase& base, const Words& words);

  /// One shape, samples x k.
  void Add(const Sort& sort, const Eigen::MatrixXd& series, const std::string& words);

  /// A grid over one continuous shape.
  void AddOver(const Sort& sort, const Shape& shape, const SharedBase& base, const SeriesAt& at,
               const Words& words);

  /// Waves of orders 1 to `last` of the table times a factor of each sample. @param words  "{}" is the order.
  void AddModulated(const Sort& sort, int last, const Eigen::VectorXd& factor, const std::string& words);

  std::vector<Family> Take() { return std::move(families_); }

 private:
  Family Make(const Sort& sort, const SharedBase& base, Seen seen, const Words& words) const;

  const Common& common_;
  std::vector<Family> families_;
};

/// Divided by its rms, so that an amplitude is an angle.
Eigen::VectorXd Unit(const Eigen::VectorXd& signal);

// Generic families of one lock each.
void AddByAngle(Collector& collect);
void AddByDirection(Collector& collect);
void AddInTime(Collector& collect);
void AddByMounting(Collector& collect);
void AddBySpeed(Collector& collect);

}  // namespace twinbench::diagnose::hob

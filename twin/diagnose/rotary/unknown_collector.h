#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/units.h"
#include "twin/diagnose/rotary/families.h"

/// How the generic families of the rotary bench are made; only the files that make them need it.
namespace twinbench::diagnose::rotary {

inline constexpr double kPlausible_m = 0.5 * units::um;  // of a disturbance on a PSD
inline constexpr double kPlausibleShare = 0.005;         // of a wrong scale

/// Grid point -> readings x k, each of rms about one.
using Signals = std::function<Eigen::MatrixXd(int grid_point)>;
using Words = std::function<std::string(int grid_point)>;

/// Collects generic families. Keeps references to its arguments, and so do the families.
class Collector {
 public:
  Collector(const RotaryRun& rotary, const SignalContext& context)
      : rotary_(rotary), context_(context), places_(PlacesOf(rotary.shown_by_motion)) {}

  const RotaryRun& rotary() const { return rotary_; }
  const Schedule& schedule() const { return rotary_.run.schedule; }
  const SignalContext& context() const { return context_; }
  const std::vector<Place>& places() const { return places_; }

  /// The same signals on every place, and on all channels independently.
  void Add(const std::string& sort, int grid, const Signals& signals, const Words& words);
  /// The same without a grid.
  void Add(const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words);
  /// On every place only.
  /// @return what these families are combinations of.
  std::shared_ptr<const Base> AddOnPlaces(const std::string& sort, int grid, const Signals& signals,
                                          const Words& words);
  /// On one place: base columns * map.
  void AddAt(const std::string& where, const std::string& sort, const std::shared_ptr<const Base>& base,
             const Eigen::MatrixXd& map, const Words& words);
  /// On one channel with signals of its own: rows of the others are zero.
  void AddOnChannel(int channel, const std::string& sort, int grid, double plausible_m, const Signals& signals,
                    const Words& words);
  /// The same without a grid.
  void AddOnChannel(int channel, const std::string& sort, double plausible_m, const Eigen::MatrixXd& signals,
                    const std::string& words);

  /// A family that still needs a signature and words.
  Family& New(const std::string& where, const std::string& sort, const Amplitude& amplitude, Eigen::Index count);

  std::vector<Family> Take() { return std::move(families_); }

 private:
  const RotaryRun& rotary_;
  const SignalContext& context_;
  std::vector<Place> places_;
  std::vector<Family> families_;
};

/// Divided by its rms.
Eigen::VectorXd Unit(Eigen::VectorXd signal);

/// Indicators of the values that a label takes, times `factor` of each reading: readings x values, ascending.
Eigen::MatrixXd Indicators(const std::vector<int>& label, const Eigen::VectorXd& factor);

/// cos and sin of the angle, times `factor` of each reading: readings x 2.
Eigen::MatrixXd Wave(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& factor);

// Generic families of one lock each.
void AddByPass(Collector& collect);
void AddByDirection(Collector& collect);
void AddByAngle(Collector& collect);
void AddInTime(Collector& collect);
void AddByDwell(Collector& collect);
void AddGains(Collector& collect);
void AddBySpot(Collector& collect);
void AddOtherPatterns(Collector& collect, const SharedSeries& series);

}  // namespace twinbench::diagnose::rotary

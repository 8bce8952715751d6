#include "twin/benches/freeform_five_axis/estimators/pose_terms.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Vector3d;

constexpr std::array<char, 6> kOfBody = {'X', 'Y', 'Z', 'A', 'B', 'C'};  // what a body can err in
constexpr std::array<const char*, 6> kOfSetUp = {"x", "y", "z", "rx", "ry", "rz"};
constexpr double kArcsec_um_m = units::arcsec / units::um;  // what an arcsec moves at the end of a metre
constexpr double kMoves_m = 1e-3;                           // a linear axis that goes less shows nothing

std::string UnitOfError(std::size_t error) {
  return error < 3 ? "um" : "arcsec";
}

/// What one um or arcsec of a body's error moves at the end of a lever, both in machine axes.
Vector3d Moved_um(std::size_t error, const Eigen::Matrix3d& frame, const Vector3d& lever_m) {
  const Vector3d along = frame.col(static_cast<Eigen::Index>(error % 3));
  return error < 3 ? along : Vector3d(kArcsec_um_m * along.cross(lever_m));
}

/// Of a rotary axis: a table moves the ball, a head the tool.
std::function<Vector3d(const PosePlace&)> OfStage(std::size_t stage, bool on_table, std::size_t error,
                                                  int order = 0, bool is_sine = false) {
  return [=](const PosePlace& place) -> Vector3d {
    const StageAt& at = place.stages[stage];
    const double course = is_sine ? std::sin(order * at.turned_rad) : std::cos(order * at.turned_rad);
    return (on_table ? course : -course) * Moved_um(error, at.frame, at.lever_m);
  };
}

bool IsAlong(std::size_t error, const RotaryStage& stage) {
  return static_cast<int>(error % 3) == stage.axis;
}

void AddMountings(const std::vector<PosePlace>& places, bool is_rigid, std::vector<PoseTerm>& terms) {
  std::set<int> balls;
  for (const PosePlace& place : places) balls.insert(place.ball);
  for (const int ball : balls) {
    for (std::size_t error = 0; error < (is_rigid ? 6U : 3U); ++error)
      terms.push_back({TermKind::kMounting, kOfSetUp[error], UnitOfError(error), 0, ball, false, false,
                       [error, ball](const PosePlace& place) -> Vector3d {
                         return place.ball == ball ? Moved_um(error, place.table, place.table * place.ball_m)
                                                   : Vector3d::Zero();
                       }});
  }
}

void AddTool(std::vector<PoseTerm>& terms) {
  for (std::size_t error = 0; error < 3; ++error)
    terms.push_back(
        {TermKind::kTool, kOfSetUp[error], "um", 0, 0, false, false, [error](const PosePlace& place) -> Vector3d {
           return -place.head.col(static_cast<Eigen::Index>(error));
         }});
}

/// Zeros are set, not found: neither a place along an axis nor an angle about it is an error of its line. The
/// slides' coordinates are those of the first axis that they carry.
void AddLocations(const MachineChain& chain, bool of_tables, std::vector<PoseTerm>& terms) {
  for (std::size_t k = 0; k < chain.stages.size(); ++k) {
    const RotaryStage& stage = chain.stages[k];
    for (std::size_t error = 0; error < kOfBody.size(); ++error) {
      const bool is_origin = error < 3 && !stage.on_table && (k == 0 || chain.stages[k - 1].on_table);
      if (IsAlong(error, stage) || stage.on_table != of_tables || is_origin) continue;
      terms.push_back({TermKind::kLocation, fmt::format("{}O{}", kOfBody[error], stage.Letter()),
                       UnitOfError(error), 0, 0, false, false, OfStage(k, stage.on_table, error)});
    }
  }
}

struct Travel {
  double low_m, high_m;
  bool IsGone() const { return high_m - low_m > kMoves_m; }
  double At(double x_m) const { return (2.0 * x_m - low_m - high_m) / (high_m - low_m); }
};

Travel TravelOf(const std::vector<PosePlace>& places, int axis) {
  const auto [low, high] = std::ranges::minmax(places, {}, [axis](const PosePlace& p) { return p.slides_m[axis]; });
  return {low.slides_m[axis], high.slides_m[axis]};
}

/// The slides move the tool. X is the first direction, Y the second.
void AddSquareness(const std::vector<PosePlace>& places, std::vector<PoseTerm>& terms) {
  const auto add = [&](const char* name, int axis, int moved, double sign) {
    if (!TravelOf(places, axis).IsGone()) return;
    terms.push_back(
        {TermKind::kSquareness, name, "arcsec", 0, 0, false, true, [=](const PosePlace& place) -> Vector3d {
           return -sign * kArcsec_um_m * place.slides_m[axis] * Vector3d::Unit(moved);
         }});
  };
  add("COY", 1, 0, -1.0);
  add("BOZ", 2, 0, 1.0);
  add("AOZ", 2, 1, -1.0);
}

double Legendre(int order, double t) {
  return order == 1 ? t : order == 2 ? 1.5 * t * t - 0.5 : (2.5 * t * t - 1.5) * t;
}

/// Order 1 along the axis is its scale, across it the squareness above. Angular errors of linear axes are none of
/// these: which lever they have is not in the poses.
void AddLinear(const std::vector<PosePlace>& places, int order, std::vector<PoseTerm>& terms) {
  for (int axis = 0; axis < 3; ++axis) {
    const Travel travel = TravelOf(places, axis);
    if (!travel.IsGone()) continue;
    for (int along = 0; along < 3; ++along) {
      if (order == 1 && along != axis) continue;
      terms.push_back(
          {TermKind::kComponent,
           fmt::format("E{}{}", kOfBody[static_cast<std::size_t>(along)], kOfBody[static_cast<std::size_t>(axis)]),
           order == 1 ? "um_m" : "um", order, 0, false, true, [=](const PosePlace& place) -> Vector3d {
             const double x_m = place.slides_m[axis];
             return -(order == 1 ? x_m : Legendre(order, travel.At(x_m))) * Vector3d::Unit(along);
           }});
    }
  }
}

/// Of the tool against the table, in machine axes.
void AddDrift(std::vector<PoseTerm>& terms) {
  constexpr int kHighest = 3;
  for (int order = 1; order <= kHighest; ++order) {
    for (int along = 0; along < 3; ++along)
      terms.push_back({TermKind::kDrift, kOfSetUp[static_cast<std::size_t>(along)], "um", order, 0, false, false,
                       [=](const PosePlace& place) -> Vector3d {
                         return (Legendre(order, place.elapsed) - Legendre(order, -1.0)) * Vector3d::Unit(along);
                       },
                       true});
  }
}

/// Orders of which an axis' angles are enough: two and more a period.
int HighestOrderOf(const std::vector<PosePlace>& places, std::size_t stage) {
  std::set<long> angles;
  for (const PosePlace& place : places) angles.insert(std::lround(place.stages[stage].turned_rad / units::arcsec));
  return (static_cast<int>(angles.size()) - 1) / 2;
}

void AddComponents(const MachineChain& chain, const std::vector<PosePlace>& places, int order, bool of_turns,
                   std::vector<PoseTerm>& terms) {
  for (std::size_t k = 0; k < chain.stages.size(); ++k) {
    const bool is_beyond = order > HighestOrderOf(places, k);
    for (std::size_t error = of_turns ? 3 : 0; error < (of_turns ? 6U : 3U); ++error) {
      for (const bool is_sine : {false, true})
        terms.push_back({TermKind::kComponent, fmt::format("E{}{}", kOfBody[error], chain.stages[k].Letter()),
                         UnitOfError(error), order, 0, is_sine, false,
                         OfStage(k, chain.stages[k].on_table, error, order, is_sine), is_beyond});
    }
  }
}

}  // namespace

std::string PoseTerm::Words() const {
  if (kind == TermKind::kMounting) return fmt::format("where ball {} stands ({})", ball, name);
  if (kind == TermKind::kTool) return fmt::format("the tool's point ({})", name);
  if (kind == TermKind::kDrift) return fmt::format("a drift along {}", name);
  if (IsLocation()) return name;
  return order == 1 && is_of_linear ? name + " in proportion" : fmt::format("{} order {}", name, order);
}

std::vector<PoseTerm> TermsOf(const MachineChain& chain, const std::vector<PosePlace>& places, int highest_order,
                              int possible_order, bool is_rigid) {
  constexpr int kHighestOfLinear = 3;
  std::vector<PoseTerm> terms;
  AddMountings(places, is_rigid, terms);
  AddLocations(chain, true, terms);
  if (chain.HasHead()) AddTool(terms);
  AddLocations(chain, false, terms);
  AddSquareness(places, terms);
  AddLinear(places, 1, terms);
  for (const bool of_turns : {false, true})
    for (int order = 1; order <= possible_order; ++order) AddComponents(chain, places, order, of_turns, terms);
  for (int order = 2; order <= std::min(kHighestOfLinear, possible_order); ++order) AddLinear(places, order, terms);
  for (PoseTerm& term : terms)
    term.is_beyond |= term.kind == TermKind::kComponent && term.order > std::max(1, highest_order);
  std::stable_partition(terms.begin(), terms.end(), [](const PoseTerm& term) { return !term.is_beyond; });
  AddDrift(terms);
  return terms;
}

}  // namespace twinbench::benches::freeform::estimators

#include "twin/benches/rotary_4dof/estimators/design.h"

#include <cmath>
#include <set>
#include <string>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr double kTurn = 2.0 * units::kPi;
constexpr double kGridTolerance = 1e-3;  // of a step
constexpr int kFewestPositions = 3;

double Wrapped(double angle_rad, double period_rad) {
  const double rest = std::fmod(angle_rad, period_rad);
  return rest < 0.0 ? rest + period_rad : rest;
}

bool IsUsable(const Motion& m) {
  return m.phase == Phase::kFullCircle && m.status == ReadingStatus::kOk;
}

int CountPositions(const std::vector<Motion>& motions) {
  std::set<long long> distinct;
  for (const Motion& m : motions) {
    if (m.phase == Phase::kFullCircle)
      distinct.insert(std::llround(Wrapped(m.target_rad, kTurn) / kTurn * 1e6) % 1000000);
  }
  return static_cast<int>(distinct.size());
}

/// Angle of position 0 in [0, step): 0 unless the first angle lies visibly off the grid.
double GridOffset(double angle_rad, double step_rad) {
  const double rest = Wrapped(angle_rad, step_rad);
  return std::min(rest, step_rad - rest) < kGridTolerance * step_rad ? 0.0 : rest;
}

int GridIndex(double angle_rad, double offset_rad, const Design& design, const Motion& motion) {
  const double steps = (angle_rad - offset_rad) / design.Step_rad();
  if (!(std::abs(steps - std::round(steps)) < kGridTolerance)) {
    throw InputError("reading " + std::to_string(motion.reading), "an angle that is not on the grid of positions",
                     "full-circle angles in steps of 360 deg / " + std::to_string(design.n));
  }
  return static_cast<int>(((std::llround(steps) % design.n) + design.n) % design.n);
}

Clamping ClampingOf(int label, const LayoutOptions& options) {
  const auto found = options.clamping_of_setup.find(label);
  return found == options.clamping_of_setup.end() ? options.clamping : found->second;
}

/// Index of the motion's set-up; makes it at its first motion.
int FindSetUp(Design& design, const Motion& motion, int shift, const LayoutOptions& options) {
  for (std::size_t s = 0; s < design.setups.size(); ++s) {
    if (design.setups[s].label != motion.setup) continue;
    if (design.setups[s].shift == shift) return static_cast<int>(s);
    throw InputError("reading " + std::to_string(motion.reading),
                     "target + reference angle differs inside mounting " + std::to_string(motion.setup),
                     "a reference that turns back by the target's step");
  }
  const Clamping clamping = ClampingOf(motion.setup, options);
  const double sum_rad = shift * design.Step_rad() + design.target_offset_rad + design.reference_offset_rad;
  design.setups.push_back({motion.setup, shift, clamping == Clamping::kReclamp ? sum_rad : 0.0, clamping});
  return static_cast<int>(design.setups.size()) - 1;
}

Design EmptyDesign(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                   const LayoutOptions& options) {
  Design design;
  design.n = options.positions > 0 ? options.positions : CountPositions(motions);
  if (design.n < kFewestPositions) throw InputError("readings", "fewer than 3 positions", "a full circle");
  design.target_height_m = geometry.SpotFromTarget().z();
  design.reference_height_m = geometry.grating_point_m.z();
  return design;
}

}  // namespace

double Design::Step_rad() const {
  return kTurn / n;
}

int Design::Column(Series series, int position) const {
  const int s = static_cast<int>(series);
  return s < kTargetSeries ? kTargetSeries * position + s
                           : kTargetSeries * n + (kSeries - kTargetSeries) * position + s - kTargetSeries;
}

int Design::MountColumn(int setup) const {
  return kSeries * n + kMountUnknowns * setup;
}

int Design::SeatColumn(int setup) const {
  int column = kSeries * n + kMountUnknowns * static_cast<int>(setups.size());
  for (int s = 0; s < setup; ++s) {
    if (setups[static_cast<std::size_t>(s)].clamping == Clamping::kReseat) column += kSeatUnknowns;
  }
  return column;
}

int Design::Unknowns() const {
  return SeatColumn(static_cast<int>(setups.size()));
}

Stop Design::StopAt(const SetUp& setup, int target) const {
  const double target_rad = TargetAngle_rad(target);
  const double reference_rad = ReferenceAngle_rad(ReferencePosition(setup, target));
  const bool reclamp = setup.clamping == Clamping::kReclamp;
  const double sum_rad = target_rad + reference_rad;
  return {target_rad, reference_rad, reclamp ? 0.0 : -sum_rad, reclamp ? sum_rad : 0.0};
}

Eigen::Matrix<double, measure::kDofs, kSeries> SeriesCoefficients(const Design& design, const SetUp& setup) {
  const double c = std::cos(setup.rho_rad), s = std::sin(setup.rho_rad);
  const double hT = design.target_height_m / kLengthUnit_m, hR = design.reference_height_m / kLengthUnit_m;
  Eigen::Matrix<double, measure::kDofs, kSeries> d;
  //   target: ex  ey   ez   dy    reference: ex      ey      ez   dx   dy
  d << /* ez */ 0, 0.0, 1.0, 0.0, /*       */ 0.0, /**/ 0.0, 1.0, 0.0, 0.0,  //
      /* ex */ 1.0, 0.0, 0.0, 0.0, /*      */ c, /*  */ -s, 0.0, 0.0, 0.0,   //
      /* ey */ 0.0, 1.0, 0.0, 0.0, /*      */ s, /*   */ c, 0.0, 0.0, 0.0,   //
      /* dy */ -hT, 0.0, 0.0, 1.0, /* */ -hR * c, hR * s, 0.0, s, c;
  return d;
}

Matrix4 SeatCoefficients(const Design& design, double target_rad) {
  const double c = std::cos(target_rad), s = std::sin(target_rad);
  const double hR = design.reference_height_m / kLengthUnit_m;
  Matrix4 d;
  d << 0.0, 0.0, 0.0, 0.0,  //
      c, -s, 0.0, 0.0,      //
      s, c, 0.0, 0.0,       //
      -hR * c, hR * s, s, c;
  return d;
}

StopModel ModelStop(const Design& design, int setup, int target) {
  const SetUp& s = design.setups[static_cast<std::size_t>(setup)];
  StopModel model;
  const auto add = [&model](int column, const Vector4& d) {
    model.column[static_cast<std::size_t>(model.columns)] = column;
    model.d.col(model.columns++) = d;
  };
  const auto series = SeriesCoefficients(design, s);
  for (int k = 0; k < kSeries; ++k) {
    const int position = k < kTargetSeries ? target : design.ReferencePosition(s, target);
    add(design.Column(static_cast<Series>(k), position), series.col(k));
  }
  for (int k = 0; k < kMountUnknowns; ++k) add(design.MountColumn(setup) + k, Vector4::Unit(k));
  if (s.clamping == Clamping::kReclamp) return model;
  const Matrix4 seat = SeatCoefficients(design, design.TargetAngle_rad(target));
  for (int k = 0; k < kSeatUnknowns; ++k) add(design.SeatColumn(setup) + k, seat.col(k));
  return model;
}

Layout FindLayout(const std::vector<Motion>& motions, const BenchGeometry& geometry, const LayoutOptions& options) {
  Layout layout{EmptyDesign(motions, geometry, options), {}};
  Design& design = layout.design;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Motion& m = motions[i];
    if (!IsUsable(m)) continue;
    if (layout.samples.empty()) {
      design.target_offset_rad = GridOffset(m.target_rad, design.Step_rad());
      design.reference_offset_rad = GridOffset(m.reference_rad, design.Step_rad());
    }
    const int target = GridIndex(m.target_rad, design.target_offset_rad, design, m);
    const int reference = GridIndex(m.reference_rad, design.reference_offset_rad, design, m);
    const int setup = FindSetUp(design, m, (target + reference) % design.n, options);
    layout.samples.push_back({i, setup, target, reference});
  }
  if (layout.samples.empty()) throw InputError("readings", "no usable full-circle reading", "at least one mounting");
  return layout;
}

}  // namespace twinbench::separate

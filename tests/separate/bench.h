#pragma once

#include "tests/support/rotary_scenario.h"
#include "tests/support/separated_table.h"
#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/benches/rotary_4dof/estimators/residuals.h"
#include "twin/benches/rotary_4dof/estimators/separator.h"
#include "twin/core/stream.h"

/// What the tests of this room share: the reference bench, designs, motions made straight from table errors.
namespace twinbench::separate {

inline BenchGeometry Bench() { return measure::NominalGeometry(test::RotaryScenario()); }

/// Without Abbe levers: dy has nothing to do with the wobble.
inline BenchGeometry FlatBench() {
  BenchGeometry flat = Bench();
  flat.grating_point_m.z() = flat.reference_height_m = 0.0;
  return flat;
}

inline LayoutOptions Layouts(int n, Clamping clamping) { return {n, clamping, {}}; }

inline SeparateOptions Options(int n, Clamping clamping, Estimator estimator = Estimator::kRigorous) {
  return {.estimator = estimator, .layout = Layouts(n, clamping)};
}

/// Errors of both tables at their n positions, ascending own angle.
struct Truth {
  TableErrors target;
  TableErrors reference;
};

inline TableErrors ZeroErrors(int n) {
  TableErrors e;
  for (int i = 0; i < n; ++i) e.position_rad.push_back(i * 2.0 * units::kPi / n);
  for (auto& column : e.value) column.assign(static_cast<std::size_t>(n), 0.0);
  return e;
}

/// White errors of about 5 arcsec and 3 um.
inline TableErrors RandomErrors(int n, Stream& stream) {
  TableErrors e = ZeroErrors(n);
  for (int c = 0; c < kComponents; ++c) {
    const double unit = IsAngle(static_cast<Component>(c)) ? 5.0 * units::arcsec : 3.0 * units::um;
    for (double& v : e.value[static_cast<std::size_t>(c)]) v = unit * stream.Normal();
  }
  return e;
}

inline Truth RandomTruth(int n, Stream& stream) { return {RandomErrors(n, stream), RandomErrors(n, stream)}; }

/// Full circles of motions with zero values: every shift is a set-up, every pass goes through all stops.
inline std::vector<Motion> EmptyMotions(int n, const std::vector<int>& shifts, int passes, const Matrix4& cov) {
  std::vector<Motion> motions;
  const double step_rad = 2.0 * units::kPi / n;
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    for (int k = 0; k < passes * n; ++k) {
      Motion m{.reading = static_cast<int>(motions.size()), .setup = static_cast<int>(s), .pass = k / n,
               .position = k % n};
      m.target_rad = m.position * step_rad;
      m.reference_rad = shifts[s] * step_rad - m.target_rad;
      m.status = ReadingStatus::kOk;
      m.SetValues(Vector4::Zero());
      m.cov = cov;
      m.cov_systematic.setZero();
      m.d_calibration.setZero();
      m.covariance_known = true;
      motions.push_back(m);
    }
  }
  return motions;
}

/// 0.3 um on every PSD axis.
inline Matrix4 ReadingCovariance() { return Vector4(1.7e-6, 0.9e-6, 4.5e-6, 0.54e-6).cwiseAbs2().asDiagonal(); }

inline Vector6 ErrorsAt(const TableErrors& e, int position) {
  Vector6 v;
  for (int c = 0; c < kComponents; ++c)
    v[c] = e.value[static_cast<std::size_t>(c)][static_cast<std::size_t>(position)];
  return v;
}

/// Sets each motion to what the exact chain gives.
inline void FillExact(std::vector<Motion>& motions, const Truth& truth, const LayoutOptions& options,
                      const BenchGeometry& geometry) {
  const Layout layout = FindLayout(motions, geometry, options);
  for (const Sample& sample : layout.samples) {
    const SetUp& setup = layout.design.setups[static_cast<std::size_t>(sample.setup)];
    PoseErrors errors{.target = ErrorsAt(truth.target, sample.target),
                      .reference = ErrorsAt(truth.reference, sample.reference)};
    motions[sample.motion].SetValues(
        MotionOf(GratingPose(layout.design.StopAt(setup, sample.target), errors, geometry)));
  }
}

/// The entries of one table that contain a component.
inline std::vector<NotSeparable> LossesOf(const std::vector<NotSeparable>& lost, Table table, Component component) {
  std::vector<NotSeparable> found;
  std::ranges::copy_if(lost, std::back_inserter(found), [&](const NotSeparable& e) {
    return e.table == table && std::ranges::count(e.components, component) > 0;
  });
  return found;
}

/// Orders lost of one component, sorted; {-999} stands for all.
inline std::vector<int> LostOrders(const std::vector<NotSeparable>& lost, Table table, Component component) {
  std::vector<int> orders;
  for (const NotSeparable& e : LossesOf(lost, table, component)) {
    if (e.all) return {-999};
    orders.insert(orders.end(), e.orders.begin(), e.orders.end());
  }
  std::sort(orders.begin(), orders.end());
  return orders;
}

/// Full circles that read what the exact chain makes of tables of random errors.
struct ExactCircles {
  Truth truth;
  std::vector<Motion> motions;
};

inline ExactCircles ReadExactly(int n, const std::vector<int>& shifts, Clamping clamping, int passes = 1,
                                const BenchGeometry& geometry = Bench()) {
  Stream stream(11, "test.truth");
  ExactCircles c{RandomTruth(n, stream), EmptyMotions(n, shifts, passes, ReadingCovariance())};
  FillExact(c.motions, c.truth, Layouts(n, clamping), geometry);
  return c;
}

/// The readings' stops and their weights.
struct WeightedStops {
  Layout layout;
  Weights weights;
  std::vector<StopModel> models;

  Eigen::MatrixXd Null() const { return NullSpace(layout.design, FindSeparability(layout.design).orders); }
  /// As one matrix.
  Eigen::MatrixXd Normal() const {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(layout.design.Unknowns(), layout.design.Unknowns());
    for (std::size_t k = 0; k < models.size(); ++k) {
      const StopModel& m = models[k];
      const std::vector<int> columns(m.column.begin(), m.column.begin() + m.columns);
      const Eigen::MatrixXd d = m.d.leftCols(m.columns);
      normal(columns, columns) += d.transpose() * weights.cells[k].weight * d;
    }
    return normal;
  }
};

inline WeightedStops Weigh(const std::vector<Motion>& motions, const LayoutOptions& options,
                           const Vector4& scale = Vector4::Ones()) {
  WeightedStops stops{FindLayout(motions, Bench(), options), {}, {}};
  stops.weights = CollectWeights(motions, stops.layout, Bench(), scale);
  for (const Cell& cell : stops.weights.cells) stops.models.push_back(ModelStop(stops.layout.design, cell.setup, cell.target));
  return stops;
}

inline Design MakeDesign(int n, const std::vector<int>& shifts, Clamping clamping, const BenchGeometry& geometry) {
  return FindLayout(EmptyMotions(n, shifts, 1, Matrix4::Identity()), geometry, Layouts(n, clamping)).design;
}

}  // namespace twinbench::separate

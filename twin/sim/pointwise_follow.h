#pragma once

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/model/follow.h"

/// What the twins that follow a record have in common, whatever their bench: disturbances become what they add to
/// each reading.
namespace twinbench::sim {

/// A point of a bench: either it enters a reading, or it is a constant of the bench.
template <class Extra>
struct BenchPoint {
  model::Point point;
  double& (*of_reading)(Extra&) = nullptr;   // this ...
  double& (*of_bench)(Scenario&) = nullptr;  // ... or this
};

/// The scenario without chance and without single outliers, which nobody can foresee, and without what was
/// tabulated by the readings of another record.
Scenario Foreseeable(Scenario scenario, const std::vector<Reading>& record);

/// Errors of a table are what a run leaves free.
void LeaveFree(TableSettings& table);

/// Bullet gives way to the linear model, which has the same following error, settling and ring-down: in the window
/// of a reading they differ by less than 0.01 nm on the grating.
void WithoutBullet(MechanicsSettings& mechanics);

/// @tparam Extra  What disturbances add to one reading of the bench.
template <class Extra>
class PointwiseFollow : public model::Follow {
 public:
  PointwiseFollow(Scenario scenario, const std::vector<Reading>& record,
                  const std::vector<BenchPoint<Extra>>& bench_points)
      : scenario_(std::move(scenario)), record_(record), bench_points_(bench_points) {
    for (const BenchPoint<Extra>& p : bench_points_) points_.push_back(p.point);
  }

  const std::vector<model::Point>& Points() const override { return points_; }
  Eigen::Index Readings() const override { return std::ssize(record_); }

  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& disturbances) const override {
    std::vector<Extra> extra(record_.size());
    std::vector<const model::Disturbance*> of_bench;
    for (const model::Disturbance& d : disturbances) {
      Require(d.value.size() == std::ssize(record_), "a disturbance has one value a reading");
      const BenchPoint<Extra>& point = PointOf(d.point);
      if (point.of_bench) of_bench.push_back(&d);
      if (!point.of_reading) continue;
      for (std::size_t i = 0; i < extra.size(); ++i)
        point.of_reading(extra[i]) += d.value[static_cast<Eigen::Index>(i)];
    }
    Eigen::MatrixXd shown = Shown(extra);
    // A constant of the bench, changed from reading to reading: to first order.
    for (const model::Disturbance* d : of_bench) shown += d->value.asDiagonal() * BenchSlope(PointOf(d->point));
    return shown;
  }

 protected:
  /// Readings x channels.
  virtual Eigen::MatrixXd Shown(const std::vector<Extra>& extra) const = 0;
  /// The same record on a bench with other constants.
  virtual std::unique_ptr<model::Follow> On(const Scenario& changed) const = 0;

  const Scenario& scenario() const { return scenario_; }
  const std::vector<Reading>& record() const { return record_; }

 private:
  const BenchPoint<Extra>& PointOf(const std::string& name) const {
    const auto found =
        std::ranges::find(bench_points_, name, [](const BenchPoint<Extra>& p) { return p.point.name; });
    Require(found != bench_points_.end(), "the bench has no point of that name");
    return *found;
  }

  Eigen::MatrixXd BenchSlope(const BenchPoint<Extra>& point) const {
    Scenario below = scenario_, above = scenario_;
    double& low = point.of_bench(below);
    double& high = point.of_bench(above);
    low = std::max(low - point.point.step, point.point.lower);
    high += point.point.step;
    return (On(above)->Predict() - On(below)->Predict()) / (high - low);
  }

  Scenario scenario_;
  std::vector<Reading> record_;
  const std::vector<BenchPoint<Extra>>& bench_points_;
  std::vector<model::Point> points_;
};

}  // namespace twinbench::sim

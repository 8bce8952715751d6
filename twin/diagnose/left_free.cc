#include "twin/diagnose/left_free.h"

#include <cmath>
#include <memory>

#include "twin/model/signals.h"

namespace twinbench::diagnose {

std::vector<FreePoint> FreeOf(const Compared& c, const TwinComparison& comparison) {
  std::vector<FreePoint> points;
  const auto add = [&](const std::string& point, const Eigen::MatrixXd& courses, const std::string& of, double sd) {
    points.push_back({c.twin.Point(point), courses, of, sd});
    if (comparison.free_sd && !(sd > 0.0)) points.back().sd = comparison.free_sd(points.back().point);
  };
  if (comparison.free_places) {
    for (const std::string& point : comparison.free_places->points) {
      add(point, model::Indicators(comparison.free_places->place(c.used)), comparison.free_places->of, kNaN);
      points.back().is_local = true;
    }
  }
  for (const std::string& point : comparison.free_points)
    add(point, model::Indicators(c.run.schedule.setup), "a mounting", kNaN);
  for (const TwinComparison::FreeCourses& of_bench : comparison.free_courses)
    add(of_bench.point, of_bench.courses(c.used), of_bench.of, of_bench.sd);
  return points;
}

void AddKnown(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison,
              Compared& c) {
  Nuisance& nuisance = c.run.nuisance;
  const Eigen::Index free = nuisance.jacobian.cols(), known = std::ssize(comparison.known);
  Eigen::MatrixXd columns(c.run.Rows(), free + known);
  columns.leftCols(free) = nuisance.jacobian;
  nuisance.prior_precision.conservativeResize(free + known);
  for (Eigen::Index k = 0; k < known; ++k) {
    const TwinComparison::KnownConstant& one = comparison.known[static_cast<std::size_t>(k)];
    const auto shown = [&](double value) {
      Scenario with = scenario;
      with.effects.push_back({one.effect, one.where, {{one.parameter, value}}, ""});
      const Followed twin(comparison.follow, with, readings, c.used, c.run.Channels());
      return c.Rows(twin.Predict(c.free.Disturbances()));
    };
    columns.col(free + k) = (shown(one.sd) - shown(-one.sd)) / (2.0 * one.sd);
    nuisance.prior_precision[free + k] = std::pow(one.sd, -2);
  }
  nuisance.jacobian = columns.sparseView();
  if (nuisance.at.size() > 0) nuisance.at.conservativeResizeLike(Eigen::VectorXd::Zero(free + known));
}

LeftByAnother LeftByAnotherOf(const Compared& c, const std::vector<Reading>& readings,
                              const TwinComparison& comparison) {
  struct Asked {
    std::vector<Reading> readings, used;
    FreeConstants free;
    Eigen::VectorXd observed;
    Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
    int channels;
  };
  const auto asked = std::make_shared<const Asked>(
      Asked{readings, c.used, c.free, c.run.observed, c.run.nuisance.jacobian, c.run.Channels()});
  return [asked, follow = comparison.follow](const Scenario& other) -> LeftWhere {
    const auto twin =
        std::make_shared<const Followed>(follow, other, asked->readings, asked->used, asked->channels);
    return [asked, twin](const Eigen::VectorXd& by) -> Eigen::VectorXd {
      const Eigen::Index free = asked->free.fitted.cols();
      const Eigen::VectorXd constants = asked->free.fitted * by.head(free);
      return asked->observed - ByRow(twin->Predict(asked->free.DisturbancesOf(constants))) +
             asked->jacobian.leftCols(free) * by.head(free);
    };
  };
}

}  // namespace twinbench::diagnose

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/model/follow.h"

namespace twinbench::diagnose {

/// Readings x channels by rows: reading i, channel c at i * channels + c.
Eigen::VectorXd ByRow(const Eigen::MatrixXd& by_reading);

/// The twin on the course of a whole record, asked about the readings that a diagnosis uses: the others have moved
/// the bench, too.
class Followed {
 public:
  /// @param used      Some of `record`, in its order.
  /// @param channels  So many of the twin's, the first ones; 0: all.
  /// @throws InputError from the maker.
  Followed(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& record,
           const std::vector<Reading>& used, int channels = 0);

  /// Used readings x channels.
  /// @param at  One value a used reading.
  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& at) const;
  /// @throws std::logic_error if there is no point of that name.
  const model::Point& Point(const std::string& name) const { return model::PointNamed(*follow_, name); }
  /// d reading / d point there.
  Eigen::MatrixXd Slope(const std::string& point, const std::vector<model::Disturbance>& at) const;

 private:
  Eigen::MatrixXd OfUsed(const Eigen::MatrixXd& of_record) const;
  std::vector<model::Disturbance> OfRecord(const std::vector<model::Disturbance>& at) const;

  std::unique_ptr<model::Follow> follow_;
  Eigen::Index readings_, channels_;
  std::vector<Eigen::Index> rows_;  // of the used readings in the record
};

}  // namespace twinbench::diagnose

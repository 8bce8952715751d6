#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/model/follow.h"

namespace twinbench::diagnose {

/// The twin on the course of a whole record, asked about the readings that a diagnosis uses: the others have moved
/// the bench, too.
class Followed {
 public:
  /// @param used  Some of `record`, in its order.
  /// @throws InputError from the maker.
  Followed(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& record,
           const std::vector<Reading>& used);

  /// Used readings x channels.
  /// @param at  One value a used reading.
  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& at) const;
  /// d reading / d point there.
  Eigen::MatrixXd Slope(const std::string& point, const std::vector<model::Disturbance>& at) const;

 private:
  std::vector<model::Disturbance> OfRecord(const std::vector<model::Disturbance>& at) const;

  std::unique_ptr<model::Follow> follow_;
  Eigen::Index readings_;
  std::vector<Eigen::Index> rows_;  // of the used readings in the record
};

}  // namespace twinbench::diagnose

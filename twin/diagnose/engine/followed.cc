#include "twin/diagnose/engine/followed.h"

#include "twin/core/errors.h"

namespace twinbench::diagnose {

Eigen::VectorXd ByRow(const Eigen::MatrixXd& by_reading) {
  return by_reading.transpose().reshaped();
}

Followed::Followed(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& record,
                   const std::vector<Reading>& used)
    : follow_(maker(scenario, record)), readings_(std::ssize(record)) {
  for (Eigen::Index i = 0; i < readings_ && rows_.size() < used.size(); ++i) {
    if (record[static_cast<std::size_t>(i)].reading == used[rows_.size()].reading) rows_.push_back(i);
  }
  Require(rows_.size() == used.size(), "the used readings are some of the record");
}

std::vector<model::Disturbance> Followed::OfRecord(const std::vector<model::Disturbance>& at) const {
  std::vector<model::Disturbance> of_record;
  for (const model::Disturbance& d : at) {
    of_record.push_back({d.point, Eigen::VectorXd::Zero(readings_)});
    of_record.back().value(rows_) = d.value;
  }
  return of_record;
}

Eigen::MatrixXd Followed::Predict(const std::vector<model::Disturbance>& at) const {
  return follow_->Predict(OfRecord(at))(rows_, Eigen::all);
}

Eigen::MatrixXd Followed::Slope(const std::string& point, const std::vector<model::Disturbance>& at) const {
  return model::Slope(*follow_, Point(point), OfRecord(at))(rows_, Eigen::all);
}

}  // namespace twinbench::diagnose

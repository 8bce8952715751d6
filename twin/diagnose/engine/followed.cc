#include "twin/diagnose/engine/followed.h"

#include "twin/core/built.h"

namespace twinbench::diagnose {

Eigen::VectorXd ByRow(const Eigen::MatrixXd& by_reading) {
  return by_reading.transpose().reshaped();
}

Followed::Followed(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& record,
                   const std::vector<Reading>& used, int channels)
    : follow_(Built(scenario.bench, [&] { return maker(scenario, record); })),
      readings_(std::ssize(record)), channels_(channels) {
  for (Eigen::Index i = 0; i < readings_ && rows_.size() < used.size(); ++i) {
    if (record[static_cast<std::size_t>(i)].reading == used[rows_.size()].reading) rows_.push_back(i);
  }
  Require(rows_.size() == used.size(), "the used readings are some of the record");
}

Eigen::MatrixXd Followed::OfUsed(const Eigen::MatrixXd& of_record) const {
  return of_record(rows_, Eigen::seqN(0, channels_ > 0 ? channels_ : of_record.cols()));
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
  return OfUsed(follow_->Predict(OfRecord(at)));
}

Eigen::MatrixXd Followed::Slope(const std::string& point, const std::vector<model::Disturbance>& at) const {
  return OfUsed(model::Slope(*follow_, Point(point), OfRecord(at)));
}

}  // namespace twinbench::diagnose

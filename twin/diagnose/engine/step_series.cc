#include "twin/diagnose/engine/step_series.h"

#include <algorithm>

#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// Of all readings from the onset on.
class SumsOfSteps : public SeriesSums {
 public:
  /// @param from  By onset: the first reading that has the step.
  explicit SumsOfSteps(std::vector<Eigen::Index> from) : from_(std::move(from)) {}

  Eigen::MatrixXd Products(const Eigen::MatrixXd& Y) const override {
    Eigen::MatrixXd products(std::ssize(from_), Y.cols());
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      double sum = 0.0;
      Eigen::Index next = Y.rows();
      for (Eigen::Index g = products.rows() - 1; g >= 0; --g) {
        const Eigen::Index from = from_[static_cast<std::size_t>(g)];
        sum += Y.col(j).segment(from, next - from).sum();
        products(g, j) = sum;
        next = from;
      }
    }
    return products;
  }

  std::vector<Eigen::MatrixXd> Squares(const Banded& T) const override {
    Eigen::MatrixXd with_later = T.diagonal;
    for (const Eigen::VectorXd& beside : T.beside) with_later += 2.0 * beside;
    const Eigen::MatrixXd squares = Products(with_later);
    std::vector<Eigen::MatrixXd> by_point;
    for (const double square : squares.reshaped()) by_point.push_back(Eigen::MatrixXd::Constant(1, 1, square));
    return by_point;
  }

 private:
  std::vector<Eigen::Index> from_;
};

}  // namespace

std::shared_ptr<const Base> StepBase(const std::vector<int>& reading, const std::vector<double>& onsets) {
  if (onsets.empty()) return nullptr;
  std::vector<Eigen::Index> from;
  for (const double onset : onsets) from.push_back(std::ranges::lower_bound(reading, onset) - reading.begin());
  return std::make_shared<const Base>(Base{static_cast<int>(std::ssize(onsets)), 1,
                                           [reading, onsets](int g) {
                                             return Eigen::MatrixXd(
                                                 model::Step(reading, onsets[static_cast<std::size_t>(g)]));
                                           },
                                           [from] { return std::make_unique<const SumsOfSteps>(from); }});
}

}  // namespace twinbench::diagnose

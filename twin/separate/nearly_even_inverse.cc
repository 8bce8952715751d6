#include "twin/separate/nearly_even_inverse.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate::shifts {
namespace {

constexpr std::size_t kMostDiffering = 4096;  // the square of these is kept

/// Stops of all set-ups, and which two values each shows.
class Cells {
 public:
  Cells(const std::vector<int>& shifts, const std::vector<int>& rows, Eigen::Index n)
      : shifts_(shifts), rows_(rows), n_(n) {}
  Eigen::Index B(Eigen::Index i, Eigen::Index j) const {
    const auto setup = static_cast<std::size_t>(j);
    const Eigen::Index place = ((i + shifts_[setup]) % n_ + n_) % n_;
    return (1 + (rows_.empty() ? 0 : rows_[setup])) * n_ + place;
  }

 private:
  const std::vector<int>& shifts_;
  const std::vector<int>& rows_;
  Eigen::Index n_;
};

/// The weight that most stops of a set-up have, of those that were read.
double MostCommon(const Eigen::VectorXd& weight) {
  std::map<double, int> count;
  for (const double w : weight) {
    if (w > 0.0) ++count[w];
  }
  return std::ranges::max_element(count, {}, [](const auto& one) { return one.second; })->first;
}

ShiftSet CommonWeights(const std::vector<int>& shifts, const std::vector<int>& rows, const Eigen::MatrixXd& weight) {
  ShiftSet set{static_cast<int>(weight.rows()), shifts, {}, rows};
  for (Eigen::Index j = 0; j < weight.cols(); ++j) set.weights.push_back(MostCommon(weight.col(j)));
  return set;
}

/// Lets one reading stand for every value that none shows: next to a value that is known already, so that it tells
/// of no two.
void FillUnread(const Cells& cells, const std::vector<double>& common, Eigen::Index values, Eigen::MatrixXd& weight) {
  std::vector<bool> known(static_cast<std::size_t>(values), false);
  const auto visit = [&](const auto& see) {
    for (Eigen::Index j = 0; j < weight.cols(); ++j) {
      for (Eigen::Index i = 0; i < weight.rows(); ++i)
        see(i, j, static_cast<std::size_t>(i), static_cast<std::size_t>(cells.B(i, j)));
    }
  };
  visit([&](Eigen::Index i, Eigen::Index j, std::size_t a, std::size_t b) {
    if (weight(i, j) > 0.0) known[a] = known[b] = true;
  });
  for (;;) {
    bool more = true;
    while (more) {
      more = false;
      visit([&](Eigen::Index i, Eigen::Index j, std::size_t a, std::size_t b) {
        if (known[a] == known[b]) return;
        weight(i, j) = common[static_cast<std::size_t>(j)];
        known[a] = known[b] = more = true;
      });
    }
    const auto open = std::ranges::find(known, false);
    if (open == known.end()) return;
    *open = true;  // a class of stops that nobody visited
  }
}

/// What stops have more (+1) or less (-1) than is common, as columns in the rows of the unknowns.
std::optional<Eigen::MatrixXd> Differing(const Cells& cells, const EvenInverse& even, const Eigen::MatrixXd& weight,
                                         double sign) {
  const Eigen::Index values = even.curves() * weight.rows();
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index j = 0; j < weight.cols(); ++j) {
    for (Eigen::Index i = 0; i < weight.rows(); ++i) {
      const double differs = sign * (weight(i, j) - even.set().weights[static_cast<std::size_t>(j)]);
      if (!(differs > 0.0)) continue;
      if (columns.size() == kMostDiffering) return std::nullopt;
      Eigen::VectorXd column = Eigen::VectorXd::Zero(even.unknowns());
      column[i] = column[cells.B(i, j)] = column[values + j] = 1.0;
      columns.push_back(std::sqrt(differs) * column);
    }
  }
  Eigen::MatrixXd matrix(even.unknowns(), std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c) matrix.col(static_cast<Eigen::Index>(c)) = columns[c];
  return matrix;
}

/// across (I + sign columns^T across)^-1/2, so that its square is what Woodbury's formula adds or takes.
std::optional<Eigen::MatrixXd> Factor(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& across, double sign) {
  if (columns.cols() == 0) return across;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(columns.cols(), columns.cols());
  const auto inverse_root = InverseCholeskyFactor(unit + sign * columns.transpose() * across);
  if (!inverse_root) return std::nullopt;
  return across * inverse_root->transpose();
}

}  // namespace

std::optional<NearlyEvenInverse> NearlyEvenInverse::Of(const std::vector<int>& shifts, const std::vector<int>& rows,
                                                       const Eigen::MatrixXd& weight) {
  const Cells cells(shifts, rows, weight.rows());
  NearlyEvenInverse inverse(EvenInverse(CommonWeights(shifts, rows, weight)));
  Eigen::MatrixXd filled = weight;
  FillUnread(cells, inverse.even_.set().weights, inverse.even_.curves() * weight.rows(), filled);
  const auto more = Differing(cells, inverse.even_, filled, 1.0);
  const auto less = Differing(cells, inverse.even_, filled, -1.0);
  if (!more || !less) return std::nullopt;
  for (const auto& [columns, sign, factor] :
       {std::tuple(&*more, 1.0, &inverse.added_), std::tuple(&*less, -1.0, &inverse.lacking_)}) {
    Eigen::MatrixXd across(columns->rows(), columns->cols());
    for (Eigen::Index c = 0; c < columns->cols(); ++c) across.col(c) = inverse.Apply(columns->col(c));
    auto found = Factor(*columns, across, sign);
    if (!found) return std::nullopt;
    *factor = *std::move(found);
  }
  return inverse;
}

Eigen::VectorXd NearlyEvenInverse::Apply(const Eigen::VectorXd& right) const {
  Eigen::VectorXd x = even_.Apply(right);
  if (added_.cols() > 0) x -= added_ * (added_.transpose() * right);
  if (lacking_.cols() > 0) x += lacking_ * (lacking_.transpose() * right);
  return x;
}

}  // namespace twinbench::separate::shifts

#include "twin/diagnose/engine/wave_series.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "twin/model/signals.h"
#include "twin/model/wave_grid.h"
#include "twin/model/wave_sums.h"

namespace twinbench::diagnose {
namespace {

/// With s = cos or sin of k phase, the sum of d_i s_i^2 is that of waves of twice the phase; the sum of
/// e_i s_i s_(i+k) is that of waves of the sum and of the difference of the two phases.
class SumsOfWaves : public SeriesSums {
 public:
  explicit SumsOfWaves(WaveSeries waves) : waves_(std::move(waves)), sums_(Over(waves_.phase_rad)) {}

  Eigen::MatrixXd Products(const Eigen::MatrixXd& Y) const override {
    const Eigen::MatrixXcd all = waves_.factor.size() > 0 ? sums_.Of(model::Times(Y, waves_.factor)) : sums_.Of(Y);
    Eigen::MatrixXd products(2 * std::ssize(waves_.numbers), Y.cols());
    for (std::size_t g = 0; g < waves_.numbers.size(); ++g) {
      const auto row = 2 * static_cast<Eigen::Index>(g);
      products.row(row) = all.row(waves_.numbers[g]).real();
      products.row(row + 1) = all.row(waves_.numbers[g]).imag();
    }
    return products;
  }

  std::vector<Eigen::MatrixXd> Squares(const Banded& T) const override {
    const Eigen::VectorXd factor =
        waves_.factor.size() > 0 ? waves_.factor : Eigen::VectorXd::Ones(T.diagonal.size()).eval();
    const Eigen::VectorXd own = T.diagonal.cwiseProduct(factor.cwiseAbs2());
    const Eigen::VectorXd& phase_rad = waves_.phase_rad;
    Eigen::VectorXcd doubled = 0.5 * Over(2.0 * phase_rad).Of(own), plain = Constant(0.5 * own.sum());
    for (std::size_t k = 0; k < T.beside.size(); ++k) {
      const Eigen::Index last = std::max<Eigen::Index>(0, T.diagonal.size() - 1 - static_cast<Eigen::Index>(k));
      const Eigen::VectorXd pair =
          T.beside[k].head(last).cwiseProduct(factor.head(last)).cwiseProduct(factor.tail(last));
      if (pair.isZero(0.0)) continue;
      doubled += Over(phase_rad.head(last) + phase_rad.tail(last)).Of(pair);
      plain += Over(phase_rad.head(last) - phase_rad.tail(last)).Of(pair);
    }
    std::vector<Eigen::MatrixXd> squares;
    for (const int number : waves_.numbers) {
      const double both = plain[number].real(), cos2 = doubled[number].real(), sin2 = doubled[number].imag();
      squares.push_back(Eigen::Matrix2d{{both + cos2, sin2}, {sin2, both - cos2}});
    }
    return squares;
  }

 private:
  int Count() const { return waves_.numbers.back() + 1; }
  Eigen::VectorXcd Constant(double value) const { return Eigen::VectorXcd::Constant(Count(), value); }
  model::WaveSums Over(const Eigen::VectorXd& phase_rad) const {
    return {phase_rad, waves_.first, waves_.step, Count()};
  }

  WaveSeries waves_;
  model::WaveSums sums_;
};

}  // namespace

Eigen::MatrixXd WaveSeries::At(int grid_point) const {
  const double k = first + numbers[static_cast<std::size_t>(grid_point)] * step;
  const Eigen::MatrixXd wave = model::Wave(k * phase_rad);
  return factor.size() > 0 ? model::Times(wave, factor) : wave;
}

std::vector<int> NumbersTo(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::shared_ptr<const Base> BaseOf(const WaveSeries& waves, int channels, const ToRows& rows) {
  const auto count = static_cast<int>(std::ssize(waves.numbers));
  if (count == 0) return nullptr;
  if (channels == 1 && !rows)
    return std::make_shared<const Base>(Base{count, 1, [waves](int g) { return waves.At(g); },
                                             [waves] { return std::make_unique<const SumsOfWaves>(waves); }});
  const auto grid =
      std::make_shared<const model::WaveGrid>(waves.phase_rad, waves.first, waves.step, waves.numbers.back() + 1);
  const auto series = [grid, numbers = waves.numbers, factor = waves.factor](int g) -> Eigen::MatrixXd {
    const Eigen::MatrixXd wave = grid->At(numbers[static_cast<std::size_t>(g)]);
    return factor.size() > 0 ? model::Times(wave, factor) : wave;
  };
  if (!rows) return std::make_shared<const Base>(Base{count, channels, series});
  return std::make_shared<const Base>(Base{count, channels, [rows, series](int g) { return rows(series(g)); }});
}

}  // namespace twinbench::diagnose

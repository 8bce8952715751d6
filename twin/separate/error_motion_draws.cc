#include "twin/separate/error_motion_draws.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::separate {
namespace {

constexpr std::size_t kBlock = 4;  // a whole block of the stream

std::vector<float> FilledUp(Stream& normal, std::size_t count) {
  std::vector<float> drawn((count + kBlock - 1) / kBlock * kBlock);
  normal.FillNormals(drawn);
  return drawn;
}

}  // namespace

const Eigen::MatrixXd& ErrorMotionDraws::Contour(Eigen::Index angles) {
  if (contour_.rows() == angles) return contour_;
  Stream normal(replicas_.seed, "iso230_7.contour");
  const std::vector<float> drawn = FilledUp(normal, static_cast<std::size_t>(angles * number()));
  contour_ = Eigen::Map<const Eigen::MatrixXf>(drawn.data(), angles, number()).cast<double>();
  return contour_;
}

const ErrorMotionDraws::Extremes& ErrorMotionDraws::Turns(const std::vector<int>& turns) {
  if (turns_ == turns) return extremes_;
  Require(std::ranges::all_of(turns, [](int count) { return count > 0; }), "extremes are those of some numbers");
  turns_ = turns;
  extremes_ = {Eigen::MatrixXd(std::ssize(turns), number()), Eigen::MatrixXd(std::ssize(turns), number())};
  Stream normal(replicas_.seed, "iso230_7.turns");
  const auto of_one = static_cast<std::size_t>(std::reduce(turns.begin(), turns.end()));
  for (Eigen::Index r = 0; r < number(); ++r) {
    const std::vector<float> drawn = FilledUp(normal, of_one);
    std::size_t begin = 0;
    for (Eigen::Index i = 0; i < std::ssize(turns); ++i) {
      const auto here = std::span(drawn).subspan(begin, static_cast<std::size_t>(turns[static_cast<std::size_t>(i)]));
      const auto [least, most] = std::ranges::minmax(here);
      extremes_.least(i, r) = least;
      extremes_.most(i, r) = most;
      begin += here.size();
    }
  }
  return extremes_;
}

}  // namespace twinbench::separate

#include "twin/benches/freeform_five_axis/estimators/pose_chain.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr double kSamePlace_m = 20.0 * units::um;  // as programmed, to the last digit
constexpr double kStands_rad = 0.01 * units::deg;

/// Whole steps of what counts as one place.
std::tuple<int, long, long, long> PlaceOf(const ShiftRead& read) {
  const auto step = [](double x_m) { return std::lround(x_m / kSamePlace_m); };
  return {read.setup, step(read.at_m.x()), step(read.at_m.y()), step(read.at_m.z())};
}

std::vector<int> TurnedAxes(const std::vector<ShiftRead>& reads) {
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(reads, {}, [axis](const ShiftRead& r) { return r.turned_rad[axis]; });
    if (high.turned_rad[axis] - low.turned_rad[axis] > kStands_rad) axes.push_back(axis);
  }
  return axes;
}

/// "A-C" as stages that are not yet on anything.
std::vector<RotaryStage> StagesSaid(const std::string& axes) {
  std::vector<RotaryStage> stages;
  double sense = 1.0;
  for (const char c : axes) {
    const bool is_axis = c >= 'A' && c <= 'C';
    if (!is_axis && c != '-')
      throw InputError("displacement.axes", fmt::format("\"{}\" has a {}", axes, c),
                       "letters of rotary axes, as in \"A-C\"");
    if (is_axis) stages.push_back({c - 'A', sense});
    sense = is_axis ? 1.0 : -1.0;
  }
  if (stages.size() > 2)
    throw InputError("displacement.axes", fmt::format("\"{}\" are {} axes", axes, stages.size()), "two at most");
  return stages;
}

MachineChain ChainOf(const std::string& topology, std::vector<RotaryStage> stages) {
  for (std::size_t k = 0; k < stages.size(); ++k)
    stages[k].on_table = topology == "table_table" || (topology == "table_head" && k == 0);
  return {topology, std::move(stages)};
}

/// Orders in which two axes are built: C stands on a tilting table, carries a tilting head, and is the table where
/// the head tilts.
std::vector<std::vector<int>> OrdersOf(const std::vector<int>& axes, const std::string& topology, bool is_said) {
  if (axes.size() < 2) return {axes};
  const std::vector<int> rising = axes, falling = {axes[1], axes[0]};
  const bool has_C = axes[1] == 2, head_first = topology == "table_table";
  if (!has_C || is_said) return head_first ? std::vector{rising, falling} : std::vector{falling, rising};
  return {head_first ? rising : falling};
}

void AddSenses(const std::string& topology, const std::vector<int>& order, std::vector<MachineChain>& chains) {
  for (int turned = 0; turned < (1 << order.size()); ++turned) {
    std::vector<RotaryStage> stages;
    for (std::size_t k = 0; k < order.size(); ++k) stages.push_back({order[k], (turned >> k) & 1 ? -1.0 : 1.0});
    chains.push_back(ChainOf(topology, stages));
  }
}

/// A turn by the commanded angle.
Matrix3d TurnedBy(const RotaryStage& stage, const ShiftRead& read) {
  return Eigen::AngleAxisd(stage.sense * read.turned_rad[stage.axis], Vector3d::Unit(stage.axis))
      .toRotationMatrix();
}

/// The chain at a pose before anything is known of lengths.
struct Turned {
  std::vector<Matrix3d> before, behind;  // each stage
  Matrix3d table = Matrix3d::Identity(), head = Matrix3d::Identity();
};

Turned TurnedAt(const MachineChain& chain, const ShiftRead& read) {
  Turned at;
  for (const RotaryStage& stage : chain.stages) {
    Matrix3d& side = stage.on_table ? at.table : at.head;
    at.before.push_back(side);
    side = side * TurnedBy(stage, read);
    at.behind.push_back(side);
  }
  return at;
}

/// Lengths of the chain in the frames of its bodies: from each to the next, and where the balls are.
struct Lengths {
  std::vector<Vector3d> stage;  // of a table up to its axis, of a head from its axis on
  std::vector<Vector3d> ball;
};

/// Lengths that others take up: along an axis what carries it, or what it carries, is as well the longer one.
bool IsFree(const MachineChain& chain, std::size_t k, int component) {
  const RotaryStage& stage = chain.stages[k];
  if (!stage.on_table) return component != stage.axis;
  const bool is_last = k + 1 == chain.stages.size() || !chain.stages[k + 1].on_table;
  return !(is_last && component == stage.axis) && !(k > 0 && component == chain.stages[k - 1].axis);
}

/// What the slides' place is by each length: tables carry the ball, heads take off what they reach.
Eigen::Matrix3Xd SlopesOfSlides(const MachineChain& chain, const Turned& at, std::size_t balls, int ball) {
  Eigen::Matrix3Xd slopes = Eigen::Matrix3Xd::Zero(3, 3 * static_cast<Eigen::Index>(chain.stages.size() + balls));
  for (std::size_t k = 0; k < chain.stages.size(); ++k) {
    for (int c = 0; c < 3; ++c)
      if (IsFree(chain, k, c))
        slopes.col(3 * static_cast<Eigen::Index>(k) + c) =
            chain.stages[k].on_table ? at.before[k].col(c) : Vector3d(-at.behind[k].col(c));
  }
  slopes.middleCols<3>(3 * (static_cast<Eigen::Index>(chain.stages.size()) + ball)) = at.table;
  return slopes;
}

Lengths LengthsOf(const Eigen::VectorXd& found, std::size_t stages) {
  Lengths lengths;
  for (Eigen::Index k = 0; 3 * k < found.size(); ++k)
    (k < static_cast<Eigen::Index>(stages) ? lengths.stage : lengths.ball).push_back(found.segment<3>(3 * k));
  return lengths;
}

/// From each axis to the ball, of a head to the tool's point.
Vector3d LeverOf(const MachineChain& chain, const Turned& at, const Lengths& lengths, const Vector3d& ball_m,
                 std::size_t k) {
  Vector3d lever =
      chain.stages[k].on_table ? Vector3d(at.table * ball_m) : Vector3d(at.behind[k] * lengths.stage[k]);
  for (std::size_t next = k + 1;
       next < chain.stages.size() && chain.stages[next].on_table == chain.stages[k].on_table; ++next)
    lever += (chain.stages[k].on_table ? at.before[next] : at.behind[next]) * lengths.stage[next];
  return lever;
}

PosePlace PlaceAt(const MachineChain& chain, const ShiftRead& read, const Lengths& lengths,
                  const Vector3d& ball_m) {
  const Turned at = TurnedAt(chain, read);
  PosePlace place{read.ball, read.at_m, ball_m, at.table, at.head, {}, read.elapsed};
  for (std::size_t k = 0; k < chain.stages.size(); ++k)
    place.stages.push_back(
        {at.before[k], LeverOf(chain, at, lengths, ball_m, k), read.turned_rad[chain.stages[k].axis]});
  return place;
}

/// From times to parts of the run.
void SetElapsed(std::vector<ShiftRead>& reads) {
  if (reads.empty()) return;
  const auto [first, last] = std::ranges::minmax(reads, {}, &ShiftRead::elapsed);
  const double begin = first.elapsed, end = last.elapsed, steps = std::max(1.0, static_cast<double>(reads.size()) - 1.0);
  for (std::size_t i = 0; i < reads.size(); ++i) {
    double& elapsed = reads[i].elapsed;
    elapsed = 2.0 * (end > begin ? (elapsed - begin) / (end - begin) : static_cast<double>(i) / steps) - 1.0;
  }
}

}  // namespace

std::vector<ShiftRead> ShiftsOf(const std::vector<Reading>& readings) {
  std::vector<ShiftRead> reads;
  for (const Reading& r : readings) {
    const double c_rad = kCommandedC(r);
    ShiftRead read{{kCommanded[0](r), kCommanded[1](r), kCommanded[2](r)},
                   {kCommanded[3](r), kCommanded[4](r), std::isfinite(c_rad) ? c_rad : 0.0},
                   {kShift_m[0](r), kShift_m[1](r), kShift_m[2](r)},
                   r.setup};
    read.reading = r.reading;
    read.elapsed = ToSeconds(r.time);
    if (read.shift_m.array().isFinite().any()) reads.push_back(read);
  }
  SetElapsed(reads);
  return reads;
}

void NumberBalls(bool by_place, std::vector<ShiftRead>& reads) {
  const auto key = [by_place](const ShiftRead& read) {
    return by_place ? PlaceOf(read) : std::tuple{read.setup, 0L, 0L, 0L};
  };
  std::set<std::tuple<int, long, long, long>> balls;
  for (const ShiftRead& read : reads) balls.insert(key(read));
  for (ShiftRead& read : reads) read.ball = static_cast<int>(std::distance(balls.begin(), balls.find(key(read))));
}

bool AreOnWorkpiece(const std::vector<ShiftRead>& reads) {
  constexpr std::size_t kPosesAPlace = 3;
  std::set<std::tuple<int, long, long, long>> places;
  std::set<std::pair<std::tuple<int, long, long, long>, std::array<long, 3>>> poses;
  for (const ShiftRead& read : reads) {
    std::array<long, 3> turned{};
    for (int axis = 0; axis < 3; ++axis)
      turned[static_cast<std::size_t>(axis)] = std::lround(read.turned_rad[axis] / kStands_rad);
    places.insert(PlaceOf(read));
    poses.insert({PlaceOf(read), turned});
  }
  return places.size() * kPosesAPlace <= poses.size();
}

std::vector<MachineChain> ChainsFor(const DisplacementSettings& settings, const std::vector<ShiftRead>& reads) {
  const std::vector<int> turned = TurnedAxes(reads);
  if (turned.size() > 2) throw InputError("readings", "A, B and C all turn", "poses of two rotary axes at most");
  const std::vector<RotaryStage> said = StagesSaid(settings.axes);
  for (const int axis : turned)
    if (!said.empty() && std::ranges::find(said, axis, &RotaryStage::axis) == said.end())
      throw InputError("displacement.axes",
                       fmt::format("{} turns and is not in \"{}\"", static_cast<char>('A' + axis), settings.axes),
                       "every axis that turns, from the bed on");
  const bool is_open = settings.topology == "auto";
  const std::vector<std::string> topologies =
      !is_open            ? std::vector{settings.topology}
      : turned.size() < 2 ? std::vector<std::string>{"table_table"}
                          : std::vector<std::string>{"table_table", "table_head", "head_head"};
  std::vector<MachineChain> chains;
  for (const std::string& topology : topologies) {
    if (!said.empty()) chains.push_back(ChainOf(topology, said));
    for (const auto& order : said.empty() ? OrdersOf(turned, topology, !is_open) : std::vector<std::vector<int>>())
      AddSenses(topology, order, chains);
  }
  return chains;
}

ChainAtPoses BySlides(const MachineChain& chain, const std::vector<ShiftRead>& reads) {
  const std::size_t balls = 1 + static_cast<std::size_t>(std::ranges::max(reads, {}, &ShiftRead::ball).ball);
  Eigen::MatrixXd slopes(3 * std::ssize(reads), 3 * static_cast<Eigen::Index>(chain.stages.size() + balls));
  Eigen::VectorXd slides_m(slopes.rows());
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    slopes.middleRows<3>(row) = SlopesOfSlides(chain, TurnedAt(chain, reads[i]), balls, reads[i].ball);
    slides_m.segment<3>(row) = reads[i].at_m;
  }
  const Eigen::VectorXd found = SolveRanked(slopes, slides_m, 1e-6).x;
  const Lengths lengths = LengthsOf(found, chain.stages.size());
  ChainAtPoses at;
  at.misfit_m = (slides_m - slopes * found).norm() / std::sqrt(static_cast<double>(slides_m.size()));
  for (const ShiftRead& read : reads) {
    at.places.push_back(PlaceAt(chain, read, lengths, lengths.ball[static_cast<std::size_t>(read.ball)]));
    if (chain.HasTable()) at.places.back().slides_m -= lengths.stage.front();
  }
  return at;
}

ChainAtPoses ByWorkpiece(const MachineChain& chain, const std::vector<ShiftRead>& reads, double tool_m) {
  Lengths lengths;
  lengths.stage.assign(chain.stages.size(), Vector3d::Zero());
  if (chain.HasHead()) lengths.stage.back() = -tool_m * Vector3d::UnitZ();
  ChainAtPoses at;
  for (const ShiftRead& read : reads) {
    at.places.push_back(PlaceAt(chain, read, lengths, read.at_m));
    PosePlace& place = at.places.back();
    place.slides_m = place.table * read.at_m -
                     (chain.HasHead() ? Vector3d(place.head * lengths.stage.back()) : Vector3d(Vector3d::Zero()));
  }
  return at;
}

}  // namespace twinbench::benches::freeform::estimators

#include "twin/import/course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/core/reading.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr double kAtRest = 0.005;         // of the top speed: slower is at rest
constexpr double kSteady = 0.03;          // of the speed: changes less over a ramp's least length
constexpr std::size_t kShortestRest = 3;  // rows; a turning point is no rest
constexpr int kWidestWindow = 200;        // rows over which a speed is taken
constexpr double kReversal = 6.0;  // standard deviations of the reference's noise: a smaller way back is noise

std::vector<double> Sizes(std::vector<double> steps) {
  for (double& step : steps) step = std::abs(step);
  return steps;
}

/// +1 and -1 by the way since the last turning point: a way back of less than `threshold` is none.
std::vector<int> Senses(const std::vector<double>& x, double threshold) {
  std::vector<int> sense(x.size(), 0);
  std::size_t extreme = 0;
  double low = x.empty() ? 0.0 : x[0], high = low;
  int now = 0;
  std::size_t begin = 0;
  const auto turn = [&](std::size_t from, int to) {
    std::fill(sense.begin() + static_cast<std::ptrdiff_t>(begin), sense.begin() + static_cast<std::ptrdiff_t>(from),
              now);
    begin = from;
    now = to;
  };
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (now == 0) {
      low = std::min(low, x[i]);
      high = std::max(high, x[i]);
      if (high - low > threshold) {
        now = x[i] >= high ? 1 : -1;
        extreme = i;
      }
      continue;
    }
    if (now * (x[i] - x[extreme]) >= 0.0) {
      extreme = i;
    } else if (now * (x[extreme] - x[i]) > threshold) {
      turn(extreme + 1, -now);
      extreme = i;
    }
  }
  turn(x.size(), now);
  return sense;
}

/// Where rows follow one another without a pause: the first row of each such part, and the number of rows behind the last.
std::vector<int> PartsOf(const std::vector<double>& time_s) {
  constexpr double kPause = 3.5;  // usual steps: some rows may be missing
  const double longest_s = kPause * MedianOf(StepsOf(time_s));
  std::vector<int> begins = {0};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] - time_s[i - 1] > longest_s) begins.push_back(static_cast<int>(i));
  }
  begins.push_back(static_cast<int>(time_s.size()));
  return begins;
}

/// At an end of a part: the slope at row `at` of the parabola through rows `a` to `b`.
double SlopeAt(int at, int a, int b, const std::vector<double>& x, const std::vector<double>& time_s) {
  const auto row = [](int i) { return static_cast<std::size_t>(i); };
  Eigen::MatrixXd powers(b - a + 1, std::min(b - a + 1, 3));
  Eigen::VectorXd way(powers.rows());
  for (int i = a; i <= b; ++i) {
    way[i - a] = x[row(i)] - x[row(at)];
    for (int k = 0; k < powers.cols(); ++k) powers(i - a, k) = std::pow((time_s[row(i)] - time_s[row(at)]) / (time_s[row(b)] - time_s[row(a)]), k);
  }
  return powers.cols() < 2 ? 0.0 : SolveShortest(powers, way)[1] / (time_s[row(b)] - time_s[row(a)]);
}

/// Speeds over windows that are just long enough for the noise of the reference, and do not reach over a pause.
std::vector<double> Velocities(const std::vector<double>& x, const std::vector<double>& time_s, double noise) {
  const double usual = QuantileOf(Sizes(StepsOf(x)), 0.9);
  const int window =
      usual > 0.0 ? std::clamp(static_cast<int>(std::ceil(15.0 * noise / usual)), 1, kWidestWindow) : 1;
  const int rows = static_cast<int>(x.size());
  const std::vector<int> begins = PartsOf(time_s);
  std::vector<double> velocity;
  for (int i = 0, part = 0; i < rows; ++i) {
    if (i == begins[static_cast<std::size_t>(part) + 1]) ++part;
    const int first = begins[static_cast<std::size_t>(part)], last = begins[static_cast<std::size_t>(part) + 1] - 1;
    if (i - window < first || i + window > last) {
      velocity.push_back(SlopeAt(i, std::max(first, i - 2 * window), std::min(last, i + 2 * window), x, time_s));
      continue;
    }
    const auto a = static_cast<std::size_t>(i - window), b = static_cast<std::size_t>(i + window);
    const double way_s = time_s[b] - time_s[a];
    velocity.push_back(way_s > 0.0 ? (x[b] - x[a]) / way_s : 0.0);
  }
  return velocity;
}

/// Runs of equal values as [begin, end).
template <class Value>
std::vector<std::pair<std::size_t, std::size_t>> Runs(const std::vector<Value>& values) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1]) runs.emplace_back(i, i);
    runs.back().second = i + 1;
  }
  return runs;
}

std::vector<int> AtRest(const std::vector<double>& velocity, double fastest, double noise_of_velocity) {
  const double limit = std::max(kAtRest * fastest, 4.0 * noise_of_velocity);
  std::vector<int> rest;
  for (const double v : velocity) rest.push_back(std::abs(v) <= limit ? 1 : 0);
  for (const auto& [begin, end] : Runs(rest)) {
    if (rest[begin] == 1 && end - begin < kShortestRest)
      std::fill(rest.begin() + static_cast<std::ptrdiff_t>(begin), rest.begin() + static_cast<std::ptrdiff_t>(end),
                0);
  }
  return rest;
}

/// Passes count up where the sense changes.
void NumberPasses(const std::vector<int>& sense, Course& course) {
  int pass = 0;
  course.pass.assign(sense.size(), 0);
  for (std::size_t i = 1; i < sense.size(); ++i) {
    if (sense[i] != sense[i - 1]) ++pass;
    course.pass[i] = pass;
  }
  course.reversals = pass;
}

void MarkRamps(const std::vector<double>& time_s, Course& course) {
  const auto n = static_cast<int>(course.velocity.size());
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (course.direction[at] == 0) continue;
    const auto a = static_cast<std::size_t>(std::max(0, i - 2)),
               b = static_cast<std::size_t>(std::min(n - 1, i + 2));
    const bool changes =
        time_s[b] > time_s[a] && std::abs(course.velocity[b] - course.velocity[a]) > kSteady * course.fastest;
    course.motion[at] = changes ? Motion::kRamp : Motion::kSteady;
  }
}

/// Motion that is read while it goes on.
void Sweep(const std::vector<double>& time_s, Course& course) {
  const std::vector<double>& x = course.reference;
  course.velocity = Velocities(x, time_s, course.noise);
  course.fastest = QuantileOf(Sizes(course.velocity), 0.95);
  const double usual_s = MedianOf(StepsOf(time_s));
  const std::vector<int> rest =
      AtRest(course.velocity, course.fastest, usual_s > 0.0 ? 0.1 * course.noise / usual_s : 0.0);
  const auto [low, high] = std::ranges::minmax(x);
  const std::vector<int> sense = Senses(x, std::max(kReversal * course.noise, 2e-5 * (high - low)));
  NumberPasses(sense, course);
  course.direction = sense;
  course.motion.assign(x.size(), Motion::kRest);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (rest[i]) course.direction[i] = 0;
  }
  for (const auto& [begin, end] : Runs(rest)) course.rests += rest[begin];
  course.rest_share =
      static_cast<double>(std::ranges::count(rest, 1)) / static_cast<double>(std::max<std::size_t>(1, x.size()));
  MarkRamps(time_s, course);
}

/// A reference that goes one way, but for a few single steps back that are no longer than its own: it errs there, and nobody drives
/// back so.
void TakeOutFewBack(std::vector<double>& steps) {
  constexpr double kFew = 0.01, kAsLong = 2.0;  // of all; usual steps
  const auto forward = std::ranges::count_if(steps, [](double step) { return step > 0.0; });
  const double sense = 2 * forward > std::ssize(steps) ? 1.0 : -1.0, usual = MedianOf(Sizes(steps));
  std::vector<std::size_t> back;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(sense * steps[i] < 0.0)) continue;
    if (-sense * steps[i] > kAsLong * usual || (!back.empty() && back.back() + 1 == i)) return;
    back.push_back(i);
  }
  if (static_cast<double>(back.size()) > kFew * static_cast<double>(steps.size())) return;
  for (const std::size_t i : back) steps[i] = 0.0;
}

/// Readings at rest, one a row.
void Stops(Course& course) {
  const std::vector<double>& x = course.reference;
  std::vector<double> steps = StepsOf(x);
  TakeOutFewBack(steps);
  std::vector<double> sizes = Sizes(steps);
  std::erase(sizes, 0.0);
  const double usual = MedianOf(sizes);
  course.motion.assign(x.size(), Motion::kStop);
  course.velocity.assign(x.size(), kNaN);
  course.direction.assign(x.size(), 1);
  course.pass.assign(x.size(), 0);
  const auto sense_from = [&](std::size_t i) {  // of the first step at or behind i that is one
    for (; i < steps.size(); ++i) {
      if (std::abs(steps[i]) > 1e-3 * usual) return steps[i] > 0.0 ? 1 : -1;
    }
    return 0;
  };
  int now = sense_from(0), pass = 0;
  if (now == 0) now = 1;
  course.direction[0] = now;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const bool stands = std::abs(steps[i - 1]) <= 1e-3 * usual;
    int sense = stands ? sense_from(i) : steps[i - 1] > 0.0 ? 1 : -1;
    if (sense == 0) sense = now;
    const int next = sense_from(i);
    const bool flies_back = !stands && sense != now && next == now && std::abs(steps[i - 1]) > 3.0 * usual;
    if (flies_back) {
      ++course.fly_backs;
      ++pass;
      sense = now;
    } else if (sense != now) {
      ++pass;
      ++course.reversals;
    }
    now = sense;
    course.direction[i] = now;
    course.pass[i] = pass;
  }
}

/// A forward and a backward pass meet the same angles: the axis went from stop to stop.
bool MeetsTheSameAngles(const Course& swept) {
  std::vector<double> forward, backward;
  for (std::size_t i = 0; i < swept.reference.size(); ++i)
    (swept.direction[i] > 0 ? forward : backward).push_back(swept.reference[i]);
  if (forward.size() < 6 || backward.size() < 6) return false;
  std::ranges::sort(forward);
  std::vector<double> gaps = StepsOf(forward);
  std::erase_if(gaps, [](double gap) { return gap < 1e-9; });
  const double spacing = MedianOf(gaps);
  const auto met = std::ranges::count_if(backward, [&](double x) {
    const auto near = std::ranges::lower_bound(forward, x - 0.02 * spacing);
    return near != forward.end() && *near <= x + 0.02 * spacing;
  });
  return 10 * met > 8 * std::ssize(backward);
}

/// Nobody drives from place to place within a tenth of a second.
bool IsOneReadingAStop(const Course& swept, const std::vector<double>& time_s) {
  constexpr double kShortestStop_s = 0.1;
  return swept.reference.size() < 2000 && swept.rests == 0 && MedianOf(StepsOf(time_s)) > kShortestStop_s &&
         MeetsTheSameAngles(swept);
}

/// A few steps of a command, or one, from one row to the next: nobody reads it while it moves.
bool Jumps(const Course& swept) {
  constexpr int kFewestRests = 2, kMostRowsBetween = 2;
  const auto moving = std::ranges::count_if(swept.direction, [](int d) { return d != 0; });
  return swept.rests >= kFewestRests && moving <= kMostRowsBetween * (swept.rests - 1);
}

/// At rest for much of the time, at many places; or nearly always, as a command is that jumps from place to place.
bool GoesFromRestToRest(const Course& swept) {
  constexpr int kFewestRests = 6;
  constexpr double kRestShare = 0.4, kNearlyAlways = 0.9;
  if (swept.rest_share > kNearlyAlways && Jumps(swept)) return true;
  if (swept.rests < kFewestRests || swept.rest_share < kRestShare) return false;
  if (swept.rest_share > kNearlyAlways) return true;
  const auto [low, high] = std::ranges::minmax(swept.reference);
  std::vector<double> places;
  for (const auto& [begin, end] : Runs(swept.direction)) {
    if (swept.direction[begin] == 0) places.push_back(swept.reference[(begin + end) / 2]);
  }
  std::ranges::sort(places);
  int different = 1;
  for (std::size_t i = 1; i < places.size(); ++i)
    different += places[i] - places[i - 1] > 1e-3 * (high - low) ? 1 : 0;
  return 2 * different >= kFewestRests && different > 3;
}

}  // namespace

const char* MotionName(Motion motion) {
  switch (motion) {
    case Motion::kStop:
      return "stop";
    case Motion::kRest:
      return "rest";
    case Motion::kRamp:
      return "ramp";
    case Motion::kSteady:
      break;
  }
  return "steady";
}

int Unwrap(double wrap_rad, std::vector<double>& angle) {
  int wraps = 0;
  double shift = 0.0, last = kNaN;
  for (double& x : angle) {
    if (!std::isfinite(x)) continue;
    const double raw = x;
    if (std::isfinite(last)) {
      const double jumps = std::round((raw - last) / wrap_rad);
      if (jumps != 0.0) ++wraps;
      shift -= jumps * wrap_rad;
    }
    last = raw;
    x = raw + shift;
  }
  return wraps;
}

double FindWrap(const std::vector<double>& reference, const CourseSettings& settings, bool linear) {
  if (settings.wrap_rad > 0.0) return settings.wrap_rad;
  if (linear || reference.empty()) return 0.0;
  const auto [low, high] = std::ranges::minmax(reference);
  if (high - low > 1.002 * units::turn || high - low < 0.9 * units::turn) return 0.0;
  const std::vector<double> steps = Sizes(StepsOf(reference));
  const auto jumps = std::ranges::count_if(steps, [](double step) { return step > 0.75 * units::turn; });
  return jumps > 0 && MedianOf(steps) < 0.25 * units::turn ? units::turn : 0.0;
}

Course CourseOf(std::vector<double> reference, const std::vector<double>& time_s, const CourseSettings& settings,
                double wrap_rad) {
  Course course;
  course.reference = std::move(reference);
  if (wrap_rad > 0.0) course.wraps = Unwrap(wrap_rad, course.reference);
  const auto [low, high] = std::ranges::minmax(course.reference);
  course.turns = (high - low) / units::turn;
  if (!time_s.empty()) {
    course.noise = RobustNoiseOnCourse(course.reference);
    Sweep(time_s, course);
  }
  course.stop_and_go = !time_s.empty() && settings.kind != "sweep" && GoesFromRestToRest(course);
  course.stops = !course.stop_and_go && (time_s.empty() || settings.kind == "stops" ||
                                         (settings.kind == "auto" && IsOneReadingAStop(course, time_s)));
  if (course.stops) {
    course = {.stops = true,
              .reference = std::move(course.reference),
              .velocity = {},
              .direction = {},
              .pass = {},
              .motion = {},
              .wraps = course.wraps,
              .turns = course.turns};
    Stops(course);
  }
  return course;
}

}  // namespace twinbench::imports

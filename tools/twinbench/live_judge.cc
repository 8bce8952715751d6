#include "tools/twinbench/live_judge.h"

#include <pthread.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tools/twinbench/alarm_text.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::tools {
namespace {

using JudgeClock = std::chrono::steady_clock;

constexpr auto kBetweenJudgements = std::chrono::milliseconds(200);
constexpr auto kShortLook = std::chrono::seconds(1);
constexpr double kFalseAlarmRate = 0.01;  // a run, as of `diagnose --follow`
constexpr double kFigures = 1e-6;         // a residual needs no more to be drawn

std::string JudgedLine(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// As many digits as a plot shows.
nlohmann::json JudgedNumber(double value, double scale) {
  if (!std::isfinite(value)) return nullptr;
  const double step = std::abs(scale) * kFigures;
  return step > 0.0 ? std::round(value / step) * step : value;
}

nlohmann::json ResidualsJson(const Watched& watched, int after) {
  nlohmann::json channels = nlohmann::json::array(), readings = nlohmann::json::array();
  for (std::size_t c = 0; c < watched.channels.size(); ++c)
    channels.push_back({{"name", report::PathInWords(watched.channels[c])}, {"unit", report::ShownUnit(watched.units[c].name)}});
  for (const diagnose::PredictedReading& p : watched.report.predicted) {
    if (p.reading <= after) continue;
    nlohmann::json v = nlohmann::json::array(), u = nlohmann::json::array();
    for (std::size_t c = 0; c < watched.channels.size(); ++c) {
      const auto k = static_cast<Eigen::Index>(c);
      const double to_SI = watched.units[c].to_SI;
      v.push_back(JudgedNumber(p.deviation[k] / to_SI, p.u[k] / to_SI));
      u.push_back(JudgedNumber(p.u[k] / to_SI, p.u[k] / to_SI));
    }
    readings.push_back({{"n", p.reading}, {"v", v}, {"u", u}});
  }
  return {{"channels", channels}, {"readings", readings}, {"limit_u", watched.report.limit_u}};
}

}  // namespace

LiveJudge::LiveJudge(const Scenario& scenario, std::function<void(const char*, const std::string&)> tell)
    : scenario_(scenario), tell_(std::move(tell)) {
  sigset_t all, before;  // signals are for the thread that measures
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::jthread([this](const std::stop_token& ended) { Work(ended); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LiveJudge::~LiveJudge() {
  thread_.request_stop();
  thread_.join();
}

void LiveJudge::Hear(const Reading& reading) {
  const std::lock_guard lock(mutex_);
  incoming_.push_back(reading);
}

bool LiveJudge::TakeNew() {
  std::vector<Reading> taken;
  {
    const std::lock_guard lock(mutex_);
    taken.swap(incoming_);
  }
  readings_.insert(readings_.end(), taken.begin(), taken.end());
  return !taken.empty();
}

void LiveJudge::Work(const std::stop_token& ended) {
  auto next = JudgeClock::now();
  while (!gives_up_) {
    const bool is_last = ended.stop_requested();
    if (is_last && look_ > kShortLook) return;
    if (is_last || JudgeClock::now() >= next) {
      if (TakeNew()) Look();
      next = JudgeClock::now() + std::max<JudgeClock::duration>(kBetweenJudgements, 3 * look_);
    }
    if (is_last) return;
    std::this_thread::sleep_for(kBetweenJudgements / 10);
  }
}

/// What goes wrong here ends the judging and nothing else.
void LiveJudge::Look() {
  const auto begun = JudgeClock::now();
  try {
    Judge();
  } catch (const InputError&) {  // too few readings to predict from
  } catch (const std::exception& error) {
    tell_("unjudged", JudgedLine({{"why", error.what()}}));
    gives_up_ = true;
  }
  look_ = JudgeClock::now() - begun;
}

void LiveJudge::Judge() {
  const Bench& bench = BenchOf(scenario_);
  const diagnose::LinearRun run = bench.linear_run(readings_, scenario_, Estimator::kRigorous);
  const Watched watched = Seen(run, {kFalseAlarmRate, bench.planned_readings(scenario_)});
  if (!watched.report.predicted.empty() && watched.report.predicted.back().reading > told_to_) {
    tell_("residuals", JudgedLine(ResidualsJson(watched, told_to_)));
    told_to_ = watched.report.predicted.back().reading;
  }
  for (; alarms_ < watched.report.alarms.size(); ++alarms_)
    tell_("alarm", JudgedLine({{"words", AlarmText(watched.report.alarms[alarms_], watched)}}));
}

}  // namespace twinbench::tools

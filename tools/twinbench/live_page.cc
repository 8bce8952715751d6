#include "tools/twinbench/live_page.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/live/server.h"
#include "tools/twinbench/exit_code.h"
#include "tools/twinbench/live_judge.h"
#include "tools/twinbench/stop_signal.h"
#include "tools/web/bundle.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::tools {
namespace {

constexpr auto kBetweenProgress = std::chrono::milliseconds(50);

/// Names and texts may come from anybody's files: bytes that are no text are replaced.
std::string OneLine(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Columns that hold numbers of the bench itself: where the axes were sent, what was shown, circumstances.
std::vector<const ReadingColumn*> Shown(const BenchFormat& format) {
  std::vector<const ReadingColumn*> columns;
  for (const ReadingColumn& column : format.columns) {
    if (column.number && !column.IsOfAnotherInstrument()) columns.push_back(&column);
  }
  return columns;
}

const char* RoleName(const ReadingColumn& column) {
  if (column.role == ColumnRole::kRequired) return "axis";
  return column.IsShown() ? "shown" : "circumstance";
}

nlohmann::json ColumnJson(const std::string& column, const char* role) {
  const auto [name, unit] = report::NameAndUnit(column);
  return {{"column", column}, {"name", name}, {"unit", report::ShownUnit(unit)}, {"role", role}};
}

/// Text of a number, as it stands in readings.csv; nothing is null.
std::string NumberOrNull(const std::string& text) {
  return text.empty() ? "null" : text;
}

std::string ReadingJson(const Reading& r, const std::vector<const ReadingColumn*>& columns) {
  std::string values;
  for (const ReadingColumn* column : columns)
    values += (values.empty() ? "" : ",") + NumberOrNull(column->print(r));
  return fmt::format(R"({{"n":{},"t":{},"setup":{},"pass":{},"phase":"{}","status":"{}","v":[{}]}})", r.reading,
                     PrintTime(r.time), r.setup, r.pass, PhaseName(r.phase), ReadingStatusName(r.status), values);
}

}  // namespace

LivePage::LivePage() : pause_({}) {}

LivePage::LivePage(int port, const std::string& command) : command_(command), pause_(Ears()) {
  if (web::LiveMarkup().empty())
    throw InputError("--web", "this program was built without pages",
                     "a program that was built where npm is installed, without -DTWINBENCH_REPORT=OFF");
  server_ = std::make_unique<live::Server>(live::Server::Settings{
      port, web::LiveMarkup(), AskToStop, [this](bool pauses) { pause_.Ask(pauses); }});
  fmt::print(stderr, "live page, for this computer and whoever has this address: {}\n", server_->address());
}

LivePage::~LivePage() = default;

void LivePage::Watch(RunRecord& record, const Scenario& scenario, const std::string& folder, bool can_pause) {
  if (!server_) return;
  judge_ = std::make_unique<LiveJudge>(
      scenario, [this](const char* kind, const std::string& json) { server_->Post(kind, json); });
  const std::vector<const ReadingColumn*> columns = Shown(FormatOf(scenario.bench));
  nlohmann::json named = nlohmann::json::array();
  for (const ReadingColumn* column : columns) named.push_back(ColumnJson(column->name, RoleName(*column)));
  const std::string run = OneLine(
      {{"command", command_}, {"bench", scenario.bench}, {"folder", folder}, {"can_pause", can_pause}, {"columns", named}});
  server_->Begin(run);
  server_->Tell("run", run);  // in its place among the events: an investigation makes several
  record.TellOf([this, columns](const Reading& r) {
    last_ = r.time;
    judge_->Hear(r);
    server_->Tell("reading", ReadingJson(r, columns));
  });
  note_ = [this, &record](const std::string& text) { record.AppendEvent(last_, "operator", text); };
}

procedure::ProgressCallback LivePage::ShownToo(procedure::ProgressCallback line, StandingCheck stands) {
  if (!server_) return line;
  begun_ = std::chrono::steady_clock::now();
  told_ = {};
  paused_ = {};
  return [this, line, stands](const procedure::Progress& p) {
    line(p);
    progress_ = p;
    const bool is_last = p.readings_done == p.readings_planned;
    if (is_last || std::chrono::steady_clock::now() - told_ >= kBetweenProgress) ShowProgress();
    if (!is_last) HoldIfWanted(stands);
  };
}

void LivePage::ShowProgress() {
  const procedure::Progress& p = progress_;
  const auto now = std::chrono::steady_clock::now();
  told_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - begun_ - paused_).count();
  const double left_s = p.readings_done > 0 ? elapsed_s * (p.readings_planned - p.readings_done) / p.readings_done : -1.0;
  server_->Tell("progress", fmt::format(R"({{"done":{},"planned":{},"phase":"{}","bench_s":{:.3f},"left_s":{:.1f}}})",
                                        p.readings_done, p.readings_planned, PhaseName(p.phase),
                                        ToSeconds(p.bench_time), left_s));
}

void LivePage::HoldIfWanted(const StandingCheck& stands) {
  const auto begun = std::chrono::steady_clock::now();
  pause_.HoldIfAsked(progress_.readings_done, stands, StopWasAsked);
  paused_ += std::chrono::steady_clock::now() - begun;
}

/// What came of a pause: on the page, and in the record.
Pause::Ears LivePage::Ears() {
  const auto tell = [this](const char* state, const nlohmann::json& more) {
    nlohmann::json json = {{"state", state}};
    json.update(more);
    server_->Tell("pause", OneLine(json));
  };
  return {[=, this](int reading) {
            ShowProgress();
            tell("paused", {{"reading", reading}});
            note_(fmt::format("paused behind {} readings; everything stands", reading));
          },
          [=](const std::string& why) { tell("not_yet", {{"why", why}}); },
          [=](const std::string& why) { tell("restless", {{"why", why}}); },
          [=, this](int reading) {
            tell("over", {{"reading", reading}});
            note_(fmt::format("goes on behind {} readings", reading));
          }};
}

void LivePage::Serve(const std::string& bench, const std::string& where, const std::vector<std::string>& axes) {
  if (!server_) return;
  nlohmann::json columns = nlohmann::json::array();
  for (const std::string& axis : axes) columns.push_back(ColumnJson(axis, "axis"));
  Begin({{"bench", bench}, {"folder", where}, {"columns", columns}});
}

void LivePage::Begin(nlohmann::json about) {
  if (!server_) return;
  about["command"] = command_;
  about["can_pause"] = false;
  server_->Begin(OneLine(about));
}

void LivePage::Axes(Time now, const std::vector<double>& at, bool is_moving) {
  if (!server_) return;
  nlohmann::json values = nlohmann::json::array();
  for (const double value : at) values.push_back(std::isfinite(value) ? nlohmann::json(value) : nlohmann::json());
  server_->Tell("axes", OneLine({{"t", ToSeconds(now)}, {"v", values}, {"moving", is_moving}}));
}

void LivePage::Told(const char* kind, const nlohmann::json& json) {
  if (server_) server_->Tell(kind, OneLine(json));
}

void LivePage::Ended(int exit_code, const std::string& words) {
  if (!server_) return;
  if (exit_code == kDone) judge_.reset();  // of a run that was stopped the end is what counts
  server_->Tell("end", OneLine({{"code", exit_code}, {"words", words}}));
  server_->Finish();
}

void AddWebOption(CLI::App& command, std::optional<int>& port) {
  command
      .add_option("--web", port,
                  "show the run on a page of this computer: a port, or 0 for any that is free; the address is printed")
      ->check(CLI::Range(0, 65535));
}

void WithLivePage(const std::optional<int>& port, const std::string& command,
                  const std::function<void(LivePage&)>& work) {
  if (!port) {
    LivePage none;
    return work(none);
  }
  LivePage page(*port, command);
  try {
    work(page);
  } catch (const std::exception& error) {
    page.Ended(ExitCodeOf(error), FailureText(error));
    throw;
  }
  page.Ended(kDone, "");
}

}  // namespace twinbench::tools

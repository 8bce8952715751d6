#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/twinbench/pause.h"
#include "twin/core/run_record.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

namespace twinbench::live {
class Server;
}

namespace twinbench::tools {

class LiveJudge;

/// A command's window: a page on this computer that shows what is being measured (docs/live-page.md). One that was not asked for
/// shows nothing and costs nothing.
class LivePage {
 public:
  LivePage();
  /// Opens the page and says where on stderr.
  /// @param command  "measure".
  /// @throws InputError if the program was built without pages, or the port is taken.
  LivePage(int port, const std::string& command);
  ~LivePage();

  /// Shows what this record takes from now on.
  /// @param can_pause  Whether the run goes through ShownToo.
  void Watch(RunRecord& record, const Scenario& scenario, const std::string& folder, bool can_pause = true);
  /// `line` and the page. Holds the run between two readings while the page wants a pause.
  /// @param stands  Whether what moves stands.
  procedure::ProgressCallback ShownToo(procedure::ProgressCallback line, StandingCheck stands = {});
  /// Whether somebody asked for it.
  bool IsOpen() const { return server_ != nullptr; }
  /// Shows something else than a record. @param about  What the page knows the command by: "folder", "columns", ...
  void Begin(nlohmann::json about);
  /// Shows axes that others move, instead of a record.
  /// @param where  What is shown there: addresses.  @param axes  "target_deg", one each.
  void Serve(const std::string& bench, const std::string& where, const std::vector<std::string>& axes);
  /// Where these axes are at a time of the bench, in the units of their names.
  void Axes(Time now, const std::vector<double>& at, bool is_moving);
  /// What else happens, beside the readings. @param kind  A word that the page knows.
  void Told(const char* kind, const nlohmann::json& json);
  /// The last that the page says: what the program ends with, in its words.
  void Ended(int exit_code, const std::string& words);

 private:
  void ShowProgress();
  void HoldIfWanted(const StandingCheck& stands);
  Pause::Ears Ears();

  std::string command_;
  Pause pause_;
  procedure::Progress progress_;
  std::chrono::steady_clock::time_point begun_{}, told_{};  // of the run, and its progress last
  std::chrono::steady_clock::duration paused_{};            // altogether
  Time last_{};                                             // reading
  std::function<void(const std::string&)> note_;            // writes into the record, in time
  std::unique_ptr<live::Server> server_;                    // behind what it calls
  std::unique_ptr<LiveJudge> judge_;                        // behind what it tells
};

/// --web PORT of a command.
void AddWebOption(CLI::App& command, std::optional<int>& port);

/// Does `work` with a page, if one was asked for, and lets it say how that ended before the program does.
void WithLivePage(const std::optional<int>& port, const std::string& command,
                  const std::function<void(LivePage&)>& work);

}  // namespace twinbench::tools

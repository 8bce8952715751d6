#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "twin/core/run_record.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

namespace twinbench::live {
class Server;
}

namespace twinbench::tools {

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
  void Watch(RunRecord& record, const Scenario& scenario, const std::string& folder);
  /// `line` and the page.
  procedure::ProgressCallback ShownToo(procedure::ProgressCallback line);
  /// The last that the page says: what the program ends with, in its words.
  void Ended(int exit_code, const std::string& words);

 private:
  std::string command_;
  std::unique_ptr<live::Server> server_;
};

/// --web PORT of a command.
void AddWebOption(CLI::App& command, std::optional<int>& port);

/// Does `work` with a page, if one was asked for, and lets it say how that ended before the program does.
void WithLivePage(const std::optional<int>& port, const std::string& command,
                  const std::function<void(LivePage&)>& work);

}  // namespace twinbench::tools

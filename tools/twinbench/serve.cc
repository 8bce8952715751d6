#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "hw_bridge/machine_file.h"
#include "hw_bridge/serve/server.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::tools {
namespace {

struct ServeArguments {
  std::string scenario, bench_file, tables = "scpi", speed = "1";
  std::vector<std::string> overrides;
  hw::ServeOptions serve;
  bool no_pty = false;
};

double SpeedOf(const std::string& text) {
  if (text == "max") return INFINITY;
  const auto speed = ParseNumber(text);
  if (!speed || *speed <= 0.0) throw InputError("--speed " + text, "this is no speed", "a positive number, or max");
  return *speed;
}

std::string Told(const hw::ServedAddresses& at) {
  std::string text = at.iiod_port == 0 ? "" : fmt::format("iiod {}:{}\n", at.host, at.iiod_port);
  text += fmt::format("scpi {}:{}\nesp  {}:{}\n", at.host, at.scpi_port, at.host, at.esp_port);
  return at.pty.empty() ? text : text + fmt::format("esp  {}\n", at.pty);
}

/// Runs until a stop is asked for.
void ServeUntilStopped(hw::Server& server) {
  std::jthread watch([&server](std::stop_token ended) {
    while (!StopWasAsked() && !ended.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.Stop();
  });
  server.Run();
}

/// Writes the bench file, says where the server is and serves. Who has read the file may already stop the server.
void ServeShown(hw::Server& server, const ServeArguments& a, const std::string& bench_file) {
  ListenForStop();
  if (!a.bench_file.empty()) WriteFileAtOnce(a.bench_file, bench_file);
  fmt::print("{}", Told(server.Addresses()));
  std::fflush(stdout);
  ServeUntilStopped(server);
}

void ServeRotary(const ServeArguments& a, const Scenario& scenario) {
  sim::Twin twin(scenario);
  hw::Server server(twin.Bench(), scenario, RotaryOf(scenario).adc, a.serve);
  ServeShown(server, a, a.bench_file.empty() ? "" : hw::WriteServedBenchFile(server.Addresses(), a.tables));
}

void ServeMachine(const ServeArguments& a, const Scenario& scenario) {
  const Bench& bench = BenchOf(scenario);
  const std::vector<ReadingColumn> shown = InstrumentColumns(bench.format->columns);
  std::vector<std::string> fields = {"time_ns", "status"};
  for (const ReadingColumn& column : shown) fields.push_back(column.name);
  const auto twin = bench.make_devices(scenario);
  hw::Server server(twin->Devices(), shown, scenario, a.serve);
  const std::string language = a.tables == "pty" ? "pty" : "esp";
  ServeShown(server, a,
             a.bench_file.empty() ? "" : hw::WriteServedMachineFile(server.Addresses(), language, fields, twin->Devices().indexer != nullptr));
}

void WarnOfOthers(const std::string& bind) {
  if (hw::IsOfThisComputerOnly(bind)) return;
  fmt::print(stderr,
             "twinbench: at {} whoever is on the network can move what is served and inject faults; nobody is asked who "
             "he is. --bind 127.0.0.1 keeps it on this computer\n",
             bind);
}

void Serve(ServeArguments a) {
  RequireOutput(a.bench_file, {a.scenario});
  const Scenario scenario = LoadScenario(a.scenario, a.overrides);
  if (!BenchOf(scenario).has_controllers)
    throw InputError(a.scenario, "the bench " + scenario.bench + " cannot be served",
                     BenchesWhere([](const Bench& bench) { return bench.has_controllers; }));
  a.serve.speed = SpeedOf(a.speed);
  WarnOfOthers(a.serve.bind);
  a.serve.pty = !a.no_pty;
  BenchOf(scenario).make_devices ? ServeMachine(a, scenario) : ServeRotary(a, scenario);
}

void AddPort(CLI::App& command, const char* name, int& port, const char* what) {
  command.add_option(name, port, what)->check(CLI::Range(0, 65535))->capture_default_str();
}

}  // namespace

void AddServe(CLI::App& app) {
  auto* command = app.add_subcommand("serve", "Show the twin as hardware on the network, until Ctrl-C");
  auto arguments = std::make_shared<ServeArguments>();
  command->add_option("scenario", arguments->scenario, "scenario file (TOML)")->required();
  command->add_option("--set", arguments->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  command->add_option("--speed", arguments->speed, "bench seconds a real second, or max")->capture_default_str();
  command->add_option("--bind", arguments->serve.bind, "address to be reached at")->capture_default_str();
  AddPort(*command, "--iiod-port", arguments->serve.iiod_port, "A/D converter, IIOD; 0: any free port");
  AddPort(*command, "--scpi-port", arguments->serve.scpi_port, "tables and instruments, SCPI");
  AddPort(*command, "--esp-port", arguments->serve.esp_port, "tables, Newport ESP");
  command->add_flag("--no-pty", arguments->no_pty, "no pseudo-terminal with ESP");
  command->add_option("--write-bench", arguments->bench_file, "write the bench file that drives what is served");
  command->add_option("--tables", arguments->tables, "what that bench file drives the tables by: scpi, esp or pty")
      ->check(CLI::IsMember({"scpi", "esp", "pty"}));
  command->callback([arguments] { Serve(*arguments); });
}

}  // namespace twinbench::tools

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "hw_bridge/machine_file.h"
#include "hw_bridge/serve/server.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/secret_token.h"

namespace twinbench::tools {
namespace {

struct ServeArguments {
  std::string scenario, bench_file, tables = "scpi", speed = "1";
  std::vector<std::string> overrides;
  hw::ServeOptions serve;
  bool no_pty = false, token = false, no_token = false, force = false;
  std::optional<int> web;  // port of the live page
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

/// For programs; a port that is not there is left out.
nlohmann::json AddressesJson(const hw::ServedAddresses& at, const ServeArguments& a) {
  nlohmann::json json = {{"scenario", a.scenario}, {"host", at.host}, {"scpi_port", at.scpi_port}, {"esp_port", at.esp_port}};
  if (at.iiod_port != 0) json["iiod_port"] = at.iiod_port;
  if (!at.pty.empty()) json["pty"] = at.pty;
  if (!a.serve.token.empty()) json["token"] = a.serve.token;
  if (!a.bench_file.empty()) json["bench_file"] = a.bench_file;
  return json;
}

/// For the page: without the lines that a terminal has.
std::string AddressLine(const hw::ServedAddresses& at) {
  std::string line = Told(at);
  std::ranges::replace(line, '\n', ' ');
  return line;
}

/// Runs until a stop is asked for.
void ServeUntilStopped(hw::Server& server) {
  std::jthread watch([&server](std::stop_token ended) {
    while (!StopWasAsked() && !ended.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.Stop();
  });
  server.Run();
}

/// Where the axes of a served bench are, as their controllers would say it.
struct AxesSeen {
  Time now{};
  std::vector<double> at;  // in the units that the page was told
  bool is_moving = false;

  bool operator==(const AxesSeen& other) const { return at == other.at && is_moving == other.is_moving; }
};

/// Shows them on the page whenever they have changed. Who looks asks nothing of the bench that takes time.
void ShowAxes(hw::Server& server, LivePage& page, const std::function<AxesSeen()>& see) {
  constexpr auto kBetweenLooks = std::chrono::milliseconds(200);
  server.LookEvery(kBetweenLooks, [&page, see, before = AxesSeen{}]() mutable {
    const AxesSeen seen = see();
    if (seen == before) return;
    page.Axes(seen.now, seen.at, seen.is_moving);
    before = seen;
  });
}

/// Writes the bench file, says where the server is and serves. Who has read the file may already stop the server.
void ServeShown(hw::Server& server, const ServeArguments& a, const std::string& bench_file, JsonAnswer& answer) {
  ListenForStop();
  const std::string& token = a.serve.token;
  if (!a.bench_file.empty()) WriteFileAtOnce(a.bench_file, hw::WithGuards(bench_file, token));
  fmt::print("{}{}", Told(server.Addresses()), token.empty() ? "" : "token " + token + "\n");
  std::fflush(stdout);
  answer.Write(AddressesJson(server.Addresses(), a));
  ServeUntilStopped(server);
}

void ServeRotary(const ServeArguments& a, const Scenario& scenario, LivePage& page, JsonAnswer& answer) {
  sim::Twin twin(scenario);
  hw::Server server(twin.Bench(), scenario, RotaryOf(scenario).adc, a.serve);
  page.Serve(scenario.bench, AddressLine(server.Addresses()), {"target_deg", "reference_deg"});
  if (a.web)
    ShowAxes(server, page, [bench = twin.Bench()] {
      const TableState target = bench.target.State(), reference = bench.reference.State();
      return AxesSeen{bench.clock.Now(), {target.encoder_rad / units::deg, reference.encoder_rad / units::deg}, target.moving || reference.moving};
    });
  ServeShown(server, a, a.bench_file.empty() ? "" : hw::WriteServedBenchFile(server.Addresses(), a.tables), answer);
}

void ServeMachine(const ServeArguments& a, const Scenario& scenario, LivePage& page, JsonAnswer& answer) {
  const Bench& bench = BenchOf(scenario);
  const std::vector<ReadingColumn> shown = InstrumentColumns(bench.format->columns);
  std::vector<std::string> fields = {"time_ns", "status"};
  for (const ReadingColumn& column : shown) fields.push_back(column.name);
  const auto twin = bench.make_devices(scenario);
  hw::Server server(twin->Devices(), shown, scenario, a.serve);
  const std::vector<MachineAxis> axes = twin->Devices().machine.Axes();
  std::vector<std::string> names;
  for (const MachineAxis& axis : axes) names.push_back(axis.name + "_" + axis.unit());
  page.Serve(scenario.bench, AddressLine(server.Addresses()), names);
  if (a.web)
    ShowAxes(server, page, [bench = twin->Devices(), axes] {
      AxesSeen seen{bench.clock.Now(), {}, false};
      const std::vector<AxisState> states = bench.machine.State();
      for (std::size_t k = 0; k < states.size(); ++k) {
        seen.at.push_back(states[k].encoder / axes[k].to_SI());
        seen.is_moving = seen.is_moving || states[k].moving;
      }
      return seen;
    });
  const std::string language = a.tables == "pty" ? "pty" : "esp";
  ServeShown(server, a,
             a.bench_file.empty() ? "" : hw::WriteServedMachineFile(server.Addresses(), language, fields, twin->Devices().indexer != nullptr), answer);
}

void WarnOfOthers(const std::string& bind, bool asks_token) {
  if (hw::IsOfThisComputerOnly(bind)) return;
  fmt::print(stderr,
             "twinbench: at {} whoever is on the network can {}; nothing is encrypted. --bind 127.0.0.1 keeps it on this "
             "computer\n",
             bind,
             asks_token ? "read what is served, and whoever hears the token can move it"
                        : "move what is served and inject faults; nobody is asked who he is");
}

/// Programs of this computer that know nothing of tokens are served as ever unless one is asked for; others are asked.
bool AsksToken(const ServeArguments& a) {
  return a.token || (!a.no_token && !hw::IsOfThisComputerOnly(a.serve.bind));
}

void Serve(ServeArguments a, LivePage& page, JsonAnswer& answer) {
  RequireOutput(answer.to(), {a.scenario, a.bench_file});
  RequireFree(a.bench_file, {a.scenario}, a.force, hw::kServedBenchFile);
  const Scenario scenario = LoadScenario(a.scenario, a.overrides);
  if (!BenchOf(scenario).has_controllers)
    throw InputError(a.scenario, "the bench " + scenario.bench + " cannot be served",
                     BenchesWhere([](const Bench& bench) { return bench.has_controllers; }));
  a.serve.speed = SpeedOf(a.speed);
  if (AsksToken(a)) a.serve.token = NewToken();
  WarnOfOthers(a.serve.bind, AsksToken(a));
  a.serve.pty = !a.no_pty;
  BenchOf(scenario).make_devices ? ServeMachine(a, scenario, page, answer) : ServeRotary(a, scenario, page, answer);
}

void AddPort(CLI::App& command, const char* name, int& port, const char* what) {
  command.add_option(name, port, what)->check(CLI::Range(0, 65535))->capture_default_str();
}

}  // namespace

void AddServe(CLI::App& app) {
  auto* command = app.add_subcommand("serve", "Emulate the bench as network instruments, until Ctrl-C");
  auto arguments = std::make_shared<ServeArguments>();
  command->add_option("scenario", arguments->scenario, "scenario file (TOML)")->required();
  AddSet(*command, arguments->overrides);
  command->add_option("--speed", arguments->speed, "bench seconds per real second, or max")->capture_default_str();
  command->add_option("--bind", arguments->serve.bind, "address to be reached at")->capture_default_str();
  AddPort(*command, "--iiod-port", arguments->serve.iiod_port, "A/D converter, IIOD; 0: any free port");
  AddPort(*command, "--scpi-port", arguments->serve.scpi_port, "tables and instruments, SCPI");
  AddPort(*command, "--esp-port", arguments->serve.esp_port, "tables, Newport ESP");
  auto* token = command->add_flag("--token", arguments->token,
                                  "whoever moves or spoils anything must show the token that is printed and written into the bench file; "
                                  "with --bind beyond this computer the default");
  command->add_flag("--no-token", arguments->no_token, "everybody may move and spoil everything")->excludes(token);
  command->add_flag("--no-pty", arguments->no_pty, "no pseudo-terminal with ESP");
  command->add_option("--write-bench", arguments->bench_file, "write the bench file that drives what is served");
  command->add_option("--tables", arguments->tables, "what that bench file drives the tables by: scpi, esp or pty")
      ->check(OneOf({"scpi", "esp", "pty"}));
  AddForce(*command, arguments->force);
  AddWebOption(*command, arguments->web);
  AnswerWith(*command, "where it is reached, as soon as it can be,", [arguments](JsonAnswer& answer) {
    WithLivePage(arguments->web, "serve", [&](LivePage& page) { Serve(*arguments, page, answer); });
  });
}

}  // namespace twinbench::tools

#include "hw_bridge/serve/server.h"

#include <asio.hpp>
#include <optional>

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/esp_machine_conversation.h"
#include "hw_bridge/serve/iiod_conversation.h"
#include "hw_bridge/serve/listener.h"
#include "hw_bridge/serve/pseudo_terminal.h"
#include "hw_bridge/serve/scpi_conversation.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr auto kGuardEvery = std::chrono::milliseconds(100);

const Scenario& RequireCounts(const Scenario& scenario) {
  if (scenario.noise_free) {
    throw InputError("noise_free", "a bench without quantisation has no counts to serve", "noise_free = false");
  }
  return scenario;
}

/// As it stands in addresses: an IPv6 address in brackets; of a server at all addresses that of this computer.
std::string HostToReach(const std::string& bind) {
  asio::error_code unknown;
  const auto address = asio::ip::make_address(bind, unknown);
  if (unknown) return bind;
  if (address.is_unspecified()) return address.is_v6() ? "[::1]" : "127.0.0.1";
  return address.is_v6() ? "[" + bind + "]" : bind;
}

}  // namespace

bool IsOfThisComputerOnly(const std::string& bind) {
  asio::error_code unknown;
  const auto address = asio::ip::make_address(bind, unknown);
  return unknown || address.is_loopback();
}

struct Server::Impl {
  explicit Impl(const ServeOptions& its_options) : options(its_options) {}

  void Show(RotaryBench bench, const Scenario& scenario, const AdcSettings& adc) {
    auto& served = *(rotary = std::make_unique<ServedBench>(bench, RequireCounts(scenario), adc, options.speed));
    iiod.emplace(Maker<IiodConversation>(served), options.iiod_port, *this);
    Listen<EspConversation>(served);
  }
  void Show(MachineBench bench, const std::vector<ReadingColumn>& shown, const Scenario& scenario) {
    machine = std::make_unique<ServedMachine>(bench, shown, scenario, options.speed);
    Listen<EspMachineConversation>(*machine);
  }

  template <class Esp, class Kind>
  void Listen(Kind& served) {
    served.token = options.token;
    served.late = options.late;
    Guard(served);
    scpi.emplace(Maker<ScpiConversation>(served), options.scpi_port, *this);
    esp.emplace(Maker<Esp>(served), options.esp_port, *this);
    if (options.pty) pty.emplace(io, patience, Maker<Esp>(served));
  }
  /// Looks for those who ought to be there.
  void Guard(Served& served) {
    guard.expires_after(kGuardEvery);
    guard.async_wait([this, &served](const asio::error_code& stopped) {
      if (stopped) return;
      try {
        if (served.watchdog.IsMissingThem()) served.StopIfMoving();
      } catch (const BenchError&) {  // whoever looks next is told
      }
      Guard(served);
    });
  }
  template <class Speaks, class Kind>
  static MakeConversation Maker(Kind& served) {
    return [&served] { return std::make_unique<Speaks>(served); };
  }

  /// A port of this server.
  struct Port : Listener {
    Port(MakeConversation make, int number, Impl& impl)
        : Listener(impl.io, impl.options.bind, number, impl.options.max_connections, impl.patience,
                   std::move(make)) {}
  };

  Served& served() { return rotary ? static_cast<Served&>(*rotary) : *machine; }

  /// A bench that cannot get on says so to the client who asks next.
  void LookAgain() {
    try {
      served().pace().CatchUp();
      look();
    } catch (const BenchError&) {
    }
    looks.expires_after(between_looks);
    looks.async_wait([this](asio::error_code error) {
      if (!error) LookAgain();
    });
  }

  ServeOptions options;
  Patience patience{options.idle_limit, options.write_limit};
  std::unique_ptr<ServedBench> rotary;  // one of the two
  std::unique_ptr<ServedMachine> machine;
  asio::io_context io{1};
  asio::steady_timer guard{io};
  std::optional<Port> iiod, scpi, esp;
  std::optional<PseudoTerminal> pty;
  asio::steady_timer looks{io};
  std::chrono::milliseconds between_looks{};
  std::function<void()> look;
};

Server::Server(RotaryBench bench, const Scenario& scenario, const AdcSettings& adc, const ServeOptions& options)
    : impl_(std::make_unique<Impl>(options)) {
  impl_->Show(bench, scenario, adc);
}
Server::Server(MachineBench bench, const std::vector<ReadingColumn>& shown, const Scenario& scenario,
               const ServeOptions& options)
    : impl_(std::make_unique<Impl>(options)) {
  impl_->Show(bench, shown, scenario);
}
Server::~Server() = default;

ServedAddresses Server::Addresses() const {
  return {HostToReach(impl_->options.bind), impl_->iiod ? impl_->iiod->port() : 0, impl_->scpi->port(), impl_->esp->port(),
          impl_->pty ? impl_->pty->path() : ""};
}

void Server::LookEvery(std::chrono::milliseconds period, std::function<void()> look) {
  impl_->between_looks = period;
  impl_->look = std::move(look);
  impl_->LookAgain();
}

void Server::Run() {
  impl_->io.run();
}

void Server::Stop() {
  impl_->io.stop();
}

}  // namespace twinbench::hw

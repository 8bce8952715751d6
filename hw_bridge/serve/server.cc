#include "hw_bridge/serve/server.h"

#include <asio.hpp>
#include <optional>

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/iiod_conversation.h"
#include "hw_bridge/serve/listener.h"
#include "hw_bridge/serve/pseudo_terminal.h"
#include "hw_bridge/serve/scpi_conversation.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

const Scenario& RequireCounts(const Scenario& scenario) {
  if (scenario.noise_free) {
    throw InputError("noise_free", "a bench without quantisation has no counts to serve", "noise_free = false");
  }
  return scenario;
}

}  // namespace

struct Server::Impl {
  Impl(RotaryBench bench, const Scenario& scenario, const AdcSettings& adc, const ServeOptions& its_options)
      : options(its_options), served(bench, RequireCounts(scenario), adc, options.speed) {
    if (options.pty) pty.emplace(io, patience, MakerOf<EspConversation>());
  }

  template <class Kind>
  MakeConversation MakerOf() {
    return [this] { return std::make_unique<Kind>(served); };
  }
  template <class Kind>
  Listener At(int port) {
    return {io, options.bind, port, options.max_connections, patience, MakerOf<Kind>()};
  }

  ServeOptions options;
  Patience patience{options.idle_limit, options.write_limit};
  ServedBench served;
  asio::io_context io{1};
  Listener iiod = At<IiodConversation>(options.iiod_port);
  Listener scpi = At<ScpiConversation>(options.scpi_port);
  Listener esp = At<EspConversation>(options.esp_port);
  std::optional<PseudoTerminal> pty;
};

Server::Server(RotaryBench bench, const Scenario& scenario, const AdcSettings& adc, const ServeOptions& options)
    : impl_(std::make_unique<Impl>(bench, scenario, adc, options)) {}
Server::~Server() = default;

ServedAddresses Server::Addresses() const {
  return {impl_->options.bind, impl_->iiod.port(), impl_->scpi.port(), impl_->esp.port(),
          impl_->pty ? impl_->pty->path() : ""};
}

void Server::Run() {
  impl_->io.run();
}

void Server::Stop() {
  impl_->io.stop();
}

}  // namespace twinbench::hw

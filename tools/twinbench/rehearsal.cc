#include "tools/twinbench/rehearsal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hw_bridge/ad/block_checks.h"
#include "hw_bridge/ad/lost_word.h"
#include "hw_bridge/ad/negotiation.h"
#include "twin/benches/proof_by_steps.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/call_text.h"
#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

constexpr double kNearTheEdge = 0.8;  // of half the width: a PSD is not linear out there

/// Watches what the tables are told and where the spots fall.
class Watcher : public ReadingSink, public RunLog {
 public:
  Watcher(const Scenario& scenario, Rehearsal& rehearsal) : scenario_(scenario), r_(rehearsal) {}

  void Append(const Reading& reading, const Acquisition&) override {
    ++r_.readings;
    if (reading.status != ReadingStatus::kOk) ++r_.not_ok;
    for (std::size_t c = 0; c < kChannels; ++c) NoteSpot(c, reading.mean_V[c]);
    if (reading.status == ReadingStatus::kOk) NoteLostWord(reading);
  }
  void Called(const DeviceCall& call) override {
    r_.duration_s = ToSeconds(call.time);
    if (call.device != "target" && call.device != "reference") return;
    CallReader words(call.request);
    if (words.Word() != "move") return;
    Rehearsal::Travel& travel = call.device == "target" ? r_.target : r_.reference;
    const double to_rad = words.Number();
    travel.lowest_rad = std::min(travel.lowest_rad, to_rad);
    travel.highest_rad = std::max(travel.highest_rad, to_rad);
  }
  void ForgetCalls() override {}
  void AttemptFailed(int, Time, const std::string&, const std::string&) override {}
  void AppendEvent(Time, const std::string&, const std::string&) override {}
  void RequireRoom() override {}

 private:
  void NoteSpot(std::size_t channel, double mean_V) {
    const PsdSettings& psd = channel < 2 ? RotaryOf(scenario_).psd_a : RotaryOf(scenario_).psd_b;
    const double half_m = 0.5 * (channel % 2 == 0 ? psd.width_m : psd.height_m);
    const double share = std::abs(mean_V) / psd.sensitivity_V_m / half_m;
    double& widest = r_.widest_share[channel / 2];
    if (share > widest) widest = share;
  }

  void NoteLostWord(const Reading& reading) {
    const AdcSettings& adc = RotaryOf(scenario_).adc;
    const double lsb_V = adc.range_V / static_cast<double>(1 << (adc.bits - 1));
    std::array<double, kChannels> level_lsb{}, noise_lsb{};
    for (std::size_t c = 0; c < kChannels; ++c) {
      level_lsb[c] = reading.mean_V[c] / lsb_V;
      noise_lsb[c] = reading.std_V[c] / lsb_V;
    }
    const hw::LostWord word = hw::IfAWordWereLost(level_lsb, hw::ScanOrderOf(adc), hw::UsualNoise_lsb(noise_lsb),
                                                  adc.samples, hw::CheckSettings{}.false_alarms);
    if (word.shows) return;
    ++r_.hide_lost_words;
    r_.lost_word_shift_V = std::max(r_.lost_word_shift_V, word.shift_lsb * lsb_V);
  }

  const Scenario& scenario_;
  Rehearsal& r_;
};

void JudgeTravel(const char* table, const Rehearsal::Travel& travel, const TableLimits& limits,
                 std::vector<std::string>& problems) {
  if (travel.lowest_rad >= limits.lower_rad && travel.highest_rad <= limits.upper_rad) return;
  problems.push_back(
      fmt::format("{} would travel from {:.6g} to {:.6g} deg; its soft limits are {:.6g} to {:.6g} deg", table,
                  travel.lowest_rad / units::deg, travel.highest_rad / units::deg, limits.lower_rad / units::deg,
                  limits.upper_rad / units::deg));
}

void JudgeLight(const Rehearsal& r, std::vector<std::string>& problems) {
  if (r.not_ok > 0)
    problems.push_back(
        fmt::format("{} of {} readings would have no numbers: no light, a clipped spot or a saturated "
                    "channel",
                    r.not_ok, r.readings));
  for (int psd = 0; psd < 2; ++psd) {
    if (r.widest_share[psd] <= kNearTheEdge) continue;
    problems.push_back(fmt::format("the spot on psd_{} would come to {:.0f} % of half the PSD's width", "ab"[psd],
                                   100.0 * r.widest_share[psd]));
  }
}

/// Hum averages out over whole periods only.
void JudgeMains(const Scenario& scenario, double mains_Hz, std::vector<std::string>& hints) {
  const double periods = RotaryOf(scenario).adc.samples * kChannels / RotaryOf(scenario).adc.rate_Hz * mains_Hz;
  if (periods > 0.5 && std::abs(periods - std::round(periods)) < 0.01) return;
  hints.push_back(
      fmt::format("a block lasts {:.3g} periods of the mains at {:.4g} Hz; hum is averaged out by whole ones: "
                  "adc.samples = {:.0f}",
                  periods, mains_Hz, RotaryOf(scenario).adc.rate_Hz / kChannels / mains_Hz));
}

void JudgeLostWords(const Rehearsal& r, std::vector<std::string>& hints) {
  if (r.hide_lost_words == 0) return;
  hints.push_back(fmt::format(
      "at {} of {} readings the four levels are so alike that a word lost by the card might not show, and would shift a mean by up to "
      "{:.2g} mV; amplifiers whose offsets keep the levels apart show every one",
      r.hide_lost_words, r.readings, r.lost_word_shift_V / units::mV));
}

std::string TravelLine(const char* table, const Rehearsal::Travel& travel, const TableLimits& limits) {
  const bool limited = std::isfinite(limits.lower_rad) || std::isfinite(limits.upper_rad);
  return fmt::format("  {:<10}{:>10.3f} to {:>10.3f} deg   {}\n", table, travel.lowest_rad / units::deg,
                     travel.highest_rad / units::deg,
                     limited ? fmt::format("soft limits {} to {} deg", limits.lower_rad / units::deg,
                                           limits.upper_rad / units::deg)
                             : "no soft limits in the bench file or the controller");
}

std::string HoursMinutes(double duration_s) {
  const long minutes = std::lround(duration_s / 60.0);
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

}  // namespace

Rehearsal Rehearse(const Scenario& scenario, const procedure::Options& limits, double mains_Hz, bool is_real) {
  Rehearsal rehearsal;
  Watcher watcher(scenario, rehearsal);
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  procedure::Options options;
  options.log = &watcher;
  if (is_real) options.prove = WayOf(ProofBySteps(bench, scenario, options));
  procedure::CarryOut(bench, scenario, watcher, {}, options);
  JudgeTravel("target", rehearsal.target, limits.target, rehearsal.problems);
  JudgeTravel("reference", rehearsal.reference, limits.reference, rehearsal.problems);
  JudgeLight(rehearsal, rehearsal.problems);
  JudgeMains(scenario, mains_Hz, rehearsal.hints);
  JudgeLostWords(rehearsal, rehearsal.hints);
  return rehearsal;
}

std::string Summary(const Rehearsal& r, const procedure::Options& limits) {
  std::string text =
      fmt::format("rehearsal by simulation: {} readings, {}\n", r.readings, HoursMinutes(r.duration_s));
  text += TravelLine("target", r.target, limits.target);
  text += TravelLine("reference", r.reference, limits.reference);
  text += fmt::format("  spots       {:>9.0f} % of half the width of psd_a, {:.0f} % of psd_b at most\n",
                      100.0 * r.widest_share[0], 100.0 * r.widest_share[1]);
  for (const std::string& hint : r.hints) text += "  note: " + hint + "\n";
  for (const std::string& problem : r.problems) text += "  PROBLEM: " + problem + "\n";
  return text;
}

nlohmann::json RehearsalJson(const Rehearsal& r) {
  const auto travel = [](const Rehearsal::Travel& of) { return nlohmann::json{of.lowest_rad / units::deg, of.highest_rad / units::deg}; };
  return {{"rehearsal",
           {{"readings", r.readings},
            {"without_numbers", r.not_ok},
            {"duration_s", r.duration_s},
            {"travel_deg", {{"target", travel(r.target)}, {"reference", travel(r.reference)}}},
            {"hints", r.hints},
            {"problems", r.problems}}}};
}

}  // namespace twinbench::tools

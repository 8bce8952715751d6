#include "tests/hw_serve/serving.h"
#include "tests/hw_serve/virtual_bench.h"

namespace twinbench::test {
namespace {

/// A held bench at no cost, an open buffer, and what an undisturbed block looks like.
class OnDemand : public testing::Test {
 protected:
  static constexpr int kScans = 400;
  OnDemand() {
    scpi.Ask("CLOC:HOLD ON;*OPC?");
    clean = adc.Read(kScans);
    Again();
  }
  void Again() { scpi.Ask("SIM:REST;*OPC?"); }
  void Demand(const std::string& fault) { scpi.Ask("SIM:FAUL " + fault + ";*OPC?"); }
  Scans Spoilt(const std::string& fault) {
    Demand("adc," + fault);
    return adc.Read(kScans);
  }
  std::int16_t Of(const Scans& scans, int scan, int channel) const { return scans.raw[scan * kChannels + channel]; }

  ServedTwin served{OnFreePorts(kAtOnce)};
  TcpClient scpi{served.at().scpi_port};
  BufferClient adc{served.at().iiod_port, kScans};
  Scans clean;
};

TEST_F(OnDemand, WhatIsNoFaultIsRefused) {
  hw::Faults faults;
  EXPECT_FALSE(faults.Add("adc", "mute", 1));
  EXPECT_FALSE(faults.Add("target", "slip", 1));
  EXPECT_FALSE(faults.Add("moon", "drop", 1));
  EXPECT_FALSE(faults.Add("adc", "drop", 0));
  EXPECT_FALSE(faults.Add("adc", "drop,many"));
  for (int k = 0; k < 1000; ++k) faults.Add("adc", "drop,2");
  EXPECT_LE(faults.Waiting().size(), 10'000u);
}

TEST_F(OnDemand, AFaultStrikesAsOftenAsToldAndSurvivesARestart) {
  Demand("adc,no_light,2");
  Again();
  EXPECT_EQ(scpi.Ask("SIM:FAUL?"), "\"adc,no_light,2\"");
  const std::vector<std::int16_t> dark(kScans * kChannels, 0);
  EXPECT_EQ(adc.Read(kScans).raw, dark);
  EXPECT_EQ(adc.Read(kScans).raw, dark);
  EXPECT_NE(adc.Read(kScans).raw, dark);
}

TEST_F(OnDemand, ASpoiltBlockWasTakenAllTheSame) {
  const Scans second = (adc.Read(kScans), adc.Read(kScans));
  Again();
  Spoilt("stuck");
  EXPECT_EQ(adc.Read(kScans).raw, second.raw);
  Again();
  EXPECT_EQ(adc.Read(kScans).raw, clean.raw);
}

TEST_F(OnDemand, AGapIsAStepInTheTimeStampsASaturatedChannelStandsOnItsEndCodeAndAStuckOneHasNoNoise) {
  const Scans gap = Spoilt("gap");
  EXPECT_EQ(gap.stamps_ns[199], clean.stamps_ns[199]);
  EXPECT_EQ(gap.stamps_ns[200] - gap.stamps_ns[199], 17 * 16000);
  Again();
  const Scans saturated = Spoilt("saturate");
  EXPECT_EQ(Of(saturated, kScans - 1, 0), 32767);
  EXPECT_EQ(Of(saturated, 0, 0), Of(clean, 0, 0));
  Again();
  const Scans stuck = Spoilt("stuck");
  for (int s = 0; s < kScans; ++s) EXPECT_EQ(Of(stuck, s, 2), Of(clean, 0, 2));
}

TEST_F(OnDemand, HumIsATenthOfAVoltOnAllChannels) {
  const Scans scans = Spoilt("hum");
  for (int k = 0; k < kScans * kChannels; ++k)
    EXPECT_LE(std::abs(scans.raw[k] - clean.raw[k]), 328);  // 0.1 V of 32768 codes per 10 V
  // After 5 ms, a quarter of a period, it is at its crest: scan 312.5.
  EXPECT_NEAR(Of(scans, 312, 0) - Of(clean, 312, 0), 328, 1);
}

TEST_F(OnDemand, AClockThatSteppedIsASecondOffAndOneThatRunsFastIsAheadByItsShare) {
  Demand("clock,step");
  EXPECT_EQ(adc.Read(kScans).stamps_ns[7], clean.stamps_ns[7] + 1'000'000'000);
  Again();
  scpi.Ask("CLOC:WAIT? 1000000000");
  Demand("clock,ppm");
  EXPECT_EQ(adc.Read(kScans).stamps_ns[0], 1'000'050'000);
}

TEST_F(OnDemand, AShortBlockIsHalfAndThenNothing) {
  TcpClient& iiod = adc.socket();
  for (const auto& [fault, rest] : {std::pair{"adc,short", "0"}, std::pair{"adc,error", "-5"}}) {
    Demand(fault);
    EXPECT_EQ(iiod.Ask("READBUF psd-adc16 6400"), "3200");
    iiod.Line();  // its mask
    iiod.Bytes(3200);
    EXPECT_EQ(iiod.Line(), rest);
  }
  EXPECT_EQ(iiod.Ask("CLOSE psd-adc16"), "0");  // the connection is in step
}

TEST_F(OnDemand, ALateAnswerComesAfterThreeSeconds) {
  VirtualBench bench(kAtOnce);
  VirtualScpi late(bench);
  late.Ask("SIM:FAUL controller,late;*OPC?");
  EXPECT_EQ(late.Ask("ROT1:ANGL?"), "0");
  EXPECT_EQ(bench.Wall_s(), 3.0);
}

}  // namespace
}  // namespace twinbench::test

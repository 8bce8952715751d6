#include "hw_bridge/control/dialogue.h"

#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <thread>

#include "hw_bridge/control/device_line.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/hw_control/faults.h"

namespace twinbench::hw {
namespace {

using test::FakeController;
using test::KindOf;
using test::TextOf;
using testing::AllOf;
using testing::HasSubstr;
using Reply = FakeController::Reply;
using Wire = FakeController::Wire;

constexpr Duration kPatience = std::chrono::milliseconds(300);
constexpr const char* kIdentity = "maker,table,1,2.0";

/// Answers *IDN?; what else comes is the test's.
FakeController::Handler WithIdentity(FakeController::Handler others) {
  return [others = std::move(others)](const std::string& line) {
    return line == "*IDN?" ? Reply{std::string(kIdentity) + "\n"} : others(line);
  };
}

Dialogue DialogueWith(const FakeController& controller, const std::string& identity = "") {
  return Dialogue(ParseAddress(controller.Address()).value(), "*IDN?", identity);
}

std::string Ask(Dialogue& dialogue, const std::string& query) {
  return dialogue.Ask("target", query + "\n", kPatience);
}

class DialogueOver : public testing::TestWithParam<Wire> {};
INSTANTIATE_TEST_SUITE_P(Wires, DialogueOver, testing::Values(Wire::kTcp, Wire::kPseudoTerminal),
                         [](const auto& wire) { return wire.param == Wire::kTcp ? "Tcp" : "PseudoTerminal"; });

TEST_P(DialogueOver, GivesTheLineThatAnswersWithoutItsEnd) {
  FakeController controller(WithIdentity([](const std::string& line) { return Reply{line + " heard\r\n"}; }),
                            GetParam());
  Dialogue dialogue = DialogueWith(controller, "maker,table");
  EXPECT_EQ(Ask(dialogue, "X?"), "X? heard");
  EXPECT_EQ(dialogue.identity(), kIdentity);
}

TEST_P(DialogueOver, TakesLinesOfAnyEndWhereTheyAreMixed) {
  FakeController controller(
      WithIdentity([](const std::string& line) {
        return Reply{line == "SET" ? "SET ACK\n\r" : line == "GET" ? "GET 5\r\n\r\n" : "LAST\r"};
      }),
      GetParam());
  Dialogue dialogue = DialogueWith(controller);
  dialogue.Speak(WithAnyLineEnd());
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(Ask(dialogue, "SET"), "SET ACK");
    EXPECT_EQ(Ask(dialogue, "GET"), "GET 5") << "what is left of an end is no answer that nobody asked for";
    EXPECT_EQ(Ask(dialogue, "ELSE"), "LAST");
  }
  EXPECT_EQ(dialogue.openings(), 1);
}

TEST_P(DialogueOver, AnAnswerCountsOnlyWithItsEnd) {
  FakeController controller(WithIdentity([](const std::string&) { return Reply{"12.5"}; }), GetParam());
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "X?"); }), FaultKind::kTimeout);
  EXPECT_THAT(TextOf([&] { Ask(dialogue, "X?"); }), HasSubstr("only \"12.5\""));
}

// pyvisa-py #376: ROT1 answers late, the next query is given ROT1's angle, and so for ever.
TEST_P(DialogueOver, ALateAnswerIsNeverTakenForThatToTheNextQuery) {
  std::atomic<bool> is_late = true;
  const auto handler = [&](const std::string& line) {
    const bool first = line == "ROT1:ANGL?";
    return Reply{first ? "10.0\n" : "20.0\n", first && is_late.exchange(false) ? 450 : 0};
  };
  FakeController controller(WithIdentity(handler), GetParam());
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "ROT1:ANGL?"); }), FaultKind::kTimeout);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(Ask(dialogue, "ROT2:ANGL?"), "20.0");
    EXPECT_EQ(Ask(dialogue, "ROT1:ANGL?"), "10.0");
  }
}

TEST(Dialogue, ALateAnswerIsWaitedForWhereNoIdentityTellsItFromTheNext) {
  std::atomic<bool> is_late = true;
  const auto handler = [&](const std::string& line) {
    return line == "ROT1:ANGL?" ? Reply{"10.0\n", is_late.exchange(false) ? 450 : 0} : Reply{"20.0\n"};
  };
  FakeController controller(handler, Wire::kPseudoTerminal);
  Dialogue dialogue(ParseAddress(controller.Address()).value(), "", "");
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "ROT1:ANGL?"); }), FaultKind::kTimeout);
  EXPECT_EQ(Ask(dialogue, "ROT2:ANGL?"), "20.0");
}

// So late that it comes when the line has been quiet and the identity was asked for again.
constexpr int kLate_ms = 450;

TEST_P(DialogueOver, AnOldIdentityAnswerDoesNotShiftTheAnswersAfterIt) {
  std::atomic<int> asked = 0;
  FakeController controller(
      [&](const std::string& line) {
        if (line != "*IDN?") return Reply{line + " heard\n"};
        return Reply{std::string(kIdentity) + "\n", asked++ == 0 ? kLate_ms : 0};
      },
      GetParam());
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kTimeout);
  EXPECT_EQ(Ask(dialogue, "B?"), "B? heard");
  EXPECT_EQ(Ask(dialogue, "C?"), "C? heard");
}

TEST_P(DialogueOver, AnAnswerThatNobodyAskedForEndsTheConnection) {
  std::atomic<bool> doubles = true;
  FakeController controller(WithIdentity([&](const std::string&) { return Reply{doubles ? "1\n2\n" : "3\n"}; }),
                            GetParam());
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(Ask(dialogue, "A?"), "1");
  doubles = false;
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "B?"); }), FaultKind::kProtocol);
  EXPECT_EQ(Ask(dialogue, "C?"), "3");
}

TEST(Dialogue, ALineWithoutEndIsRefusedAndNotKept) {
  FakeController controller(WithIdentity([](const std::string&) { return Reply{std::string(100'000, '7')}; }));
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kProtocol);
}

TEST(Dialogue, TellsTheEndOfTheConnectionFromSlowness) {
  std::atomic<bool> closes = true;
  FakeController controller(WithIdentity([&](const std::string&) { return Reply{"", 0, closes.load()}; }));
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
  closes = false;
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kTimeout);
}

TEST(Dialogue, HalfAnAnswerAndThenTheEndIsNoAnswer) {
  FakeController controller(WithIdentity([](const std::string&) { return Reply{"12.", 0, true}; }));
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
}

TEST(Dialogue, OpensAgainAfterAFaultAndAsksWhoIsThere) {
  std::atomic<bool> closes = true;
  FakeController controller(WithIdentity([&](const std::string& line) {
    return Reply{line + "\n", 0, closes.exchange(false)};
  }));
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(Ask(dialogue, "A?"), "A?");
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "B?"); }), FaultKind::kDropped);
  EXPECT_EQ(Ask(dialogue, "C?"), "C?");
  EXPECT_THAT(controller.Lines(), testing::ElementsAre("*IDN?", "A?", "*IDN?", "C?"));
  EXPECT_EQ(dialogue.openings(), 2);
}

TEST(Dialogue, RefusesADeviceThatIsNotTheOneOfTheFile) {
  FakeController controller(WithIdentity([](const std::string&) { return Reply{"1\n"}; }));
  Dialogue dialogue = DialogueWith(controller, "maker,mirror");
  const auto ask = [&] { Ask(dialogue, "A?"); };
  EXPECT_EQ(KindOf(ask), FaultKind::kIdentity);
  EXPECT_THAT(TextOf(ask), AllOf(HasSubstr("target: "), HasSubstr("maker,table,1,2.0"), HasSubstr("maker,mirror"),
                                 HasSubstr(controller.Address())));
}

TEST(Dialogue, RefusesADeviceThatIsNotTheOneFromBefore) {
  std::atomic<int> serial = 1;
  FakeController controller([&](const std::string& line) {
    if (line == "*IDN?") return Reply{"maker,table," + std::to_string(serial.exchange(10)) + "\n"};
    return Reply{"1\n", 0, true};
  });
  Dialogue dialogue = DialogueWith(controller, "maker,table");  // both begin as the file says
  EXPECT_EQ(Ask(dialogue, "A?"), "1");
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kIdentity);
}

TEST(Dialogue, WhatASerialLineHeldBeforeIsNotTakenForTheIdentity) {
  FakeController controller(WithIdentity([](const std::string&) { return Reply{"7\n"}; }), Wire::kPseudoTerminal);
  controller.Say("10.0\n20.");  // of a program that ended
  Dialogue dialogue = DialogueWith(controller);
  EXPECT_EQ(Ask(dialogue, "A?"), "7");
  EXPECT_EQ(dialogue.identity(), kIdentity);
}

TEST(Dialogue, NobodyThereIsAFaultWithinThePatience) {
  const test::ReservedPort port;
  Dialogue dialogue(ParseAddress(port.Address()).value(), "*IDN?", "");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
  EXPECT_LE(std::chrono::steady_clock::now() - begin, 2 * kPatience);
}

TEST(Dialogue, AControllerThatComesBackWithinThePatienceIsFound) {
  const auto handler = WithIdentity([](const std::string&) { return Reply{"7\n"}; });
  const test::ReservedPort port;
  auto controller = std::make_unique<FakeController>(handler, Wire::kTcp, port.Port());
  Dialogue dialogue(ParseAddress(port.Address()).value(), "*IDN?", "");
  EXPECT_EQ(Ask(dialogue, "A?"), "7");
  controller.reset();
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
  const std::jthread boots([&] {
    std::this_thread::sleep_for(kPatience / 3);
    controller = std::make_unique<FakeController>(handler, Wire::kTcp, port.Port());
  });
  EXPECT_EQ(Ask(dialogue, "A?"), "7");
}

TEST(Dialogue, AMissingSerialDeviceIsAFault) {
  Dialogue dialogue(ParseAddress("serial:/dev/there-is-no-such-line:9600").value(), "*IDN?", "");
  EXPECT_EQ(KindOf([&] { Ask(dialogue, "A?"); }), FaultKind::kDropped);
}

class NumberText : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rubbish, NumberText,
                         testing::Values("12.5x", "12.5 13", "", "nan", "inf", "1,2", "0x10", "12.5;12.5", "--1",
                                         "1e"));

TEST_P(NumberText, WithAnythingElseInItIsAProtocolFaultAndEndsTheConnection) {
  FakeController controller(WithIdentity(
      [](const std::string& line) { return Reply{line == "A?" ? std::string(GetParam()) + "\n" : "7\n"}; }));
  Dialogue dialogue = DialogueWith(controller);
  DeviceLine line(dialogue, "target", kPatience);
  EXPECT_EQ(KindOf([&] { line.AskNumber("A?", 1.0); }), FaultKind::kProtocol);
  EXPECT_EQ(line.AskNumber("B?", 1.0), 7.0);
  EXPECT_EQ(controller.Connections(), 2);
}

TEST(AddressText, GoesBothWays) {
  for (const char* text : {"tcp:localhost:5025", "tcp:[::1]:5026", "serial:/dev/ttyUSB0:9600", "serial:/dev/ttyUSB0:9600:7E2"})
    EXPECT_EQ(ParseAddress(text).value().Text(), text);
  EXPECT_EQ(ParseAddress("serial:/dev/ttyUSB0:9600:7E2").value().frame, "7E2");
  EXPECT_EQ(ParseAddress("serial:/dev/ttyUSB0:9600:8N1").value().Text(), "serial:/dev/ttyUSB0:9600") << "the usual frame";
  EXPECT_EQ(ParseAddress("serial:/dev/serial/by-path/pci-0000:00:14.0").value().number, kDefaultBaud);
}

TEST(AddressText, IsRefusedIfItIsNone) {
  for (const char* text : {"", "tcp:", "tcp:host", "tcp::5025", "tcp:host:0", "tcp:host:65536", "tcp:host:50x",
                           "serial:", "serial:ttyUSB0", "usb:1", "localhost:5025", "serial:/dev/ttyUSB0:7E2"})
    EXPECT_FALSE(ParseAddress(text)) << text;
}

}  // namespace
}  // namespace twinbench::hw

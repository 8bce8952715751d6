#pragma once

#include "hw_bridge/control/controlled_machine.h"

namespace twinbench::hw {

/// The request that begins a conversation with linuxcncrsh; its answer says who is there.
/// @param connect_password  What linuxcncrsh was started with, or "EMC".
std::string LinuxCncHello(const std::string& connect_password);
/// What its answer begins with where the password is right.
inline constexpr const char* kLinuxCncIdentity = "HELLO ACK";

/// Where one of our axes is found at the controller.
struct LinuxCncAxis {
  char letter = 'X';  // X, Y, Z, A, B or C, as programs name it
  int joint = 0;      // that moves it
};

/// A machine run by LinuxCNC, over its remote shell linuxcncrsh (docs/protocols.md). Reference: linuxcncrsh(1).
///
/// Moves are single blocks of a program in absolute machine coordinates (G53), so that offsets of work and tool do
/// not count. Emergency stop and power are left to whoever stands at the machine; Home switches it on, for it is
/// asked only where homing is allowed.
class LinuxCncMachine : public ControlledMachine {
 public:
  /// @param at               One entry an axis.
  /// @param enable_password  That lets a connection move something.
  LinuxCncMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                  std::vector<LinuxCncAxis> at, std::string enable_password, const MachineManner& manner);

  /// MIN_LIMIT and MAX_LIMIT of the axes' sections in the controller's configuration.
  /// @throws DeviceFault kRestarted unless it is switched on and homed: it tells them only then.
  std::vector<AxisLimits> Travel() override;
  void StartMove(const std::vector<double>& to, double feed_m_s) override;
  /// @throws DeviceFault kRefused: it has no pulses at places of an arc, by which instruments could be latched.
  void StartArc(const Arc& arc) override;
  std::vector<AxisState> State() override;

 private:
  /// It takes nothing from somebody who has not said the password.
  std::string StopWord() const override { return "set enable " + enable_password_ + "\nset abort"; }
  /// What an emergency stop or a loss of power has ended needs no command, and takes none: whether the axes rest is
  /// for State to say.
  void SendStop() override;
  bool AskDone() override;
  void SendHome() override;
  bool FindsOrigin(Duration within) override;

  void Greet();
  void Prepare();
  void RequireAxes();
  std::vector<std::string> Words(const std::string& what, std::size_t least);
  std::string Get(const std::string& what) { return Words(what, 1).front(); }
  std::vector<std::string> OfJoints(const std::string& what);
  void Set(const std::string& what);
  bool IsSet(const std::string& what);
  /// Says the password, by which it obeys us and nobody else. @return whether it is the right one.
  bool TakesOver() { return IsSet("enable " + enable_password_); }
  bool IsObeyed() { return Get("enable") == "ON"; }
  bool IsOn() { return Get("machine") == "ON"; }
  void RequireObeyed();
  void RequireReleased();
  void RequireOn();
  void TakeCommands();
  double Limit(std::size_t axis, const char* which);
  std::string Errors();
  std::vector<double> Places(const std::string& what);
  std::size_t FurthestOff(const std::vector<double>& commanded) const;

  std::vector<LinuxCncAxis> at_;
  std::string enable_password_;
  int greeted_opening_ = 0, prepared_opening_ = 0;
  std::vector<double> sent_;  // by the move that goes on; empty: none has been sent
  std::chrono::steady_clock::time_point sent_at_;
};

}  // namespace twinbench::hw
